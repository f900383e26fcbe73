#include "djpete/backend/object_size.h"

#include <cmath>

#include "djpete/solver/robust_kernel.h"

namespace djpete::backend {

namespace {

using geometry::Vec3;
using obs::ObjectClass;

constexpr int kReweightings = 5;
constexpr double kCauchyScale = 2;
/// Errors of neighbouring detections are alike: so many of them count as one.
constexpr double kAlike = 4;

}  // namespace

ClassSize usualSize(ObjectClass objectClass) {
    switch (objectClass) {
        case ObjectClass::Car:
            return {{3.9, 1.65, 1.52}, {0.45, 0.12, 0.14}};
        case ObjectClass::Van:
            return {{5.0, 1.9, 2.2}, {0.7, 0.2, 0.35}};
        case ObjectClass::Truck:
            return {{9.0, 2.5, 3.2}, {4.0, 0.3, 0.6}};
        case ObjectClass::Pedestrian:
            return {{0.8, 0.65, 1.75}, {0.25, 0.15, 0.15}};
        case ObjectClass::Cyclist:
            return {{1.75, 0.6, 1.75}, {0.2, 0.15, 0.15}};
        case ObjectClass::Tram:
            return {{20, 2.5, 3.5}, {10, 0.4, 0.4}};
        case ObjectClass::Other:
            break;
    }
    return {{4, 2, 2}, {4, 2, 2}};
}

Vec3 estimateSize(const std::vector<SeenSize>& seen, ObjectClass objectClass, double priorWeight) {
    const ClassSize usual = usualSize(objectClass);
    const auto kernel = solver::RobustKernel::cauchy(kCauchyScale);
    Vec3 out;
    for (int axis = 0; axis < 3; ++axis) {
        double x = 0, all = 0;
        for (const auto& s : seen) {
            x += std::log(s.size_m[axis]) / (s.sigma * s.sigma);
            all += 1 / (s.sigma * s.sigma);
        }
        x /= all;
        const double spread = usual.sigma_m[axis] / usual.mean_m[axis];
        for (int round = 0; round < kReweightings; ++round) {
            double sum = 0, weights = 0;
            for (const auto& s : seen) {
                const double d = std::log(s.size_m[axis]) - x;
                const double w =
                    kernel.weight(d * d / (s.sigma * s.sigma)) / (s.sigma * s.sigma * kAlike);
                sum += w * d;
                weights += w;
            }
            const double prior = priorWeight / (spread * spread);
            sum += prior * (std::log(usual.mean_m[axis]) - x);
            x += sum / (weights + prior);
        }
        out[axis] = std::exp(x);
    }
    return out;
}

}  // namespace djpete::backend
