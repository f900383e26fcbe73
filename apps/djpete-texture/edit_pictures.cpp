#include "edit_pictures.h"

#include <array>
#include <opencv2/imgcodecs.hpp>
#include <opencv2/imgproc.hpp>

#include "djpete/obs/errors.h"
#include "djpete/texture/render_model.h"

namespace djpete::apps {

namespace {

using geometry::SE3;
using geometry::StereoCamera;
using geometry::Vec3;

constexpr int kWidth = 360, kHeight = 220, kText = 22;
const cv::Scalar kBackground(64, 60, 58);

struct Side {
    const char* name;
    Vec3 from;  ///< direction of the camera, frame obj
};

const std::array<Side, 5>& sides() {
    static const std::array<Side, 5> all{{{"left", {0, 1, 0.12}},
                                          {"right", {0, -1, 0.12}},
                                          {"front", {1, 0, 0.12}},
                                          {"back", {-1, 0, 0.12}},
                                          {"above", {0.8, 0.8, 0.6}}}};
    return all;
}

/// A camera that looks at the object's middle, z up.
SE3 cameraAt(const Vec3& eye_obj) {
    const Vec3 forward = -eye_obj.normalized();
    const Vec3 right = forward.cross(Vec3::UnitZ()).normalized();
    geometry::Mat3 R_obj_cam;
    R_obj_cam << right, forward.cross(right), forward;
    return SE3(R_obj_cam, eye_obj).inverse();
}

cv::Mat view(const texture::ObjectModel& model, const Vec3& size_m, const Vec3& from) {
    const double reach = std::max(1.0, size_m.norm());
    StereoCamera camera;
    camera.width_px = kWidth;
    camera.height_px = kHeight;
    camera.cx = 0.5 * (kWidth - 1);
    camera.cy = 0.5 * (kHeight - 1);
    const double distance = 2.5 * reach;
    // The longest side fills nine tenths of the width, or the height if that is less.
    const double high = std::max(0.5, size_m.z() + 0.35 * size_m.y());
    const double scale = std::min(0.9 * kWidth / std::max(1.0, size_m.x()), 0.8 * kHeight / high);
    camera.fx = camera.fy = scale * (distance - 0.5 * size_m.y());
    texture::RenderOptions options;
    options.discScale = 1.3;
    options.maxTilt_cos = 0.02;  // what faces away would show the inside through holes
    const auto image =
        texture::renderModel(model, camera, cameraAt(distance * from.normalized()), options);
    cv::Mat out(kHeight, kWidth, CV_8UC3, kBackground);
    for (int y = 0; y < kHeight; ++y) {
        for (int x = 0; x < kWidth; ++x) {
            const auto k = static_cast<std::size_t>(y * kWidth + x);
            if (!image.covered(k)) continue;
            const auto& rgb = image.rgb[k];
            out.at<cv::Vec3b>(y, x) = {rgb[2], rgb[1], rgb[0]};
        }
    }
    return out;
}

void write(cv::Mat& image, const std::string& text, int x, int y) {
    cv::putText(image, text, {x, y}, cv::FONT_HERSHEY_SIMPLEX, 0.45, {235, 235, 235}, 1,
                cv::LINE_AA);
}

}  // namespace

void writePicture(const std::vector<PictureRow>& rows, const std::filesystem::path& file) {
    const int rowHeight = kHeight + kText;
    cv::Mat picture(kText + rowHeight * static_cast<int>(rows.size()),
                    kWidth * static_cast<int>(sides().size()), CV_8UC3, kBackground);
    for (std::size_t s = 0; s < sides().size(); ++s) {
        const int left = static_cast<int>(s) * kWidth;
        write(picture, sides()[s].name, left + kWidth / 2 - 20, kText - 7);
        for (std::size_t r = 0; r < rows.size(); ++r) {
            const int top = kText + static_cast<int>(r) * rowHeight;
            view(*rows[r].model, rows.front().model->size_m, sides()[s].from)
                .copyTo(picture(cv::Rect(left, top + kText, kWidth, kHeight)));
            if (s == 0) write(picture, rows[r].caption, 8, top + kText - 7);
        }
    }
    std::error_code error;
    if (file.has_parent_path()) std::filesystem::create_directories(file.parent_path(), error);
    bool written = false;
    try {
        written = !error && cv::imwrite(file.string(), picture);
    } catch (const cv::Exception&) {
    }
    if (!written) throw obs::InputError(file.string() + ": cannot be written");
}

}  // namespace djpete::apps
