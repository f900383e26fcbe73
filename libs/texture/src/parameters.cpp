#include "parameters.h"

#include <cmath>
#include <cstdlib>

#include "djpete/obs/errors.h"

namespace djpete::texture {

void throwExpected(const std::string& what, const std::string& expected, const std::string& text) {
    throw obs::InputError(what + ": expected " + expected + ", got '" + text + "'");
}

std::string trimmed(const std::string& text) {
    const auto from = text.find_first_not_of(" \t\r\n");
    if (from == std::string::npos) return "";
    return text.substr(from, text.find_last_not_of(" \t\r\n") - from + 1);
}

std::vector<std::string> pieces(const std::string& text, char separator) {
    std::vector<std::string> out;
    std::size_t from = 0;
    for (;;) {
        const std::size_t to = text.find(separator, from);
        out.push_back(trimmed(text.substr(from, to == std::string::npos ? to : to - from)));
        if (to == std::string::npos) return out;
        from = to + 1;
    }
}

double numberOf(const std::string& text, const std::string& what, const std::string& expected) {
    const std::string word = trimmed(text);
    char* end = nullptr;
    const double value = std::strtod(word.c_str(), &end);
    const bool whole = !word.empty() && end == word.c_str() + word.size();
    if (!whole || !std::isfinite(value)) throwExpected(what, expected, text);
    return value;
}

std::vector<double> numbersOf(const std::string& text, std::size_t count, const std::string& what,
                              const std::string& expected) {
    const auto words = pieces(text, ',');
    if (words.size() != count) throwExpected(what, expected, text);
    std::vector<double> out;
    for (const auto& word : words) {
        if (word.empty()) throwExpected(what, expected, text);
        out.push_back(numberOf(word, what, expected));
    }
    return out;
}

std::array<float, 3> colourOf(const std::string& text, const std::string& what) {
    const std::string expected = "a colour R,G,B of three numbers 0..255";
    const auto values = numbersOf(text, 3, what, expected);
    std::array<float, 3> out{};
    for (std::size_t c = 0; c < 3; ++c) {
        if (values[c] < 0 || values[c] > 255) throwExpected(what, expected, text);
        out[c] = static_cast<float>(values[c]);
    }
    return out;
}

}  // namespace djpete::texture
