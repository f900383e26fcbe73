#include "djpete/texture/object_file.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <fstream>
#include <limits>

#include "djpete/obs/checked_file.h"
#include "djpete/obs/errors.h"

namespace {

using namespace djpete::texture;
using testing::HasSubstr;
namespace fs = std::filesystem;

class ObjectFile : public testing::Test {
  protected:
    void SetUp() override {
        folder_ = fs::path(testing::TempDir()) /
                  (std::string("djpete_") +
                   testing::UnitTest::GetInstance()->current_test_info()->name());
        fs::create_directories(folder_);
    }
    void TearDown() override { fs::remove_all(folder_); }

    fs::path folder_;
};

ObjectModel someModel() {
    ObjectModel model;
    model.id = {42};
    model.objectClass = djpete::obs::ObjectClass::Van;
    model.size_m = {4.5, 1.9, 2.1};
    for (int i = 0; i < 50; ++i) {
        const auto x = static_cast<float>(i);
        model.addPoint({0.01F * x, -0.02F * x, 0.5F}, {0, 0, 1}, 0.05F,
                       static_cast<uint8_t>(i % 8));
        if (i % 3 == 0) continue;
        model.colours.back().add({x, 2 * x, 3 * x}, 0.5F);
        model.colours.back().add({x + 4, 2 * x, 3 * x}, 0.25F);
        model.seenIn.back() = 3;
        model.showColour(static_cast<std::size_t>(i));
    }
    for (uint8_t i = 0; i < 50; ++i) model.albedo.push_back({i, static_cast<uint8_t>(2 * i), 9});
    model.views = {{3}, {8}};
    model.freeSpace.reset(model.size_m);
    for (int k = 0; k < 3; ++k) model.freeSpace.addRay({9, 0, 0}, {1, 0.2, 0});
    return model;
}

std::vector<char> bytesOf(const fs::path& file) {
    std::ifstream in(file, std::ios::binary);
    return {std::istreambuf_iterator<char>(in), std::istreambuf_iterator<char>()};
}

void writeBytes(const fs::path& file, const std::vector<char>& bytes) {
    std::ofstream(file, std::ios::binary)
        .write(bytes.data(), static_cast<std::streamsize>(bytes.size()));
}

std::string sentenceOf(const fs::path& file) {
    try {
        loadObject(file);
    } catch (const djpete::obs::InputError& e) {
        return e.what();
    }
    return "";
}

TEST_F(ObjectFile, LoadsBackToEqualFieldsAndEqualBytes) {
    const SavedObject saved{someModel(),
                            {{"recolour", "200,30,30", "", {}},
                             {"replace", "", "sphere 0,0,0,1", packObject(someModel())}}};
    saveObject(saved, folder_ / "a.object");
    const SavedObject loaded = loadObject(folder_ / "a.object");
    const ObjectModel &a = saved.original, &b = loaded.original;
    EXPECT_EQ(a.id, b.id);
    EXPECT_EQ(a.objectClass, b.objectClass);
    EXPECT_EQ(a.size_m, b.size_m);
    ASSERT_EQ(a.size(), b.size());
    for (std::size_t i = 0; i < a.size(); ++i) {
        EXPECT_EQ(a.point(i), b.point(i));
        EXPECT_EQ(a.normals[i], b.normals[i]);
        EXPECT_EQ(a.colours[i].count, b.colours[i].count);
        EXPECT_EQ(a.colours[i].mean, b.colours[i].mean);
        EXPECT_EQ(a.colours[i].m2, b.colours[i].m2);
    }
    EXPECT_EQ(a.radius_m, b.radius_m);
    EXPECT_EQ(a.flags, b.flags);
    EXPECT_EQ(a.seenIn, b.seenIn);
    EXPECT_EQ(a.albedo, b.albedo);
    EXPECT_EQ(a.views, b.views);
    EXPECT_EQ(a.freeSpace.passed, b.freeSpace.passed);
    EXPECT_TRUE(b.freeSpace.isFree({1.8, 0.1, 0}));
    ASSERT_EQ(loaded.edits.size(), 2U);
    EXPECT_EQ(loaded.edits[0].parameters, "200,30,30");
    EXPECT_EQ(unpackObject(loaded.edits[1].embeddedObject, "it").size(), a.size());
    saveObject(loaded, folder_ / "b.object");
    EXPECT_EQ(bytesOf(folder_ / "a.object"), bytesOf(folder_ / "b.object"));
}

TEST_F(ObjectFile, AnEmptyModelMakesTheTrip) {
    saveObject({}, folder_ / "empty.object");
    EXPECT_EQ(loadObject(folder_ / "empty.object").original.size(), 0U);
}

TEST_F(ObjectFile, EveryCutIsToldInOneSentence) {
    const fs::path file = folder_ / "a.object";
    saveObject({someModel(), {}}, file);
    const auto whole = bytesOf(file);
    for (std::size_t size = 0; size < whole.size(); size += size < 64 ? 1 : 97) {
        writeBytes(file, {whole.begin(), whole.begin() + static_cast<std::ptrdiff_t>(size)});
        EXPECT_THAT(sentenceOf(file), HasSubstr("a.object")) << size;
    }
    for (std::size_t at = 0; at < whole.size(); at += 53) {
        auto bytes = whole;
        bytes[at] = static_cast<char>(bytes[at] ^ 0x10);
        writeBytes(file, bytes);
        EXPECT_THAT(sentenceOf(file), HasSubstr("a.object")) << at;
    }
}

TEST_F(ObjectFile, OtherFilesAreTold) {
    EXPECT_THAT(sentenceOf(folder_ / "none.object"), HasSubstr("none.object"));
    EXPECT_THAT(sentenceOf(folder_), HasSubstr("expected an object file (.object)"));
    writeBytes(folder_ / "text.object", std::vector<char>(100, 'x'));
    EXPECT_THAT(sentenceOf(folder_ / "text.object"), HasSubstr("DJPETOBJ"));
    const djpete::obs::CheckedFileKind newer{
        {'D', 'J', 'P', 'E', 'T', 'O', 'B', 'J'}, kObjectFileVersion + 1, "object file", ".object"};
    djpete::obs::writeChecked(newer, packObject(someModel()), folder_ / "newer.object");
    EXPECT_THAT(sentenceOf(folder_ / "newer.object"), HasSubstr("a newer program wrote it"));
}

/// Wrong content under a right checksum, as a faulty program would write it.
TEST_F(ObjectFile, ContentThatDoesNotFitIsTold) {
    const fs::path file = folder_ / "a.object";
    auto model = someModel();
    model.normals.pop_back();
    saveObject({model, {}}, file);
    EXPECT_THAT(sentenceOf(file), HasSubstr("not as long as its cloud"));
    model = someModel();
    model.normals[7][1] = std::numeric_limits<float>::quiet_NaN();
    saveObject({model, {}}, file);
    EXPECT_THAT(sentenceOf(file), HasSubstr("point 7"));
    model = someModel();
    model.freeSpace.cells[0] = 3;
    saveObject({model, {}}, file);
    EXPECT_THAT(sentenceOf(file), HasSubstr("free space"));
    const djpete::obs::CheckedFileKind kind{
        {'D', 'J', 'P', 'E', 'T', 'O', 'B', 'J'}, kObjectFileVersion, "object file", ".object"};
    const auto whole = packObject(someModel());
    for (std::size_t size = 0; size < whole.size(); size += 499) {
        djpete::obs::writeChecked(
            kind, {whole.begin(), whole.begin() + static_cast<std::ptrdiff_t>(size)}, file);
        EXPECT_THAT(sentenceOf(file), HasSubstr("a.object")) << size;
    }
    for (std::size_t at = 0; at < whole.size(); at += 307) {  // told or read, but never a crash
        auto bytes = whole;
        bytes[at] = 0xFF;
        djpete::obs::writeChecked(kind, bytes, file);
        const std::string sentence = sentenceOf(file);
        EXPECT_TRUE(sentence.empty() || sentence.find("a.object") != std::string::npos);
    }
}

TEST_F(ObjectFile, AFileThatCannotBeWrittenIsTold) {
    try {
        saveObject({someModel(), {}}, folder_ / "no" / "such" / "a.object");
        FAIL();
    } catch (const djpete::obs::InputError& e) {
        EXPECT_THAT(e.what(), HasSubstr("a.object"));
    }
    EXPECT_EQ(objectFileName({7}), "0007.object");
}

}  // namespace
