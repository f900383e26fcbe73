/// How the error of textures falls from view to view.
#pragma once

#include <vector>

#include "djpete/evaluation/texture_evaluation.h"
#include "djpete/evaluation/texture_rebuild.h"

namespace djpete::evaluation {

/// One object after one more view.
struct CurvePoint {
    std::size_t step = 0;   ///< 1: the first view that coloured the object
    std::size_t frame = 0;  ///< of the view
    std::size_t points = 0, colouredPoints = 0;
    std::optional<double> colourError;  ///< median CIEDE2000 of the points coloured so far
    std::optional<double> imageError;   ///< completeness counts: see imageErrorOf; 0..255
};

struct ObjectCurve {
    int64_t objectId = 0, actorId = 0;
    std::vector<CurvePoint> points;  ///< the last one is of the settled model
};

struct TextureCurves {
    double gain = 1;  ///< of the last models; used for all steps
    std::vector<ObjectCurve> objects;
};

/// What share of objects ends better than it began, and what share of single steps falls.
struct CurveSummary {
    std::size_t objects = 0, objectsFalling = 0;
    std::size_t steps = 0, stepsFalling = 0;
};

/// Builds the textures again and measures after each view that coloured an object; objects are
/// those of evaluateTextures.
TextureCurves textureCurves(const EstimatedDrive& estimate, const TrueDrive& truth,
                            const std::string& rawlog, const TextureCriteria& criteria,
                            const RebuildOptions& options);

/// Root mean square over the mask's pixels of image minus rendering (after a * rendering + b);
/// where the rendering has nothing, of image minus the mask's mean. Nothing for an empty mask.
std::optional<double> imageErrorOf(const texture::ObjectModel& model, const RgbImage& image,
                                   const MaskImage& mask, const geometry::StereoCamera& camera,
                                   const geometry::SE3& T_cam_est);

using CurveValue = std::optional<double> CurvePoint::*;
CurveSummary summariseCurves(const TextureCurves& curves, CurveValue value);
/// Mean over objects of the value after 1, 2, ... views; objects with fewer views keep their last.
std::vector<double> meanCurve(const TextureCurves& curves, CurveValue value);

/// object,actor,step,frame,points,coloured_points,colour_error_de2000,image_error
void writeCurvesCsv(const TextureCurves& curves, const std::string& file);
/// A picture: thin lines are objects, the thick one is their mean; both values, one over the other.
void plotCurves(const TextureCurves& curves, const std::string& file);

}  // namespace djpete::evaluation
