/// Keyframes wait here until their poses have settled; then they colour the objects.
#pragma once

#include <deque>

#include "djpete/map/slam_map.h"
#include "djpete/obs/sensor_frame.h"
#include "djpete/pipeline/options.h"
#include "djpete/pipeline/stage_times.h"
#include "djpete/texture/background_cloud.h"
#include "djpete/texture/object_texturer.h"

namespace djpete::pipeline {

/// Feeds ObjectTexturer and BackgroundCloud with views, a fixed number of keyframes late, so that
/// the result depends on the frames only and not on thread timing.
class TextureQueue {
  public:
    explicit TextureQueue(const ObjectSlamOptions& options);

    /// A keyframe with its images and scan; they are let go once the view was used.
    void push(const obs::SensorFrame& keyframe);
    /// Textures the views that are old enough (all of them if `all`) with the poses of `map`.
    void process(const map::SlamMap& map, bool all, StageTable& times);
    /// After the last view and the last change of the map: textures follow the poses, those of
    /// objects that went into others (`joined`) go with them, those of objects that `map` no longer
    /// holds are forgotten, and all kept views are weighed once more.
    void finish(const map::SlamMap& map, const std::map<map::ObjectId, map::ObjectId>& joined,
                unsigned threads);

    const std::map<map::ObjectId, texture::ObjectModel>& models() const {
        return texturer_.models();
    }
    const std::map<obs::FrameId, texture::Exposure>& exposures() const {
        return texturer_.exposures();
    }
    const texture::BackgroundCloud& background() const { return background_; }

  private:
    void processView(const obs::SensorFrame& frame, const map::SlamMap& map, StageTable& times);
    /// Where the texture camera of an earlier view stands to the object by `map`.
    texture::ObjectTexturer::PoseOf posesOf(const map::SlamMap& map, map::ObjectId object) const;

    PipelineOptions options_;
    std::map<obs::FrameId, geometry::SE3> T_main_texture_;  ///< cameras of the views so far
    texture::ObjectTexturer texturer_;
    texture::BackgroundCloud background_;
    std::deque<obs::SensorFrame> waiting_;
};

/// T_cam_obj of the main camera, from the poses of both. A standing object has one pose for all
/// views: what single frames show of it (ObjectTrack::views) is noisier than cameras drift while
/// it is in sight.
std::optional<geometry::SE3> mainCameraToObject(const map::SlamMap& map, map::ObjectId object,
                                                obs::FrameId frame);

/// The objects of `map` that can be seen at `frame` within `range_m`: those observed in it (with
/// their masks if `T_vehicle_cam` is the camera that masks are made for, `T_vehicle_main`), and
/// static ones that are in front of the camera.
std::vector<texture::ObjectInView> objectsInView(const map::SlamMap& map, obs::FrameId frame,
                                                 const geometry::SE3& T_world_cam, bool masksFit,
                                                 double range_m);

}  // namespace djpete::pipeline
