/// What the detections of a frame say of vehicles in its image. Private to the room.
#pragma once

#include <string>

#include "djpete/evaluation/silhouette_pairs.h"
#include "djpete/obs/CObservationDetectedObjects.h"

namespace djpete::evaluation {

struct TrueVehicle {
    const obs::ObjectDetection* detection = nullptr;
    MaskImage mask;     ///< empty if the frame has no masks
    obs::ImageBox box;  ///< of the mask if there is one
};

struct FrameTruths {
    bool masked = false;  ///< some detection has a mask; those without are left out then
    std::vector<TrueVehicle> vehicles;
    std::vector<MaskImage> otherMasks;  ///< of what is no vehicle

    /// All masks but that of the vehicle `own`, without the pixels of its mask.
    MaskImage othersThan(const std::optional<std::size_t>& own, int width_px, int height_px) const;
};

/// Nothing if the frame has only detections of the GeometricObserver: they come from the scans that
/// make the models. The result points into `seen`. Throws obs::InputError naming `file` and the
/// frame if a mask has not the size of the camera's images.
std::optional<FrameTruths> truthsOf(const obs::CObservationDetectedObjects& seen, std::size_t frame,
                                    const geometry::StereoCamera& camera, const std::string& file);

}  // namespace djpete::evaluation
