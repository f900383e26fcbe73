#include <mrpt/config/CConfigFileBase.h>

#include "djpete/io/scene_writer.h"

namespace djpete::io {

void SceneOptions::loadFromConfigFile(const mrpt::config::CConfigFileBase& c,
                                      const std::string& s) {
    MRPT_LOAD_CONFIG_VAR(object_point_px, double, c, s);
    MRPT_LOAD_CONFIG_VAR(background_point_px, double, c, s);
    MRPT_LOAD_CONFIG_VAR(max_background_cubes, uint64_t, c, s);
    MRPT_LOAD_CONFIG_VAR(landmark_point_px, double, c, s);
    MRPT_LOAD_CONFIG_VAR(max_frustums, uint64_t, c, s);
    MRPT_LOAD_CONFIG_VAR(show_uncoloured, bool, c, s);
    MRPT_LOAD_CONFIG_VAR(image_width_px, int, c, s);
    MRPT_LOAD_CONFIG_VAR(image_height_px, int, c, s);
    MRPT_LOAD_CONFIG_VAR(bird_view, bool, c, s);
    MRPT_LOAD_CONFIG_VAR(view_behind_m, double, c, s);
    MRPT_LOAD_CONFIG_VAR(view_height_m, double, c, s);
}

void SceneOptions::saveToConfigFile(mrpt::config::CConfigFileBase& c, const std::string& s) const {
    MRPT_SAVE_CONFIG_VAR_COMMENT(object_point_px, "px: points of textured objects");
    MRPT_SAVE_CONFIG_VAR_COMMENT(background_point_px, "px: points of the background");
    MRPT_SAVE_CONFIG_VAR_COMMENT(max_background_cubes,
                                 "an octree of at most so many voxels is drawn as cubes, else as "
                                 "points");
    MRPT_SAVE_CONFIG_VAR_COMMENT(landmark_point_px, "px: points of the sparse map");
    MRPT_SAVE_CONFIG_VAR_COMMENT(max_frustums, "camera frusta to draw, evenly chosen keyframes");
    MRPT_SAVE_CONFIG_VAR_COMMENT(show_uncoloured,
                                 "draw the grey points that no view coloured, too; an object "
                                 "without any colour is always drawn");
    MRPT_SAVE_CONFIG_VAR_COMMENT(image_width_px,
                                 "px: rounded down to a multiple of 4, which "
                                 "MRPT's renderer needs");
    MRPT_SAVE_CONFIG_VAR_COMMENT(image_height_px, "px");
    MRPT_SAVE_CONFIG_VAR_COMMENT(bird_view,
                                 "look straight down on the whole drive instead of "
                                 "along it");
    MRPT_SAVE_CONFIG_VAR_COMMENT(view_behind_m,
                                 "m: the picture is taken from this far behind the "
                                 "start of the drive");
    MRPT_SAVE_CONFIG_VAR_COMMENT(view_height_m, "m: and from this far above the camera there");
}

}  // namespace djpete::io
