/// Strict reading of small text files. Private to the room.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "djpete/geometry/se3.h"

namespace djpete::evaluation {

struct TextLine {
    std::string where;  ///< "file:line"
    std::size_t number = 0;
    std::string text;  ///< without line end
};

/// All lines that are not blank. Throws obs::InputError if the file cannot be read or has none.
std::vector<TextLine> readLines(const std::string& path);

std::vector<std::string> splitAtBlanks(const std::string& text);
/// Fields between commas, blanks around them removed; an empty text is one empty field.
std::vector<std::string> splitAtCommas(const std::string& text);

/// A finite number and nothing else; `what` names it in the error.
double parseNumber(const std::string& word, const std::string& where, const std::string& what);
int64_t parseInteger(const std::string& word, const std::string& where, const std::string& what);
/// An integer >= 0.
std::size_t parseCount(const std::string& word, const std::string& where, const std::string& what);

/// The pose of a row-major 3x4 [R t] of 12 words from `first` on; R is put back on SO(3).
geometry::SE3 parseMatrixPose(const std::vector<std::string>& words, std::size_t first,
                              const std::string& where);
/// The pose of `x y z qx qy qz qw`, 7 words from `first` on.
geometry::SE3 parseQuaternionPose(const std::vector<std::string>& words, std::size_t first,
                                  const std::string& where);

}  // namespace djpete::evaluation
