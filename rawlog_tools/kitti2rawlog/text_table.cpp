#include "text_table.h"

#include <cerrno>
#include <cmath>
#include <cstdlib>
#include <fstream>
#include <sstream>

#include "djpete/obs/errors.h"

namespace djpete::kitti2rawlog {

using obs::InputError;

namespace {

std::string trimmed(const std::string& s) {
    const char* blanks = " \t\r\n";
    const auto first = s.find_first_not_of(blanks);
    if (first == std::string::npos) return {};
    return s.substr(first, s.find_last_not_of(blanks) - first + 1);
}

std::vector<std::string> split(const std::string& line, char separator) {
    std::vector<std::string> out;
    std::istringstream in(line);
    std::string word;
    if (separator == ' ') {
        while (in >> word) out.push_back(word);
    } else {
        while (std::getline(in, word, separator)) out.push_back(trimmed(word));
        if (line.back() == separator) out.emplace_back();
    }
    return out;
}

std::vector<std::string> readLines(const std::filesystem::path& file, const std::string& what) {
    if (!std::filesystem::is_regular_file(file)) {
        throw InputError(file.string() + ": no such file; expected " + what);
    }
    std::ifstream in(file, std::ios::binary);
    std::vector<std::string> lines;
    for (std::string line; std::getline(in, line);) lines.push_back(trimmed(line));
    if (in.bad() || !in.eof()) throw InputError(file.string() + ": cannot be read as " + what);
    return lines;
}

std::vector<TextRow> toRows(const std::filesystem::path& file,
                            const std::vector<std::string>& lines, char separator) {
    std::vector<TextRow> rows;
    for (std::size_t i = 0; i < lines.size(); ++i) {
        if (lines[i].empty()) continue;
        rows.push_back({file.string() + ":" + std::to_string(i + 1), split(lines[i], separator)});
    }
    return rows;
}

}  // namespace

double TextRow::number(std::size_t i, const std::string& what) const {
    if (i >= words.size()) {
        throw InputError(where + ": only " + std::to_string(words.size()) + " columns; expected " +
                         what + " in column " + std::to_string(i + 1));
    }
    const char* text = words[i].c_str();
    char* end = nullptr;
    const double value = std::strtod(text, &end);
    if (end == text || *end != '\0' || !std::isfinite(value)) {
        throw InputError(where + ": '" + words[i] + "' in column " + std::to_string(i + 1) +
                         " is not a finite number; expected " + what);
    }
    return value;
}

int64_t TextRow::integer(std::size_t i, const std::string& what) const {
    const double value = number(i, what);
    if (value != std::floor(value) || std::abs(value) > 1e15) {
        throw InputError(where + ": '" + words[i] + "' in column " + std::to_string(i + 1) +
                         " is not a whole number; expected " + what);
    }
    return static_cast<int64_t>(value);
}

std::vector<double> TextRow::numbers(std::size_t first, std::size_t count,
                                     const std::string& what) const {
    if (words.size() != first + count) {
        throw InputError(where + ": " + std::to_string(words.size()) + " columns; expected " +
                         std::to_string(first + count) + " (" + what + ")");
    }
    std::vector<double> out;
    for (std::size_t i = first; i < words.size(); ++i) out.push_back(number(i, what));
    return out;
}

std::vector<TextRow> readRows(const std::filesystem::path& file, const std::string& what,
                              char separator) {
    return toRows(file, readLines(file, what), separator);
}

DetectedTable readTable(const std::filesystem::path& file, const std::string& what) {
    const auto lines = readLines(file, what);
    DetectedTable out;
    for (const auto& line : lines) {
        if (line.empty()) continue;
        out.commas = line.find(',') != std::string::npos;
        break;
    }
    out.rows = toRows(file, lines, out.commas ? ',' : ' ');
    return out;
}

}  // namespace djpete::kitti2rawlog
