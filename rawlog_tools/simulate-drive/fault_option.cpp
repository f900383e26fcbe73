#include "fault_option.h"

#include <algorithm>
#include <sstream>

#include "djpete/obs/errors.h"
#include "djpete_app/frame_range.h"

namespace djpete::apps {

using simulator::DriveOptions;
using simulator::Fault;
using simulator::Frames;

std::string faultHelp() {
    std::string text =
        "Make the drive wrong in the frames A to B-1 (may be repeated; default: five frames in the "
        "middle for dropped and black ones, the middle third for others; wrong calibrations hold "
        "for the whole drive):";
    for (const auto& f : simulator::faultNames())
        text += std::string(" ") + f.name + " (" + f.what + ")" +
                (&f == &simulator::faultNames().back() ? "" : ",");
    return text;
}

Fault parseFault(const std::string& text, const DriveOptions& options) {
    const auto at = text.find('@');
    const std::string word = text.substr(0, at);
    const auto& names = simulator::faultNames();
    const auto name =
        std::find_if(names.begin(), names.end(), [&](const auto& f) { return word == f.name; });
    if (name == names.end()) {
        std::string all;
        for (const auto& f : names) all += (all.empty() ? "" : ", ") + std::string(f.name);
        throw obs::InputError("--fault " + text + ": expected one of " + all);
    }
    if (at == std::string::npos)
        return simulator::faultAtItsPlace(name->kind, options.begin, options.end);
    if (name->ofDrive)
        throw obs::InputError("--fault " + text + ": " + word +
                              " holds for the whole drive; expected no @A:B");
    const auto range = parseFrameRange(text.substr(at + 1));
    const Fault fault{name->kind, std::max(range.begin, options.begin),
                      std::min(range.end, options.end)};
    if (fault.begin >= fault.end) {
        std::ostringstream o;
        o << "--fault " << text << ": expected frames of the drive, " << options.begin << ":"
          << options.end;
        throw obs::InputError(o.str());
    }
    return fault;
}

std::vector<Frames> parseFrames(const std::string& text) {
    std::vector<Frames> out;
    std::istringstream in(text);
    for (std::string part; std::getline(in, part, ',');) {
        const auto range = parseFrameRange(part);
        out.push_back({range.begin, range.end});
    }
    return out;
}

}  // namespace djpete::apps
