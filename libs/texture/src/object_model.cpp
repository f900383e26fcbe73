#include "djpete/texture/object_model.h"

#include <algorithm>
#include <cmath>

namespace djpete::texture {

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

void ObjectModel::addPoint(const std::array<float, 3>& p_obj, const std::array<float, 3>& normal,
                           float discRadius_m, uint8_t pointFlags) {
    if (!cloud) cloud = mrpt::maps::CColouredPointsMap::Create();
    if (!albedo.empty()) albedo.push_back(kUnknownAlbedo);
    cloud->insertPointRGB(p_obj[0], p_obj[1], p_obj[2], kNeutralGrey, kNeutralGrey, kNeutralGrey);
    colours.emplace_back();
    normals.push_back(normal);
    radius_m.push_back(discRadius_m);
    flags.push_back(pointFlags);
    seenIn.push_back(0);
}

std::array<float, 3> ObjectModel::point(std::size_t index) const {
    std::array<float, 3> p{};
    cloud->getPointFast(index, p[0], p[1], p[2]);
    return p;
}

void ObjectModel::showColour(std::size_t index) {
    const ColourSum& sum = colours[index];
    if (sum.count == 0) {
        cloud->setPointColor_fast(index, kNeutralGrey, kNeutralGrey, kNeutralGrey);
    } else {
        const auto share = [&](std::size_t c) { return std::clamp(sum.mean[c] / 255, 0.0F, 1.0F); };
        cloud->setPointColor_fast(index, share(0), share(1), share(2));
    }
}

ObjectModel ObjectModel::subset(const std::vector<bool>& keep) const {
    ObjectModel out;
    out.id = id;
    out.objectClass = objectClass;
    out.size_m = size_m;
    out.views = views;
    out.freeSpace = freeSpace;
    out.cloud = mrpt::maps::CColouredPointsMap::Create();
    for (std::size_t i = 0; i < size(); ++i) {
        if (!keep[i]) continue;
        const std::size_t to = out.size();
        out.addPoint(point(i), normals[i], radius_m[i], flags[i]);
        out.colours[to] = colours[i];
        out.seenIn[to] = seenIn[i];
        out.showColour(to);
        if (!albedo.empty()) {
            out.albedo.resize(to + 1);
            out.albedo[to] = albedo[i];
        }
    }
    return out;
}

ObjectModel ObjectModel::clone() const {
    ObjectModel copy = *this;
    if (cloud) copy.cloud = std::make_shared<mrpt::maps::CColouredPointsMap>(*cloud);
    return copy;
}

ObjectModel ObjectModel::withAlbedo() const {
    ObjectModel out = clone();
    for (std::size_t i = 0; i < size(); ++i) {
        const uint32_t count = colours[i].count;
        out.colours[i] = ColourSum();
        if (!albedo.empty() && albedo[i] != kUnknownAlbedo && count > 0) {
            const auto& a = albedo[i];
            out.colours[i].add(
                {static_cast<float>(a[0]), static_cast<float>(a[1]), static_cast<float>(a[2])},
                1.0F);
            out.colours[i].count = count;
        }
        out.showColour(i);
    }
    return out;
}

double ObjectModel::coverage() const {
    if (colours.empty()) return 0;
    std::size_t coloured = 0;
    for (const auto& sum : colours) coloured += sum.count > 0 ? 1 : 0;
    return static_cast<double>(coloured) / static_cast<double>(colours.size());
}

}  // namespace djpete::texture
