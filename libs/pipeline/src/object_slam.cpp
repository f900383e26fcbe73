#include "djpete/pipeline/object_slam.h"

#include <algorithm>
#include <thread>

#include "djpete/backend/map_keeper.h"
#include "djpete/frontend/threads.h"
#include "djpete/geometry/mrpt_bridge.h"
#include "djpete/obs/errors.h"
#include "djpete/observers/appearance.h"
#include "djpete/observers/point_gatherer.h"
#include "djpete/observers/projection.h"
#include "djpete/pipeline/background_stage.h"
#include "djpete/pipeline/pose_odometry.h"
#include "djpete/pipeline/scan_stage.h"
#include "djpete/pipeline/texture_queue.h"

namespace djpete::pipeline {

namespace {

backend::Mode modeOf(const PipelineOptions& options) {
    return options.mode == "lockstep" ? backend::Mode::Lockstep : backend::Mode::Threaded;
}

/// The camera that detections' image boxes and masks refer to.
std::optional<obs::RigCamera> mainCamera(const LoadedFrame& frame) {
    if (frame.images) return frame.images->camera;
    if (frame.frame.keyframe) {
        return obs::RigCamera{frame.frame.keyframe->camera,
                              geometry::fromCPose3D(frame.frame.keyframe->sensorPose)};
    }
    return std::nullopt;
}

}  // namespace

struct ObjectSlam::Impl {
    Impl(const ObjectSlamOptions& o, std::unique_ptr<observers::ObjectObserver> ob)
        : options(o),
          observer(std::move(ob)),
          odometry(o.frontend),
          scans(o.scans, o.pipeline.mode == "threaded"),
          keeper(o.backend, modeOf(o.pipeline)),
          textures(o),
          octomap(o) {
        frontend::useThreads(o.pipeline.threads);
    }

    obs::CObservationDetectedObjects::Ptr observe(const LoadedFrame& in) {
        if (!observer) return nullptr;
        const auto camera = mainCamera(in);
        return measured(times, "observer", [&] {
            const auto objects = observer->observe(in.frame, in.scan ? &*in.scan : nullptr,
                                                   camera ? &*camera : nullptr);
            if (objects && in.scan && options.backend.objects.usePoints) {
                observers::gatherPoints(*objects, *in.scan, {});
            }
            if (objects && in.images) observers::describeAppearance(*objects, *in.images);
            return objects;
        });
    }

    obs::CObservationVisualKeyframe::Ptr measureOdometry(
        const LoadedFrame& in, const obs::CObservationDetectedObjects::Ptr& detections) {
        if (in.frame.keyframe) return in.frame.keyframe;
        if (!in.images) return poseOdometry(in);
        frontend::OdometryInput input{in.frame.id, in.frame.stamp, *in.images,
                                      in.scan ? &*in.scan : nullptr, std::nullopt};
        if (detections && !detections->detections.empty()) {
            input.exclusion = observers::exclusionImage(*detections, in.images->camera,
                                                        int(options.pipeline.exclusionMargin_px));
        }
        return scans.process(
            in.scan ? &*in.scan : nullptr,
            [&] { return measured(times, "front end", [&] { return odometry.process(input); }); },
            times);
    }

    obs::CObservationVisualKeyframe::Ptr poseOdometry(const LoadedFrame& in) {
        if (!poses) {
            if (!rig) {
                throw obs::InputError("frame " + std::to_string(in.frame.id.value) +
                                      ": no image and no calibration; expected one of them");
            }
            poses.emplace(*rig);
        }
        return poses->process(in.frame);
    }

    /// The frame with the number that it has in the map.
    LoadedFrame inMap(const LoadedFrame& frame) const {
        LoadedFrame out = frame;
        if (firstFrame.value == 0) return out;
        out.frame.id.value += firstFrame.value;
        if (frame.frame.keyframe) {
            out.frame.keyframe =
                std::make_shared<obs::CObservationVisualKeyframe>(*frame.frame.keyframe);
            out.frame.keyframe->frame = out.frame.id;
            auto& motion = out.frame.keyframe->scanMotion;
            if (motion) motion->from.value += firstFrame.value;
        }
        return out;
    }

    void continueFrom(map::SlamMap base, bool localiseOnly) {
        if (!base.frames().empty()) {
            const uint64_t last = base.frames().rbegin()->first.value;
            firstFrame.value = (last / map::kFramesPerDrive + 1) * map::kFramesPerDrive;
        }
        keeper.continueFrom(std::move(base), localiseOnly);
    }

