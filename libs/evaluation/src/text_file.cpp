#include "text_file.h"

#include <charconv>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <sstream>

#include "djpete/obs/errors.h"

namespace djpete::evaluation {

using geometry::Mat3;
using geometry::SE3;
using geometry::Vec3;
using obs::InputError;

namespace {

constexpr double kRotationTolerance = 1e-3;  // files with four decimals still pass
constexpr double kFarthest_m = 1e9;          // sums of squares stay far from overflow
constexpr const char* kBlanks = " \t\r\v\f";

std::string trimmed(const std::string& text) {
    const auto first = text.find_first_not_of(kBlanks);
    if (first == std::string::npos) return {};
    return text.substr(first, text.find_last_not_of(kBlanks) - first + 1);
}

template <typename T>
bool parseAll(const std::string& word, T& value) {
    // from_chars reads the same in every locale, but knows no leading plus.
    const char* begin = word.data() + (word.size() > 1 && word[0] == '+' && word[1] != '-' ? 1 : 0);
    const char* end = word.data() + word.size();
    const auto result = std::from_chars(begin, end, value);
    return result.ec == std::errc() && result.ptr == end;
}

void requireNearby(const Vec3& position, const std::string& where) {
    if (position.cwiseAbs().maxCoeff() <= kFarthest_m) return;
    throw InputError(where + ": expected a position within 1e9 m of the origin");
}

}  // namespace

std::vector<TextLine> readLines(const std::string& path) {
    if (!std::filesystem::exists(path)) throw InputError(path + ": no such file");
    if (std::filesystem::is_directory(path)) {
        throw InputError(path + ": is a folder; expected a text file");
    }
    std::ifstream in(path, std::ios::binary);
    if (!in) throw InputError(path + ": cannot be opened for reading");
    std::vector<TextLine> lines;
    std::string text;
    for (std::size_t number = 1; std::getline(in, text); ++number) {
        text = trimmed(text);
        if (text.empty()) continue;
        lines.push_back({path + ":" + std::to_string(number), number, text});
    }
    if (in.bad()) throw InputError(path + ": cannot be read to its end");
    if (lines.empty()) throw InputError(path + ": is empty; expected rows of text");
    return lines;
}

std::vector<std::string> splitAtBlanks(const std::string& text) {
    std::istringstream in(text);
    std::vector<std::string> words;
    for (std::string word; in >> word;) words.push_back(word);
    return words;
}

std::vector<std::string> splitAtCommas(const std::string& text) {
    std::vector<std::string> fields;
    std::size_t begin = 0;
    for (;;) {
        const auto comma = text.find(',', begin);
        fields.push_back(trimmed(text.substr(begin, comma - begin)));
        if (comma == std::string::npos) return fields;
        begin = comma + 1;
    }
}

double parseNumber(const std::string& word, const std::string& where, const std::string& what) {
    double value = 0;
    if (!parseAll(word, value) || !std::isfinite(value)) {
        throw InputError(where + ": expected a finite number as " + what + ", got '" + word + "'");
    }
    return value;
}

int64_t parseInteger(const std::string& word, const std::string& where, const std::string& what) {
    int64_t value = 0;
    if (!parseAll(word, value)) {
        throw InputError(where + ": expected an integer as " + what + ", got '" + word + "'");
    }
    return value;
}

std::size_t parseCount(const std::string& word, const std::string& where, const std::string& what) {
    const int64_t value = parseInteger(word, where, what);
    if (value < 0) {
        throw InputError(where + ": expected an integer of at least 0 as " + what + ", got '" +
                         word + "'");
    }
    return static_cast<std::size_t>(value);
}

SE3 parseMatrixPose(const std::vector<std::string>& words, std::size_t first,
                    const std::string& where) {
    Eigen::Matrix<double, 3, 4, Eigen::RowMajor> m;
    for (std::size_t i = 0; i < 12; ++i) {
        m.data()[i] =
            parseNumber(words.at(first + i), where, "element " + std::to_string(i + 1) + " of 12");
    }
    const Mat3 R = m.leftCols<3>();
    const double deviation = (R.transpose() * R - Mat3::Identity()).cwiseAbs().maxCoeff();
    if (!(deviation <= kRotationTolerance) || R.determinant() < 0) {
        throw InputError(where +
                         ": the left 3x3 of the matrix is not a rotation (expected R^T R = I "
                         "within 0.001 and determinant +1)");
    }
    requireNearby(m.col(3), where);
    return SE3(R, m.col(3)).normalised();
}

SE3 parseQuaternionPose(const std::vector<std::string>& words, std::size_t first,
                        const std::string& where) {
    static const char* const kNames[] = {"x", "y", "z", "qx", "qy", "qz", "qw"};
    double v[7];
    for (std::size_t i = 0; i < 7; ++i) v[i] = parseNumber(words.at(first + i), where, kNames[i]);
    Eigen::Quaterniond q(v[6], v[3], v[4], v[5]);
    if (!(std::abs(q.norm() - 1) <= kRotationTolerance)) {
        throw InputError(where + ": (qx, qy, qz, qw) is not a rotation (expected length 1 within " +
                         "0.001)");
    }
    q.normalize();
    requireNearby({v[0], v[1], v[2]}, where);
    return {q.toRotationMatrix(), Vec3(v[0], v[1], v[2])};
}

}  // namespace djpete::evaluation
