/// The program djpete-eval.
#pragma once

#include <iosfwd>
#include <optional>
#include <string>
#include <vector>

#include "djpete/evaluation/tracking_errors.h"
#include "figures.h"
#include "report.h"
#include "texture_report.h"

namespace djpete::apps {

/// Reads an estimated camera path, the truth and (if asked) objects and labels; or tracked boxes
/// and labels; or folders of runs with and without objects; or a result and a simulated drive for
/// the objects' textures. Prints how well they agree, as a table
/// or as JSON.
class DjpeteEvalApp {
  public:
    /// What the command line says.
    struct Settings {
        std::string trajectoryFile;
        std::optional<std::string> truthFile, objectsFile, loopsFile;
        std::vector<std::string> labelsFiles;      ///< with trackingFiles also folders
        std::vector<std::string> ablationFolders;  ///< then no other files
        std::vector<std::string> trackingFiles;    ///< files or folders; then no trajectory
        std::optional<evaluation::FrameRange> range;
        evaluation::ObjectCriteria criteria;
        evaluation::TrackingCriteria trackingCriteria;
        TextureSettings textures;  ///< with a resultFolder no other files
        bool worldFromTruth = false;
        std::optional<figures::FigureRequest> figures;  ///< then nothing is compared
        bool json = false;
    };
    Settings settings;
    EvaluationResults results;  ///< filled by run()

    /// Parses the command line. False if it only asked for help or the version, which then has been
    /// printed. Throws obs::InputError on a command line that makes no sense.
    bool initialize(int argc, const char** argv);
    /// Evaluates and prints to `out`. Throws obs::InputError on bad input, before printing.
    void run(std::ostream& out);

  private:
    void evaluateObjects(const evaluation::TrajectoryFile& estimate,
                         const std::optional<evaluation::TrajectoryFile>& truth);
};

}  // namespace djpete::apps
