/// All figures of the textures of one simulated drive.
#pragma once

#include <map>
#include <optional>
#include <string>
#include <vector>

#include "djpete/evaluation/estimated_drive.h"
#include "djpete/evaluation/saved_models.h"
#include "djpete/evaluation/texture_errors.h"
#include "djpete/evaluation/true_drive.h"

namespace djpete::evaluation {

/// What counts.
struct TextureCriteria {
    double maxRange_m = 25;       ///< views from farther away count for nothing
    std::size_t minViews = 3;     ///< objects with fewer views within the range are left out
    std::size_t heldOut = 6;      ///< at most so many images of each object that made no model
    std::string stripFolder;      ///< if not empty: gets a picture NNNN.png of each object
    std::size_t minPixels = 400;  ///< of the object's mask in such an image
};

/// Figures of one object. Nothing where there is nothing to measure.
struct ObjectTexture {
    int64_t objectId = 0, actorId = 0;
    bool moving = false;
    std::size_t points = 0, colouredPoints = 0;
    std::size_t views = 0, nearViews = 0;  ///< that coloured it; those of them within the range
    Coverage coverage;                     ///< of what the model's own views saw
    Coverage keyframeCoverage;             ///< of what all keyframes with the object saw
    std::vector<ColourPair> pairs;         ///< colours as the images have them against albedo
    std::vector<ColourPair> albedoPairs;   ///< the model's own albedo against the true one
    std::vector<ColourPair> lightPairs;    ///< pixels of its views against albedo
    std::optional<double> colourError, lightError;  ///< medians, CIEDE2000
    std::optional<double> albedoError;              ///< the same, of the model's albedo
    std::optional<double> ownGainError;  ///< colourError with a gain for this object alone
    Bleeding bleeding;
    std::optional<double> spread;
    std::size_t heldOut = 0;
    std::optional<double> psnr_dB, flatPsnr_dB, iou;  ///< medians over the held-out images
};

/// Points of one kind of all objects, each as much as any other.
struct SideErrors {
    double share = 0;                    ///< of all points
    std::optional<double> colourError;   ///< median with the drive's gain
    std::optional<double> ownGainError;  ///< median with a gain for this side alone
    double ownGain = 1;
};

struct TextureErrors {
    double gain = 1, lightGain = 1;  ///< of the drive: models, pixels
    double albedoGain = 1;
    std::optional<SideErrors> sunny, shady;  ///< of the models; nothing without a known sun
    std::size_t withoutActor = 0, withoutMesh = 0, fewViews = 0;
    std::vector<ObjectTexture> objects;  ///< by object id
};

/// The actor nearest to an object (from above, within 2 m) in most of its frames; nothing if there
/// is none.
std::optional<int64_t> actorOf(const EstimatedObject& object, const EstimatedDrive& estimate,
                               const TrueDrive& truth);

/// Figures of all models. Throws obs::InputError if a file of the drive cannot be read.
TextureErrors evaluateTextures(const ObjectModels& models, const EstimatedDrive& estimate,
                               const TrueDrive& truth, const TextureCriteria& criteria);

}  // namespace djpete::evaluation
