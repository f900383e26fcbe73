#include "djpete/backend/map_keeper.h"

#include <algorithm>
#include <chrono>
#include <deque>
#include <stdexcept>
#include <utility>

#include "backbone_merge.h"
#include "djpete/geometry/mrpt_bridge.h"
#include "djpete/obs/errors.h"
#include "input_check.h"
#include "landmark_builder.h"
#include "loop_keeper.h"
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
          objectKeeper_(options_.association, options_.objects),
          loopKeeper_(options_.recognition.loops),
          finder_(std::make_shared<LoopFinder>(options_.recognition)),
          backboneWorker_(
              [o = options_.backbone, j = options_.joint,
               before = beforeSolve_](const BackboneProblem& p) {
                  if (before) before("backbone");
                  return solve(p, o, j);
              },
              mode),
          objectWorker_(
              [o = options_.objects, before = beforeSolve_](const ObjectProblem& p) {
                  if (before) before("objects");
                  return solve(p, o);
              },
              mode),
          loopWorker_(
              [finder = finder_, before = beforeSolve_](const LoopJob& job) {
                  if (before) before("places");
                  return finder->find(job);
              },
              mode),
          fullWorker_(
              [o = options_.backbone, j = options_.joint,
               before = beforeSolve_](const BackboneProblem& p) {
                  if (before) before("full adjustment");
                  return solve(p, o, j);
              },
              mode) {
        if (options_.keeper.latency_keyframes == 0 || options_.keeper.maxFramesPerKeyframe == 0) {
            throw obs::InputError(
                "section [map_keeper]: latency_keyframes and maxFramesPerKeyframe must be at least "
                "1");
        }
    }

    void continueFrom(map::SlamMap base, bool localiseOnly) {
        if (!map_.frames().empty()) throw std::logic_error("MapKeeper: a base after a frame");
        base.check();
        map_ = std::move(base);
        if (map_.keyframes().empty()) return;
        for (const auto& [id, kf] : map_.keyframes()) finder_->add(places::placeView(kf));
        firstOwn_ = KeyframeId{newest().value + 1};
        if (localiseOnly) firstFree_ = firstOwn_;
        landmarks_.startAt(firstOwn_);
        objectKeeper_.adopt(map_);
    }

    void addFrame(const obs::CObservationVisualKeyframe& frame,
                  const obs::CObservationDetectedObjects* detections) {
        if (finished_) throw std::logic_error("MapKeeper: a frame after finish()");
        requireGoodFrame(frame, map_, firstOfDrive());
        const bool keyframe = frame.isKeyframe || firstOfDrive() ||
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
        if (detections && options_.objects.mode != ObjectMode::Off) {
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
        mergeFull();
        mergeLoops();
        mergeObjects();
        const Stopwatch watch(statistics_.stages["finish"]);
        if (options_.backbone.enabled && !map_.keyframes().empty()) {
            const bool all = statistics_.loopsClosed + statistics_.worldsJoined > 0 &&
                             firstFree_ == KeyframeId{0};
            const unsigned window =
                all ? unsigned(map_.keyframes().size()) : options_.backbone.finalWindowSize;
            const auto problem = windowProblem(window);
            if (!problem.cameras.empty())
                apply(solve(problem, options_.backbone, options_.joint), newest());
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
    const std::vector<map::LoopRecord>& loops() const { return loopKeeper_.records(); }
    const std::map<map::ObjectId, map::ObjectId>& joinedObjects() const {
        return objectKeeper_.joined();
    }
    map::MapSnapshot snapshot() const {
        if (!snapshot_ || snapshot_->revision() != map_.revision()) {
            snapshot_ = std::make_shared<const map::SlamMap>(map_);
        }
        return snapshot_;
    }

  private:
    KeyframeId newest() const { return map_.lastKeyframe()->id; }

    bool firstOfDrive() const { return map_.keyframes().empty() || newest() < firstOwn_; }
    /// Odometry broke off and began anew: where it is now must be found out.
    bool begunAnew(const obs::CObservationVisualKeyframe& frame) const {
        if (frame.tracked || !frame.isKeyframe || !options_.recognition.loops.enabled) return false;
        return std::any_of(frame.features.begin(), frame.features.end(),
                           [](const auto& f) { return f.descriptor.has_value(); });
    }

    void insertKeyframe(const obs::CObservationVisualKeyframe& frame) {
        map::Keyframe kf;
        kf.frame = frame.frame;
        kf.stamp = frame.timestamp;
        kf.camera = frame.camera;
        kf.T_vehicle_cam = geometry::fromCPose3D(frame.sensorPose);
        kf.T_odom_cam = frame.T_odom_cam;
        // The world is the vehicle at the first frame.
        kf.T_world_cam = kf.T_vehicle_cam;
        if (const map::Keyframe* last = map_.lastKeyframe()) {
            const bool fresh = firstOfDrive() || begunAnew(frame);
            kf.segment = last->segment + (fresh ? 1 : 0);
            kf.world = fresh ? kf.segment : last->world;
            if (!firstOfDrive()) {
                const SE3 T_last_cam = last->T_odom_cam.inverse() * frame.T_odom_cam;
                kf.T_world_cam = (last->T_world_cam * T_last_cam).normalised();
            }
        }
        if (frame.isKeyframe) kf.features = goodFeatures(frame, statistics_);
        kf.scanMotion = frame.scanMotion;
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

    /// Cameras and points around the newest keyframe, and in joint mode objects.
    BackboneProblem windowProblem(unsigned size) const {
        auto problem = backboneProblem(map_, options_.backbone, size, firstFree_);
        if (options_.objects.mode == ObjectMode::Joint)
            addObjects(map_, objectKeeper_.solved(), options_.joint, problem);
        return problem;
    }

    /// One job of a kind at a time: the next is issued once its forerunner is merged.
    void issue() {
        if (loopWorker_.underWay() == decltype(loopWorker_)::kCapacity) mergeLoop();
        const uint64_t due = statistics_.keyframes + options_.keeper.latency_keyframes;
        if (options_.backbone.enabled && backboneWorker_.underWay() == 0) {
            auto problem = windowProblem(options_.backbone.windowSize);
            if (!problem.cameras.empty()) {
                backboneDue_ = due;
                backboneIssuedAt_ = newest();
                backboneBends_ = bends_;
                backboneWorker_.issue(std::move(problem));
            }
        }
        if (options_.objects.mode != ObjectMode::Off && objectWorker_.underWay() == 0) {
            auto problem = objectKeeper_.problem(map_, false);
            if (!problem.objects.empty()) {
                objectsDue_ = due;
                objectWorker_.issue(std::move(problem));
            }
        }
        const auto& loops = options_.recognition.loops;
        if (loops.enabled && !map_.lastKeyframe()->features.empty()) {
            loopsDue_.push_back(due);
            loopWorker_.issue(loopJob(map_, newest(), loopKeeper_.claimed(), loops));
        }
    }

    void mergeDue() {
        const Stopwatch watch(statistics_.stages["merge"]);
        if (backboneDue_ <= statistics_.keyframes) mergeBackbone();
        if (fullDue_ <= statistics_.keyframes) mergeFull();
        while (!loopsDue_.empty() && loopsDue_.front() <= statistics_.keyframes) mergeLoop();
        if (objectsDue_ <= statistics_.keyframes) mergeObjects();
    }

    void mergeBackbone() {
        if (backboneWorker_.underWay() == 0) return;
        const auto update = backboneWorker_.take();
        statistics_.stages["backbone"].add(update.time_ms);
        ++statistics_.backboneSolves;
        statistics_.lastBackboneStatus = solver::toString(update.report.status);
        statistics_.lastBackboneInitialCost = update.report.initialCost;
        statistics_.lastBackboneFinalCost = update.report.finalCost;
        if (update.cameras.empty()) ++statistics_.backboneFailures;
        // A map bent meanwhile has no place for poses from before.
        if (backboneBends_ == bends_) apply(update, backboneIssuedAt_);
    }

    void mergeFull() {
        if (fullWorker_.underWay() == 0) return;
        const auto update = fullWorker_.take();
        statistics_.stages["full adjustment"].add(update.time_ms);
        ++statistics_.fullAdjustments;
        apply(update, fullIssuedAt_);
        ++bends_;
        objectKeeper_.solveAgain(map_);
    }

    void mergeLoops() {
        while (!loopsDue_.empty()) mergeLoop();
    }

    void mergeLoop() {
        loopsDue_.pop_front();
        const auto update = loopWorker_.take();
        statistics_.stages["places"].add(update.time_ms);
        const auto outcome = loopKeeper_.merge(map_, update, firstFree_, landmarks_, statistics_);
        if (!outcome.moved) return;
        ++bends_;
        objectKeeper_.follow(map_);
        objectKeeper_.solveAgain(map_);
        const auto& loops = options_.recognition.loops;
        if (finished_ || !options_.backbone.enabled || !loops.fullAdjustment ||
            firstFree_ > KeyframeId{0})
            return;
        if (fullWorker_.underWay() > 0) fullWorker_.take();  // of the map before
        fullDue_ = statistics_.keyframes + loops.fullLatency_keyframes;
        fullIssuedAt_ = newest();
        fullWorker_.issue(windowProblem(unsigned(map_.keyframes().size())));
    }

    void mergeObjects() {
        if (objectWorker_.underWay() == 0) return;
        const auto update = objectWorker_.take();
        statistics_.stages["objects"].add(update.time_ms);
        objectKeeper_.merge(map_, update, statistics_);
        objectKeeper_.mergeDoubles(map_, statistics_);
    }

    void apply(const BackboneUpdate& update, KeyframeId issuedAt) {
        if (update.joint != JointOutcome::None) ++statistics_.jointSolves;
        if (update.joint == JointOutcome::Accepted) ++statistics_.jointAccepted;
        if (update.cameras.empty()) return;
        mergeUpdate(map_, update, issuedAt, statistics_);
        objectKeeper_.follow(map_);
    }

    BackendOptions options_;
    BeforeSolve beforeSolve_;
    map::SlamMap map_;
    LandmarkBuilder landmarks_;
    ObjectKeeper objectKeeper_;
    LoopKeeper loopKeeper_;
    std::shared_ptr<LoopFinder> finder_;  // of loopWorker_ once the first job is issued
    BackendStatistics statistics_;
    Worker<BackboneProblem, BackboneUpdate> backboneWorker_;
    Worker<ObjectProblem, ObjectUpdate> objectWorker_;
    Worker<LoopJob, LoopUpdate> loopWorker_;
    Worker<BackboneProblem, BackboneUpdate> fullWorker_;
    uint64_t backboneDue_ = 0, objectsDue_ = 0, fullDue_ = 0;  // as a count of keyframes
    std::deque<uint64_t> loopsDue_;
    KeyframeId backboneIssuedAt_, fullIssuedAt_;
    KeyframeId firstOwn_;         // the first keyframe of this drive
    KeyframeId firstFree_;        // older ones never move
    uint64_t bends_ = 0;          // times the whole map was moved
    uint64_t backboneBends_ = 0;  // ... when the job under way was issued
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
const std::vector<map::LoopRecord>& MapKeeper::loops() const { return impl_->loops(); }
const std::map<map::ObjectId, map::ObjectId>& MapKeeper::joinedObjects() const {
    return impl_->joinedObjects();
}
void MapKeeper::continueFrom(map::SlamMap base, bool localiseOnly) {
    impl_->continueFrom(std::move(base), localiseOnly);
}
const BackendOptions& MapKeeper::options() const { return impl_->options(); }

}  // namespace djpete::backend
