/// Summaries of error samples.
#pragma once

#include <cstddef>
#include <optional>
#include <vector>

namespace djpete::evaluation {

/// The value below which the given fraction (0..1) of the samples lies, linear between neighbouring
/// samples; nothing without samples.
std::optional<double> quantile(std::vector<double> samples, double fraction);

struct Summary {
    std::size_t count = 0;
    std::optional<double> median, mean, p90;  ///< nothing without samples
};
Summary summarise(const std::vector<double>& samples);

}  // namespace djpete::evaluation
