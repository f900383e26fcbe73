#include "djpete/texture/object_model.h"

#include <cmath>

namespace djpete::texture {

void ColourSum::add(const std::array<float, 3>& rgb, float sampleWeight) {
    weight += sampleWeight;
    ++count;
    for (unsigned c = 0; c < 3; ++c) {
        const float before = rgb[c] - mean[c];
        mean[c] += before * (sampleWeight / weight);
        m2[c] += sampleWeight * before * (rgb[c] - mean[c]);
    }
}

void ColourSum::add(const ColourSum& other) {
    if (other.count == 0) return;
    const float total = weight + other.weight;
    for (unsigned c = 0; c < 3; ++c) {
        const float apart = other.mean[c] - mean[c];
        m2[c] += other.m2[c] + apart * apart * (weight * other.weight / total);
        mean[c] += apart * (other.weight / total);
    }
    weight = total;
    count += other.count;
}

std::array<float, 3> ColourSum::variance() const {
    if (count < 2) return {0, 0, 0};
    return {m2[0] / weight, m2[1] / weight, m2[2] / weight};
}

float ColourSum::standardDeviation() const {
    const auto v = variance();
    return std::sqrt((v[0] + v[1] + v[2]) / 3);
}

ObjectModel ObjectModel::clone() const {
    ObjectModel copy = *this;
    if (cloud) copy.cloud = std::make_shared<mrpt::maps::CColouredPointsMap>(*cloud);
    return copy;
}

double ObjectModel::coverage() const {
    if (colours.empty()) return 0;
    std::size_t coloured = 0;
    for (const auto& sum : colours) coloured += sum.count > 0 ? 1 : 0;
    return static_cast<double>(coloured) / static_cast<double>(colours.size());
}

}  // namespace djpete::texture
