/// The sole owner of the map.
#pragma once

#include <mrpt/config/CLoadableOptions.h>

#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "djpete/backend/association.h"
#include "djpete/backend/backbone.h"
#include "djpete/backend/joint.h"
#include "djpete/backend/loops.h"
#include "djpete/backend/objects.h"
#include "djpete/backend/statistics.h"
#include "djpete/backend/worker.h"
#include "djpete/map/slam_map.h"
#include "djpete/obs/CObservationDetectedObjects.h"
#include "djpete/obs/CObservationVisualKeyframe.h"

namespace djpete::backend {

struct KeeperOptions : public mrpt::config::CLoadableOptions {
    /// A job issued at keyframe k is merged just before keyframe k + latency, never earlier.
    unsigned latency_keyframes = 1;
    /// A drive that has gone this many frames without a keyframe gets one without features, so that
    /// objects keep an anchor nearby and jobs are merged.
    unsigned maxFramesPerKeyframe = 15;

    void loadFromConfigFile(const mrpt::config::CConfigFileBase& source,
                            const std::string& section) override;
    void saveToConfigFile(mrpt::config::CConfigFileBase& target,
                          const std::string& section) const override;
};

/// All options of the back end; sections [map_keeper], [backbone], [loops], [places],
/// [place_match], [association], [objects], [joint].
struct BackendOptions {
    KeeperOptions keeper;
    BackboneOptions backbone;
    RecognitionOptions recognition;
    AssociationOptions association;
    ObjectOptions objects;
    JointOptions joint;

    /// Loads the sections that exist. Throws obs::InputError naming `origin` on an unknown key.
    void load(const mrpt::config::CConfigFileBase& config, const std::string& origin);
    void save(mrpt::config::CConfigFileBase& config) const;
};

/// Turns keyframes and detections into the map. One thread calls it; the workers' threads are its
/// own. Equal input gives equal bytes, lockstep or threaded, whatever the scheduler does; the
/// cameras are the same with and without objects, unless objects are in joint mode.
class MapKeeper {
  public:
    /// Called on the worker's side before each solve ("backbone", "objects", "places",
    /// "full adjustment"); tests inject delays.
    using BeforeSolve = std::function<void(const char* worker)>;

    explicit MapKeeper(BackendOptions options, Mode mode, BeforeSolve beforeSolve = {});
    ~MapKeeper();
    MapKeeper(const MapKeeper&) = delete;
    MapKeeper& operator=(const MapKeeper&) = delete;

    /// Goes on from a map of an earlier drive; call it before the first frame. This drive begins a
    /// world of its own, until its place is known again in `base`. With `localiseOnly` the poses of
    /// `base` stay as they are. Frame numbers of this drive must lie above those of `base`; its
    /// stamps need not.
    void continueFrom(map::SlamMap base, bool localiseOnly);
    /// The next frame, and what was detected in it (may be null). Frame numbers and stamps must
    /// rise; throws obs::InputError naming the frame if not, if the camera is not a camera, or if
    /// the pose is not finite; the map is then as before. Broken features and detections are left
    /// out and counted in statistics().rejected.
    /// Throws what a worker threw, at the point where its result was due.
    void addFrame(const obs::CObservationVisualKeyframe::Ptr& keyframe,
                  const obs::CObservationDetectedObjects::Ptr& detections);
    /// Merges what is under way, then solves backbone and objects once more over everything.
    /// Further frames throw std::logic_error.
    void finish();

    const map::SlamMap& map() const;
    /// An immutable copy; the same one as long as the map does not change.
    map::MapSnapshot snapshot() const;
    const BackendStatistics& statistics() const;
    /// The pairs of views that closed loops, joined worlds or were matched along the way.
    const std::vector<map::LoopRecord>& loops() const;
    /// Objects that turned out to be another one and went into it; that one may have gone into a
    /// third.
    const std::map<map::ObjectId, map::ObjectId>& joinedObjects() const;
    const BackendOptions& options() const;

  private:
    class Impl;
    std::unique_ptr<Impl> impl_;
};

}  // namespace djpete::backend
