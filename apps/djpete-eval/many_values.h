/// Options that take several words.
#pragma once

#include <set>
#include <string>
#include <vector>

namespace djpete::apps {

/// TCLAP wants an option before each value: `--labels a b --json` becomes
/// `--labels a --labels b --json` for the options in `many`.
std::vector<std::string> repeatOptions(int argc, const char** argv,
                                       const std::set<std::string>& many);

}  // namespace djpete::apps
