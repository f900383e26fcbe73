/// Tuning of the octree of the background.
#pragma once

#include <mrpt/config/CLoadableOptions.h>

#include <cstdint>
#include <string>

namespace djpete::background {

/// Options of OctoBackground and its worker; every key is explained in saveToConfigFile.
struct OctoOptions : public mrpt::config::CLoadableOptions {
    double resolution_m = 0.2;
    double min_distance_m = 2.5;
    double max_distance_m = 40;
    double carve_distance_m = 30;
    double stereo_max_distance_m = 25;
    double decimation_m = 0.15;
    double object_margin_m = 0.25;
    double ground_clearance_m = 0.15;
    double hit_probability = 0.7;
    double stereo_hit_probability = 0.58;
    double miss_probability = 0.4;
    double ground_share = 0.15;
    bool store_free_space = true;
    unsigned colour_reach_voxels = 2;

    uint64_t max_nodes = 20000000;
    uint64_t max_stored_points = 20000000;
    double min_period_s = 0;
    unsigned queue_keyframes = 4;
    std::string when_full = "wait";
    double rebuild_above_m = 0.1;
    double rebuild_above_deg = 0.3;

    /// Throws obs::InputError, naming the key, on a value out of its range.
    void check() const;
    void loadFromConfigFile(const mrpt::config::CConfigFileBase& source,
                            const std::string& section) override;
    void saveToConfigFile(mrpt::config::CConfigFileBase& target,
                          const std::string& section) const override;
};

}  // namespace djpete::background
