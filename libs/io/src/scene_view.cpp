#include "djpete/io/scene_view.h"

#include <mrpt/io/CMemoryStream.h>
#include <mrpt/opengl/CFBORender.h>
#include <mrpt/opengl/CSetOfObjects.h>
#include <mrpt/serialization/CArchive.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <memory>

#include "djpete/obs/errors.h"

namespace djpete::io {

namespace {

constexpr const char* kLayers[] = {"trajectory", "sparse_map", "background",
                                   "objects",    "boxes",      "ids"};

/// MRPT's objects remember the buffers of the first renderer that drew them, which are useless to
/// the next one; a copy through an archive has none.
mrpt::opengl::COpenGLScene::Ptr copyOf(const mrpt::opengl::COpenGLScene& scene) {
    mrpt::io::CMemoryStream buffer;
    auto archive = mrpt::serialization::archiveFrom(buffer);
    archive << scene;
    buffer.Seek(0);
    auto out = mrpt::opengl::COpenGLScene::Create();
    archive >> *out;
    return out;
}

/// What MRPT's exception says without its head and its call stack.
std::string firstSentence(const std::string& what) {
    const std::string mark = "Message:";
    const auto at = what.find(mark);
    std::string out = at == std::string::npos ? what : what.substr(at + mark.size());
    out = out.substr(out.find_first_not_of(" \n"));
    return out.substr(0, out.find('\n'));
}

}  // namespace

void setCamera(const SceneView& view, mrpt::opengl::CCamera& camera) {
    const geometry::Vec3 back = view.eye - view.target;
    camera.setPointingAt(static_cast<float>(view.target.x()), static_cast<float>(view.target.y()),
                         static_cast<float>(view.target.z()));
    camera.setZoomDistance(static_cast<float>(back.norm()));
    camera.setAzimuthDegrees(static_cast<float>(std::atan2(back.y(), back.x()) * 180 / M_PI));
    camera.setElevationDegrees(static_cast<float>(std::asin(back.z() / back.norm()) * 180 / M_PI));
    camera.setProjectiveFOVdeg(static_cast<float>(view.height_deg));
}

ScenePicture pictureOf(const mrpt::opengl::COpenGLScene& scene, const SceneView& view) {
    ScenePicture out;
    std::unique_ptr<mrpt::opengl::CFBORender> renderer;
    try {
        renderer = std::make_unique<mrpt::opengl::CFBORender>(
            static_cast<unsigned>(view.width_px - view.width_px % 4),
            static_cast<unsigned>(view.height_px));
    } catch (const std::exception&) {
        out.whyNot = "no off-screen OpenGL here; expected EGL (packages libegl1, libgl1-mesa-dri)";
        return out;
    }
    try {
        const auto fresh = copyOf(scene);
        // Files do not keep these, and with MRPT's own the depth buffer is too coarse.
        const double apart = (view.eye - view.target).norm();
        fresh->getViewport("main")->setViewportClipDistances(
            static_cast<float>(std::max(0.3, 0.05 * apart)),
            static_cast<float>(std::max(500.0, 10 * apart)));
        setCamera(view, renderer->getCamera(*fresh));
        mrpt::img::CImage image;
        renderer->render_RGB(*fresh, image);
        out.image = image;
    } catch (const std::exception& e) {
        out.whyNot = "MRPT cannot render the scene: " + firstSentence(e.what());
    }
    return out;
}

mrpt::opengl::COpenGLScene::Ptr loadScene(const std::string& file) {
    auto scene = mrpt::opengl::COpenGLScene::Create();
    bool read = false;
    try {
        read = std::filesystem::is_regular_file(file) && scene->loadFromFile(file);
    } catch (const std::exception&) {
        read = false;
    }
    if (!read) throw obs::InputError(file + ": expected a scene as djpete-slam writes it");
    return scene;
}

void showLayers(mrpt::opengl::COpenGLScene& scene, const std::set<std::string>& names) {
    for (const char* name : kLayers) {
        if (const auto layer = scene.getByName(name)) layer->setVisibility(names.count(name) > 0);
    }
}

}  // namespace djpete::io
