/// Objects become coloured points, view by view.
#pragma once

#include <cstdint>
#include <map>
#include <memory>

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

/// Builds the models of all objects. One thread; the same views in the same order give the same
/// bytes.
///
/// Geometry comes from the scan's points inside the object's box, or, in a view without a scan,
/// from dense stereo on the object's part of the images. Colour is taken for a point only if it
/// faces the camera, is in the eroded mask (if there is one), and nothing hides it: not the
/// object's own surface, not the scene's points, not the box of another object.
class ObjectTexturer {
  public:
    explicit ObjectTexturer(const TextureOptions& options = TextureOptions());
    ~ObjectTexturer();
    ObjectTexturer(ObjectTexturer&&) noexcept;
    ObjectTexturer& operator=(ObjectTexturer&&) noexcept;

    /// Throws obs::InputError, naming the frame, on an image that does not fit its camera, a mask
    /// that does not fit the image, or an object twice.
    ViewReport addView(const TextureView& view);

    /// Valid until the next change; clone() what must outlive it.
    const std::map<map::ObjectId, ObjectModel>& models() const;

    /// Forgets an object; nothing happens if there is none.
    void removeObject(map::ObjectId object);
    /// Moves the points and colours of `from` into `into` when both turned out to be one object;
    /// `into` need not exist.
    void mergeObjects(map::ObjectId into, map::ObjectId from, const geometry::SE3& T_into_from);

  private:
    struct Impl;
    std::unique_ptr<Impl> impl_;
};

}  // namespace djpete::texture
