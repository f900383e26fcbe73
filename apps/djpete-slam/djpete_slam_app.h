/// The command line program `djpete-slam`, callable from tests.
#pragma once

#include <chrono>
#include <filesystem>
#include <map>
#include <memory>
#include <optional>
#include <string>

#include "djpete/calibration/corrected_calibration.h"
#include "djpete/map/map_file.h"
#include "djpete/pipeline/object_slam.h"
#include "djpete/pipeline/result_folder.h"
#include "djpete_app/frame_range.h"

namespace djpete::apps {

/// Runs a drive from a rawlog and writes the result folder.
class DjpeteSlamApp {
  public:
    DjpeteSlamApp();
    ~DjpeteSlamApp();

    /// Reads the command line and the INI. False if there is nothing to run
    /// (--help,
    /// --print-config). Throws obs::InputError on bad arguments or options.
    bool initialize(int argc, const char* const* argv);
    /// Processes the drive and writes all results. 0, or 1 after bad input was
    /// met on the way: then one sentence was printed and the results of
    /// everything before it were written.
    int run();

    // Results, for tests.
    std::filesystem::path outFolder;
    std::unique_ptr<pipeline::ObjectSlam> slam;
    pipeline::RunSummary summary;

  private:
    struct Arguments;

    std::unique_ptr<observers::ObjectObserver> makeObserver() const;
    /// Until the drive ends or a frame cannot be used; then summary.error says
    /// why.
    void processDrive(obs::RawlogSource& source);
    void compareWithTruth();
    /// --map and --save-map, if asked for.
    void openMap();
    void saveMap();
    double sinceStart_s() const {
        return std::chrono::duration<double>(std::chrono::steady_clock::now() - start_).count();
    }
    /// What the drive says of its rig.
    calibration::CalibrationReport checkRig() const;
    std::string note(const pipeline::FrameOutcome& outcome) const;

    std::chrono::steady_clock::time_point start_ = std::chrono::steady_clock::now();
    std::unique_ptr<Arguments> arguments_;
    map::MapFileInfo mapInfo_;
    std::map<obs::FrameId, geometry::SE3> truth_;                  ///< T_world_vehicle
    std::optional<calibration::CorrectedCalibration> correction_;  ///< of a run that asks for it
};

}  // namespace djpete::apps
