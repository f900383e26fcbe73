#include "djpete/frontend/visual_odometry.h"

#include <algorithm>
#include <chrono>
#include <cmath>

#include "anchor_patch.h"
#include "corners.h"
#include "depth_measurement.h"
#include "djpete/geometry/mrpt_bridge.h"
#include "djpete/obs/errors.h"
#include "djpete/obs/labels.h"
#include "input_images.h"
#include "measurement_model.h"
#include "ordered_parallel.h"
#include "pose_estimator.h"
#include "stereo_calibrator.h"
#include "track_follower.h"

namespace djpete::frontend {

using geometry::SE3;
using geometry::Vec3;

namespace {

/// Adds the time since it was last read to a sum in milliseconds.
class StopWatch {
  public:
    void lap(double& sum_ms) {
        const auto now = std::chrono::steady_clock::now();
        sum_ms += std::chrono::duration<double, std::milli>(now - last_).count();
        last_ = now;
    }

  private:
    std::chrono::steady_clock::time_point last_ = std::chrono::steady_clock::now();
};

/// Depth from a few metres to infinity: the start of tracks whose depth nothing measures.
constexpr InverseDepth kUnknownDepth{0.05, 0.1 * 0.1};
/// Below this a frame has no texture to follow.
constexpr std::size_t kMinFeaturesToStart = 12;

std::array<uint8_t, 3> colourAt(const InputImages& images, const cv::Point2f& px) {
    const cv::Point at(static_cast<int>(std::lround(px.x)), static_cast<int>(std::lround(px.y)));
    if (images.leftColour.empty()) {
        const uint8_t g = images.leftGrey.at<uint8_t>(at);
        return {g, g, g};
    }
    const auto& bgr = images.leftColour.at<cv::Vec3b>(at);
    return {bgr[2], bgr[1], bgr[0]};
}

obs::KeyframeFeature toKeyframeFeature(const FeatureTrack& track, const FrontendOptions& options) {
    obs::KeyframeFeature f;
    f.track = track.id;
    f.u_px = track.now.px.x;
    f.v_px = track.now.px.y;
    f.sigma_px = static_cast<float>(
        std::sqrt(options.sigmaTrack_px * options.sigmaTrack_px +
                  options.sigmaDrift_px * options.sigmaDrift_px * track.framesFollowed));
    f.uRight_px = track.uRight_px;
    f.uRightSigma_px = track.uRight_px ? track.disparitySigma_px : 1.F;
    f.depth_m = track.lidarDepth_m;
    f.depthSigma_m = track.lidarDepth_m ? track.lidarSigma_m : 0.F;
    f.rgb = track.rgb;
    return f;
}

double seconds(mrpt::Clock::duration d) { return std::chrono::duration<double>(d).count(); }

}  // namespace

struct VisualOdometry::Impl {
    explicit Impl(const FrontendOptions& o) : options(o), calibrator(o) { options.check(); }

    FrontendOptions options;
    OdometryStatistics statistics;
    StereoCalibrator calibrator;

    // The last frame.
    bool started = false;
    cv::Size size;
    mrpt::Clock::time_point stamp;
    SE3 T_odom_cam;                             ///< measured or predicted
    std::optional<geometry::Vec6> twist_per_s;  ///< in cam; nothing before two frames

    // The last frame with tracks; older than the last frame while the image shows nothing.
    GreyPyramid base;
    GreyPyramid next;  ///< of the frame at work; becomes the base if its tracks do
    std::vector<FeatureTrack> tracks;
    uint64_t nextTrack = 0;

    // The last keyframe.
    SE3 T_odom_keyframe;
    mrpt::Clock::time_point keyframeStamp;
    uint64_t keyframeNextTrack = 0;
    std::size_t keyframeFeatures = 0;

