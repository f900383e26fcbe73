#include "djpete/figures/silhouette_strips.h"

#include <cstdio>
#include <filesystem>
#include <opencv2/imgproc.hpp>

#include "canvas.h"
#include "djpete/obs/errors.h"
#include "object_panels.h"

namespace djpete::figures {

namespace fs = std::filesystem;

namespace {

using evaluation::SilhouetteCase;
using geometry::SE3;

const cv::Scalar kBoxColour(40, 220, 60);

/// 8UC1, 255 inside.
cv::Mat dense(const obs::RleMask& mask) {
    const auto pixels = mask.toDense();
    return cv::Mat(int(mask.height_px), int(mask.width_px), CV_8UC1,
                   const_cast<uint8_t*>(pixels.data()))
        .clone();
}

cv::Mat comparison(const SilhouetteCase& found) {
    const cv::Mat silhouette = dense(found.silhouette);
    cv::Mat out(silhouette.size(), CV_8UC3, cv::Scalar::all(0));
    out.setTo(cv::Scalar(0, 0, 255), silhouette);
    if (found.fit) {
        const cv::Mat mask = dense(*found.mask);
        out.setTo(cv::Scalar::all(255), mask);
        out.setTo(cv::Scalar(0, 0, 255), silhouette & ~mask);
        out.setTo(cv::Scalar(0, 255, 255), silhouette & mask);
    }
    if (!found.boxIou) {
        if (found.ignored.width_px > 0) out.setTo(cv::Scalar(110, 80, 60), dense(found.ignored));
        return out;
    }
    const auto& b = found.truthBox;
    cv::rectangle(out, cv::Point(int(b.left), int(b.top)), cv::Point(int(b.right), int(b.bottom)),
                  cv::Scalar::all(255), 1);
    return out;
}

/// The whole image, dark, with the boxes of all objects and this one's model.
cv::Mat sceneImage(const texture::RenderedModel& render, int64_t shown,
                   const evaluation::EstimatedDrive& estimate, const ShownFrame& frame) {
    cv::Mat out = 0.45 * frame.image;
    for (const auto& [id, object] : estimate.objects) {
        const auto T_cam_obj = estimate.T_cam_obj(id, frame.frame);
        if (!T_cam_obj || T_cam_obj->translation().z() < 1 || id == shown) continue;
        drawBox(out, frame.camera, *T_cam_obj, object.size_m, colourOf(id), 1);
    }
    overlay(render, out);
    if (const auto T_cam_obj = estimate.T_cam_obj(shown, frame.frame)) {
        drawBox(out, frame.camera, *T_cam_obj, estimate.objects.at(shown).size_m, kBoxColour, 2);
    }
    return out;
}

cv::Mat strip(const SilhouetteCase& found, const texture::ObjectModel& model,
              const evaluation::EstimatedDrive& estimate, const ShownFrame& frame) {
    const SE3& T_cam_obj = found.T_cam_obj;
    const auto size_m = estimate.objects.at(found.object).size_m;
    const cv::Rect part = around(frame.camera, T_cam_obj, size_m, frame.image.size());
    if (part.width < 8 || part.height < 8) return {};
    const auto render = renderModel(model, frame.camera, T_cam_obj);
    cv::Mat projected = frame.image.clone();
    overlay(render, projected);
    char fit[64];
    if (found.fit) {
        std::snprintf(fit, sizeof(fit), "mask, silhouette: IoU %.3f", found.fit->iou);
    } else if (!found.boxIou) {
        std::snprintf(fit, sizeof(fit), "silhouette without truth");
    } else {
        std::snprintf(fit, sizeof(fit), "box, silhouette: IoU %.3f", *found.boxIou);
    }
    std::vector<cv::Mat> panels{
        captioned(pointsPanel(model, T_cam_obj.inverse().translation(), PointColour::Own),
                  "Object " + std::to_string(found.object) + ": " + std::to_string(model.size()) +
                      " points"),
        captioned(enlarged(frame.image, part), "Frame " + std::to_string(found.frame)),
        captioned(enlarged(projected, part), "Model projected"),
        captioned(enlarged(comparison(found), part), fit)};
    if (frame.scan) {
        panels.push_back(
            captioned(placementPanel(model, frame.T_world_cam * T_cam_obj, size_m, frame),
                      "In the scan of the frame"));
    } else {
        panels.push_back(captioned(sceneImage(render, found.object, estimate, frame),
                                   "In the image; boxes of all objects"));
    }
    return beside(panels);
}

}  // namespace

void drawSilhouetteStrips(const evaluation::DriveSilhouettes& silhouettes,
                          const evaluation::ObjectModels& models,
                          const evaluation::EstimatedDrive& estimate, const std::string& rawlog,
                          const std::string& folder) {
    std::error_code failed;
    fs::create_directories(folder, failed);
    if (!fs::is_directory(folder)) throw obs::InputError(folder + ": the folder cannot be made");
    std::vector<const SilhouetteCase*> shown;
    std::vector<std::size_t> frames;
    for (const auto& object : silhouettes.objects) {
        if (const auto* found = object.typical()) {
            shown.push_back(found);
            frames.push_back(found->frame);
        }
    }
    const auto drive = readDrive(rawlog, estimate.cameras, frames, ShownImage::Main);
    for (const auto* found : shown) {
        const auto frame = drive.shown.find(found->frame);
        if (frame == drive.shown.end()) continue;
        const auto picture = strip(*found, models.at(found->object), estimate, frame->second);
        char name[32];
        std::snprintf(name, sizeof(name), "%04lld.png", static_cast<long long>(found->object));
        if (!picture.empty()) save(picture, (fs::path(folder) / name).string());
    }
}

}  // namespace djpete::figures
