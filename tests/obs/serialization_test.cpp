#include <gmock/gmock.h>
#include <mrpt/io/CMemoryStream.h>
#include <mrpt/opengl/CSetOfObjects.h>

#include "djpete/obs/CObservationVisualKeyframe.h"
#include "obs_samples.h"

using djpete::obs::CObservationDetectedObjects;
using djpete::obs::CObservationVisualKeyframe;
using djpete::obs::ObjectDetection;

namespace {

std::string bytesOf(const mrpt::serialization::CSerializable& o) {
    mrpt::io::CMemoryStream stream;
    mrpt::serialization::archiveFrom(stream) << o;
    return {static_cast<const char*>(stream.getRawBufferData()),
            static_cast<std::size_t>(stream.getTotalBytesCount())};
}

mrpt::serialization::CSerializable::Ptr fromBytes(const std::string& bytes) {
    djpete::obs::registerObservationClasses();
    mrpt::io::CMemoryStream stream;
    stream.assignMemoryNotOwn(bytes.data(), bytes.size());
    return mrpt::serialization::archiveFrom(stream).ReadObject();
}

void expectSame(const ObjectDetection& a, const ObjectDetection& b) {
    EXPECT_EQ(a.objectClass, b.objectClass);
    EXPECT_EQ(a.score, b.score);
    EXPECT_EQ(a.size_m, b.size_m);
    EXPECT_EQ(a.T_sensor_obj.matrix(), b.T_sensor_obj.matrix());
    EXPECT_EQ(a.information, b.information);
    ASSERT_EQ(a.box.has_value(), b.box.has_value());
    if (a.box) {
        EXPECT_EQ(a.box->left, b.box->left);
        EXPECT_EQ(a.box->top, b.box->top);
        EXPECT_EQ(a.box->right, b.box->right);
        EXPECT_EQ(a.box->bottom, b.box->bottom);
    }
    ASSERT_EQ(a.mask.has_value(), b.mask.has_value());
    if (a.mask) {
        EXPECT_EQ(a.mask->width_px, b.mask->width_px);
        EXPECT_EQ(a.mask->height_px, b.mask->height_px);
        EXPECT_EQ(a.mask->runs, b.mask->runs);
    }
    EXPECT_EQ(a.source, b.source);
    EXPECT_EQ(a.sourceTrackId, b.sourceTrackId);
    ASSERT_EQ(a.points != nullptr, b.points != nullptr);
    if (a.points) {
        EXPECT_EQ(a.points->body, b.points->body);
        EXPECT_EQ(a.points->ground, b.points->ground);
        EXPECT_EQ(a.points->origin, b.points->origin);
    }
}

CObservationVisualKeyframe sampleKeyframe() {
    CObservationVisualKeyframe k;
    k.sensorLabel = djpete::obs::label::kKeyframes;
    k.timestamp = obs_samples::stampOf(3);
    k.frame.value = 1234567890123ULL;
    k.isKeyframe = true;
    k.tracked = false;
    k.camera = {700.5, 701.5, 320.25, 240.125, 0.54, 640, 480};
    k.T_odom_cam = obs_samples::somePose();
    k.sensorPose = mrpt::poses::CPose3D(1, 2, 3, 0.1, 0.2, 0.3);
    djpete::obs::KeyframeFeature plain;
    plain.track.value = 5;
    plain.u_px = 100.5F;
    djpete::obs::KeyframeFeature full = plain;
    full.uRight_px = 90.5F;
    full.depth_m = 12.5F;
    full.depthSigma_m = 0.25F;
    full.rgb = {1, 2, 3};
    full.descriptor = djpete::obs::Descriptor{1, 2, 3, ~uint64_t{0}};
    k.features = {plain, full};
    return k;
}

/// Where an MRPT object keeps its version: after the length of its class name and the name.
std::size_t versionAt(const std::string& bytes) {
    return 1 + (static_cast<unsigned char>(bytes[0]) & 0x7FU);
}

}  // namespace

TEST(DetectedObjects, SurviveTheRoundTripWithAndWithoutOptionals) {
    const auto a = obs_samples::detectedObjects(4);
    const auto b = std::dynamic_pointer_cast<CObservationDetectedObjects>(fromBytes(bytesOf(*a)));
    ASSERT_TRUE(b);
    EXPECT_EQ(a->sensorLabel, b->sensorLabel);
    EXPECT_EQ(a->timestamp, b->timestamp);
    EXPECT_LT((djpete::geometry::fromCPose3D(a->sensorPose).inverse() *
               djpete::geometry::fromCPose3D(b->sensorPose))
                  .log()
                  .norm(),
              1e-12);
    ASSERT_EQ(b->detections.size(), 2U);
    for (std::size_t i = 0; i < 2; ++i) expectSame(a->detections[i], b->detections[i]);
}

TEST(DetectedObjects, OlderBytesHaveNoPoints) {
    auto a = obs_samples::detectedObjects(4);
    a->detections.erase(a->detections.begin());  // the other one has nothing optional
    std::string old = bytesOf(*a);
    // Version 0 ended before the flag; after it comes MRPT's end mark of one byte.
    old[versionAt(old)] = 0;
    old.erase(old.size() - 2, 1);
    const auto b = std::dynamic_pointer_cast<CObservationDetectedObjects>(fromBytes(old));
    ASSERT_TRUE(b);
    ASSERT_EQ(b->detections.size(), 1U);
    expectSame(a->detections[0], b->detections[0]);
}

