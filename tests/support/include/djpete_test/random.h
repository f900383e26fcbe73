/// Random numbers for tests.
#pragma once

#include <cmath>
#include <cstdint>
#include <random>

#include "djpete/geometry/types.h"

namespace djpete_test {

/// Uniform and normal numbers that are the same with every standard library.
class Random {
  public:
    explicit Random(uint64_t seed) : engine_(seed) {}
    double uniform(double a = 0, double b = 1) {
        return a + (b - a) * static_cast<double>(engine_() >> 11U) / 9007199254740992.0;
    }
    double normal(double sigma) {
        const double u = 1 - uniform(), v = uniform();
        return sigma * std::sqrt(-2 * std::log(u)) * std::cos(2 * M_PI * v);
    }
    djpete::geometry::Vec3 normal3(double sigma) {
        const double x = normal(sigma), y = normal(sigma), z = normal(sigma);
        return {x, y, z};
    }

  private:
    std::mt19937_64 engine_;
};

}  // namespace djpete_test
