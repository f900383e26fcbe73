#include "djpete/io/scene_writer.h"

#include <mrpt/io/CFileGZOutputStream.h>
#include <mrpt/opengl/CBox.h>
#include <mrpt/opengl/CFrustum.h>
#include <mrpt/opengl/COctoMapVoxels.h>
#include <mrpt/opengl/CPointCloudColoured.h>
#include <mrpt/opengl/CSetOfLines.h>
#include <mrpt/opengl/CText3D.h>

#include <algorithm>
#include <cmath>
#include <fstream>

#include "djpete/geometry/mrpt_bridge.h"
#include "djpete/obs/errors.h"
#include "scene_camera.h"
#include "text_file.h"

namespace djpete::io {

namespace {

using geometry::SE3;
using geometry::Vec3;
using Layer = mrpt::opengl::CSetOfObjects::Ptr;

const mrpt::img::TColor kTrajectoryColour(255, 120, 0), kStaticColour(70, 200, 90),
    kMovingColour(240, 60, 200), kFrustumColour(80, 160, 255);
constexpr double kDegree = M_PI / 180;

Layer layer(const std::string& name, mrpt::opengl::COpenGLScene& scene) {
    auto out = mrpt::opengl::CSetOfObjects::Create();
    out->setName(name);
    scene.insert(out);
    return out;
}

void addTrajectory(const map::SlamMap& map, const SceneOptions& options, const Layer& to) {
    auto line = mrpt::opengl::CSetOfLines::Create();
    line->setName("path");
    line->setLineWidth(4);
    line->setColor_u8(kTrajectoryColour);
    std::optional<Vec3> before;
    for (const auto& [id, pose] : map.frames()) {
        const Vec3 at = map.cameraAt(id)->translation();
        if (before) {
            line->appendLine(before->x(), before->y(), before->z(), at.x(), at.y(), at.z());
        }
        before = at;
    }
    to->insert(line);
    const std::size_t count = map.keyframes().size();
    if (options.max_frustums == 0) return;
    const std::size_t step = (count + options.max_frustums - 1) / options.max_frustums;
    std::size_t index = 0;
    for (const auto& [id, kf] : map.keyframes()) {
        if (index++ % std::max<std::size_t>(1, step) != 0 || !kf.camera.valid()) continue;
        auto frustum = mrpt::opengl::CFrustum::Create();
        frustum->setNearFarPlanes(0.02F, 0.6F);
        const double across = 2 * std::atan(0.5 * kf.camera.width_px / kf.camera.fx) / kDegree;
        const double upright = 2 * std::atan(0.5 * kf.camera.height_px / kf.camera.fy) / kDegree;
        frustum->setHorzFOV(static_cast<float>(across));
        frustum->setVertFOV(static_cast<float>(upright));
        frustum->setColor_u8(kFrustumColour);
        // MRPT's frustum looks along +x.
        const SE3 T_world_frustum = kf.T_world_cam * geometry::opticalToVehicleAxes().inverse();
        frustum->setPose(geometry::toCPose3D(T_world_frustum));
        to->insert(frustum);
    }
}

mrpt::opengl::CPointCloudColoured::Ptr newCloud(double point_px, std::size_t points) {
    auto cloud = mrpt::opengl::CPointCloudColoured::Create();
    cloud->setPointSize(static_cast<float>(point_px));
    cloud->reserve(points);
    return cloud;
}

void addSparseMap(const map::SlamMap& map, const SceneOptions& options, const Layer& to) {
    auto cloud = newCloud(options.landmark_point_px, map.landmarks().size());
    for (const auto& [id, landmark] : map.landmarks()) {
        const auto p = landmark.p_world.cast<float>();
        cloud->insertPoint(
            {p.x(), p.y(), p.z(), landmark.rgb[0], landmark.rgb[1], landmark.rgb[2], 255});
    }
    to->insert(cloud);
}

void addCubes(const std::vector<texture::ColouredPoint>& points, double side_m, const Layer& to) {
    auto cubes = mrpt::opengl::COctoMapVoxels::Create();
    cubes->setName("voxels");
    cubes->setVisualizationMode(mrpt::opengl::COctoMapVoxels::FIXED);
    cubes->enableCubeTransparency(false);
    cubes->enableLights(false);  // the colours are those of images: lit already
    cubes->resizeVoxelSets(1);
    cubes->reserveVoxels(0, points.size());
    mrpt::math::TPoint3D low(0, 0, 0), high(0, 0, 0);
    for (const auto& p : points) {
        const mrpt::math::TPoint3D at(static_cast<double>(p.x), static_cast<double>(p.y),
                                      static_cast<double>(p.z));
        for (std::size_t i = 0; i < 3; ++i) {
            low[i] = std::min(low[i], at[i] - side_m);
            high[i] = std::max(high[i], at[i] + side_m);
        }
        cubes->push_back_Voxel(
            0, {{p.x, p.y, p.z}, side_m, mrpt::img::TColor(p.rgb[0], p.rgb[1], p.rgb[2])});
    }
    cubes->setBoundingBox(low, high);
    to->insert(cubes);
}

void addBackground(const SceneContent& content, const SceneOptions& options, const Layer& to) {
    const auto& points = content.background;
    if (content.backgroundVoxel_m > 0 && points.size() <= options.max_background_cubes) {
        addCubes(points, content.backgroundVoxel_m, to);
        return;
    }
    auto cloud = newCloud(options.background_point_px, points.size());
    for (const auto& p : points) {
        cloud->insertPoint({p.x, p.y, p.z, p.rgb[0], p.rgb[1], p.rgb[2], 255});
    }
    to->insert(cloud);
}

void addObject(const map::ObjectTrack& object, const SE3& T_world_obj, const Layer& boxes,
               const Layer& ids) {
    const auto pose = geometry::toCPose3D(T_world_obj.normalised());
    const Vec3 half = 0.5 * object.size_m;
    auto box = mrpt::opengl::CBox::Create();
    box->setBoxCorners({-half.x(), -half.y(), -half.z()}, {half.x(), half.y(), half.z()});
    box->setWireframe(true);
    box->setLineWidth(2);
    const auto colour = object.moving ? kMovingColour : kStaticColour;
    box->setColor_u8(colour);
    box->setBoxBorderColor(colour);  // MRPT draws wireframes in the border's colour
    box->setPose(pose);
    box->setName("box " + std::to_string(object.id.value));
    boxes->insert(box);
    auto text = mrpt::opengl::CText3D::Create(std::to_string(object.id.value), "sans", 0.7,
                                              mrpt::opengl::FILL);
    text->setColor_u8(colour);
    const Vec3 above = T_world_obj * Vec3(0, 0, half.z() + 0.3);
    // Text lies in its x-y plane; stand it up, readable from behind the start of the drive.
    text->setPose(
        mrpt::poses::CPose3D(above.x(), above.y(), above.z(), -90 * kDegree, 0, 90 * kDegree));
    text->setName("id " + std::to_string(object.id.value));
    ids->insert(text);
}

void addTexture(const texture::ObjectModel& model, const SE3& T_world_obj,
                const SceneOptions& options, const Layer& to) {
    auto cloud = newCloud(options.object_point_px, model.size());
    const bool all = options.show_uncoloured || model.coverage() == 0;
    for (std::size_t i = 0; i < model.size(); ++i) {
        if (!all && model.colours[i].count == 0) continue;
        float x = 0, y = 0, z = 0, r = 0, g = 0, b = 0;
        model.cloud->getPointRGB(i, x, y, z, r, g, b);
        cloud->insertPoint({x, y, z, mrpt::f2u8(r), mrpt::f2u8(g), mrpt::f2u8(b), 255});
    }
    cloud->setPose(geometry::toCPose3D(T_world_obj.normalised()));
    cloud->setName("object " + std::to_string(model.id.value));
    to->insert(cloud);
}

}  // namespace

mrpt::opengl::COpenGLScene::Ptr makeScene(const SceneContent& content,
                                          const SceneOptions& options) {
    const map::SlamMap& map = *content.map;
    auto scene = mrpt::opengl::COpenGLScene::Create();
    addBackground(content, options, layer("background", *scene));
    addSparseMap(map, options, layer("sparse_map", *scene));
    const Layer objects = layer("objects", *scene), boxes = layer("boxes", *scene),
                ids = layer("ids", *scene);
    for (const auto& [id, object] : map.objects()) {
        if (object.states.empty()) continue;
        const SE3 T_world_obj = map.T_world_obj(object.states.rbegin()->second);
        addObject(object, T_world_obj, boxes, ids);
        const auto model = content.models.find(id);
        if (model != content.models.end() && model->second.size() > 0) {
            addTexture(model->second, T_world_obj, options, objects);
        }
    }
    addTrajectory(map, options, layer("trajectory", *scene));
    placeCamera(map, options, *scene);
    return scene;
}

void writeScene(const mrpt::opengl::COpenGLScene& scene, const std::string& file) {
    std::ofstream probe(file, std::ios::binary);  // MRPT does not say why it could not open
    if (!probe) throwUnwritable(file);
    probe.close();
    if (!scene.saveToFile(file)) throwUnwritable(file);
}

}  // namespace djpete::io
