#include "djpete/obs/options.h"

#include <mrpt/config/CConfigFileMemory.h>
#include <mrpt/system/string_utils.h>

#include <algorithm>
#include <set>

#include "djpete/obs/errors.h"

namespace djpete::obs {

namespace {

std::string joined(const std::set<std::string>& words) {
    std::string out;
    for (const auto& w : words) out += (out.empty() ? "" : ", ") + w;
    return out;
}

}  // namespace

void loadOptions(mrpt::config::CLoadableOptions& options,
                 const mrpt::config::CConfigFileBase& config, const std::string& section,
                 const std::string& origin) {
    if (!config.sectionExists(section)) return;
    mrpt::config::CConfigFileMemory defaults;
    options.saveToConfigFile(defaults, section);
    std::vector<std::string> keys;
    defaults.getAllKeys(section, keys);
    std::set<std::string> known;
    for (const auto& key : keys) known.insert(mrpt::system::trim(key));  // MRPT pads what it saves
    config.getAllKeys(section, keys);
    for (const auto& key : keys) {
        if (known.count(key) == 0) {
            throw InputError(origin + ": unknown key '" + key + "' in section [" + section +
                             "]; expected one of: " + joined(known));
        }
    }
    try {
        options.loadFromConfigFile(config, section);
    } catch (const InputError&) {
        throw;
    } catch (const std::exception& e) {
        std::string what = e.what();
        what = what.substr(0, what.find('\n'));
        throw InputError(origin + ": section [" + section + "] cannot be read: " + what);
    }
}

void requireKnownSections(const mrpt::config::CConfigFileBase& config,
                          const std::vector<std::string>& known, const std::string& origin) {
    std::vector<std::string> sections;
    config.getAllSections(sections);
    for (const auto& section : sections) {
        if (section.empty()) continue;
        if (std::find(known.begin(), known.end(), section) == known.end()) {
            throw InputError(origin + ": unknown section [" + section + "]; expected one of: " +
                             joined(std::set<std::string>(known.begin(), known.end())));
        }
    }
}

}  // namespace djpete::obs
