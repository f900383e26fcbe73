#include "djpete_app/frame_range.h"

#include <algorithm>
#include <optional>

#include "djpete/obs/errors.h"

namespace djpete::apps {

namespace {

/// Whole numbers of at most 18 digits, or nothing.
std::optional<uint64_t> wholeNumber(const std::string& s) {
    const auto digit = [](char c) { return c >= '0' && c <= '9'; };
    if (s.empty() || s.size() > 18 || !std::all_of(s.begin(), s.end(), digit)) return std::nullopt;
    return std::stoull(s);
}

}  // namespace

FrameRange parseFrameRange(const std::string& text) {
    FrameRange out;
    if (text.empty()) return out;
    const auto colon = text.find(':');
    const std::string a = text.substr(0, colon);
    const std::string b = colon == std::string::npos ? "" : text.substr(colon + 1);
    const auto begin = a.empty() ? std::optional<uint64_t>(out.begin) : wholeNumber(a);
    const auto end = b.empty() ? std::optional<uint64_t>(out.end) : wholeNumber(b);
    if (colon == std::string::npos || !begin || !end || *begin >= *end) {
        throw obs::InputError("range '" + text +
                              "': expected A:B with A < B for the frames A to B-1, e.g. 0:100");
    }
    return {*begin, *end};
}

}  // namespace djpete::apps
