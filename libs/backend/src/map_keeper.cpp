#include "djpete/backend/map_keeper.h"

#include <chrono>
#include <stdexcept>
#include <utility>

#include "djpete/geometry/mrpt_bridge.h"
#include "djpete/obs/errors.h"
#include "input_check.h"
#include "landmark_builder.h"
#include "object_keeper.h"

namespace djpete::backend {

namespace {

using geometry::SE3;
using map::KeyframeId;

/// Adds the time until it goes out of scope.
class Stopwatch {
  public:
    explicit Stopwatch(StageTimes& times) : times_(times) {}
    ~Stopwatch() {
        times_.add(
            std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - begin_)
                .count());
    }
    Stopwatch(const Stopwatch&) = delete;
    Stopwatch& operator=(const Stopwatch&) = delete;

  private:
    StageTimes& times_;
    std::chrono::steady_clock::time_point begin_ = std::chrono::steady_clock::now();
};

}  // namespace

class MapKeeper::Impl {
  public:
    Impl(BackendOptions options, Mode mode, BeforeSolve beforeSolve)
        : options_(std::move(options)),
          beforeSolve_(std::move(beforeSolve)),
          objectKeeper_(options_.association),
          backboneWorker_(
              [o = options_.backbone, before = beforeSolve_](const BackboneProblem& p) {
                  if (before) before("backbone");
                  return solve(p, o);
              },
              mode),
          objectWorker_(
              [o = options_.objects, before = beforeSolve_](const ObjectProblem& p) {
                  if (before) before("objects");
                  return solve(p, o);
              },
              mode) {
        if (options_.keeper.latency_keyframes == 0 || options_.keeper.maxFramesPerKeyframe == 0) {
            throw obs::InputError(
                "section [map_keeper]: latency_keyframes and maxFramesPerKeyframe must be at least "
                "1");
        }
    }

    void addFrame(const obs::CObservationVisualKeyframe& frame,
                  const obs::CObservationDetectedObjects* detections) {
        if (finished_) throw std::logic_error("MapKeeper: a frame after finish()");
        requireGoodFrame(frame, map_);
        const bool keyframe = frame.isKeyframe || map_.keyframes().empty() ||
                              framesSinceKeyframe_ >= options_.keeper.maxFramesPerKeyframe;
        ++statistics_.frames;
        if (keyframe) {
            ++statistics_.keyframes;
            mergeDue();
        }
        {
            const Stopwatch watch(statistics_.stages["insert"]);
            if (keyframe) {
                insertKeyframe(frame);
            } else {
                insertFrame(frame);
            }
        }
        if (detections && options_.objects.enabled) {
            const Stopwatch watch(statistics_.stages["associate"]);
            objectKeeper_.observe(
                map_, frame.frame,
                goodDetections(frame, *detections, options_.association, statistics_), statistics_);
        }
        if (keyframe) issue();
    }

    void finish() {
        if (finished_) return;
        finished_ = true;
        mergeBackbone();
        mergeObjects();
        const Stopwatch watch(statistics_.stages["finish"]);
        if (options_.backbone.enabled) {
            const auto problem =
                backboneProblem(map_, options_.backbone, options_.backbone.finalWindowSize);
            if (!problem.cameras.empty()) apply(solve(problem, options_.backbone), newest());
        }
        // Twice, because a heading may be turned or doubles may show themselves in the first.
        for (int round = 0; round < 2; ++round) {
            const auto problem = objectKeeper_.problem(map_, true);
            if (problem.objects.empty()) break;
            const uint64_t flipped = statistics_.headingsFlipped;
            objectKeeper_.merge(map_, solve(problem, options_.objects), statistics_);
            const bool doubles = objectKeeper_.mergeDoubles(map_, statistics_);
            if (!doubles && flipped == statistics_.headingsFlipped) break;
        }
    }

    const map::SlamMap& map() const { return map_; }
    const BackendStatistics& statistics() const { return statistics_; }
    const BackendOptions& options() const { return options_; }
    map::MapSnapshot snapshot() const {
        if (!snapshot_ || snapshot_->revision() != map_.revision()) {
            snapshot_ = std::make_shared<const map::SlamMap>(map_);
        }
        return snapshot_;
    }

  private:
    KeyframeId newest() const { return map_.lastKeyframe()->id; }

    void insertKeyframe(const obs::CObservationVisualKeyframe& frame) {
        map::Keyframe kf;
        kf.frame = frame.frame;
        kf.stamp = frame.timestamp;
        kf.camera = frame.camera;
        kf.T_vehicle_cam = geometry::fromCPose3D(frame.sensorPose);
        kf.T_odom_cam = frame.T_odom_cam;
        const map::Keyframe* last = map_.lastKeyframe();
        // The world is the vehicle at the first frame.
        kf.T_world_cam =
            last
                ? (last->T_world_cam * (last->T_odom_cam.inverse() * frame.T_odom_cam)).normalised()
                : kf.T_vehicle_cam;
        if (frame.isKeyframe) kf.features = goodFeatures(frame, statistics_);
        const KeyframeId id = map_.addKeyframe(std::move(kf), frame.tracked);
        landmarks_.connect(map_, id, options_.backbone, statistics_);
        framesSinceKeyframe_ = 1;
    }

    void insertFrame(const obs::CObservationVisualKeyframe& frame) {
        const map::Keyframe& last = *map_.lastKeyframe();
        map_.addFrame({frame.frame, frame.timestamp, last.id,
                       last.T_odom_cam.inverse() * frame.T_odom_cam, frame.tracked});
        ++framesSinceKeyframe_;
    }

