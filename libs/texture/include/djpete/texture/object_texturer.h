/// Objects become coloured points, view by view.
#pragma once

#include <cstdint>
#include <functional>
#include <map>
#include <memory>
#include <optional>

#include "djpete/texture/exposure.h"
#include "djpete/texture/object_model.h"
#include "djpete/texture/options.h"
#include "djpete/texture/texture_view.h"

namespace djpete::texture {

/// What one view changed.
struct ViewReport {
    uint64_t pointsAdded = 0;
    uint64_t pointsProjected = 0;  ///< points tested against the image
    uint64_t pointsColoured = 0;   ///< colour samples taken
};

/// Builds the models of all objects. The same views in the same order give the same bytes.
///
/// Geometry comes from the scan's points inside the object's box, or, in a view without a scan,
/// from dense stereo on the object's part of the images. Colour is taken for a point only if it
/// faces the camera, is in the eroded mask (if there is one), and nothing hides it: not the
/// object's own surface, not the scene's points, not the box of another object.
///
/// Of every view the object's part of the image is kept, so that the colour of a point is at any
/// time a robust mean over all kept views, on a common scale of exposures, and can be made anew
/// when poses change.
class ObjectTexturer {
  public:
    /// Throws obs::InputError if camera_gamma is not within 0.3 to 3.
    explicit ObjectTexturer(const TextureOptions& options = TextureOptions());
    ~ObjectTexturer();
    ObjectTexturer(ObjectTexturer&&) noexcept;
    ObjectTexturer& operator=(ObjectTexturer&&) noexcept;

    /// Throws obs::InputError, naming the frame, on an image that does not fit its camera, a mask
    /// that does not fit the image, or an object twice.
    ViewReport addView(const TextureView& view);

    /// Valid until the next change; clone() what must outlive it.
    const std::map<map::ObjectId, ObjectModel>& models() const;

    /// Where the texture camera stood to an object in a frame, T_cam_obj, as known now; nothing if
    /// unknown.
    using PoseOf = std::function<std::optional<geometry::SE3>(obs::FrameId)>;
    /// After poses changed: if one of the object's views moved by more than the thresholds (with
    /// `exact`: at all), its points move with the views that gave them and all colours are taken
    /// again. Returns whether.
    bool follow(map::ObjectId object, const PoseOf& T_cam_obj, bool exact = false);
    /// What is known of the object's size now; nothing happens if there is no such object.
    void setSize(map::ObjectId object, const geometry::Vec3& size_m);
    /// Makes the best of all kept views, meant for the end of a drive: points that came late take
    /// colours from early views, exposures are solved from all images at once. No influence of
    /// `threads` on the result.
    void settle(unsigned threads = 1);
    /// Of the images so far; empty with `exposure = false`.
    const std::map<obs::FrameId, Exposure>& exposures() const;
    /// Memory of the kept views of all objects.
    std::size_t viewBytes() const;

    /// Forgets an object; nothing happens if there is none.
    void removeObject(map::ObjectId object);
    /// Moves the points and views of `from` into `into` when both turned out to be one object;
    /// `into` need not exist.
    void mergeObjects(map::ObjectId into, map::ObjectId from, const geometry::SE3& T_into_from);
    /// The same by where `into` is known to stand in the views of `from`; without such a view the
    /// models of `from` are let go.
    void mergeObjects(map::ObjectId into, map::ObjectId from, const PoseOf& T_cam_into);

  private:
    struct Impl;
    std::unique_ptr<Impl> impl_;
};

}  // namespace djpete::texture
