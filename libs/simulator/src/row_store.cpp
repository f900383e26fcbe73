#include "row_store.h"

#include <cstdlib>
#include <fstream>
#include <iterator>
#include <map>
#include <sstream>
#include <stdexcept>

#include "image_files.h"

namespace djpete::simulator {

namespace fs = std::filesystem;

namespace {

void removeAll(const fs::path& p) {
    std::error_code failed;
    fs::remove_all(p, failed);
    if (failed) throw std::runtime_error(p.string() + ": cannot be removed");
}

void makeFolder(const fs::path& p) {
    std::error_code failed;
    fs::create_directories(p, failed);
    if (failed) throw std::runtime_error(p.string() + ": the folder cannot be made");
}

std::string textOf(const fs::path& file) {
    std::ifstream in(file, std::ios::binary);
    if (!in) throw std::runtime_error(file.string() + ": cannot be read");
    return {std::istreambuf_iterator<char>(in), {}};
}

/// Calls f(line with its new line) for every line.
template <class F>
void forLines(const std::string& text, F&& f) {
    std::istringstream in(text);
    for (std::string line; std::getline(in, line);) f(line + "\n");
}

}  // namespace

RowStore::RowStore(const fs::path& drive) : drive_(drive), folder_(drive / "unfinished") {}

fs::path RowStore::fileOf(uint64_t frame) const {
    return folder_ / (std::to_string(frame) + ".txt");
}

void RowStore::clear() const {
    removeAll(folder_);
    for (const char* table : kTables) removeAll(drive_ / table);
    makeFolder(folder_);
}

void RowStore::reopen() const {
    std::map<uint64_t, FrameRows> frames;
    if (!fs::is_directory(folder_)) {
        for (std::size_t i = 0; i < kTables.size(); ++i) {
            if (!fs::exists(drive_ / kTables[i])) continue;
            forLines(textOf(drive_ / kTables[i]), [&](const std::string& line) {
                frames[std::strtoull(line.c_str(), nullptr, 10)].of[i] += line;
            });
        }
        makeFolder(folder_);
    }
    for (const auto& [frame, rows] : frames) put(frame, rows);
}

bool RowStore::has(uint64_t frame) const { return fs::exists(fileOf(frame)); }

void RowStore::put(uint64_t frame, const FrameRows& rows) const {
    std::string text;
    for (std::size_t i = 0; i < kTables.size(); ++i) {
        forLines(rows.of[i],
                 [&](const std::string& line) { text += std::to_string(i) + " " + line; });
    }
    writeWhole(fileOf(frame), text);
}

void RowStore::close(uint64_t begin, uint64_t end) const {
    std::array<std::string, kTables.size()> tables;
    for (uint64_t f = begin; f < end; ++f) {
        if (!has(f)) continue;
        forLines(textOf(fileOf(f)), [&](const std::string& line) {
            const auto table = static_cast<std::size_t>(line.front() - '0');
            if (table < tables.size()) tables[table] += line.substr(2);
        });
    }
    for (std::size_t i = 0; i < tables.size(); ++i) writeWhole(drive_ / kTables[i], tables[i]);
    removeAll(folder_);
}

}  // namespace djpete::simulator