    /// One job of a kind at a time: the next is issued once its forerunner is merged.
    void issue() {
        const uint64_t due = statistics_.keyframes + options_.keeper.latency_keyframes;
        if (options_.backbone.enabled && backboneWorker_.underWay() == 0) {
            auto problem = backboneProblem(map_, options_.backbone, options_.backbone.windowSize);
            if (!problem.cameras.empty()) {
                backboneDue_ = due;
                backboneIssuedAt_ = newest();
                backboneWorker_.issue(std::move(problem));
            }
        }
        if (options_.objects.enabled && objectWorker_.underWay() == 0) {
            auto problem = objectKeeper_.problem(map_, false);
            if (!problem.objects.empty()) {
                objectsDue_ = due;
                objectWorker_.issue(std::move(problem));
            }
        }
    }

    void mergeDue() {
        const Stopwatch watch(statistics_.stages["merge"]);
        if (backboneDue_ <= statistics_.keyframes) mergeBackbone();
        if (objectsDue_ <= statistics_.keyframes) mergeObjects();
    }

    void mergeBackbone() {
        if (backboneWorker_.underWay() == 0) return;
        apply(backboneWorker_.take(), backboneIssuedAt_);
    }

    void mergeObjects() {
        if (objectWorker_.underWay() == 0) return;
        const auto update = objectWorker_.take();
        statistics_.stages["objects"].add(update.time_ms);
        objectKeeper_.merge(map_, update, statistics_);
        objectKeeper_.mergeDoubles(map_, statistics_);
    }

    /// Writes an update of a problem whose newest keyframe was `issuedAt` into the map. What came
    /// since moves along.
    void apply(const BackboneUpdate& update, KeyframeId issuedAt) {
        statistics_.stages["backbone"].add(update.time_ms);
        ++statistics_.backboneSolves;
        statistics_.lastBackboneStatus = solver::toString(update.report.status);
        statistics_.lastBackboneInitialCost = update.report.initialCost;
        statistics_.lastBackboneFinalCost = update.report.finalCost;
        if (update.cameras.empty()) {
            ++statistics_.backboneFailures;
            return;
        }
        const SE3 before = map_.keyframes().at(issuedAt).T_world_cam;
        for (const auto& [id, T_world_cam] : update.cameras) map_.setKeyframePose(id, T_world_cam);
        carryAlong(map_.keyframes().at(issuedAt).T_world_cam * before.inverse(), issuedAt);
        for (const auto& [id, p_world] : update.points) {
            if (map_.landmarks().count(id) != 0) map_.setLandmarkPosition(id, p_world);
        }
        for (const auto& [landmark, keyframe] : update.outliers) {
            const auto it = map_.landmarks().find(landmark);
            if (it == map_.landmarks().end() || it->second.observations.count(keyframe) == 0) {
                continue;
            }
            map_.removeObservation(landmark, keyframe);
            ++statistics_.outlierObservations;
        }
        for (const auto id : update.culled) {
            if (map_.landmarks().count(id) == 0) continue;
            map_.removeLandmark(id);
            ++statistics_.landmarksCulled;
        }
        objectKeeper_.follow(map_);
    }

    void carryAlong(const SE3& T_new_old, KeyframeId issuedAt) {
        std::vector<KeyframeId> later;
        for (auto it = map_.keyframes().upper_bound(issuedAt); it != map_.keyframes().end(); ++it) {
            later.push_back(it->first);
        }
        std::set<map::LandmarkId> begunLater;
        for (const KeyframeId id : later) {
            const auto& kf = map_.keyframes().at(id);
            for (const auto& l : kf.landmarks) {
                if (l && map_.landmarks().at(*l).observations.begin()->first > issuedAt) {
                    begunLater.insert(*l);
                }
            }
            map_.setKeyframePose(id, (T_new_old * kf.T_world_cam).normalised());
        }
        for (const auto id : begunLater) {
            map_.setLandmarkPosition(id, T_new_old * map_.landmarks().at(id).p_world);
        }
    }

    BackendOptions options_;
    BeforeSolve beforeSolve_;
    map::SlamMap map_;
    LandmarkBuilder landmarks_;
    ObjectKeeper objectKeeper_;
    BackendStatistics statistics_;
    Worker<BackboneProblem, BackboneUpdate> backboneWorker_;
    Worker<ObjectProblem, ObjectUpdate> objectWorker_;
    uint64_t backboneDue_ = 0, objectsDue_ = 0;  // as a count of keyframes
    KeyframeId backboneIssuedAt_;
    unsigned framesSinceKeyframe_ = 0;
    bool finished_ = false;
    mutable map::MapSnapshot snapshot_;
};

MapKeeper::MapKeeper(BackendOptions options, Mode mode, BeforeSolve beforeSolve)
    : impl_(std::make_unique<Impl>(std::move(options), mode, std::move(beforeSolve))) {}
MapKeeper::~MapKeeper() = default;

void MapKeeper::addFrame(const obs::CObservationVisualKeyframe::Ptr& keyframe,
                         const obs::CObservationDetectedObjects::Ptr& detections) {
    if (!keyframe) throw std::logic_error("MapKeeper: addFrame without a frame");
    impl_->addFrame(*keyframe, detections.get());
}
void MapKeeper::finish() { impl_->finish(); }
const map::SlamMap& MapKeeper::map() const { return impl_->map(); }
map::MapSnapshot MapKeeper::snapshot() const { return impl_->snapshot(); }
const BackendStatistics& MapKeeper::statistics() const { return impl_->statistics(); }
const BackendOptions& MapKeeper::options() const { return impl_->options(); }

}  // namespace djpete::backend
