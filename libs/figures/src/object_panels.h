/// Panels that show one object. Private.
#pragma once

#include "djpete/texture/render_model.h"
#include "run_result.h"

namespace djpete::figures {

constexpr int kPanelWidth_px = 460, kPanelHeight_px = 340;

enum class PointColour { Height, Own };

/// Draws `render` over `on`, as if it stood there. Sizes must be equal.
void overlay(const texture::RenderedModel& render, cv::Mat& on);

/// The part of an image around a box, with some border.
cv::Rect around(const geometry::StereoCamera& camera, const geometry::SE3& T_cam_obj,
                const geometry::Vec3& size_m, const cv::Size& image);

/// That part as high as a panel.
cv::Mat enlarged(const cv::Mat& image, const cv::Rect& part);

/// The points alone, from the side where the sensor is, and the box.
cv::Mat pointsPanel(const texture::ObjectModel& model, const geometry::Vec3& sensor_obj,
                    PointColour colour);

/// The scan around the object in grey, its model in colour, its box. Requires a scan.
cv::Mat placementPanel(const texture::ObjectModel& model, const geometry::SE3& T_world_obj,
                       const geometry::Vec3& size_m, const ShownFrame& frame);

}  // namespace djpete::figures
