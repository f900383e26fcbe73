/// The textured model of one object.
#pragma once

#include <mrpt/maps/CColouredPointsMap.h>

#include <array>
#include <cstdint>
#include <vector>

#include "djpete/map/entities.h"
#include "djpete/texture/free_space.h"

namespace djpete::texture {

/// What all views said about the colour of one point: weighted mean and spread (West's update of
/// Welford's sums), channels red, green, blue in 0..255.
struct ColourSum {
    float weight = 0;
    uint32_t count = 0;                  ///< views that coloured the point
    std::array<float, 3> mean{0, 0, 0};  ///< weighted mean
    std::array<float, 3> m2{0, 0, 0};    ///< sum of weight * squared deviation from the mean

    void add(const std::array<float, 3>& rgb, float sampleWeight) {
        weight += sampleWeight;
        ++count;
        const float share = sampleWeight / weight;
        for (unsigned c = 0; c < 3; ++c) {
            const float before = rgb[c] - mean[c];
            mean[c] += before * share;
            m2[c] += sampleWeight * before * (rgb[c] - mean[c]);
        }
    }
    /// Joins the samples of two points that turned out to be one.
    void add(const ColourSum& other);
    /// Weighted variance per channel; 0 with fewer than two samples.
    std::array<float, 3> variance() const;
    /// Root of the mean of the channels' variances.
    float standardDeviation() const;
};

/// How a point or its colour came to be; bits of ObjectModel::flags. 0: seen.
namespace flag {
constexpr uint8_t kInferredPoint = 1;   ///< mirrored or filled in; no sensor saw a surface there
constexpr uint8_t kInferredColour = 2;  ///< taken from the mirrored side or from neighbours
constexpr uint8_t kEdited = 4;          ///< changed by hand (see editing.h)
constexpr uint8_t kDarkPart = 8;        ///< glass, rubber, grilles: what they show is mirrored
}  // namespace flag

/// Points of one object in its frame `obj`, and their colours. All vectors are parallel to the
/// cloud's points. A point that no view coloured is neutral grey (kNeutralGrey) with count 0.
struct ObjectModel {
    static constexpr float kNeutralGrey = 0.5F;  ///< of red, green, blue in 0..1
    static constexpr std::size_t kMaxViews = 32;
    static constexpr std::array<uint8_t, 3> kUnknownAlbedo{128, 128, 128};

    map::ObjectId id;
    obs::ObjectClass objectClass = obs::ObjectClass::Car;
    geometry::Vec3 size_m{0, 0, 0};             ///< as last told
    mrpt::maps::CColouredPointsMap::Ptr cloud;  ///< frame obj; colours = means / 255
    std::vector<ColourSum> colours;
    std::vector<std::array<float, 3>> normals;  ///< outward unit normals, frame obj
    std::vector<float> radius_m;                ///< of the disc that a point stands for
    std::vector<uint8_t> flags;                 ///< see namespace flag
    std::vector<uint32_t> seenIn;               ///< bit k: views[k] gave the point a colour sample
    /// What the surface reflects by itself, without the light of the drive, coded as sRGB. Parallel
    /// to the points, or empty where it was never estimated (see TextureOptions::albedo).
    std::vector<std::array<uint8_t, 3>> albedo;
    std::vector<obs::FrameId> views;  ///< at most kMaxViews that coloured a point, rising
    FreeSpace freeSpace;              ///< where sensors looked through, frame obj

    std::size_t size() const { return colours.size(); }
    /// Adds a point without colour that stands for a disc; all vectors grow by one.
    void addPoint(const std::array<float, 3>& p_obj, const std::array<float, 3>& normal,
                  float discRadius_m, uint8_t pointFlags = 0);
    std::array<float, 3> point(std::size_t index) const;
    /// The cloud's colour of a point: its ColourSum's mean, or neutral grey.
    void showColour(std::size_t index);
    /// A copy of the points whose `keep` is true, in the same order, with a cloud of its own.
    ObjectModel subset(const std::vector<bool>& keep) const;
    /// A copy with a cloud of its own; plain copies share the cloud.
    ObjectModel clone() const;
    /// A copy whose colours are the albedo, 0..255 as sRGB codes them. Points without one, and all
    /// points of a model whose albedo was never estimated, keep no colour.
    ObjectModel withAlbedo() const;
    /// Fraction of points with a colour; 0 for an empty model.
    double coverage() const;
};

}  // namespace djpete::texture
