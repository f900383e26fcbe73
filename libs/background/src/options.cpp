#include "djpete/background/options.h"

#include <mrpt/config/CConfigFileBase.h>

#include <sstream>

#include "djpete/obs/errors.h"

namespace djpete::background {

namespace {

void requireRange(const char* key, double value, double low, double high) {
    if (value >= low && value <= high) return;
    std::ostringstream text;
    text << "key '" << key << "' is " << value << "; expected " << low << " to " << high;
    throw obs::InputError(text.str());
}

}  // namespace

void OctoOptions::check() const {
    requireRange("resolution_m", resolution_m, 0.02, 5);
    requireRange("max_distance_m", max_distance_m, 1, 120);
    requireRange("min_distance_m", min_distance_m, 0, max_distance_m);
    requireRange("carve_distance_m", carve_distance_m, 0, 120);
    requireRange("stereo_max_distance_m", stereo_max_distance_m, 1, 120);
    requireRange("decimation_m", decimation_m, 0.01, 5);
    requireRange("object_margin_m", object_margin_m, 0, 5);
    requireRange("ground_clearance_m", ground_clearance_m, 0, 1);
    requireRange("hit_probability", hit_probability, 0.5, 0.99);
    requireRange("stereo_hit_probability", stereo_hit_probability, 0.5, 0.99);
    requireRange("miss_probability", miss_probability, 0.01, 0.5);
    requireRange("ground_share", ground_share, 0, 0.9);
    requireRange("colour_reach_voxels", colour_reach_voxels, 0, 100);
    requireRange("max_nodes", double(max_nodes), 1000, 2e9);
    requireRange("max_stored_points", double(max_stored_points), 1000, 2e9);
    requireRange("min_period_s", min_period_s, 0, 3600);
    requireRange("queue_keyframes", queue_keyframes, 1, 1000);
    requireRange("rebuild_above_m", rebuild_above_m, 0, 1e6);
    requireRange("rebuild_above_deg", rebuild_above_deg, 0, 360);
    // A scan's grid of bits must fit a machine's memory.
    requireRange("max_distance_m / resolution_m", max_distance_m / resolution_m, 1, 400);
    if (when_full != "wait" && when_full != "skip") {
        throw obs::InputError("key 'when_full' is '" + when_full +
                              "'; expected one of: wait, skip");
    }
}

void OctoOptions::loadFromConfigFile(const mrpt::config::CConfigFileBase& c, const std::string& s) {
    MRPT_LOAD_CONFIG_VAR(resolution_m, double, c, s);
    MRPT_LOAD_CONFIG_VAR(min_distance_m, double, c, s);
    MRPT_LOAD_CONFIG_VAR(max_distance_m, double, c, s);
    MRPT_LOAD_CONFIG_VAR(carve_distance_m, double, c, s);
    MRPT_LOAD_CONFIG_VAR(stereo_max_distance_m, double, c, s);
    MRPT_LOAD_CONFIG_VAR(decimation_m, double, c, s);
    MRPT_LOAD_CONFIG_VAR(object_margin_m, double, c, s);
    MRPT_LOAD_CONFIG_VAR(ground_clearance_m, double, c, s);
    MRPT_LOAD_CONFIG_VAR(hit_probability, double, c, s);
    MRPT_LOAD_CONFIG_VAR(stereo_hit_probability, double, c, s);
    MRPT_LOAD_CONFIG_VAR(miss_probability, double, c, s);
    MRPT_LOAD_CONFIG_VAR(ground_share, double, c, s);
    MRPT_LOAD_CONFIG_VAR(store_free_space, bool, c, s);
    MRPT_LOAD_CONFIG_VAR(max_nodes, uint64_t, c, s);
    MRPT_LOAD_CONFIG_VAR(max_stored_points, uint64_t, c, s);
    MRPT_LOAD_CONFIG_VAR(min_period_s, double, c, s);
    const auto reach = c.read_int(s, "colour_reach_voxels", int(colour_reach_voxels));
    requireRange("colour_reach_voxels", reach, 0, 100);
    colour_reach_voxels = unsigned(reach);
    const auto queue = c.read_int(s, "queue_keyframes", int(queue_keyframes));
    requireRange("queue_keyframes", queue, 1, 1000);
    queue_keyframes = unsigned(queue);
    when_full = c.read_string(s, "when_full", when_full);
    MRPT_LOAD_CONFIG_VAR(rebuild_above_m, double, c, s);
    MRPT_LOAD_CONFIG_VAR(rebuild_above_deg, double, c, s);
    check();
}

void OctoOptions::saveToConfigFile(mrpt::config::CConfigFileBase& c, const std::string& s) const {
    MRPT_SAVE_CONFIG_VAR_COMMENT(resolution_m, "m: side of the smallest voxel");
    MRPT_SAVE_CONFIG_VAR_COMMENT(min_distance_m,
                                 "m: nearer points are the vehicle's own; left out");
    MRPT_SAVE_CONFIG_VAR_COMMENT(max_distance_m,
                                 "m: points farther from the sensor are no hits; at most 400 "
                                 "voxels");
    MRPT_SAVE_CONFIG_VAR_COMMENT(carve_distance_m,
                                 "m: rays make voxels free up to here, also those that end "
                                 "farther away; 0: no carving");
    MRPT_SAVE_CONFIG_VAR_COMMENT(stereo_max_distance_m,
                                 "m: the farthest points of dense stereo, for views without a "
                                 "scan");
    MRPT_SAVE_CONFIG_VAR_COMMENT(decimation_m,
                                 "m: one point of a scan per cube this wide, coloured ones first");
    MRPT_SAVE_CONFIG_VAR_COMMENT(object_margin_m,
                                 "m: boxes of objects are grown by this; nothing in them is hit "
                                 "or carved");
    MRPT_SAVE_CONFIG_VAR_COMMENT(ground_clearance_m,
                                 "m: up to here above its bottom a box holds road, not object");
    MRPT_SAVE_CONFIG_VAR_COMMENT(hit_probability, "that a voxel is occupied, after one hit");
    MRPT_SAVE_CONFIG_VAR_COMMENT(stereo_hit_probability,
                                 "the same for a point of dense stereo, which may be wrong");
    MRPT_SAVE_CONFIG_VAR_COMMENT(miss_probability, "... after one ray went through it");
    MRPT_SAVE_CONFIG_VAR_COMMENT(ground_share,
                                 "share of a ray, before its end, that does not carve the layer "
                                 "it ends in: grazing rays would carve the road");
    MRPT_SAVE_CONFIG_VAR_COMMENT(store_free_space,
                                 "keep voxels that were only ever free (for planning); else rays "
                                 "only clear what was hit, with a tenth of the memory");
    MRPT_SAVE_CONFIG_VAR_COMMENT(colour_reach_voxels,
                                 "voxels that no image showed take their neighbours' colours, so "
                                 "many voxels far; 0: they stay without");
    MRPT_SAVE_CONFIG_VAR_COMMENT(max_nodes,
                                 "of the tree, about 50 bytes each; later voxels are not made");
    MRPT_SAVE_CONFIG_VAR_COMMENT(max_stored_points,
                                 "of all keyframes, 10 bytes each, for rebuilding; beyond, every "
                                 "keyframe keeps half of its points");
    MRPT_SAVE_CONFIG_VAR_COMMENT(min_period_s,
                                 "s: keyframes closer in time to the last one used are left out");
    MRPT_SAVE_CONFIG_VAR_COMMENT(queue_keyframes, "that may wait for the worker");
    MRPT_SAVE_CONFIG_VAR_COMMENT(when_full,
                                 "wait | skip; skip: for live robots, the result then depends on "
                                 "timing and the number of skipped keyframes is reported");
    MRPT_SAVE_CONFIG_VAR_COMMENT(rebuild_above_m,
                                 "m: if a keyframe moved more than this since it was used, the "
                                 "tree is built again at the end");
    MRPT_SAVE_CONFIG_VAR_COMMENT(rebuild_above_deg, "deg: ... or turned more than this");
}

}  // namespace djpete::background
