/// The background as a coloured octree: what is hit is occupied, what rays go through is free.
#pragma once

#include <cstdint>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include "djpete/background/options.h"
#include "djpete/map/slam_map.h"
#include "djpete/texture/background_cloud.h"
#include "djpete/texture/texture_view.h"

namespace djpete::background {

/// Everything that is not an object, in voxels of `world`. Objects' boxes are neither hit nor
/// carved; what moved away without being an object is carved by later rays. Deterministic; one
/// thread (OctoWorker gives it one of its own).
class OctoBackground {
  public:
    /// Throws obs::InputError if an option is out of its range.
    explicit OctoBackground(const OctoOptions& options = OctoOptions());
    ~OctoBackground();
    OctoBackground(OctoBackground&&) noexcept;
    OctoBackground& operator=(OctoBackground&&) noexcept;

    /// A keyframe with the boxes of all objects near it, also those that it does not show. Uses
    /// its scan, or dense stereo; colours come from its left image. Throws obs::InputError, naming
    /// the frame, if the image does not fit its calibration.
    void addView(const texture::TextureView& view);

    /// With the final poses of `map`: builds the tree again if a keyframe moved by more than the
    /// options allow, clears the voxels in every box that an object ever had, and compacts the
    /// tree. Call once, after the last view.
    void finish(const map::SlamMap& map);

    /// Centres of the occupied voxels that have a colour, in `world`, in the tree's order; larger
    /// (merged) voxels as their smallest ones. Also the uncoloured ones, grey, if `all`.
    std::vector<texture::ColouredPoint> points(bool all = false) const;
    double resolution_m() const;
    std::size_t nodes() const;
    /// As octomap counts it, without the allocator's own.
    std::size_t treeBytes() const;
    std::size_t storedPoints() const;
    bool isOccupied(const geometry::Vec3& p_world) const;
    bool isFree(const geometry::Vec3& p_world) const;

    /// octomap's full tree (.ot), with colours and probabilities. Throws obs::InputError.
    void writeOt(const std::string& file) const;
    /// octomap's binary tree (.bt): occupied, free or unknown. Throws obs::InputError.
    void writeBt(const std::string& file) const;

    /// Figures worth reporting, name to value.
    std::map<std::string, uint64_t> counters() const;

  private:
    struct Impl;
    std::unique_ptr<Impl> impl_;
};

/// The objects of `map` and where they are at `frame`: standing ones anywhere within `range_m` of
/// the vehicle, moving ones while they were tracked.
std::vector<texture::ObjectInView> boxesNear(const map::SlamMap& map, obs::FrameId frame,
                                             const geometry::SE3& T_world_vehicle, double range_m);

}  // namespace djpete::background
