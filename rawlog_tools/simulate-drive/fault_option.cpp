#include "fault_option.h"

#include <algorithm>
#include <cstdlib>
#include <sstream>

#include "djpete/obs/errors.h"
#include "djpete_app/frame_range.h"

namespace djpete::apps {

using simulator::DriveOptions;
using simulator::Fault;
using simulator::FaultName;
using simulator::Frames;

namespace {

/// The name as one writes it.
std::string shown(const FaultName& f) {
    return std::string(f.name) + (f.mostAmount > 0 ? "=F" : "");
}

/// The amount in "NAME=F" (`number`: what follows the "=", empty without one).
double parseAmount(const std::string& text, const FaultName& name, const std::string& number) {
    char* end = nullptr;
    const double amount = std::strtod(number.c_str(), &end);
    if (number.empty() || *end != 0 || !(amount > 0 && amount <= name.mostAmount)) {
        std::ostringstream o;
        o << "--fault " << text << ": expected " << shown(name)
          << " with a number F above 0 and at most " << name.mostAmount;
        throw obs::InputError(o.str());
    }
    return amount;
}

}  // namespace

std::string faultHelp() {
    std::string text =
        "Make the drive wrong in the frames A to B-1 (may be repeated; default: five frames in the "
        "middle for dropped and black ones, the middle third for others; wrong calibrations and "
        "exposures "
        "hold for the whole drive):";
    for (const auto& f : simulator::faultNames())
        text += " " + shown(f) + " (" + f.what + ")" +
                (&f == &simulator::faultNames().back() ? "" : ",");
    return text;
}

Fault parseFault(const std::string& text, const DriveOptions& options) {
    const auto at = text.find('@');
    const std::string whole = text.substr(0, at);
    const auto equals = whole.find('=');
    const std::string word = whole.substr(0, equals);
    const auto& names = simulator::faultNames();
    const auto name =
        std::find_if(names.begin(), names.end(), [&](const auto& f) { return word == f.name; });
    if (name == names.end()) {
        std::string all;
        for (const auto& f : names) all += (all.empty() ? "" : ", ") + shown(f);
        throw obs::InputError("--fault " + text + ": expected one of " + all);
    }
    double amount = 0;
    if (name->mostAmount > 0)
        amount =
            parseAmount(text, *name, equals == std::string::npos ? "" : whole.substr(equals + 1));
    else if (equals != std::string::npos)
        throw obs::InputError("--fault " + text + ": " + word + " has no number; expected no =");
    if (at == std::string::npos) {
        Fault fault = simulator::faultAtItsPlace(name->kind, options.begin, options.end);
        fault.amount = amount;
        return fault;
    }
    if (name->ofDrive)
        throw obs::InputError("--fault " + text + ": " + word +
                              " holds for the whole drive; expected no @A:B");
    const auto range = parseFrameRange(text.substr(at + 1));
    const Fault fault{name->kind, std::max(range.begin, options.begin),
                      std::min(range.end, options.end), amount};
    if (fault.begin >= fault.end) {
        std::ostringstream o;
        o << "--fault " << text << ": expected frames of the drive, " << options.begin << ":"
          << options.end;
        throw obs::InputError(o.str());
    }
    return fault;
}

std::vector<Fault> parseFaults(const std::vector<std::string>& texts, const DriveOptions& options) {
    std::vector<Fault> out;
    for (const auto& text : texts) {
        const Fault fault = parseFault(text, options);
        if (fault.amount > 0 && simulator::hasFault(out, fault.kind))
            throw obs::InputError("--fault " + text + ": expected it only once");
        out.push_back(fault);
    }
    return out;
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
