/// The program djpete-eval.
#pragma once

#include <iosfwd>
#include <optional>

#include "eval_settings.h"
#include "report.h"

namespace djpete::apps {

/// Reads an estimated camera path, the truth and (if asked) objects and labels; or tracked boxes
/// and labels; or folders of runs with and without objects; or a result and a simulated drive for
/// the objects' textures; or a result and masks for their silhouettes. Prints how well they agree,
/// as a table or as JSON.
class DjpeteEvalApp {
  public:
    using Settings = EvalSettings;
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
