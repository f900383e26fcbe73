/// Options in INI files: every key is known, or it is an error.
#pragma once

#include <mrpt/config/CConfigFileBase.h>
#include <mrpt/config/CLoadableOptions.h>

#include <string>
#include <vector>

namespace djpete::obs {

/// Loads `section` of `config` into `options`; an absent section keeps the defaults.
/// Throws InputError, naming `origin` (the file), if the section holds a key that `options` does
/// not write itself, or a value that MRPT cannot parse.
void loadOptions(mrpt::config::CLoadableOptions& options,
                 const mrpt::config::CConfigFileBase& config, const std::string& section,
                 const std::string& origin);

/// Throws InputError if `config` has a section that is not in `known`.
void requireKnownSections(const mrpt::config::CConfigFileBase& config,
                          const std::vector<std::string>& known, const std::string& origin);

}  // namespace djpete::obs