    FrameOutcome process(const LoadedFrame& drive) {
        const LoadedFrame in = inMap(drive);
        FrameOutcome out;
        out.frame = drive.frame.id;
        out.objectsInFrame = observe(drive);
        out.odometry = measureOdometry(in, out.objectsInFrame);
        out.keyframe = out.odometry->isKeyframe;
        out.tracked = out.odometry->tracked;
        out.features = in.images && !in.frame.keyframe ? std::size_t(odometry.last().features)
                                                       : out.odometry->features.size();
        if (out.objectsInFrame) out.detections = out.objectsInFrame->detections.size();
        measured(times, "map", [&] { keeper.addFrame(out.odometry, out.objectsInFrame); });
        const auto& keyframes = keeper.map().keyframes();
        out.localised = keyframes.rbegin()->second.world == keyframes.begin()->second.world;
        if (out.keyframe && in.images && (viewWanted() || options.pipeline.octomap)) {
            octomap.push(in.frame);
            octomap.process(keeper.map(), false, !viewWanted(), times);
            if (viewWanted()) textures.push(in.frame);
            textures.process(keeper.map(), false, times);
        } else {
            in.frame.unload();
        }
        return out;
    }

    bool viewWanted() const { return options.pipeline.texture || options.pipeline.background; }

    void finish() {
        if (finished) return;
        finished = true;
        measured(times, "final optimisation", [&] { keeper.finish(); });
        octomap.process(keeper.map(), true, !viewWanted(), times);
        textures.process(keeper.map(), true, times);
        measured(times, "texture settles", [&] {
            const unsigned cores = std::max(1U, std::thread::hardware_concurrency());
            const unsigned wanted = options.pipeline.threads > 0 ? options.pipeline.threads : cores;
            textures.finish(keeper.map(), keeper.joinedObjects(),
                            options.pipeline.mode == "threaded" ? wanted : 1);
        });
        octomap.finish(keeper.map(), times);
    }

    ObjectSlamOptions options;
    std::unique_ptr<observers::ObjectObserver> observer;
    std::optional<obs::RigCamera> rig;
    frontend::VisualOdometry odometry;
    ScanStage scans;
    std::optional<PoseOdometry> poses;
    backend::MapKeeper keeper;
    TextureQueue textures;
    BackgroundStage octomap;
    StageTable times;
    obs::FrameId firstFrame;  ///< the number in the map of this drive's frame 0
    bool finished = false;
};

ObjectSlam::ObjectSlam(const ObjectSlamOptions& options,
                       std::unique_ptr<observers::ObjectObserver> observer)
    : impl_(std::make_unique<Impl>(options, std::move(observer))) {}
ObjectSlam::~ObjectSlam() = default;

void ObjectSlam::setRig(const obs::RigCamera& camera) { impl_->rig = camera; }
void ObjectSlam::continueFrom(map::SlamMap base, bool localiseOnly) {
    impl_->continueFrom(std::move(base), localiseOnly);
}
obs::FrameId ObjectSlam::frameInMap(obs::FrameId frame) const {
    return {frame.value + impl_->firstFrame.value};
}
const std::vector<map::LoopRecord>& ObjectSlam::loops() const { return impl_->keeper.loops(); }
FrameOutcome ObjectSlam::process(const LoadedFrame& frame) { return impl_->process(frame); }
void ObjectSlam::finish() { impl_->finish(); }

const map::SlamMap& ObjectSlam::map() const { return impl_->keeper.map(); }
map::MapSnapshot ObjectSlam::snapshot() const { return impl_->keeper.snapshot(); }
const std::map<map::ObjectId, texture::ObjectModel>& ObjectSlam::models() const {
    return impl_->textures.models();
}
const std::map<obs::FrameId, texture::Exposure>& ObjectSlam::exposures() const {
    return impl_->textures.exposures();
}
std::vector<texture::ColouredPoint> ObjectSlam::background() const {
    if (const auto* tree = octomap()) return tree->points();
    return impl_->textures.background().points(impl_->keeper.map());
}
const background::OctoBackground* ObjectSlam::octomap() const { return impl_->octomap.tree(); }

StageTable ObjectSlam::timings() const {
    StageTable out = impl_->times;
    for (const auto& [stage, times] : impl_->keeper.statistics().stages) {
        out["back end: " + stage] = times;
    }
    impl_->octomap.addTo(out);
    return out;
}

std::map<std::string, uint64_t> ObjectSlam::counters() const {
    const auto& s = impl_->keeper.statistics();
    std::map<std::string, uint64_t> out{{"keyframes", s.keyframes},
                                        {"frames", s.frames},
                                        {"landmarks created", s.landmarksCreated},
                                        {"landmarks culled", s.landmarksCulled},
                                        {"detections", s.detections},
                                        {"detections matched", s.detectionsMatched},
                                        {"objects created", s.objectsCreated},
                                        {"objects merged", s.objectsMerged},
                                        {"objects removed", s.objectsRemoved},
                                        {"backbone solves", s.backboneSolves},
                                        {"backbone failures", s.backboneFailures},
                                        {"object solves", s.objectSolves},
                                        {"joint solves", s.jointSolves},
                                        {"joint solves accepted", s.jointAccepted},
                                        {"view matches", s.viewMatches},
                                        {"loops closed", s.loopsClosed},
                                        {"worlds joined", s.worldsJoined},
                                        {"landmarks fused", s.landmarksFused},
                                        {"full adjustments", s.fullAdjustments}};
    for (const auto& [reason, count] : s.rejected) out["rejected: " + reason] = count;
    impl_->octomap.addTo(out);
    return out;
}

}  // namespace djpete::pipeline