TEST(VisualKeyframe, SurvivesTheRoundTrip) {
    const auto a = sampleKeyframe();
    const auto b = std::dynamic_pointer_cast<CObservationVisualKeyframe>(fromBytes(bytesOf(a)));
    ASSERT_TRUE(b);
    EXPECT_EQ(a.frame, b->frame);
    EXPECT_EQ(a.isKeyframe, b->isKeyframe);
    EXPECT_EQ(a.tracked, b->tracked);
    EXPECT_EQ(a.camera.fx, b->camera.fx);
    EXPECT_EQ(a.camera.baseline_m, b->camera.baseline_m);
    EXPECT_EQ(a.camera.height_px, b->camera.height_px);
    EXPECT_EQ(a.T_odom_cam.matrix(), b->T_odom_cam.matrix());
    ASSERT_EQ(b->features.size(), 2U);
    EXPECT_FALSE(b->features[0].uRight_px || b->features[0].depth_m);
    EXPECT_EQ(b->features[1].uRight_px, 90.5F);
    EXPECT_EQ(b->features[1].depth_m, 12.5F);
    EXPECT_EQ(b->features[1].depthSigma_m, 0.25F);
    EXPECT_EQ(b->features[1].rgb, a.features[1].rgb);
    EXPECT_EQ(b->features[0].descriptor, a.features[0].descriptor);
    EXPECT_EQ(b->features[1].descriptor, a.features[1].descriptor);
    EXPECT_EQ(b->features[1].track, a.features[1].track);
}

TEST(VisualKeyframe, AScansMotionSurvivesAndOlderBytesHaveNone) {
    auto a = sampleKeyframe();
    const std::string without = bytesOf(a);
    a.scanMotion =
        djpete::obs::ScanMotion{{77}, obs_samples::somePose(), djpete::geometry::Mat6::Random()};
    const auto b = std::dynamic_pointer_cast<CObservationVisualKeyframe>(fromBytes(bytesOf(a)));
    ASSERT_TRUE(b && b->scanMotion);
    EXPECT_EQ(b->scanMotion->from.value, 77U);
    EXPECT_EQ(b->scanMotion->T_from_cam.matrix(), a.scanMotion->T_from_cam.matrix());
    EXPECT_EQ(b->scanMotion->information, a.scanMotion->information);
    // Version 1 ended before the flag; after it comes MRPT's end mark of one byte.
    std::string old = without;
    old[versionAt(old)] = 1;
    old.erase(old.size() - 2, 1);
    const auto c = std::dynamic_pointer_cast<CObservationVisualKeyframe>(fromBytes(old));
    ASSERT_TRUE(c);
    EXPECT_FALSE(c->scanMotion);
    EXPECT_EQ(c->features.size(), 2U);
}

TEST(Serialization, ALaterVersionIsRefused) {
    for (std::string bytes :
         {bytesOf(*obs_samples::detectedObjects(0)), bytesOf(sampleKeyframe())}) {
        EXPECT_NO_THROW(fromBytes(bytes));
        const char newest = bytes[versionAt(bytes)];
        ASSERT_EQ(newest, bytes.find("VisualKeyframe") < versionAt(bytes) ? 2 : 1);
        bytes[versionAt(bytes)] = static_cast<char>(newest + 1);
        EXPECT_ANY_THROW(fromBytes(bytes));
    }
}

TEST(Serialization, EveryCutIsNoticed) {
    const std::string bytes = bytesOf(*obs_samples::detectedObjects(0));
    for (std::size_t n = 0; n < bytes.size(); ++n)
        ASSERT_ANY_THROW(fromBytes(bytes.substr(0, n))) << n << " of " << bytes.size();
}

TEST(Serialization, AMaskThatDoesNotFitItsSizeIsRefused) {
    auto o = obs_samples::detectedObjects(0);
    o->detections[0].mask = djpete::obs::RleMask{4, 3, {2, 3, 8}};
    EXPECT_ANY_THROW(fromBytes(bytesOf(*o)));
}

TEST(DetectedObjects, DescribeAndDrawThemselves) {
    const auto o = obs_samples::detectedObjects(0);
    std::stringstream text;
    o->getDescriptionAsText(text);
    EXPECT_THAT(text.str(), testing::HasSubstr("2 detected objects"));
    EXPECT_THAT(text.str(), testing::HasSubstr("Van score 0.75"));
    EXPECT_THAT(o->exportTxtDataRow(), testing::StartsWith("2 Van 0.75 4.5 1.9 2.1 "));
    mrpt::opengl::CSetOfObjects scene;
    o->getVisualizationInto(scene);
    EXPECT_EQ(scene.size(), 4U) << "a box and a name for each";
}

TEST(ObjectClass, NamesAreKittisAndReadBack) {
    using djpete::obs::ObjectClass;
    for (auto c : {ObjectClass::Car, ObjectClass::Van, ObjectClass::Truck, ObjectClass::Pedestrian,
                   ObjectClass::Cyclist, ObjectClass::Tram, ObjectClass::Other})
        EXPECT_EQ(djpete::obs::objectClassFromString(djpete::obs::toString(c)), c);
    EXPECT_EQ(djpete::obs::objectClassFromString("car"), ObjectClass::Car);
    EXPECT_EQ(djpete::obs::objectClassFromString("Person_sitting"), ObjectClass::Pedestrian);
    EXPECT_EQ(djpete::obs::objectClassFromString("spaceship"), ObjectClass::Other);
}
