#include "djpete/calibration/corrected_calibration.h"

#include <opencv2/imgproc.hpp>

namespace djpete::calibration {

using geometry::SE3;
using geometry::Vec6;

CorrectedCalibration corrected(const obs::RigCamera& calibration, const CalibrationReport& r) {
    const auto deviation = [](const Estimate& e, double nominal) {
        return e.deviates(nominal, 0) ? e.value - nominal : 0.0;
    };
    CorrectedCalibration out;
    out.camera = calibration;
    out.camera.model.baseline_m *= 1 + deviation(r.disparity.scale, 1);
    Vec6 xi;
    xi << deviation(r.lidar.shiftX_m, 0), deviation(r.lidar.shiftY_m, 0),
        deviation(r.lidar.shiftZ_m, 0), deviation(r.lidar.tiltX_rad, 0),
        deviation(r.lidar.tiltY_rad, 0), deviation(r.lidar.tiltZ_rad, 0);
    out.camera.T_vehicle_cam = (calibration.T_vehicle_cam * SE3::exp(xi)).normalised();
    out.columnOffset_px = deviation(r.disparity.offset_px, 0);
    out.rowOffset_px = deviation(r.rows.offset_px, 0);
    out.rowPerColumn_px = deviation(r.rows.perColumn_px, 0);
    out.rowPerRow_px = deviation(r.rows.perRow_px, 0);
    return out;
}

obs::ImageSet CorrectedCalibration::apply(const obs::ImageSet& images) const {
    obs::ImageSet out = images;
    const int width = out.camera.model.width_px, height = out.camera.model.height_px;
    out.camera = camera;
    out.camera.model.width_px = width;
    out.camera.model.height_px = height;
    if (!images.right || !warpsRight()) return out;
    const auto& m = camera.model;
    // (u, v) of the new right image -> place in the stated one.
    const cv::Matx23d affine(
        1, 0, -columnOffset_px,  //
        rowPerColumn_px / m.fx, 1 + rowPerRow_px / m.fy,
        rowOffset_px - rowPerColumn_px * m.cx / m.fx - rowPerRow_px * m.cy / m.fy);
    const cv::Mat& stated = images.right->asCvMatRef();
    cv::Mat right;
    cv::warpAffine(stated, right, affine, stated.size(), cv::INTER_CUBIC | cv::WARP_INVERSE_MAP,
                   cv::BORDER_REPLICATE);
    out.right = mrpt::img::CImage(right, mrpt::img::DEEP_COPY);
    return out;
}

}  // namespace djpete::calibration
