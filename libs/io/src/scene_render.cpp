#include <mrpt/opengl/CFBORender.h>

#include <cstdio>
#include <fstream>

#include "djpete/io/scene_writer.h"
#include "djpete/obs/errors.h"
#include "text_file.h"

namespace djpete::io {

namespace {

/// The first line of MRPT's exception, which goes on with call stacks.
std::string firstLine(const std::string& text) { return text.substr(0, text.find('\n')); }

}  // namespace

RenderReport renderScene(const mrpt::opengl::COpenGLScene& scene, const std::string& file,
                         const SceneOptions& options) {
    RenderReport report;
    const int width = options.image_width_px - options.image_width_px % 4;
    if (width < 4 || options.image_height_px < 4) {
        report.whyNot = file + " is not drawn: the picture's size must be at least 4x4";
        return report;
    }
    {
        std::ofstream probe(file, std::ios::binary);
        if (!probe) throwUnwritable(file);
    }
    try {
        mrpt::opengl::CFBORender renderer(static_cast<unsigned>(width),
                                          static_cast<unsigned>(options.image_height_px));
        renderer.getCamera(scene) = scene.getViewport("main")->getCamera();
        mrpt::img::CImage image;
        renderer.render_RGB(scene, image);
        report.written = image.saveToFile(file);
        if (!report.written) throwUnwritable(file);
    } catch (const obs::InputError&) {
        throw;
    } catch (const std::exception& e) {
        std::remove(file.c_str());
        report.whyNot = file + " is not drawn: no off-screen OpenGL (EGL with Mesa) here: " +
                        firstLine(e.what());
    }
    return report;
}

}  // namespace djpete::io
