#include "djpete/background/octo_background.h"

#include <cmath>

#include "djpete/obs/errors.h"
#include "scan_record.h"
#include "tree_update.h"

namespace djpete::background {

namespace {

using geometry::SE3;
using geometry::Vec3;

constexpr std::array<uint8_t, 3> kUncoloured{128, 128, 128};

std::vector<KeepOut> keepOutsOf(const std::vector<texture::ObjectInView>& objects,
                                const OctoOptions& options) {
    std::vector<KeepOut> out;
    for (const auto& o : objects) out.push_back(keepOutOf(o.T_world_obj, o.size_m, options));
    return out;
}

/// Of the vehicle at a frame that the map knows.
std::optional<SE3> vehicleAt(const map::SlamMap& map, obs::FrameId frame) {
    const auto T_world_cam = map.cameraAt(frame);
    if (!T_world_cam) return std::nullopt;
    const auto& keyframe = map.keyframes().at(map.frames().at(frame).reference);
    return *T_world_cam * keyframe.T_vehicle_cam.inverse();
}

}  // namespace

std::vector<texture::ObjectInView> boxesNear(const map::SlamMap& map, obs::FrameId frame,
                                             const SE3& T_world_vehicle, double range_m) {
    std::vector<texture::ObjectInView> out;
    for (const auto& [id, object] : map.objects()) {
        const auto T_world_obj = map.objectPoseAt(id, frame);
        if (!T_world_obj) continue;
        const double apart = (T_world_obj->translation() - T_world_vehicle.translation()).norm();
        if (apart > range_m + 0.5 * object.size_m.norm()) continue;
        out.push_back({id, object.objectClass, object.size_m, *T_world_obj, {}});
    }
    return out;
}

struct OctoBackground::Impl {
    explicit Impl(const OctoOptions& o) : options(o), tree(o.resolution_m) {
        options.check();
        tree.setProbHit(o.hit_probability);
        tree.setProbMiss(o.miss_probability);
    }

    void insert(const ScanRecord& record, const SE3& T_world_vehicle,
                const std::vector<KeepOut>& boxes) {
        const auto marks = markRays(record, T_world_vehicle, boxes, options);
        if (!marks) {
            ++outside;
            return;
        }
        const UpdateCount count = updateTree(
            tree, *marks,
            record.fromStereo ? options.stereo_hit_probability : options.hit_probability, options);
        hits += count.hits;
        frees += count.frees;
        refused += count.refused;
        // Full of what could be merged? Then merge, unless that has just been tried in vain.
        if (tree.size() > nextCompaction && tree.size() > options.max_nodes / 2) {
            compact();
            nextCompaction = tree.size() + options.max_nodes / 8;
        }
    }

    void compact() {
        if (!tree.getRoot()) return;
        tree.updateInnerOccupancy();
        tree.prune();
    }

    void keep(ScanRecord record) {
        for (unsigned i = 0; i < thinned; ++i) thin(record);
        stored += record.points.size();
        records.push_back(std::move(record));
        while (stored > options.max_stored_points && thinned < 16) {
            ++thinned;
            stored = 0;
            for (auto& r : records) {
                thin(r);
                stored += r.points.size();
            }
        }
    }
    static void thin(ScanRecord& record) {
        std::size_t kept = 0;
        for (std::size_t i = 0; i < record.points.size(); i += 2) {
            record.points[kept++] = record.points[i];
        }
        record.points.resize(kept);
        record.points.shrink_to_fit();
    }

    bool moved(const map::SlamMap& map) const {
        for (const auto& record : records) {
            const auto T_world_vehicle = vehicleAt(map, record.frame);
            if (!T_world_vehicle) continue;
            const SE3 T_then_now = record.T_world_vehicle.inverse() * *T_world_vehicle;
            if (T_then_now.translation().norm() > options.rebuild_above_m ||
                T_then_now.angle_rad() > options.rebuild_above_deg * M_PI / 180) {
                return true;
            }
        }
        return false;
    }

    void rebuild(const map::SlamMap& map) {
        tree.clear();
        nextCompaction = 0;
        hits = frees = refused = outside = 0;
        for (auto& record : records) {
            if (const auto now = vehicleAt(map, record.frame)) record.T_world_vehicle = *now;
            const auto boxes =
                boxesNear(map, record.frame, record.T_world_vehicle, options.max_distance_m);
            insert(record, record.T_world_vehicle, keepOutsOf(boxes, options));
        }
        ++rebuilt;
    }

    void clearBox(const KeepOut& box) {
        forCellsIn(box, options.resolution_m, [&](const Cell& c) {
            for (const int k : c) {
                if (k < 0 || k >= 2 * kMiddleCell) return;
            }
            const auto key = keyOf(c);
            const auto* node = tree.search(key);
            if (!node || !tree.isNodeOccupied(node)) return;
            // octomap's own deleteNode() aborts when it takes the last of eight neighbours; a voxel
            // that one ray went through is as little known.
            auto* leaf = tree.setNodeValue(key, tree.getProbMissLog(), true);
            leaf->setColor(255, 255, 255);
            ++cleared;
        });
    }

