/// The whole line as one object: frames in; trajectory, map and textured objects out.
#pragma once

#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "djpete/background/octo_background.h"
#include "djpete/frontend/visual_odometry.h"
#include "djpete/map/slam_map.h"
#include "djpete/observers/object_observer.h"
#include "djpete/pipeline/frame_prefetcher.h"
#include "djpete/pipeline/options.h"
#include "djpete/pipeline/stage_times.h"
#include "djpete/texture/background_cloud.h"
#include "djpete/texture/exposure.h"
#include "djpete/texture/object_model.h"

namespace djpete::pipeline {

/// What one frame gave.
struct FrameOutcome {
    obs::FrameId frame;  ///< as the drive numbers it
    bool keyframe = false;
    bool tracked = true;
    /// The camera's place in the map's first world is known: false for a drive that goes on from a
    /// map, or that was lost, until a place is known again.
    bool localised = true;
    std::size_t features = 0;                       ///< that odometry holds in this frame
    std::size_t detections = 0;                     ///< objects the observer saw
    obs::CObservationVisualKeyframe::Ptr odometry;  ///< never null
    obs::CObservationDetectedObjects::Ptr
        objectsInFrame;  ///< null if the observer had nothing to say
};

/// Object-level SLAM over one drive. Call process() for each frame in order, then finish() once.
/// Same frames and options give the same map and models, byte for byte, in lockstep and threaded
/// mode. One thread calls; worker threads live inside and end with finish() or the destructor.
class ObjectSlam {
  public:
    /// `observer` says which objects a frame shows; null means none. Throws obs::InputError if an
    /// option is out of range.
    ObjectSlam(const ObjectSlamOptions& options,
               std::unique_ptr<observers::ObjectObserver> observer);
    ~ObjectSlam();
    ObjectSlam(const ObjectSlam&) = delete;
    ObjectSlam& operator=(const ObjectSlam&) = delete;

    /// The rig's main camera, for drives without images (call before process()).
    void setRig(const obs::RigCamera& camera);

    /// Goes on from the map of an earlier drive (call before process()). This drive is a world of
    /// its own until its place is known again; then both become one, and objects seen in both are
    /// joined. With `localiseOnly` the poses of `base` stay as they are.
    void continueFrom(map::SlamMap base, bool localiseOnly);
    /// The number that a frame of this drive has in map(): the same, unless the map was continued.
    obs::FrameId frameInMap(obs::FrameId frame) const;

    /// Odometry comes, in this order of preference, from a recorded keyframe observation in the
    /// frame, from its images (and scan), or, in a drive without images, from its ground-truth
    /// poses. Throws obs::InputError naming the frame if there is none of them or if one cannot be
    /// used; everything before that frame is kept, and finish() may still be called.
    FrameOutcome process(const LoadedFrame& frame);

    /// Waits for the workers, runs the last optimisation and textures the last views.
    void finish();

    const map::SlamMap& map() const;
    /// Places known again, in the order in which they were believed.
    const std::vector<map::LoopRecord>& loops() const;
    /// A copy that stays as it is while processing goes on.
    map::MapSnapshot snapshot() const;
    const std::map<map::ObjectId, texture::ObjectModel>& models() const;
    /// How brightly the images of keyframes were taken, as the street and the objects tell.
    const std::map<obs::FrameId, texture::Exposure>& exposures() const;
    /// Coloured points of what is not an object, in `world`; empty if switched off. Of the octree
    /// the voxels' centres, after finish().
    std::vector<texture::ColouredPoint> background() const;
    /// The octree of what is not an object; null before finish() and if switched off.
    const background::OctoBackground* octomap() const;
    /// Per-stage wall times so far, all threads.
    StageTable timings() const;
    /// Counters worth reporting (rejected detections, solves, ...), name to value.
    std::map<std::string, uint64_t> counters() const;

  private:
    struct Impl;
    std::unique_ptr<Impl> impl_;
};

}  // namespace djpete::pipeline
