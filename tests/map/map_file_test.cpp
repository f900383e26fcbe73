#include "djpete/map/map_file.h"

#include <gmock/gmock.h>
#include <sys/resource.h>
#include <unistd.h>

#include <csignal>
#include <fstream>
#include <iterator>

#include "djpete/obs/errors.h"
#include "djpete_test/shared_data.h"
#include "map_file_world.h"

namespace djpete::map {
namespace {

namespace fs = std::filesystem;
using testing::HasSubstr;

std::string bytesOf(const fs::path& file) {
    std::ifstream in(file, std::ios::binary);
    return {std::istreambuf_iterator<char>(in), std::istreambuf_iterator<char>()};
}

void writeBytes(const fs::path& file, const std::string& bytes) {
    std::ofstream(file, std::ios::binary).write(bytes.data(), std::streamsize(bytes.size()));
}

/// The sentence of the InputError; fails the test if there is none.
template <class Action>
std::string sentenceOf(Action action) {
    try {
        action();
    } catch (const obs::InputError& e) {
        return e.what();
    }
    ADD_FAILURE() << "expected an InputError";
    return {};
}

/// The last 8 bytes made right for what is before them.
std::string withChecksum(std::string bytes) {
    uint64_t crc = ~uint64_t{0};
    for (std::size_t i = 0; i + 8 < bytes.size(); ++i) {
        crc ^= uint8_t(bytes[i]);
        for (int bit = 0; bit < 8; ++bit) {
            crc = (crc & 1) != 0 ? (crc >> 1) ^ 0xC96C5795D7870F42ULL : crc >> 1;
        }
    }
    for (unsigned i = 0; i < 8; ++i) bytes[bytes.size() - 8 + i] = char((~crc >> (8 * i)) & 0xFF);
    return bytes;
}

TEST(MapFile, aMapComesBackAsItWas) {
    const auto file = djpete_test::scratch("map_file_whole") / "m.djmap";
    const SlamMap map = MadeUpMap({}).map();
    saveMap(map, file, someInfo());
    EXPECT_FALSE(fs::exists(file.string() + ".part"));
    LoadedMap back = loadMap(file);
    back.map.check();
    EXPECT_EQ(back.map.revision(), map.revision());
    EXPECT_EQ(back.info.drive, "drive 00");
    EXPECT_EQ(back.info.sessions, someInfo().sessions);
    EXPECT_EQ(back.info.toolVersion, "1.2.3");
    EXPECT_EQ(back.info.textures, someInfo().textures);
    ASSERT_EQ(back.map.keyframes().size(), map.keyframes().size());
    for (const auto& [id, kf] : map.keyframes()) {
        const auto& b = back.map.keyframes().at(id);
        EXPECT_EQ(b.frame, kf.frame);
        EXPECT_EQ(b.stamp, kf.stamp);
        EXPECT_EQ(b.camera.baseline_m, kf.camera.baseline_m);
        EXPECT_EQ(b.camera.height_px, kf.camera.height_px);
        EXPECT_EQ(b.T_vehicle_cam.matrix(), kf.T_vehicle_cam.matrix());
        EXPECT_EQ(b.T_odom_cam.matrix(), kf.T_odom_cam.matrix());
        EXPECT_EQ(b.segment, kf.segment);
        EXPECT_EQ(b.world, kf.world);
        EXPECT_EQ(b.T_world_cam.matrix(), kf.T_world_cam.matrix());
        EXPECT_EQ(b.landmarks, kf.landmarks);
        ASSERT_EQ(b.scanMotion.has_value(), kf.scanMotion.has_value());
        if (kf.scanMotion) {
            EXPECT_EQ(b.scanMotion->from, kf.scanMotion->from);
            EXPECT_EQ(b.scanMotion->T_from_cam.matrix(), kf.scanMotion->T_from_cam.matrix());
            EXPECT_EQ(b.scanMotion->information, kf.scanMotion->information);
        }
        ASSERT_EQ(b.features.size(), kf.features.size());
        for (std::size_t i = 0; i < kf.features.size(); ++i) {
            EXPECT_EQ(b.features[i].track, kf.features[i].track);
            EXPECT_EQ(b.features[i].u_px, kf.features[i].u_px);
            EXPECT_EQ(b.features[i].sigma_px, kf.features[i].sigma_px);
            EXPECT_EQ(b.features[i].uRight_px, kf.features[i].uRight_px);
            EXPECT_EQ(b.features[i].depth_m, kf.features[i].depth_m);
            EXPECT_EQ(b.features[i].depthSigma_m, kf.features[i].depthSigma_m);
            EXPECT_EQ(b.features[i].rgb, kf.features[i].rgb);
            EXPECT_EQ(b.features[i].descriptor, kf.features[i].descriptor);
        }
    }
    ASSERT_EQ(back.map.frames().size(), map.frames().size());
    for (const auto& [id, pose] : map.frames()) {
        EXPECT_EQ(back.map.cameraAt(id)->matrix(), map.cameraAt(id)->matrix());
        EXPECT_EQ(back.map.frames().at(id).tracked, pose.tracked);
        EXPECT_EQ(back.map.frames().at(id).stamp, pose.stamp);
    }
    ASSERT_EQ(back.map.landmarks().size(), map.landmarks().size());
    for (const auto& [id, landmark] : map.landmarks()) {
        EXPECT_EQ(back.map.landmarks().at(id).p_world, landmark.p_world);
        EXPECT_EQ(back.map.landmarks().at(id).rgb, landmark.rgb);
        EXPECT_EQ(back.map.landmarks().at(id).observations, landmark.observations);
    }
}

TEST(MapFile, objectsComeBackAsTheyWere) {
    const auto file = djpete_test::scratch("map_file_objects") / "m.djmap";
    const SlamMap map = MadeUpMap({}).map();
    saveMap(map, file, someInfo());
    const SlamMap back = loadMap(file).map;
    ASSERT_EQ(back.objects().size(), map.objects().size());
    for (const auto& [id, track] : map.objects()) {
        const auto& b = back.objects().at(id);
        EXPECT_EQ(b.objectClass, track.objectClass);
        EXPECT_EQ(b.size_m, track.size_m);
        EXPECT_EQ(b.moving, track.moving);
        ASSERT_EQ(b.observations.size(), track.observations.size());
        for (const auto& [frame, o] : track.observations) {
            const auto& bo = b.observations.at(frame);
            EXPECT_EQ(bo.T_cam_obj.matrix(), o.T_cam_obj.matrix());
            EXPECT_EQ(bo.information, o.information);
            EXPECT_EQ(bo.size_m, o.size_m);
            EXPECT_EQ(bo.score, o.score);
            EXPECT_EQ(bo.objectClass, o.objectClass);
            EXPECT_EQ(bo.source, o.source);
            ASSERT_EQ(bo.box.has_value(), o.box.has_value());
            if (o.box) {
                EXPECT_EQ(bo.box->bottom, o.box->bottom);
            }
            ASSERT_EQ(bo.mask.has_value(), o.mask.has_value());
            if (o.mask) {
                EXPECT_EQ(bo.mask->runs, o.mask->runs);
            }
        }
        ASSERT_EQ(b.states.size(), track.states.size());
        for (const auto& [frame, s] : track.states) {
            EXPECT_EQ(b.states.at(frame).anchor, s.anchor);
            EXPECT_EQ(b.states.at(frame).T_anchor_obj.matrix(), s.T_anchor_obj.matrix());
            EXPECT_EQ(b.states.at(frame).twist, s.twist);
            EXPECT_EQ(b.states.at(frame).covariance, s.covariance);
        }
    }
}

TEST(MapFile, idsGoOnWhereTheyWere) {
    const auto file = djpete_test::scratch("map_file_ids") / "m.djmap";
    SlamMap map = MadeUpMap({}).map();  // its last landmark and its first object are gone
    saveMap(map, file, {});
    SlamMap back = loadMap(file).map;
    EXPECT_EQ(back.addLandmark({0, 0, 0}, {}), map.addLandmark({0, 0, 0}, {}));
    EXPECT_EQ(back.addObject({}), map.addObject({}));
    Keyframe kf;
    kf.frame = {100000};
    EXPECT_EQ(back.addKeyframe(kf, true), map.addKeyframe(kf, true));
}

TEST(MapFile, equalMapsGiveEqualBytes) {
    const auto dir = djpete_test::scratch("map_file_bytes");
    const SlamMap map = MadeUpMap({}).map();
    saveMap(map, dir / "a", someInfo());
    saveMap(map, dir / "b", someInfo());
    const auto back = loadMap(dir / "a");
    saveMap(back.map, dir / "c", back.info);
    EXPECT_EQ(bytesOf(dir / "a"), bytesOf(dir / "b"));
    EXPECT_EQ(bytesOf(dir / "a"), bytesOf(dir / "c"));
    saveMap(SlamMap(), dir / "empty", {});
    EXPECT_TRUE(loadMap(dir / "empty").map.keyframes().empty());
}

TEST(MapFile, aFileCutAnywhereIsRefusedInOneSentence) {
    const auto file = djpete_test::scratch("map_file_cut") / "m.djmap";
    saveMap(MadeUpMap({2, 1, 3, 4, 1, 2}).map(), file, {});
    const std::string whole = bytesOf(file);
    for (std::size_t size = 0; size < whole.size(); size += size < 40 ? 1 : 17) {
        writeBytes(file, whole.substr(0, size));
        const auto sentence = sentenceOf([&] { loadMap(file); });
        EXPECT_THAT(sentence, HasSubstr(file.string())) << size;
        EXPECT_EQ(sentence.find('\n'), std::string::npos);
    }
    writeBytes(file, whole + "x");
    EXPECT_THAT(sentenceOf([&] { loadMap(file); }), HasSubstr("damaged"));
}

TEST(MapFile, everyFlippedBitIsSeen) {
    const auto file = djpete_test::scratch("map_file_flip") / "m.djmap";
    saveMap(MadeUpMap({}).map(), file, someInfo());
    const std::string whole = bytesOf(file);
    std::mt19937_64 rng(1);
    for (unsigned n = 0; n < 500; ++n) {
        // First the head and the checksum, then anywhere.
        const std::size_t at = n < 20   ? n
                               : n < 28 ? whole.size() - 1 - (n - 20)
                                        : std::size_t(rng() % whole.size());
        std::string bytes = whole;
        bytes[at] = char(bytes[at] ^ char(1U << (rng() % 8)));
        writeBytes(file, bytes);
        EXPECT_THAT(sentenceOf([&] { loadMap(file); }), HasSubstr(file.string())) << at;
    }
}

/// Wrong content under a right checksum, as a faulty program would write it: refused or read, but
/// never a crash, and what is read is a sound map.
TEST(MapFile, wrongContentNeverCrashes) {
    const auto file = djpete_test::scratch("map_file_wrong") / "m.djmap";
    saveMap(MadeUpMap({3, 1, 6, 10, 2, 3}).map(), file, someInfo());
    const std::string whole = bytesOf(file);
    std::mt19937_64 rng(2);
    unsigned refused = 0;
    for (unsigned n = 0; n < 600; ++n) {
        std::string bytes = whole;
        const std::size_t at = 20 + std::size_t(rng() % (whole.size() - 28));
        bytes[at] = char(rng());
        writeBytes(file, withChecksum(bytes));
        try {
            loadMap(file).map.check();
        } catch (const obs::InputError& e) {
            ++refused;
            EXPECT_THAT(e.what(), HasSubstr(file.string()));
        }
    }
    EXPECT_GT(refused, 10U);
    EXPECT_LT(refused, 600U);
}

TEST(MapFile, aNewerLayoutIsToldFromDamage) {
    const auto file = djpete_test::scratch("map_file_newer") / "m.djmap";
    saveMap(MadeUpMap({}).map(), file, {});
    std::string bytes = bytesOf(file);
    bytes[8] = char(kMapFileVersion + 1);
    writeBytes(file, withChecksum(bytes));
    EXPECT_THAT(sentenceOf([&] { loadMap(file); }), HasSubstr("newer program"));
    bytes[8] = char(kMapFileVersion);
    writeBytes(file, withChecksum(bytes));
    loadMap(file).map.check();  // the test's checksum is the file's
}

TEST(MapFile, whatIsNoMapIsToldApart) {
    const auto dir = djpete_test::scratch("map_file_other");
    EXPECT_THAT(sentenceOf([&] { loadMap(dir / "none.djmap"); }), HasSubstr("none.djmap"));
    EXPECT_THAT(sentenceOf([&] { loadMap(dir); }), HasSubstr("not a file"));
    writeBytes(dir / "picture.djmap", std::string(5000, 'P'));
    EXPECT_THAT(sentenceOf([&] { loadMap(dir / "picture.djmap"); }), HasSubstr("not a map file"));
}

TEST(MapFile, texturesStayBesideTheMap) {
    const auto file = djpete_test::scratch("map_file_textures") / "m.djmap";
    const SlamMap map = MadeUpMap({}).map();
    for (const char* name : {"/etc/passwd", "../car.ply", "a/../../b", ""}) {
        EXPECT_THAT(sentenceOf([&] {
                        saveMap(map, file, {"", {}, "", {{ObjectId{1}, name}}});
                    }),
                    HasSubstr("beside or below"));
    }
    EXPECT_THAT(sentenceOf([&] {
                    saveMap(map, file, {"", {}, "", {{ObjectId{99}, "a.ply"}}});
                }),
                HasSubstr("object 99"));
    EXPECT_FALSE(fs::exists(file));
}

TEST(MapFile, whereNothingCanBeWrittenTheOldFileStays) {
    const auto dir = djpete_test::scratch("map_file_refused");
    const SlamMap map = MadeUpMap({}).map();
    EXPECT_THAT(sentenceOf([&] { saveMap(map, dir / "no" / "m.djmap", {}); }),
                HasSubstr("cannot write the map file"));
    EXPECT_THAT(sentenceOf([&] { saveMap(map, dir, {}); }), HasSubstr("is a folder"));
    saveMap(map, dir / "m.djmap", {});
    const std::string old = bytesOf(dir / "m.djmap");
    fs::create_directory(dir / "m.djmap.part");  // stands in the way
    EXPECT_THAT(sentenceOf([&] { saveMap(map, dir / "m.djmap", someInfo()); }),
                HasSubstr("m.djmap"));
    EXPECT_EQ(bytesOf(dir / "m.djmap"), old);
}

/// A limit on the size of files fails in the middle of writing, as a full disk does.
TEST(MapFile, aFullDiskLeavesTheOldFile) {
    const auto file = djpete_test::scratch("map_file_full") / "m.djmap";
    const SlamMap map = MadeUpMap({}).map();
    saveMap(map, file, {});
    const std::string old = bytesOf(file);
    rlimit before{};
    ASSERT_EQ(getrlimit(RLIMIT_FSIZE, &before), 0);
    const auto handler = std::signal(SIGXFSZ, SIG_IGN);
    const rlimit small{old.size() / 2, before.rlim_max};
    ASSERT_EQ(setrlimit(RLIMIT_FSIZE, &small), 0);
    std::string sentence;
    try {
        saveMap(map, file, someInfo());
    } catch (const obs::InputError& e) {
        sentence = e.what();
    }
    ASSERT_EQ(setrlimit(RLIMIT_FSIZE, &before), 0);
    std::signal(SIGXFSZ, handler);
    EXPECT_THAT(sentence, HasSubstr("cannot write the map file " + file.string()));
    EXPECT_EQ(bytesOf(file), old);
    EXPECT_FALSE(fs::exists(file.string() + ".part"));
}

}  // namespace
}  // namespace djpete::map