    void clearObjects(const map::SlamMap& map) {
        for (const auto& [id, object] : map.objects()) {
            std::optional<SE3> before;
            for (const auto& [frame, state] : object.states) {
                const SE3 T_world_obj = map.T_world_obj(state);
                if (before) {  // a standing object has one pose in all its frames
                    const SE3 moved = before->inverse() * T_world_obj;
                    if (moved.translation().norm() < 0.02 && moved.angle_rad() < 0.01) continue;
                }
                before = T_world_obj;
                clearBox(keepOutOf(T_world_obj, object.size_m, options));
            }
        }
    }

    OctoOptions options;
    octomap::ColorOcTree tree;
    std::vector<ScanRecord> records;  ///< in the order of the views
    std::size_t stored = 0, nextCompaction = 0;
    unsigned thinned = 0;
    uint64_t hits = 0, frees = 0, refused = 0, outside = 0, cleared = 0, rebuilt = 0, spread = 0;
};

OctoBackground::OctoBackground(const OctoOptions& options)
    : impl_(std::make_unique<Impl>(options)) {}
OctoBackground::~OctoBackground() = default;
OctoBackground::OctoBackground(OctoBackground&&) noexcept = default;
OctoBackground& OctoBackground::operator=(OctoBackground&&) noexcept = default;

void OctoBackground::addView(const texture::TextureView& view) {
    ScanRecord record = recordOf(view, impl_->options);
    impl_->insert(record, record.T_world_vehicle, keepOutsOf(view.objects, impl_->options));
    impl_->keep(std::move(record));
}

void OctoBackground::finish(const map::SlamMap& map) {
    if (impl_->moved(map)) impl_->rebuild(map);
    impl_->clearObjects(map);
    impl_->spread = spreadColours(impl_->tree, impl_->options.colour_reach_voxels);
    impl_->compact();
}

std::vector<texture::ColouredPoint> OctoBackground::points(bool all) const {
    std::vector<texture::ColouredPoint> out;
    const auto& tree = impl_->tree;
    for (auto leaf = tree.begin_leafs(), end = tree.end_leafs(); leaf != end; ++leaf) {
        if (!tree.isNodeOccupied(*leaf) || (!all && !leaf->isColorSet())) continue;
        const auto colour = leaf->getColor();
        const auto rgb =
            leaf->isColorSet() ? std::array<uint8_t, 3>{colour.r, colour.g, colour.b} : kUncoloured;
        const int side = 1 << (tree.getTreeDepth() - leaf.getDepth());
        const auto corner = leaf.getIndexKey();
        for (int i = 0; i < side * side * side; ++i) {
            const Vec3 p = centreOf(
                {corner[0] + i % side, corner[1] + i / side % side, corner[2] + i / (side * side)},
                impl_->options.resolution_m);
            out.push_back({static_cast<float>(p.x()), static_cast<float>(p.y()),
                           static_cast<float>(p.z()), rgb});
        }
    }
    return out;
}

double OctoBackground::resolution_m() const { return impl_->options.resolution_m; }
std::size_t OctoBackground::nodes() const { return impl_->tree.size(); }
std::size_t OctoBackground::treeBytes() const { return impl_->tree.memoryUsage(); }
std::size_t OctoBackground::storedPoints() const { return impl_->stored; }

bool OctoBackground::isOccupied(const Vec3& p_world) const {
    const auto* node = impl_->tree.search(p_world.x(), p_world.y(), p_world.z());
    return node && impl_->tree.isNodeOccupied(node);
}

bool OctoBackground::isFree(const Vec3& p_world) const {
    const auto* node = impl_->tree.search(p_world.x(), p_world.y(), p_world.z());
    return node && !impl_->tree.isNodeOccupied(node);
}

void OctoBackground::writeOt(const std::string& file) const {
    if (!impl_->tree.write(file)) throw obs::InputError(file + ": cannot be written");
}

void OctoBackground::writeBt(const std::string& file) const {
    if (!impl_->tree.writeBinaryConst(file)) throw obs::InputError(file + ": cannot be written");
}

std::map<std::string, uint64_t> OctoBackground::counters() const {
    std::map<std::string, uint64_t> out{{"octomap keyframes", impl_->records.size()},
                                        {"octomap nodes", nodes()},
                                        {"octomap bytes", treeBytes()},
                                        {"octomap stored points", storedPoints()},
                                        {"octomap voxels cleared", impl_->cleared},
                                        {"octomap voxels with a neighbour's colour", impl_->spread},
                                        {"octomap rebuilds", impl_->rebuilt}};
    if (impl_->refused > 0) out["rejected: octomap voxels beyond max_nodes"] = impl_->refused;
    if (impl_->outside > 0) out["rejected: octomap scans too far from the start"] = impl_->outside;
    return out;
}

}  // namespace djpete::background
