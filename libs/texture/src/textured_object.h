/// One object: its growing model, the views kept of it, and the colours they give. Private.
#pragma once

#include <functional>
#include <map>
#include <optional>
#include <vector>

#include "djpete/texture/exposure.h"
#include "djpete/texture/options.h"
#include "growing_model.h"
#include "kept_view.h"

namespace djpete::texture {

using ExposureMap = std::map<obs::FrameId, Exposure>;

class TexturedObject {
  public:
    /// `model` must be new and outlive this.
    TexturedObject(ObjectModel& model, const TextureOptions& options);

    /// Adds points that the frame saw, at most up to `maxPoints` in all; returns how many.
    std::size_t insert(std::vector<SurfacePoint> points, obs::FrameId frame,
                       const geometry::SE3& T_cam_obj, std::size_t maxPoints);
    /// Keeps the view (in place of one of the same frame); colours stay as they are. Views that
    /// coloured nothing are let go. Returns how many samples there are.
    std::size_t addView(KeptView view);
    /// Lets the views go that add least, until `most` are left.
    void keepBest(std::size_t most);

    /// What `frame` shows of points that other views show too.
    void collect(obs::FrameId frame, const ExposureMap& exposures, ExposureSamples& out) const;
    /// The ratios of brightness between views.
    void collect(std::vector<ExposurePair>& out) const;

    /// Colours the points that `frame` shows, or all, from all kept views.
    void recolour(const ExposureMap& exposures, std::optional<obs::FrameId> frame = std::nullopt);
    /// Points that views show to be nothing go, the others move onto the surface that they make
    /// together, and gaps between them are filled, up to `maxPoints` in all. Colours are to be made
    /// anew with resample() and recolour(). Nothing happens if no points came since the last time.
    void refine(std::size_t maxPoints);
    /// Takes all samples again, if points came or moved since.
    void resample();
    /// Lets memory go that only further points need.
    void shrink() { grower_.shrink(); }
    /// True if a pose of a view is farther from T_cam_obj(frame) than the thresholds (with `exact`:
    /// than a tenth of a millimetre or a thousandth of a degree). Then points
    /// and views have followed, and colours are to be made anew with resample() and recolour().
    bool follow(const std::function<std::optional<geometry::SE3>(obs::FrameId)>& T_cam_obj,
                bool exact);
    /// Takes over points and views of what turned out to be the same object.
    void absorb(const TexturedObject& other, const geometry::SE3& T_this_other,
                std::size_t maxPoints);

    const std::vector<KeptView>& views() const { return views_; }
    std::size_t viewBytes() const;
    ObjectModel& model() { return grower_.model(); }
    const ObjectModel& model() const { return grower_.model(); }

  private:
    /// A frame that gave points, and where the object stood in it then.
    struct Source {
        obs::FrameId frame;
        geometry::SE3 T_cam_obj;
    };
    std::optional<std::size_t> indexOf(obs::FrameId frame) const;
    std::vector<float> sharpnessFactors() const;
    /// Parallel to the views.
    std::vector<ToCommonScale> toCommonScale(const ExposureMap& exposures) const;
    void eraseView(std::size_t index);
    void nameViews();

    TextureOptions options_;
    GrowingModel grower_;
    std::vector<Source> sources_;
    std::vector<KeptView> views_;  ///< by frame
    bool sampled_ = true;          ///< all views sampled all points
    bool refined_ = true;          ///< no points came since
    bool allStale_ = false;        ///< a view went whose colours are still in the points
};

}  // namespace djpete::texture
