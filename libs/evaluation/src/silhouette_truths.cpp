#include "silhouette_truths.h"

#include <algorithm>

#include "djpete/obs/errors.h"

namespace djpete::evaluation {

namespace {

MaskImage denseMask(const obs::RleMask& mask, const geometry::StereoCamera& camera,
                    std::size_t frame, const std::string& file) {
    if (int(mask.width_px) != camera.width_px || int(mask.height_px) != camera.height_px) {
        throw obs::InputError(file + ": frame " + std::to_string(frame) + " has a mask of " +
                              std::to_string(mask.width_px) + "x" + std::to_string(mask.height_px) +
                              " pixels, expected the size of the images, " +
                              std::to_string(camera.width_px) + "x" +
                              std::to_string(camera.height_px));
    }
    return {camera.width_px, camera.height_px, mask.toDense()};
}

}  // namespace

MaskImage FrameTruths::othersThan(const std::optional<std::size_t>& own, int width_px,
                                  int height_px) const {
    MaskImage out{width_px, height_px, {}};
    out.pixels.assign(static_cast<std::size_t>(width_px) * static_cast<std::size_t>(height_px), 0);
    const auto paint = [&out](const MaskImage& mask, uint8_t value) {
        for (std::size_t i = 0; i < out.pixels.size(); ++i) {
            if (mask.pixels[i] != 0) out.pixels[i] = value;
        }
    };
    for (const auto& vehicle : vehicles) paint(vehicle.mask, 255);
    for (const auto& mask : otherMasks) paint(mask, 255);
    if (own) paint(vehicles[*own].mask, 0);
    return out;
}

std::optional<FrameTruths> truthsOf(const obs::CObservationDetectedObjects& seen, std::size_t frame,
                                    const geometry::StereoCamera& camera, const std::string& file) {
    std::vector<const obs::ObjectDetection*> all;
    for (const auto& d : seen.detections) {
        if (d.source != "geometric" && (d.mask || d.box)) all.push_back(&d);
    }
    if (all.empty() && !seen.detections.empty()) return std::nullopt;
    FrameTruths out;
    out.masked =
        std::any_of(all.begin(), all.end(), [](const auto* d) { return d->mask.has_value(); });
    for (const auto* d : all) {
        const bool vehicle = obs::isVehicle(d->objectClass);
        if (!out.masked) {
            if (vehicle) out.vehicles.push_back({d, {}, *d->box});
            continue;
        }
        if (!d->mask) continue;
        MaskImage mask = denseMask(*d->mask, camera, frame, file);
        const auto box = boxOf(mask);
        if (!box) continue;
        if (vehicle) {
            out.vehicles.push_back({d, std::move(mask), *box});
        } else {
            out.otherMasks.push_back(std::move(mask));
        }
    }
    return out;
}

}  // namespace djpete::evaluation
