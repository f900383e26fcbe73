/// What KITTI's annotators would have written.
#pragma once

#include <string>
#include <vector>

#include "djpete/simulator/renderer.h"

namespace djpete::simulator {

/// One row of KITTI's tracking labels: camera-0 frame, bottom centre, right-handed rotation about
/// the camera's y axis.
struct Label {
    uint64_t frame = 0;
    uint32_t trackId = 0;
    std::string type;       ///< Car, Van, Truck, Pedestrian or Cyclist
    double truncation = 0;  ///< share of the box's volume outside the image, 0..1
    int occlusion = 0;      ///< 0 visible, 1 partly, 2 largely occluded
    double alpha_rad = 0;
    double left = 0, top = 0, right = 0, bottom = 0;  ///< px, as if unoccluded; in the image
    double height_m = 0, width_m = 0, length_m = 0;
    double x_m = 0, y_m = 0, z_m = 0, rotationY_rad = 0;
};

/// Track ids that masks can tell apart. Actors with higher ids have no label, and their masks say
/// "ignore".
constexpr uint32_t kMostTrackIds = 999;

struct LabelOptions {
    double maxRange_m = 60;
    uint32_t minVisible_px = 25;  ///< in the left image
    uint32_t maxTrackId = kMostTrackIds;
};

/// Labels of the actors that can be seen in `image` (the left camera's picture of `frame`).
std::vector<Label> makeLabels(Renderer& renderer, const World& world, uint64_t frame,
                              const geometry::StereoCamera& camera,
                              const geometry::SE3& T_vehicle_cam, const RenderedImage& image,
                              const LabelOptions& options);

/// How a detector errs.
struct DetectorNoise {
    double sigma_m = 0.3;      ///< per axis of the camera
    double sigma_rad = 0.087;  ///< heading
    double missRate = 0;
    double falseShare = 0;  ///< of all rows, on average: see false_detections.h
};

/// Noisy copies of the labels, with a score each; the same for the same seed.
struct Detection {
    Label label;
    double score = 1;
};
std::vector<Detection> makeDetections(const std::vector<Label>& labels, const DetectorNoise& noise,
                                      uint32_t seed);

/// `frame id type trunc occ alpha x1 y1 x2 y2 h w l x y z ry`
std::string toKittiRow(const Label& label);
/// `frame,type,x1,y1,x2,y2,score,h,w,l,x,y,z,ry,alpha` with type 1 for pedestrians, 2 for cars
/// (vans and trucks too), 3 for cyclists
std::string toPointRcnnRow(const Detection& detection);

}  // namespace djpete::simulator
