/// How visual odometry detects, follows and measures.
#pragma once

#include <mrpt/config/CLoadableOptions.h>

#include <cstdint>
#include <iosfwd>
#include <string>

namespace djpete::frontend {

/// Section [frontend] of an INI file; units and reasons stand in the comments that
/// saveToConfigFile() writes. Every key is written, so that unknown ones can be told.
struct FrontendOptions : public mrpt::config::CLoadableOptions {
    // Detection
    int featuresWanted = 900;
    int fastThreshold = 8;
    double minDistance_px = 11;
    double minTexture = 4.0;
    int border_px = 12;
    double detectBelowRatio = 0.4;

    // Following from image to image
    int kltLevels = 4;
    double kltForwardBackward_px = 0.7;
    double kltMinCorrelation = 0.8;

    // Stereo
    double stereoMinDepth_m = 2.5;
    double stereoLeftRight_px = 0.7;
    double stereoMinCorrelation = 0.85;
    double stereoUniqueness = 0.9;
    bool stereoCalibrate = true;

    // LiDAR depth
    double lidarHalfWidth_px = 6;
    double lidarHalfHeight_px = 9;
    double lidarMaxResidual = 0.02;
    double lidarSigma_m = 0.05;
    double lidarMaxDepth_m = 70;

    // Pose
    double sigmaTrack_px = 0.35;
    double sigmaStereo_px = 0.30;
    double sigmaDrift_px = 0.02;
    double robustScale = 2.0;
    double outlierChi2PerDof = 6.0;
    int minInliers = 20;
    double minInlierRatio = 0.35;
    int ransacIterations = 100;
    uint64_t seed = 1;

    // Keyframes
    double keyframeTranslation_m = 2.0;
    double keyframeRotation_deg = 5.0;
    double keyframeKeptRatio = 0.5;
    double keyframeInterval_s = 2.0;

    void loadFromConfigFile(const mrpt::config::CConfigFileBase& source,
                            const std::string& section) override;
    void saveToConfigFile(mrpt::config::CConfigFileBase& target,
                          const std::string& section) const override;
    void dumpToTextStream(std::ostream& out) const override;
    /// Throws obs::InputError naming the key and what was expected if a value is out of its range.
    void check() const;
};

}  // namespace djpete::frontend
