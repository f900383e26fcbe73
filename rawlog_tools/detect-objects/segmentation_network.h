/// Instance masks of vehicles and people by a network, from the image alone.
#pragma once

#include <memory>
#include <opencv2/core.hpp>
#include <vector>

#include "djpete/observers/object_observer.h"

namespace djpete::detect_objects {

/// Where an image lies in the network's input: input = scale * image + (left, top).
struct Letterbox {
    double scale = 1;
    int left_px = 0, top_px = 0;
    cv::Size input;  ///< of the network
    cv::Size image;
};
Letterbox letterboxOf(const cv::Size& image, const cv::Size& input);

/// Reads the outputs of a YOLOv8 segmentation network trained on COCO: boxes [1, 116, N] (centre,
/// size in input pixels; 80 class probabilities; 32 mask coefficients) and prototypes [1, 32, h,
/// w]. Classes car, bus, truck, and person, bicycle, motorcycle, from probability 0.3; of two that
/// overlap by 0.6 the surer one stays. Throws obs::InputError on other shapes.
std::vector<obs::ObjectDetection> decodeSegmentation(const cv::Mat& boxes,
                                                     const cv::Mat& prototypes,
                                                     const Letterbox& letterbox);

/// Runs such a network (ONNX, input [1, 3, 320, 1056]) on the left image that odometry uses. Its
/// detections have class, score, box and mask, source "network", and no place in space: size_m is
/// 0. They are a truth to compare silhouettes with, no input of djpete-slam.
class SegmentationNetwork : public observers::ObjectObserver {
  public:
    /// Throws obs::InputError naming the file if it cannot be read.
    explicit SegmentationNetwork(const std::string& onnxFile);
    ~SegmentationNetwork() override;

    std::string name() const override { return "network"; }
    /// nullptr if the frame has no image.
    obs::CObservationDetectedObjects::Ptr observe(const obs::SensorFrame& frame,
                                                  const obs::LidarScan* scan,
                                                  const obs::RigCamera* camera) override;

  private:
    struct Impl;
    std::unique_ptr<Impl> impl_;
};

}  // namespace djpete::detect_objects
