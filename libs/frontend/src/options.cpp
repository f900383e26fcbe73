#include "djpete/frontend/options.h"

#include <mrpt/config/CConfigFileBase.h>
#include <mrpt/config/CConfigFileMemory.h>

#include <ostream>
#include <sstream>
#include <type_traits>

#include "djpete/obs/errors.h"

namespace djpete::frontend {

namespace {

/// Calls visit(key, value, comment) for every option: the one list that loading, saving and
/// dumping share.
template <class Options, class Visitor>
void forEach(Options& o, Visitor&& visit) {
    visit("features_wanted", o.featuresWanted,
          "corners kept per image; more cost time, fewer cost accuracy");
    visit("fast_threshold", o.fastThreshold,
          "grey levels; least FAST corner contrast: the strongest of a cell is taken");
    visit("min_distance_px", o.minDistance_px, "between two features, so that they are spread");
    visit("min_texture", o.minTexture,
          "grey levels per px; root of the patch's smaller structure eigenvalue: below it a "
          "patch slides along an edge");
    visit("border_px", o.border_px, "no feature nearer to the image border");
    visit("detect_below_ratio", o.detectBelowRatio,
          "new corners in non-keyframes if fewer than this share of features_wanted are left");
    visit("klt_levels", o.kltLevels, "pyramid levels above full size for tracking unpredicted");
    visit("klt_forward_backward_px", o.kltForwardBackward_px,
          "a patch tracked back must return this near");
    visit("klt_min_correlation", o.kltMinCorrelation,
          "0..1; normalised correlation with the track's first patch, warped to the new view");
    visit("stereo_min_depth_m", o.stereoMinDepth_m, "nearest depth searched: bounds disparity");
    visit("stereo_left_right_px", o.stereoLeftRight_px,
          "matching right to left must return this near");
    visit("stereo_min_correlation", o.stereoMinCorrelation,
          "0..1; normalised correlation of the patches");
    visit("stereo_uniqueness", o.stereoUniqueness,
          "0..1; the best cost must be below this times the best elsewhere in the row");
    visit("stereo_calibrate", o.stereoCalibrate,
          "learn what the rectification left of row and disparity errors while driving");
    visit("lidar_half_width_px", o.lidarHalfWidth_px, "scan points used about a feature");
    visit("lidar_half_height_px", o.lidarHalfHeight_px,
          "likewise, along the column: must span two scan lines");
    visit("lidar_max_residual", o.lidarMaxResidual,
          "share of depth; points must fit one plane this well, else it is a depth edge");
    visit("lidar_sigma_m", o.lidarSigma_m, "standard deviation of a range");
    visit("lidar_max_depth_m", o.lidarMaxDepth_m, "farther scan points are not used");
    visit("sigma_track_px", o.sigmaTrack_px, "standard deviation of a followed corner");
    visit("sigma_stereo_px", o.sigmaStereo_px, "standard deviation of a disparity");
    visit("sigma_drift_px", o.sigmaDrift_px,
          "per root of frames followed: a patch slowly slides off its point");
    visit("robust_scale", o.robustScale,
          "standard deviations beyond which a feature loses weight (Geman-McClure)");
    visit("outlier_chi2_per_dof", o.outlierChi2PerDof, "features beyond are dropped");
    visit("min_inliers", o.minInliers, "fewer: the frame is not measured but predicted");
    visit("min_inlier_ratio", o.minInlierRatio,
          "of the followed features; fewer: restart from minimal samples");
    visit("ransac_iterations", o.ransacIterations, "minimal samples of that restart");
    visit("seed", o.seed, "of those samples, together with the frame number");
    visit("keyframe_translation_m", o.keyframeTranslation_m, "new keyframe after this way");
    visit("keyframe_rotation_deg", o.keyframeRotation_deg, "new keyframe after this turn");
    visit("keyframe_kept_ratio", o.keyframeKeptRatio,
          "new keyframe when less of the last keyframe's features is left");
    visit("keyframe_interval_s", o.keyframeInterval_s, "new keyframe at least this often, moving");
}

void requireThat(bool ok, const char* key, const char* expected) {
    if (!ok) throw obs::InputError(std::string("option ") + key + ": expected " + expected);
}

}  // namespace

void FrontendOptions::loadFromConfigFile(const mrpt::config::CConfigFileBase& source,
                                         const std::string& section) {
    forEach(*this, [&](const char* key, auto& value, const char*) {
        using T = std::decay_t<decltype(value)>;
        if constexpr (std::is_same_v<T, double>) {
            value = source.read_double(section, key, value);
        } else if constexpr (std::is_same_v<T, uint64_t>) {
            value = source.read_uint64_t(section, key, value);
        } else if constexpr (std::is_same_v<T, bool>) {
            value = source.read_bool(section, key, value);
        } else {
            value = source.read_int(section, key, value);
        }
    });
}

void FrontendOptions::saveToConfigFile(mrpt::config::CConfigFileBase& target,
                                       const std::string& section) const {
    forEach(*this, [&](const char* key, const auto& value, const char* comment) {
        std::ostringstream exact;  // MRPT itself writes six digits
        exact.precision(15);
        exact << std::boolalpha;
        exact << value;
        target.write(section, key, exact.str(), -1, -1, comment);
    });
}

void FrontendOptions::dumpToTextStream(std::ostream& out) const {
    mrpt::config::CConfigFileMemory text;
    saveToConfigFile(text, "frontend");
    out << text.getContent();
}

void FrontendOptions::check() const {
    requireThat(featuresWanted >= 20, "features_wanted", "20 or more");
    requireThat(fastThreshold > 0 && fastThreshold < 255, "fast_threshold", "1 to 254");
    requireThat(minDistance_px >= 1, "min_distance_px", "1 or more");
    requireThat(border_px >= 8, "border_px", "8 or more");
    requireThat(kltLevels >= 0 && kltLevels <= 8, "klt_levels", "0 to 8");
    requireThat(kltForwardBackward_px > 0, "klt_forward_backward_px", "more than 0");
    requireThat(stereoMinDepth_m > 0, "stereo_min_depth_m", "more than 0");
    requireThat(stereoLeftRight_px > 0, "stereo_left_right_px", "more than 0");
    requireThat(lidarHalfWidth_px >= 1, "lidar_half_width_px", "1 or more");
    requireThat(lidarHalfHeight_px >= 1, "lidar_half_height_px", "1 or more");
    requireThat(lidarMaxResidual > 0, "lidar_max_residual", "more than 0");
    requireThat(lidarSigma_m > 0, "lidar_sigma_m", "more than 0");
    requireThat(sigmaTrack_px > 0, "sigma_track_px", "more than 0");
    requireThat(sigmaStereo_px > 0, "sigma_stereo_px", "more than 0");
    requireThat(sigmaDrift_px >= 0, "sigma_drift_px", "0 or more");
    requireThat(robustScale > 0, "robust_scale", "more than 0");
    requireThat(outlierChi2PerDof > 0, "outlier_chi2_per_dof", "more than 0");
    requireThat(minInliers >= 6, "min_inliers", "6 or more");
    requireThat(ransacIterations > 0, "ransac_iterations", "1 or more");
    requireThat(keyframeTranslation_m > 0, "keyframe_translation_m", "more than 0");
    requireThat(keyframeRotation_deg > 0, "keyframe_rotation_deg", "more than 0");
    requireThat(keyframeInterval_s > 0, "keyframe_interval_s", "more than 0");
}

}  // namespace djpete::frontend