    obs::CObservationVisualKeyframe::Ptr process(const OdometryInput& input);
    void checkSequence(const OdometryInput& input, const InputImages& images) const;
    DepthSensors depthSensors(const OdometryInput& input, const InputImages& images);
    /// Sets T_odom_cam; false if it could only be predicted.
    bool advancePose(const OdometryInput& input, const InputImages& images,
                     const DepthSensors& sensors);
    /// Adds corners where they are needed; true if this frame is a keyframe.
    bool renewTracks(mrpt::Clock::time_point now, const InputImages& images,
                     const DepthSensors& sensors);
    obs::CObservationVisualKeyframe::Ptr publish(const OdometryInput& input,
                                                 const obs::RigCamera& camera);
    /// Follows, measures and culls the tracks; false, leaving them as they were, if too few agree.
    bool trackFrame(const InputImages& images, const DepthSensors& sensors, const SE3& T_predicted,
                    obs::FrameId frame);
    uint64_t seedOf(obs::FrameId frame) const {
        return options.seed * 0x9E3779B97F4A7C15ULL + frame.value;
    }
    std::optional<PoseEstimate> measurePose(const std::vector<FeatureTrack>& followed,
                                            const SE3& T_predicted,
                                            const geometry::StereoCamera& camera,
                                            obs::FrameId frame);
    void addFeatures(const InputImages& images, const DepthSensors& sensors);
    bool keyframeIsDue(mrpt::Clock::time_point now) const;
    void countFeatures();
};

void VisualOdometry::Impl::checkSequence(const OdometryInput& input,
                                         const InputImages& images) const {
    const std::string frame = "frame " + std::to_string(input.frame.value);
    if (!started) {
        if (images.rightGrey.empty() && !input.scan) {
            throw obs::InputError(frame +
                                  ": the first frame of visual odometry needs a right image or a "
                                  "scan, which give the scale");
        }
        return;
    }
    if (images.leftGrey.size() != size) {
        throw obs::InputError(frame + ": left image is " + std::to_string(images.leftGrey.cols) +
                              "x" + std::to_string(images.leftGrey.rows) + " but " +
                              std::to_string(size.width) + "x" + std::to_string(size.height) +
                              " was expected, as in the first frame");
    }
    if (input.stamp <= stamp) {
        throw obs::InputError(frame +
                              ": time stamp is not later than that of the frame before; expected "
                              "frames in order of time");
    }
}

DepthSensors VisualOdometry::Impl::depthSensors(const OdometryInput& input,
                                                const InputImages& images) {
    StopWatch watch;
    DepthSensors sensors;
    sensors.camera = images.camera.model;
    if (!images.rightGrey.empty()) {
        sensors.stereo.emplace(images.leftGrey, images.rightGrey, images.camera.model,
                               calibrator.calibration(), options);
    }
    if (input.scan) sensors.scan.emplace(*input.scan, images.camera, options);
    watch.lap(statistics.times.lidar_ms);
    return sensors;
}

std::optional<PoseEstimate> VisualOdometry::Impl::measurePose(
    const std::vector<FeatureTrack>& followed, const SE3& T_predicted,
    const geometry::StereoCamera& camera, obs::FrameId frame) {
    if (followed.size() < static_cast<std::size_t>(options.minInliers)) return std::nullopt;
    auto estimate = estimatePose(followed, T_predicted, camera, options);
    const double enough = options.minInlierRatio * static_cast<double>(followed.size());
    if (estimate.inlierCount < enough) {
        statistics.usedRansac = true;
        auto other = estimatePoseFromSamples(followed, T_predicted, camera, options, seedOf(frame));
        if (other.inlierCount > estimate.inlierCount) estimate = std::move(other);
    }
    if (estimate.inlierCount < options.minInliers) return std::nullopt;
    return estimate;
}

bool VisualOdometry::Impl::trackFrame(const InputImages& images, const DepthSensors& sensors,
                                      const SE3& T_predicted, obs::FrameId frame) {
    StopWatch watch;
    const auto& camera = images.camera.model;
    auto followed = followTracks(tracks, base, next, T_predicted, camera, images.exclusion, options,
                                 seedOf(frame));
    statistics.usedFullSearch = followed.usedFullSearch;
    statistics.followed = static_cast<int>(followed.tracks.size());
    watch.lap(statistics.times.track_ms);

    const SE3 T_cam_odom = followed.T_odom_cam.inverse();
    forEachItem(followed.tracks.size(), [&](std::size_t i) {
        auto& t = followed.tracks[i];
        std::optional<double> guess;
        const Vec3 q = t.scaledPoint(T_cam_odom * t.T_odom_anchor);
        if (t.depthKnown() && q.z() > 0.05) guess = t.anchorDepth.value / q.z();
        measureStereo(t, sensors, guess);
    });
    watch.lap(statistics.times.stereo_ms);
    forEachItem(followed.tracks.size(),
                [&](std::size_t i) { measureLidar(followed.tracks[i], sensors); });
    watch.lap(statistics.times.lidar_ms);

    const auto estimate = measurePose(followed.tracks, followed.T_odom_cam, camera, frame);
    if (!estimate) {
        watch.lap(statistics.times.pose_ms);
        return false;
    }
    T_odom_cam = estimate->T_odom_cam;
    statistics.inliers = estimate->inlierCount;
    statistics.rms_px = estimate->rms_px;
    tracks.clear();
    for (std::size_t i = 0; i < followed.tracks.size(); ++i) {
        if (!estimate->inlier[i]) continue;
        tracks.push_back(std::move(followed.tracks[i]));
    }
    calibrator.learnDisparity(tracks, T_odom_cam, camera, options);
    for (auto& t : tracks)
        updateDepth(t, T_odom_cam, estimate->covariance, calibrator.poseBias(), camera, options);
    watch.lap(statistics.times.pose_ms);
    return true;
}

void VisualOdometry::Impl::addFeatures(const InputImages& images, const DepthSensors& sensors) {
    StopWatch watch;
    std::vector<cv::Point2f> existing;
    for (const auto& t : tracks) existing.push_back(t.now.px);
    const int wanted = options.featuresWanted - static_cast<int>(tracks.size());
    const auto corners =
        detectCorners(images.leftGrey, existing, images.exclusion, wanted, options);
    const std::size_t first = tracks.size();
    tracks.resize(first + corners.size());
    forEachItem(corners.size(), [&](std::size_t i) {
        const auto& px = corners[i];
        FeatureTrack& t = tracks[first + i];
        t.id = obs::TrackId{nextTrack + i};
        t.T_odom_anchor = T_odom_cam;
        t.anchorPatch = anchorPatchAt(images.leftGrey, px);
        t.ray_anchor = images.camera.model.ray({px.x, px.y});
        t.now.px = px;
        t.rgb = colourAt(images, px);
        measureLidar(t, sensors);
        std::optional<double> guess;
        if (t.lidarDepth_m) guess = 1.0 / *t.lidarDepth_m;
        measureStereo(t, sensors, guess);
        t.anchorDepth = t.now.inverseDepth.value_or(kUnknownDepth);
        t.anchorPoseBias = calibrator.poseBias();
        const double fb = images.camera.model.fx * images.camera.model.baseline_m;
        if (fb > 0) t.depthBias = -t.now.stereoShare / fb;
        t.anchorDepth.value = std::max(t.anchorDepth.value, 1e-5);
    });
    nextTrack += corners.size();
    statistics.added += static_cast<int>(corners.size());
    watch.lap(statistics.times.detect_ms);
}

bool VisualOdometry::Impl::keyframeIsDue(mrpt::Clock::time_point now) const {
    const SE3 T_keyframe_cam = T_odom_keyframe.inverse() * T_odom_cam;
    const double way_m = T_keyframe_cam.translation().norm();
    if (way_m > options.keyframeTranslation_m) return true;
    if (T_keyframe_cam.angle_rad() > options.keyframeRotation_deg * M_PI / 180.0) return true;
    constexpr double kStanding_m = 0.05;
    if (way_m > kStanding_m && seconds(now - keyframeStamp) > options.keyframeInterval_s)
        return true;
    const auto kept = std::count_if(tracks.begin(), tracks.end(), [&](const FeatureTrack& t) {
        return t.id.value < keyframeNextTrack;
    });
    return static_cast<double>(kept) <
           options.keyframeKeptRatio * static_cast<double>(keyframeFeatures);
}

void VisualOdometry::Impl::countFeatures() {
    statistics.features = static_cast<int>(tracks.size());
    for (const auto& t : tracks) {
        statistics.stereoMatched += t.uRight_px ? 1 : 0;
        statistics.withLidarDepth += t.lidarDepth_m ? 1 : 0;
    }
}

bool VisualOdometry::Impl::advancePose(const OdometryInput& input, const InputImages& images,
                                       const DepthSensors& sensors) {
    if (!started) {
        T_odom_cam = images.camera.T_vehicle_cam;
        return true;
    }
    const double dt_s = seconds(input.stamp - stamp);
    const SE3 T_odom_before = T_odom_cam;
    const SE3 T_predicted = twist_per_s ? T_odom_cam * SE3::exp(*twist_per_s * dt_s) : T_odom_cam;
    if (!trackFrame(images, sensors, T_predicted, input.frame)) {
        T_odom_cam = T_predicted;
        return false;
    }
    twist_per_s = (T_odom_before.inverse() * T_odom_cam).log() / dt_s;
    return true;
}

bool VisualOdometry::Impl::renewTracks(mrpt::Clock::time_point now, const InputImages& images,
                                       const DepthSensors& sensors) {
    if (!statistics.tracked) {
        // Start anew if there is something to see here; else wait with the old tracks.
        std::vector<FeatureTrack> old;
        std::swap(old, tracks);
        addFeatures(images, sensors);
        if (tracks.size() < kMinFeaturesToStart) {
            std::swap(old, tracks);
            return false;
        }
        std::swap(base, next);
        return true;
    }
    const bool keyframe = !started || keyframeIsDue(now);
    const double few = options.detectBelowRatio * options.featuresWanted;
    if (keyframe || static_cast<double>(tracks.size()) < few) addFeatures(images, sensors);
    std::swap(base, next);
    return keyframe;
}

obs::CObservationVisualKeyframe::Ptr VisualOdometry::Impl::publish(const OdometryInput& input,
                                                                   const obs::RigCamera& camera) {
    auto out = obs::CObservationVisualKeyframe::Create();
    out->timestamp = input.stamp;
    out->sensorLabel = obs::label::kKeyframes;
    out->frame = input.frame;
    out->tracked = statistics.tracked;
    out->isKeyframe = statistics.keyframe;
    out->camera = camera.model;
    out->sensorPose = geometry::toCPose3D(camera.T_vehicle_cam);
    out->T_odom_cam = T_odom_cam;
    if (!statistics.keyframe) return out;
    for (const auto& t : tracks) out->features.push_back(toKeyframeFeature(t, options));
    T_odom_keyframe = T_odom_cam;
    keyframeStamp = input.stamp;
    keyframeNextTrack = nextTrack;
    keyframeFeatures = tracks.size();
    return out;
}

obs::CObservationVisualKeyframe::Ptr VisualOdometry::Impl::process(const OdometryInput& input) {
    StopWatch whole, watch;
    const InputImages images = checkedImages(input);
    checkSequence(input, images);
    statistics = OdometryStatistics();
    statistics.frame = input.frame;
    next.build(images.leftGrey, options.kltLevels);
    watch.lap(statistics.times.prepare_ms);
    const DepthSensors sensors = depthSensors(input, images);
    statistics.tracked = advancePose(input, images, sensors);
    statistics.keyframe = renewTracks(input.stamp, images, sensors);
    started = true;
    size = images.leftGrey.size();
    stamp = input.stamp;
    countFeatures();
    calibrator.learnRows(tracks, images.camera.model);
    auto out = publish(input, images.camera);
    whole.lap(statistics.times.total_ms);
    return out;
}

VisualOdometry::VisualOdometry(const FrontendOptions& options)
    : impl_(std::make_unique<Impl>(options)) {}
VisualOdometry::~VisualOdometry() = default;
VisualOdometry::VisualOdometry(VisualOdometry&&) noexcept = default;
VisualOdometry& VisualOdometry::operator=(VisualOdometry&&) noexcept = default;

obs::CObservationVisualKeyframe::Ptr VisualOdometry::process(const OdometryInput& input) {
    return impl_->process(input);
}

const OdometryStatistics& VisualOdometry::last() const { return impl_->statistics; }

}  // namespace djpete::frontend
