/// Rules on the text of the project.
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <sstream>
#include <string>
#include <vector>

namespace {

namespace fs = std::filesystem;

const fs::path kSource = DJPETE_SOURCE_DIR;

std::string textOf(const fs::path& file) {
    std::ifstream in(file);
    std::stringstream out;
    out << in.rdbuf();
    return out.str();
}

std::vector<fs::path> filesUnder(const std::vector<std::string>& folders,
                                 const std::vector<std::string>& extensions) {
    std::vector<fs::path> out;
    for (const auto& folder : folders) {
        if (!fs::exists(kSource / folder)) continue;
        for (const auto& entry : fs::recursive_directory_iterator(kSource / folder)) {
            const auto ext = entry.path().extension().string();
            for (const auto& e : extensions) {
                if (ext == e) out.push_back(entry.path());
            }
        }
    }
    return out;
}

const std::vector<std::string> kCode{"libs", "apps", "rawlog_tools", "tests"};

TEST(Text, NoMachineSpecificFlags) {
    auto files = filesUnder({"libs", "apps", "rawlog_tools", "tests", "cmake"}, {".txt", ".cmake"});
    files.push_back(kSource / "CMakeLists.txt");
    for (const auto& file : files) {
        EXPECT_EQ(textOf(file).find("march=native"), std::string::npos) << file;
        EXPECT_EQ(textOf(file).find("ffast-math"), std::string::npos) << file;
    }
}

TEST(Text, LibrariesDoNotPrintOrExit) {
    for (const auto& file : filesUnder({"libs"}, {".h", ".cpp"})) {
        const auto text = textOf(file);
        for (const char* word : {"std::cout", "std::cerr", "printf(", "exit(", "abort("}) {
            if (std::string(word) == "printf(" && text.find("snprintf(") != std::string::npos)
                continue;
            EXPECT_EQ(text.find(word), std::string::npos) << file << " uses " << word;
        }
    }
}

TEST(Text, RandomNumbersAreSeeded) {
    for (const auto& file : filesUnder(kCode, {".h", ".cpp"})) {
        if (file.filename() == "text_test.cpp") continue;
        EXPECT_EQ(textOf(file).find("random_device"), std::string::npos) << file;
    }
}

TEST(Text, NoFileIsARoomWhereStrangersLive) {
    for (const auto& file : filesUnder({"libs", "apps", "rawlog_tools"}, {".h", ".cpp"})) {
        const auto text = textOf(file);
        EXPECT_LE(std::count(text.begin(), text.end(), '\n'), 600) << file;
    }
}

TEST(Text, MainsAreShort) {
    for (const auto& file : filesUnder({"apps", "rawlog_tools"}, {".cpp"})) {
        if (file.filename() != "main.cpp") continue;
        const auto text = textOf(file);
        EXPECT_LE(std::count(text.begin(), text.end(), '\n'), 40) << file;
    }
}

}  // namespace
