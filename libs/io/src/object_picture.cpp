#include "djpete/io/object_picture.h"

#include <mrpt/img/CImage.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "djpete/texture/render_model.h"
#include "text_file.h"

namespace djpete::io {

namespace {

using geometry::SE3;
using geometry::Vec3;

constexpr int kWidth_px = 320, kHeight_px = 200;
constexpr double kFocal_px = 700;
const std::array<Vec3, 5> kFrom{
    {{0, 1, 0.25}, {1, 0, 0.25}, {0, -1, 0.25}, {-1, 0, 0.25}, {1, -0.8, 0.55}}};
constexpr std::array<uint8_t, 3> kPaper{235, 235, 235};

/// Of a camera at `eye` (frame obj) that looks at the object's centre, z up.
SE3 T_cam_obj(const Vec3& eye) {
    const Vec3 z = -eye.normalized(), x = z.cross(Vec3::UnitZ()).normalized();
    geometry::Mat3 R_obj_cam;
    R_obj_cam.col(0) = x;
    R_obj_cam.col(1) = z.cross(x);
    R_obj_cam.col(2) = z;
    return SE3(R_obj_cam, eye).inverse();
}

}  // namespace

void writeObjectPicture(const std::vector<texture::ObjectModel>& models, const std::string& file) {
    geometry::StereoCamera camera;
    camera.fx = camera.fy = kFocal_px;
    camera.cx = 0.5 * (kWidth_px - 1);
    camera.cy = 0.5 * (kHeight_px - 1);
    camera.width_px = kWidth_px;
    camera.height_px = kHeight_px;
    double reach = 1;
    for (const auto& model : models) reach = std::max(reach, model.size_m.norm());
    const double distance = 0.5 * reach + reach * kFocal_px / kWidth_px;
    const auto columns = static_cast<unsigned>(kFrom.size());
    mrpt::img::CImage picture(columns * kWidth_px,
                              static_cast<unsigned>(models.size()) * kHeight_px, mrpt::img::CH_RGB);
    for (unsigned row = 0; row < models.size(); ++row) {
        for (unsigned column = 0; column < columns; ++column) {
            const auto view = texture::renderModel(
                models[row], camera, T_cam_obj(distance * kFrom[column].normalized()));
            for (unsigned v = 0; v < kHeight_px; ++v) {
                for (unsigned u = 0; u < kWidth_px; ++u) {
                    const std::size_t pixel = v * kWidth_px + u;
                    const auto& rgb = view.covered(pixel) ? view.rgb[pixel] : kPaper;
                    for (unsigned c = 0; c < 3; ++c) {  // stored blue first
                        picture.at<uint8_t>(column * kWidth_px + u, row * kHeight_px + v,
                                            static_cast<int8_t>(c)) = rgb[2 - c];
                    }
                }
            }
        }
    }
    if (!picture.saveToFile(file)) throwUnwritable(file);
}

}  // namespace djpete::io
