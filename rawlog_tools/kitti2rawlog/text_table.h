/// Text files of numbers and words, read with the place of every mistake.
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

namespace djpete::kitti2rawlog {

/// One line that is not blank, split into words.
struct TextRow {
    std::string where;  ///< "file:line", for messages
    std::vector<std::string> words;

    /// Word i as a finite number. Throws InputError naming the place and `what`.
    double number(std::size_t i, const std::string& what) const;
    /// Word i as a whole number of either sign. Throws likewise.
    int64_t integer(std::size_t i, const std::string& what) const;
    /// `count` finite numbers from word `first` on. Throws if there are not exactly that many.
    std::vector<double> numbers(std::size_t first, std::size_t count,
                                const std::string& what) const;
};

/// All rows of `file`, split at blanks, or at commas if `separator` is ','.
/// Throws InputError if the file is missing or cannot be read; `what` names its purpose.
std::vector<TextRow> readRows(const std::filesystem::path& file, const std::string& what,
                              char separator = ' ');

/// Like readRows, but splits at commas exactly if the first row has one; says so in `commas`.
struct DetectedTable {
    std::vector<TextRow> rows;
    bool commas = false;
};
DetectedTable readTable(const std::filesystem::path& file, const std::string& what);

}  // namespace djpete::kitti2rawlog
