#include <mrpt/opengl/CPointCloudColoured.h>
#include <mrpt/opengl/CSetOfObjects.h>

#include <algorithm>
#include <cmath>

#include "canvas.h"
#include "parts.h"

namespace djpete::figures {

namespace {

using geometry::Vec3;

/// Level direction in which camera `i` of the path looks.
Vec3 aheadAt(const evaluation::CameraPath& cameras, std::size_t i) {
    Vec3 ahead = cameras.T_world_cam[i].rotation().col(2);
    ahead.z() = 0;
    return ahead.norm() > 1e-6 ? Vec3(ahead.normalized()) : Vec3(1, 0, 0);
}

io::SceneView behind(const evaluation::CameraPath& cameras, std::size_t i, double back_m,
                     double up_m, double ahead_m) {
    const Vec3 at = cameras.T_world_cam[i].translation(), ahead = aheadAt(cameras, i);
    io::SceneView view;
    view.eye = at - back_m * ahead + Vec3(0, 0, up_m);
    view.target = at + ahead_m * ahead - Vec3(0, 0, 1.5);
    return view;
}

/// From above, so that the whole path is in it and lies along the picture's width.
io::SceneView fromAbove(const evaluation::CameraPath& cameras, double border_m) {
    Eigen::Matrix2d spread = Eigen::Matrix2d::Zero();
    Eigen::Vector2d mean(0, 0);
    const auto& path = cameras.T_world_cam;
    for (const auto& T : path) mean += T.translation().head<2>() / double(path.size());
    for (const auto& T : path) {
        const Eigen::Vector2d d = T.translation().head<2>() - mean;
        spread += d * d.transpose();
    }
    Eigen::Vector2d along =
        Eigen::SelfAdjointEigenSolver<Eigen::Matrix2d>(spread).eigenvectors().col(1);
    if (along.dot((path.back().translation() - path.front().translation()).head<2>()) < 0) {
        along = -along;
    }
    const Eigen::Vector2d across(-along.y(), along.x());
    Eigen::Vector2d low(1e9, 1e9), high(-1e9, -1e9);
    for (const auto& T : path) {
        const Eigen::Vector2d p(T.translation().head<2>().dot(along),
                                T.translation().head<2>().dot(across));
        low = low.cwiseMin(p);
        high = high.cwiseMax(p);
    }
    const Eigen::Vector2d size = high - low + Eigen::Vector2d::Constant(2 * border_m);
    const Eigen::Vector2d middle = 0.5 * (low + high);
    const Eigen::Vector2d centre = middle.x() * along + middle.y() * across;
    io::SceneView view;
    // A long and thin path needs no high picture.
    view.height_px = static_cast<int>(std::clamp(1600 * size.y() / size.x(), 320.0, 1200.0));
    const double aspect = double(view.width_px) / view.height_px;
    const double height_m = std::max(size.y(), size.x() / aspect);
    const double up_m = 0.5 * height_m / std::tan(0.5 * view.height_deg * M_PI / 180);
    const double z = path.front().translation().z();
    view.target = Vec3(centre.x(), centre.y(), z);
    view.eye = view.target + Vec3(-0.002 * up_m * across.x(), -0.002 * up_m * across.y(), up_m);
    return view;
}

void setPointSize(mrpt::opengl::COpenGLScene& scene, const char* layer, float size_px) {
    const auto set = std::dynamic_pointer_cast<mrpt::opengl::CSetOfObjects>(scene.getByName(layer));
    if (!set) return;
    for (const auto& object : *set) {
        if (auto cloud = std::dynamic_pointer_cast<mrpt::opengl::CPointCloudColoured>(object)) {
            cloud->setPointSize(size_px);
        }
    }
}

/// Cuts empty rows above and below.
cv::Mat withoutBorder(const cv::Mat& picture) {
    constexpr int kBorder_px = 12;
    int first = picture.rows, last = -1;
    for (int v = 0; v < picture.rows; ++v) {
        const cv::Mat row = picture.row(v).reshape(1);
        double low = 255, high = 0;
        cv::minMaxLoc(row, &low, &high);
        if (low > 250) continue;
        first = std::min(first, v);
        last = v;
    }
    if (last < first) return picture;
    return picture
        .rowRange(std::max(0, first - kBorder_px), std::min(picture.rows, last + 1 + kBorder_px))
        .clone();
}

struct Shot {
    io::SceneView view;
    std::string caption;
    float background_px = 3;  ///< points of the background, if it is points
};

/// Two views of a scene, one below the other.
Figure twoViews(mrpt::opengl::COpenGLScene& scene, const Shot& upper, const Shot& lower) {
    Figure out;
    scene.getViewport("main")->setCustomBackgroundColor(mrpt::img::TColorf(1, 1, 1));
    std::vector<cv::Mat> panels;
    for (const auto& shot : {upper, lower}) {
        setPointSize(scene, "background", shot.background_px);
        const auto picture = io::pictureOf(scene, shot.view);
        if (!picture.image) {
            out.whyNot = picture.whyNot;
            return out;
        }
        panels.push_back(captioned(withoutBorder(colourCopy(*picture.image)), shot.caption));
    }
    out.picture = below(panels);
    return out;
}

}  // namespace

Figure mapFigure(mrpt::opengl::COpenGLScene& scene, const evaluation::CameraPath& cameras) {
    io::showLayers(scene, {"trajectory", "sparse_map"});
    setPointSize(scene, "sparse_map", 3);
    auto detail = behind(cameras, cameras.T_world_cam.size() / 3, 9, 7, 12);
    detail.height_px = 700;
    detail.height_deg = 40;
    return twoViews(scene, {fromAbove(cameras, 22), "Sparse map and trajectory from above"},
                    {detail, "Detail, along the drive"});
}

Figure jointFigure(mrpt::opengl::COpenGLScene& scene, const evaluation::CameraPath& cameras) {
    io::showLayers(scene, {"trajectory", "background", "objects", "boxes", "ids"});
    setPointSize(scene, "objects", 4);
    auto along = behind(cameras, 0, 12, 9, 22);
    along.height_deg = 40;
    return twoViews(
        scene,
        {along, "Background, textured objects with boxes and ids (moving ones pink), trajectory",
         9},
        {fromAbove(cameras, 22), "The same from above", 3});
}

}  // namespace djpete::figures
