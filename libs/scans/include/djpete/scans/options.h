/// How scans are matched; section [scans].
#pragma once

#include <mrpt/config/CLoadableOptions.h>

#include <string>

namespace djpete::scans {

struct ScanOptions : public mrpt::config::CLoadableOptions {
    /// Off: scans give depth to features only.
    bool enabled = true;
    /// Time of one turn of a scanner whose frames are stamped when it looks ahead and that turns
    /// counter-clockwise; 0: all points are of one instant (or the motion was taken out already).
    double spinPeriod_s = 0;
    /// Points nearer hit the own vehicle; farther ones are too sparse for planes.
    double minRange_m = 2.5, maxRange_m = 60;
    /// One point is kept per cube of this size: to build planes, and to be matched with them.
    double mapSpacing_m = 0.2, matchSpacing_m = 0.7;
    /// Cube whose points form one plane.
    double planeSize_m = 1.0;
    /// Points that make a plane at least.
    unsigned planePoints = 10;
    /// Largest standard deviation of the points across it.
    double planeThickness_m = 0.08;
    /// Points go out of the local map when the vehicle has gone this far since, or after so many
    /// keyframes.
    double mapLength_m = 30;
    unsigned mapKeyframes = 20;
    /// Standard deviation of a range.
    double rangeSigma_m = 0.03;
    /// Width of Geman and McClure's kernel at the start; it follows what predictions were worth.
    double firstKernel_m = 0.3;
    /// Iterations at most.
    unsigned iterations = 12;
    /// Fewer points on planes, or a smaller share of all: no match.
    unsigned minMatched = 300;
    double minMatchedRatio = 0.2;
    /// Errors of neighbouring points are alike: cubes of this size err on their own, points do not.
    double alikeSize_m = 10;
    /// 1-sigma added to a motion between keyframes, per axis, however many points agree: what a
    /// real scanner's own distortions do (seen on KITTI against stereo).
    double floor_m = 0.005, floor_rad = 5e-4;

    void loadFromConfigFile(const mrpt::config::CConfigFileBase& source,
                            const std::string& section) override;
    void saveToConfigFile(mrpt::config::CConfigFileBase& target,
                          const std::string& section) const override;
};

}  // namespace djpete::scans
