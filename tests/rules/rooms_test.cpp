/// Includes follow the room table of CONVENTIONS.md.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <map>
#include <regex>
#include <set>
#include <sstream>
#include <string>
#include <vector>

namespace {

namespace fs = std::filesystem;

const fs::path kSource = DJPETE_SOURCE_DIR;

std::vector<std::string> linesOf(const fs::path& file) {
    std::ifstream in(file);
    std::vector<std::string> out;
    for (std::string line; std::getline(in, line);) out.push_back(line);
    return out;
}

std::vector<std::string> cells(const std::string& row) {
    std::vector<std::string> out;
    std::stringstream in(row);
    for (std::string cell; std::getline(in, cell, '|');) {
        const auto from = cell.find_first_not_of(' ');
        const auto to = cell.find_last_not_of(' ');
        out.push_back(from == std::string::npos ? "" : cell.substr(from, to - from + 1));
    }
    return out;
}

struct Room {
    std::set<std::string> allowed;  ///< itself and everything it rests on, directly or not
    bool openCvPrivate = false, pclPrivate = false;
};

/// The table under "## Rooms", in order.
std::map<std::string, Room> roomTable() {
    std::map<std::string, Room> rooms;
    bool inside = false;
    for (const auto& line : linesOf(kSource / "CONVENTIONS.md")) {
        if (line.rfind("## ", 0) == 0) inside = line == "## Rooms";
        if (!inside || line.rfind("| ", 0) != 0) continue;
        const auto c = cells(line);
        if (c.size() < 4 || c[1] == "library") continue;
        Room room;
        room.allowed.insert(c[1]);
        std::stringstream words(std::regex_replace(c[3], std::regex("[,;()]"), " "));
        for (std::string w; words >> w;) {
            if (rooms.count(w))
                room.allowed.insert(rooms[w].allowed.begin(), rooms[w].allowed.end());
        }
        if (c[3].find("all above") != std::string::npos) {
            for (const auto& [name, r] : rooms) room.allowed.insert(name);
        }
        room.openCvPrivate = c[3].find("OpenCV") != std::string::npos;
        room.pclPrivate = c[3].find("PCL") != std::string::npos;
        rooms[c[1]] = room;
    }
    return rooms;
}

std::vector<fs::path> sourcesUnder(const fs::path& folder) {
    std::vector<fs::path> out;
    if (!fs::exists(folder)) return out;
    for (const auto& entry : fs::recursive_directory_iterator(folder)) {
        const auto ext = entry.path().extension();
        if (ext == ".h" || ext == ".cpp") out.push_back(entry.path());
    }
    std::sort(out.begin(), out.end());
    return out;
}

TEST(Rooms, TableNamesEveryLibraryFolder) {
    const auto rooms = roomTable();
    ASSERT_GE(rooms.size(), 10U);
    for (const auto& entry : fs::directory_iterator(kSource / "libs")) {
        EXPECT_EQ(rooms.count(entry.path().filename().string()), 1U) << entry.path();
    }
}

TEST(Rooms, IncludesFollowTheTable) {
    const std::regex include(R"(#include\s+[<"]djpete/(\w+)/)");
    std::size_t checked = 0;
    for (const auto& [name, room] : roomTable()) {
        for (const auto& file : sourcesUnder(kSource / "libs" / name)) {
            for (const auto& line : linesOf(file)) {
                std::smatch m;
                if (!std::regex_search(line, m, include)) continue;
                ++checked;
                EXPECT_EQ(room.allowed.count(m[1]), 1U) << file << ": " << line;
            }
        }
    }
    EXPECT_GT(checked, 50U);
}

TEST(Rooms, PrivateLibrariesStayOutOfPublicHeaders) {
    for (const auto& [name, room] : roomTable()) {
        for (const auto& file : sourcesUnder(kSource / "libs" / name / "include")) {
            for (const auto& line : linesOf(file)) {
                EXPECT_THAT(line, testing::Not(testing::HasSubstr("#include <opencv2/"))) << file;
                EXPECT_THAT(line, testing::Not(testing::HasSubstr("#include <pcl/"))) << file;
                EXPECT_THAT(line, testing::Not(testing::HasSubstr("#include <embree"))) << file;
                EXPECT_THAT(line, testing::Not(testing::HasSubstr("#include <octomap/"))) << file;
            }
        }
    }
}

TEST(Rooms, ARoomMayNotUseOneBelowIt) {
    // The check itself can fail: geometry is the bottom, pipeline stands on everything.
    const auto rooms = roomTable();
    EXPECT_EQ(rooms.at("geometry").allowed.size(), 1U);
    EXPECT_EQ(rooms.at("simulator").allowed, (std::set<std::string>{"geometry", "simulator"}));
    EXPECT_EQ(rooms.at("map").allowed.count("backend"), 0U);
    EXPECT_EQ(rooms.at("frontend").allowed.count("observers"), 0U);
    EXPECT_EQ(rooms.at("pipeline").allowed.count("backend"), 1U);
}

}  // namespace
