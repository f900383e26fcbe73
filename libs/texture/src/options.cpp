#include "djpete/texture/options.h"

#include <mrpt/config/CConfigFileBase.h>

namespace djpete::texture {

void TextureOptions::loadFromConfigFile(const mrpt::config::CConfigFileBase& c,
                                        const std::string& s) {
    MRPT_LOAD_CONFIG_VAR(voxel_m, double, c, s);
    MRPT_LOAD_CONFIG_VAR(box_margin_m, double, c, s);
    MRPT_LOAD_CONFIG_VAR(ground_clearance_m, double, c, s);
    MRPT_LOAD_CONFIG_VAR(max_points_per_object, uint64_t, c, s);
    MRPT_LOAD_CONFIG_VAR(max_points_total, uint64_t, c, s);
    MRPT_LOAD_CONFIG_VAR(max_distance_m, double, c, s);
    MRPT_LOAD_CONFIG_VAR(min_facing_cos, double, c, s);
    MRPT_LOAD_CONFIG_VAR(self_tolerance_m, double, c, s);
    MRPT_LOAD_CONFIG_VAR(scene_tolerance_m, double, c, s);
    MRPT_LOAD_CONFIG_VAR(scan_vertical_spacing_deg, double, c, s);
    MRPT_LOAD_CONFIG_VAR(scan_horizontal_spacing_deg, double, c, s);
    MRPT_LOAD_CONFIG_VAR(mask_border_px, int, c, s);
    MRPT_LOAD_CONFIG_VAR(reference_distance_m, double, c, s);
    MRPT_LOAD_CONFIG_VAR(max_views_per_object, uint64_t, c, s);
    MRPT_LOAD_CONFIG_VAR(max_view_mb, uint64_t, c, s);
    MRPT_LOAD_CONFIG_VAR(exposure, bool, c, s);
    MRPT_LOAD_CONFIG_VAR(refine, bool, c, s);
    MRPT_LOAD_CONFIG_VAR(albedo, bool, c, s);
    MRPT_LOAD_CONFIG_VAR(camera_gamma, double, c, s);
    MRPT_LOAD_CONFIG_VAR(follow_distance_m, double, c, s);
    MRPT_LOAD_CONFIG_VAR(follow_angle_deg, double, c, s);
    MRPT_LOAD_CONFIG_VAR(stereo_geometry, bool, c, s);
    MRPT_LOAD_CONFIG_VAR(stereo_max_distance_m, double, c, s);
}

void TextureOptions::saveToConfigFile(mrpt::config::CConfigFileBase& c,
                                      const std::string& s) const {
    MRPT_SAVE_CONFIG_VAR_COMMENT(voxel_m, "m: at most one point of an object per cube this wide");
    MRPT_SAVE_CONFIG_VAR_COMMENT(box_margin_m,
                                 "m: boxes are a little wrong; points this far "
                                 "outside still belong to the object");
    MRPT_SAVE_CONFIG_VAR_COMMENT(ground_clearance_m,
                                 "m: points lower than this above the box's "
                                 "bottom are road, not car");
    MRPT_SAVE_CONFIG_VAR_COMMENT(max_points_per_object, "later points of an object are dropped");
    MRPT_SAVE_CONFIG_VAR_COMMENT(max_points_total,
                                 "points of all objects together (about 120 "
                                 "bytes each)");
    MRPT_SAVE_CONFIG_VAR_COMMENT(max_distance_m, "m: no colours from farther away");
    MRPT_SAVE_CONFIG_VAR_COMMENT(min_facing_cos,
                                 "cosine between surface normal and line of sight "
                                 "below which a point gets no colour");
    MRPT_SAVE_CONFIG_VAR_COMMENT(self_tolerance_m,
                                 "m: a point this far behind the object's own "
                                 "surface is hidden");
    MRPT_SAVE_CONFIG_VAR_COMMENT(scene_tolerance_m,
                                 "m: scene points this far in front of a point "
                                 "hide it");
    MRPT_SAVE_CONFIG_VAR_COMMENT(scan_vertical_spacing_deg,
                                 "deg: between the scan's beams; a scan "
                                 "point hides what is within half of it");
    MRPT_SAVE_CONFIG_VAR_COMMENT(scan_horizontal_spacing_deg, "deg: between points of one beam");
    MRPT_SAVE_CONFIG_VAR_COMMENT(mask_border_px,
                                 "px: masks are eroded by this, since their "
                                 "border shows the background");
    MRPT_SAVE_CONFIG_VAR_COMMENT(reference_distance_m,
                                 "m: a sample weighs (this / distance)^2 "
                                 "cos(angle)^2, at most cos(angle)^2, times its view's sharpness");
    MRPT_SAVE_CONFIG_VAR_COMMENT(max_views_per_object,
                                 "of an object this many cut-outs of images are kept (1 to 32), "
                                 "those that add most; its colours come from them");
    MRPT_SAVE_CONFIG_VAR_COMMENT(max_view_mb,
                                 "MB: cut-outs of all objects together; beyond it objects not seen "
                                 "for long keep fewer");
    MRPT_SAVE_CONFIG_VAR_COMMENT(exposure,
                                 "find each image's brightness (gain and offset) from points that "
                                 "several images show, and even it out");
    MRPT_SAVE_CONFIG_VAR_COMMENT(refine,
                                 "at the end: drop points that masks contradict, take out the "
                                 "noise, fill gaps between beams");
    MRPT_SAVE_CONFIG_VAR_COMMENT(albedo,
                                 "at the end: take sun, sky and mirrored light out of the colours, "
                                 "as a second colour of each point");
    MRPT_SAVE_CONFIG_VAR_COMMENT(camera_gamma,
                                 "of the cameras, for the albedo: value = 255 light^(1/gamma)");
    MRPT_SAVE_CONFIG_VAR_COMMENT(
        follow_distance_m,
        "m: if a pose of an object in a view changes by more, its points "
        "follow and all views are projected again; at the end of the drive "
        "they do so anyway");
    MRPT_SAVE_CONFIG_VAR_COMMENT(follow_angle_deg, "deg: the same for angles");
    MRPT_SAVE_CONFIG_VAR_COMMENT(stereo_geometry,
                                 "dense stereo gives an object points in views "
                                 "without a scan");
    MRPT_SAVE_CONFIG_VAR_COMMENT(stereo_max_distance_m, "m: beyond, stereo depth is too coarse");
}

void BackgroundCloudOptions::loadFromConfigFile(const mrpt::config::CConfigFileBase& c,
                                                const std::string& s) {
    MRPT_LOAD_CONFIG_VAR(voxel_m, double, c, s);
    MRPT_LOAD_CONFIG_VAR(max_distance_m, double, c, s);
    MRPT_LOAD_CONFIG_VAR(stereo_max_distance_m, double, c, s);
    MRPT_LOAD_CONFIG_VAR(object_margin_m, double, c, s);
    MRPT_LOAD_CONFIG_VAR(max_points, uint64_t, c, s);
}

void BackgroundCloudOptions::saveToConfigFile(mrpt::config::CConfigFileBase& c,
                                              const std::string& s) const {
    MRPT_SAVE_CONFIG_VAR_COMMENT(voxel_m, "m: at most one point per cube this wide");
    MRPT_SAVE_CONFIG_VAR_COMMENT(max_distance_m, "m: scan points farther away are left out");
    MRPT_SAVE_CONFIG_VAR_COMMENT(stereo_max_distance_m, "m: the same for stereo points");
    MRPT_SAVE_CONFIG_VAR_COMMENT(object_margin_m,
                                 "m: objects' boxes are grown by this and kept "
                                 "out");
    MRPT_SAVE_CONFIG_VAR_COMMENT(max_points, "later points are dropped");
}

}  // namespace djpete::texture
