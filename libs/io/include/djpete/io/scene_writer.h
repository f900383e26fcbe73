/// The map as a scene, and its picture.
#pragma once

#include <mrpt/config/CLoadableOptions.h>
#include <mrpt/opengl/COpenGLScene.h>

#include <cstdint>
#include <map>
#include <string>
#include <vector>

#include "djpete/map/slam_map.h"
#include "djpete/texture/background_cloud.h"
#include "djpete/texture/object_model.h"

namespace djpete::io {

/// Look of the scene and of its picture; every key is explained in saveToConfigFile.
struct SceneOptions : public mrpt::config::CLoadableOptions {
    double object_point_px = 4;
    double background_point_px = 5;
    uint64_t max_background_cubes = 150000;
    double landmark_point_px = 2;
    uint64_t max_frustums = 40;
    bool show_uncoloured = false;

    int image_width_px = 1600;
    int image_height_px = 900;
    bool bird_view = false;
    double view_behind_m = 12;
    double view_height_m = 9;

    void loadFromConfigFile(const mrpt::config::CConfigFileBase& source,
                            const std::string& section) override;
    void saveToConfigFile(mrpt::config::CConfigFileBase& target,
                          const std::string& section) const override;
};

struct SceneContent {
    map::MapSnapshot map;  ///< must not be null
    std::map<map::ObjectId, texture::ObjectModel> models;
    std::vector<texture::ColouredPoint> background;  ///< in world; may be empty
    double backgroundVoxel_m = 0;                    ///< if they are centres of voxels this wide
};

/// Named layers (CSetOfObjects): trajectory, sparse_map, background, objects, boxes, ids. A moving
/// object stands at its last state. The main viewport's camera looks along the drive from behind
/// and above its start.
mrpt::opengl::COpenGLScene::Ptr makeScene(const SceneContent& content, const SceneOptions& options);

/// MRPT's .3Dscene, for SceneViewer3D.
void writeScene(const mrpt::opengl::COpenGLScene& scene, const std::string& file);

struct RenderReport {
    bool written = false;
    std::string whyNot;  ///< one sentence, if not written: no EGL on this machine
};

/// Renders the scene from its main camera into a PNG without a display. Throws obs::InputError if
/// the file cannot be written; a machine without EGL is no error.
RenderReport renderScene(const mrpt::opengl::COpenGLScene& scene, const std::string& file,
                         const SceneOptions& options);

}  // namespace djpete::io
