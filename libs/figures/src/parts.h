/// The single figures. Private.
#pragma once

#include <opencv2/core.hpp>

#include "djpete/io/scene_view.h"
#include "run_result.h"

namespace djpete::figures {

/// A figure, or why there is none (one sentence).
struct Figure {
    cv::Mat picture;
    std::string whyNot;
};

/// 6: trajectory and sparse map. 8: all layers.
Figure mapFigure(mrpt::opengl::COpenGLScene& scene, const evaluation::CameraPath& cameras);
Figure jointFigure(mrpt::opengl::COpenGLScene& scene, const evaluation::CameraPath& cameras);

/// 7. The frame with the most objects well in view; nothing if none is.
std::optional<std::size_t> busiestFrame(const RunResult& result);
Figure perceptionFigure(const RunResult& result, const ShownFrame& frame);

/// 4 and 5. `first`: the first view of the object with its image, or null.
Figure textureFigure(const texture::ObjectModel& model, const RunResult& result,
                     const ShownFrame* first);

/// 11. The frame of the object's rows in which it is seen best; nothing if it has no row.
std::optional<std::size_t> bestFrameOf(int64_t object, const RunResult& result);
Figure objectFigure(const texture::ObjectModel& model, const RunResult& result,
                    const ShownFrame& frame);

/// 10. Truth: T_world_cam by frame number; may be empty.
Figure trajectoryFigure(const evaluation::CameraPath& estimate,
                        const std::map<std::size_t, geometry::SE3>& truth);

/// The row of an object at a frame, or null.
const evaluation::ObjectRow* rowOf(const RunResult& result, int64_t object, std::size_t frame);

}  // namespace djpete::figures
