#include "segmentation_network.h"

#include <algorithm>
#include <cmath>
#include <opencv2/dnn.hpp>
#include <opencv2/imgproc.hpp>

#include "djpete/geometry/mrpt_bridge.h"
#include "djpete/obs/errors.h"
#include "djpete/obs/labels.h"
#include "djpete/obs/overlap.h"

namespace djpete::detect_objects {

namespace {

constexpr int kBoxRows = 4, kClasses = 80, kCoefficients = 32;
constexpr int kInputWidth_px = 1056, kInputHeight_px = 320;  // KITTI's shape, multiples of 32
constexpr float kScoreMin = 0.3F;
constexpr double kOverlapMax = 0.6;

std::optional<obs::ObjectClass> classOf(int coco) {
    switch (coco) {
        case 0:
            return obs::ObjectClass::Pedestrian;
        case 1:
        case 3:
            return obs::ObjectClass::Cyclist;
        case 2:
            return obs::ObjectClass::Car;
        case 5:
        case 7:
            return obs::ObjectClass::Truck;
        default:
            return std::nullopt;
    }
}

struct Candidate {
    obs::ObjectDetection detection;
    cv::Rect2d box_input;
    cv::Mat coefficients;  ///< 1 x 32
};

/// Candidates with their boxes in the image, surest first.
std::vector<Candidate> candidatesOf(const cv::Mat& rows, const Letterbox& letterbox) {
    std::vector<Candidate> out;
    const auto toImage = [&](double input, int offset, int size) {
        return static_cast<float>(std::clamp((input - offset) / letterbox.scale, 0.0, size - 1.0));
    };
    for (int i = 0; i < rows.cols; ++i) {
        int best = 0;
        for (int k = 1; k < kClasses; ++k) {
            if (rows.at<float>(kBoxRows + k, i) > rows.at<float>(kBoxRows + best, i)) best = k;
        }
        const float score = rows.at<float>(kBoxRows + best, i);
        const auto objectClass = classOf(best);
        if (!(score > kScoreMin) || !objectClass) continue;
        Candidate c;
        const double w = rows.at<float>(2, i), h = rows.at<float>(3, i);
        c.box_input = cv::Rect2d(rows.at<float>(0, i) - w / 2, rows.at<float>(1, i) - h / 2, w, h);
        c.coefficients = rows.col(i).rowRange(kBoxRows + kClasses, rows.rows).clone().reshape(1, 1);
        c.detection.objectClass = *objectClass;
        c.detection.score = score;
        c.detection.source = "network";
        const auto& b = c.box_input;
        c.detection.box =
            obs::ImageBox{toImage(b.x, letterbox.left_px, letterbox.image.width),
                          toImage(b.y, letterbox.top_px, letterbox.image.height),
                          toImage(b.x + b.width, letterbox.left_px, letterbox.image.width),
                          toImage(b.y + b.height, letterbox.top_px, letterbox.image.height)};
        out.push_back(std::move(c));
    }
    std::stable_sort(out.begin(), out.end(), [](const Candidate& a, const Candidate& b) {
        return a.detection.score > b.detection.score;
    });
    return out;
}

/// sigmoid(coefficients * prototypes), cut to the box, in the image.
obs::RleMask maskOf(const Candidate& c, const cv::Mat& prototypes, const Letterbox& letterbox) {
    const int h = prototypes.size[2], w = prototypes.size[3];
    const cv::Mat flat(kCoefficients, h * w, CV_32F, prototypes.data);
    const cv::Mat logits = cv::Mat(c.coefficients * flat).reshape(1, h);
    cv::Mat large;
    cv::resize(logits, large, letterbox.input, 0, 0, cv::INTER_LINEAR);
    cv::Mat cut(large.size(), CV_32F, cv::Scalar(-1));  // a logit: outside
    const cv::Rect box =
        cv::Rect(
            cv::Point(int(std::floor(c.box_input.x)), int(std::floor(c.box_input.y))),
            cv::Point(int(std::ceil(c.box_input.br().x)), int(std::ceil(c.box_input.br().y)))) &
        cv::Rect(cv::Point(0, 0), letterbox.input);
    large(box).copyTo(cut(box));
    const cv::Matx23d imageToInput(letterbox.scale, 0, letterbox.left_px, 0, letterbox.scale,
                                   letterbox.top_px);
    cv::Mat image;
    cv::warpAffine(cut, image, imageToInput, letterbox.image,
                   cv::INTER_LINEAR | cv::WARP_INVERSE_MAP, cv::BORDER_CONSTANT, cv::Scalar(-1));
    const cv::Mat mask = image > 0;  // sigmoid above 0.5
    return obs::RleMask::fromDense(mask.data, static_cast<uint32_t>(mask.cols),
                                   static_cast<uint32_t>(mask.rows), mask.step[0]);
}

}  // namespace

Letterbox letterboxOf(const cv::Size& image, const cv::Size& input) {
    Letterbox out;
    out.input = input;
    out.image = image;
    out.scale = std::min(double(input.width) / image.width, double(input.height) / image.height);
    out.left_px = int(std::lround((input.width - out.scale * image.width) / 2));
    out.top_px = int(std::lround((input.height - out.scale * image.height) / 2));
    return out;
}

std::vector<obs::ObjectDetection> decodeSegmentation(const cv::Mat& boxes,
                                                     const cv::Mat& prototypes,
                                                     const Letterbox& letterbox) {
    if (boxes.dims != 3 || boxes.size[1] != kBoxRows + kClasses + kCoefficients ||
        prototypes.dims != 4 || prototypes.size[1] != kCoefficients) {
        throw obs::InputError(
            "the network's outputs have other shapes than [1, 116, N] and [1, 32, h, w]; expected "
            "a YOLOv8 segmentation network with COCO's classes");
    }
    const cv::Mat rows(boxes.size[1], boxes.size[2], CV_32F, boxes.data);
    std::vector<obs::ObjectDetection> out;
    for (auto& c : candidatesOf(rows, letterbox)) {
        const bool doubled = std::any_of(out.begin(), out.end(), [&](const auto& other) {
            return obs::imageOverlap(*other.box, *c.detection.box) > kOverlapMax &&
                   obs::isVehicle(other.objectClass) == obs::isVehicle(c.detection.objectClass);
        });
        if (doubled) continue;
        c.detection.mask = maskOf(c, prototypes, letterbox);
        out.push_back(std::move(c.detection));
    }
    return out;
}

struct SegmentationNetwork::Impl {
    std::string file;
    cv::dnn::Net net;
};

SegmentationNetwork::SegmentationNetwork(const std::string& onnxFile)
    : impl_(std::make_unique<Impl>()) {
    impl_->file = onnxFile;
    try {
        impl_->net = cv::dnn::readNetFromONNX(onnxFile);
    } catch (const cv::Exception&) {
        throw obs::InputError(onnxFile + ": cannot be read, expected a network in an ONNX file");
    }
}

SegmentationNetwork::~SegmentationNetwork() = default;

obs::CObservationDetectedObjects::Ptr SegmentationNetwork::observe(const obs::SensorFrame& frame,
                                                                   const obs::LidarScan* /*scan*/,
                                                                   const obs::RigCamera* /*c*/) {
    const auto images = frame.loadMainImages();
    if (!images) return nullptr;
    cv::Mat image = images->left.asCvMatRef();
    if (image.channels() == 1) cv::cvtColor(image, image, cv::COLOR_GRAY2BGR);
    const Letterbox letterbox =
        letterboxOf(image.size(), cv::Size(kInputWidth_px, kInputHeight_px));
    cv::Mat input(letterbox.input, CV_8UC3, cv::Scalar::all(114));
    const cv::Matx23d imageToInput(letterbox.scale, 0, letterbox.left_px, 0, letterbox.scale,
                                   letterbox.top_px);
    cv::warpAffine(image, input, imageToInput, letterbox.input, cv::INTER_LINEAR,
                   cv::BORDER_CONSTANT, cv::Scalar::all(114));
    std::vector<cv::Mat> outputs;
    try {
        impl_->net.setInput(cv::dnn::blobFromImage(input, 1 / 255.0, {}, {}, true));
        impl_->net.forward(outputs, impl_->net.getUnconnectedOutLayersNames());
    } catch (const cv::Exception&) {
        throw obs::InputError(impl_->file +
                              ": the network does not run on an input of [1, 3, 320, 1056]");
    }
    const auto withDims = [&](int dims) {
        const auto it = std::find_if(outputs.begin(), outputs.end(),
                                     [dims](const cv::Mat& m) { return m.dims == dims; });
        return it == outputs.end() ? cv::Mat() : *it;
    };
    auto out = obs::CObservationDetectedObjects::Create();
    out->timestamp = frame.stamp;
    out->sensorLabel = obs::label::kDetections;
    out->sensorPose = geometry::toCPose3D(images->camera.T_vehicle_cam);
    out->detections = decodeSegmentation(withDims(3), withDims(4), letterbox);
    return out;
}

}  // namespace djpete::detect_objects
