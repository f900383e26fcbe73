#include "map_file_entities.h"

#include <chrono>

namespace djpete::map {

namespace {

template <class Derived>
void put(ByteWriter& out, const Eigen::MatrixBase<Derived>& m) {
    for (Eigen::Index r = 0; r < m.rows(); ++r) {
        for (Eigen::Index c = 0; c < m.cols(); ++c) out.put(m(r, c));
    }
}

template <class Matrix>
Matrix getMatrix(ByteReader& in) {
    Matrix m;
    for (Eigen::Index r = 0; r < m.rows(); ++r) {
        for (Eigen::Index c = 0; c < m.cols(); ++c) m(r, c) = in.get<double>();
    }
    return m;
}

void put(ByteWriter& out, const geometry::SE3& T) {
    put(out, T.rotation());
    put(out, T.translation());
}

geometry::SE3 getPose(ByteReader& in) {
    const auto rotation = getMatrix<geometry::Mat3>(in);
    return {rotation, getMatrix<geometry::Vec3>(in)};
}

void put(ByteWriter& out, const mrpt::Clock::time_point& stamp) {
    out.put(static_cast<int64_t>(stamp.time_since_epoch().count()));
}

mrpt::Clock::time_point getStamp(ByteReader& in) {
    return mrpt::Clock::time_point(mrpt::Clock::duration(in.get<int64_t>()));
}

void put(ByteWriter& out, const geometry::StereoCamera& c) {
    for (const double value : {c.fx, c.fy, c.cx, c.cy, c.baseline_m}) out.put(value);
    out.put(static_cast<int32_t>(c.width_px));
    out.put(static_cast<int32_t>(c.height_px));
}

geometry::StereoCamera getCamera(ByteReader& in) {
    geometry::StereoCamera c;
    for (double* value : {&c.fx, &c.fy, &c.cx, &c.cy, &c.baseline_m}) *value = in.get<double>();
    c.width_px = in.get<int32_t>();
    c.height_px = in.get<int32_t>();
    return c;
}

void put(ByteWriter& out, const obs::KeyframeFeature& f) {
    out.put(f.track.value);
    for (const float value : {f.u_px, f.v_px, f.sigma_px, f.uRightSigma_px, f.depthSigma_m}) {
        out.put(value);
    }
    for (const uint8_t value : f.rgb) out.put(value);
    out.put(
        static_cast<uint8_t>((f.uRight_px ? 1 : 0) | (f.depth_m ? 2 : 0) | (f.descriptor ? 4 : 0)));
    if (f.uRight_px) out.put(*f.uRight_px);
    if (f.depth_m) out.put(*f.depth_m);
    if (f.descriptor) {
        for (const uint64_t bits : *f.descriptor) out.put(bits);
    }
}

obs::KeyframeFeature getFeature(ByteReader& in) {
    obs::KeyframeFeature f;
    f.track.value = in.get<uint64_t>();
    for (float* value : {&f.u_px, &f.v_px, &f.sigma_px, &f.uRightSigma_px, &f.depthSigma_m}) {
        *value = in.get<float>();
    }
    for (uint8_t& value : f.rgb) value = in.get<uint8_t>();
    const auto has = in.get<uint8_t>();
    if (has > 7) throw DamagedBytes("a feature has an unknown part");
    if ((has & 1) != 0) f.uRight_px = in.get<float>();
    if ((has & 2) != 0) f.depth_m = in.get<float>();
    if ((has & 4) != 0) {
        f.descriptor.emplace();
        for (uint64_t& bits : *f.descriptor) bits = in.get<uint64_t>();
    }
    return f;
}

obs::ObjectClass getClass(ByteReader& in) {
    const auto value = in.get<uint8_t>();
    if (value > static_cast<uint8_t>(obs::ObjectClass::Other)) {
        throw DamagedBytes("an object is of an unknown class");
    }
    return static_cast<obs::ObjectClass>(value);
}

void put(ByteWriter& out, const obs::RleMask& mask) {
    out.put(mask.width_px);
    out.put(mask.height_px);
    out.put(static_cast<uint64_t>(mask.runs.size()));
    for (const uint32_t run : mask.runs) out.put(run);
}

obs::RleMask getMask(ByteReader& in) {
    obs::RleMask mask;
    mask.width_px = in.get<uint32_t>();
    mask.height_px = in.get<uint32_t>();
    mask.runs.resize(in.getCount(sizeof(uint32_t)));
    for (uint32_t& run : mask.runs) run = in.get<uint32_t>();
    return mask;
}

void put(ByteWriter& out, const ObjectObservation& o) {
    out.put(o.frame.value);
    put(out, o.T_cam_obj);
    put(out, o.information);
    put(out, o.size_m);
    out.put(o.score);
    out.put(static_cast<uint8_t>(o.objectClass));
    out.put(o.box.has_value());
    if (o.box) {
        for (const float v : {o.box->left, o.box->top, o.box->right, o.box->bottom}) out.put(v);
    }
    out.put(o.mask.has_value());
    if (o.mask) put(out, *o.mask);
    out.putText(o.source);
}

ObjectObservation getObservation(ByteReader& in) {
    ObjectObservation o;
    o.frame.value = in.get<uint64_t>();
    o.T_cam_obj = getPose(in);
    o.information = getMatrix<geometry::Mat6>(in);
    o.size_m = getMatrix<geometry::Vec3>(in);
    o.score = in.get<float>();
    o.objectClass = getClass(in);
    if (in.getFlag()) {
        o.box.emplace();
        for (float* v : {&o.box->left, &o.box->top, &o.box->right, &o.box->bottom}) {
            *v = in.get<float>();
        }
    }
    if (in.getFlag()) o.mask = getMask(in);
    o.source = in.getText();
    return o;
}

void put(ByteWriter& out, const ObjectState& s) {
    out.put(s.frame.value);
    out.put(s.anchor.value);
    put(out, s.T_anchor_obj);
    put(out, s.twist);
    put(out, s.covariance);
}

ObjectState getState(ByteReader& in) {
    ObjectState s;
    s.frame.value = in.get<uint64_t>();
    s.anchor.value = in.get<uint64_t>();
    s.T_anchor_obj = getPose(in);
    s.twist = getMatrix<geometry::Vec6>(in);
    s.covariance = getMatrix<geometry::Mat6>(in);
    return s;
}

constexpr std::size_t kLeastFeature = 32, kLeastObservation = 400, kLeastState = 400;
constexpr uint64_t kNoLandmark = ~uint64_t{0};

}  // namespace

void write(ByteWriter& out, const Keyframe& kf) {
    out.put(kf.id.value);
    out.put(kf.frame.value);
    out.put(kf.segment);
    out.put(kf.world);
    put(out, kf.stamp);
    put(out, kf.camera);
    put(out, kf.T_vehicle_cam);
    put(out, kf.T_odom_cam);
    put(out, kf.T_world_cam);
    out.put(static_cast<uint64_t>(kf.features.size()));
    for (const auto& f : kf.features) put(out, f);
    for (const auto& landmark : kf.landmarks) out.put(landmark ? landmark->value : kNoLandmark);
    out.put(kf.scanMotion.has_value());
    if (!kf.scanMotion) return;
    out.put(kf.scanMotion->from.value);
    put(out, kf.scanMotion->T_from_cam);
    put(out, kf.scanMotion->information);
}

Keyframe readKeyframe(ByteReader& in, uint32_t /*version*/) {
    Keyframe kf;
    kf.id.value = in.get<uint64_t>();
    kf.frame.value = in.get<uint64_t>();
    kf.segment = in.get<uint32_t>();
    kf.world = in.get<uint32_t>();
    kf.stamp = getStamp(in);
    kf.camera = getCamera(in);
    kf.T_vehicle_cam = getPose(in);
    kf.T_odom_cam = getPose(in);
    kf.T_world_cam = getPose(in);
    const std::size_t features = in.getCount(kLeastFeature);
    kf.features.reserve(features);
    for (std::size_t i = 0; i < features; ++i) kf.features.push_back(getFeature(in));
    kf.landmarks.resize(features);
    for (auto& landmark : kf.landmarks) {
        const auto id = in.get<uint64_t>();
        if (id != kNoLandmark) landmark = LandmarkId{id};
    }
    if (in.getFlag()) {
        kf.scanMotion.emplace();
        kf.scanMotion->from.value = in.get<uint64_t>();
        kf.scanMotion->T_from_cam = getPose(in);
        kf.scanMotion->information = getMatrix<geometry::Mat6>(in);
    }
    return kf;
}

void write(ByteWriter& out, const FramePose& pose) {
    out.put(pose.frame.value);
    put(out, pose.stamp);
    out.put(pose.reference.value);
    put(out, pose.T_ref_cam);
    out.put(pose.tracked);
}

FramePose readFramePose(ByteReader& in, uint32_t /*version*/) {
    FramePose pose;
    pose.frame.value = in.get<uint64_t>();
    pose.stamp = getStamp(in);
    pose.reference.value = in.get<uint64_t>();
    pose.T_ref_cam = getPose(in);
    pose.tracked = in.getFlag();
    return pose;
}

void write(ByteWriter& out, const Landmark& landmark) {
    out.put(landmark.id.value);
    put(out, landmark.p_world);
    for (const uint8_t value : landmark.rgb) out.put(value);
}

Landmark readLandmark(ByteReader& in, uint32_t /*version*/) {
    Landmark landmark;
    landmark.id.value = in.get<uint64_t>();
    landmark.p_world = getMatrix<geometry::Vec3>(in);
    for (uint8_t& value : landmark.rgb) value = in.get<uint8_t>();
    return landmark;
}

void write(ByteWriter& out, const ObjectTrack& track) {
    out.put(track.id.value);
    out.put(static_cast<uint8_t>(track.objectClass));
    put(out, track.size_m);
    out.put(track.moving);
    out.put(static_cast<uint64_t>(track.observations.size()));
    for (const auto& [frame, observation] : track.observations) put(out, observation);
    out.put(static_cast<uint64_t>(track.states.size()));
    for (const auto& [frame, state] : track.states) put(out, state);
}

ObjectTrack readObject(ByteReader& in, uint32_t /*version*/) {
    ObjectTrack track;
    track.id.value = in.get<uint64_t>();
    track.objectClass = getClass(in);
    track.size_m = getMatrix<geometry::Vec3>(in);
    track.moving = in.getFlag();
    for (std::size_t n = in.getCount(kLeastObservation); n > 0; --n) {
        auto observation = getObservation(in);
        const auto frame = observation.frame;
        if (!track.observations.emplace(frame, std::move(observation)).second) {
            throw DamagedBytes("an object is observed twice in one frame");
        }
    }
    for (std::size_t n = in.getCount(kLeastState); n > 0; --n) {
        const auto state = getState(in);
        if (!track.states.emplace(state.frame, state).second) {
            throw DamagedBytes("an object has two states in one frame");
        }
    }
    return track;
}

}  // namespace djpete::map
