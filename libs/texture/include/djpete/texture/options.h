/// Tuning of the object textures and of the coloured background.
#pragma once

#include <mrpt/config/CLoadableOptions.h>

#include <cstdint>

namespace djpete::texture {

/// Options of ObjectTexturer; every key is explained in saveToConfigFile.
struct TextureOptions : public mrpt::config::CLoadableOptions {
    double voxel_m = 0.03;
    double box_margin_m = 0.10;
    double ground_clearance_m = 0.12;
    uint64_t max_points_per_object = 20000;
    uint64_t max_points_total = 4000000;

    double max_distance_m = 40;
    double min_facing_cos = 0.2;
    double self_tolerance_m = 0.12;
    double scene_tolerance_m = 0.4;
    double scan_vertical_spacing_deg = 0.42;
    double scan_horizontal_spacing_deg = 0.18;
    int mask_border_px = 2;
    double reference_distance_m = 10;
    uint64_t max_views_per_object = 16;
    uint64_t max_view_mb = 256;
    bool exposure = true;
    bool refine = true;
    bool albedo = true;
    double camera_gamma = 1;
    double follow_distance_m = 0.05;
    double follow_angle_deg = 0.5;

    bool stereo_geometry = true;
    double stereo_max_distance_m = 20;

    void loadFromConfigFile(const mrpt::config::CConfigFileBase& source,
                            const std::string& section) override;
    void saveToConfigFile(mrpt::config::CConfigFileBase& target,
                          const std::string& section) const override;
};

/// Options of BackgroundCloud.
struct BackgroundCloudOptions : public mrpt::config::CLoadableOptions {
    double voxel_m = 0.15;
    double max_distance_m = 40;
    double stereo_max_distance_m = 25;
    double object_margin_m = 0.25;
    uint64_t max_points = 2000000;

    void loadFromConfigFile(const mrpt::config::CConfigFileBase& source,
                            const std::string& section) override;
    void saveToConfigFile(mrpt::config::CConfigFileBase& target,
                          const std::string& section) const override;
};

}  // namespace djpete::texture
