/// Which points of a view lie on which object, and what may hide them. Private: brings OpenCV.
#pragma once

#include <opencv2/core.hpp>
#include <vector>

#include "depth_map.h"
#include "djpete/texture/options.h"
#include "growing_model.h"
#include "view_image.h"

namespace djpete::texture {

struct ViewGeometry {
    explicit ViewGeometry(const TextureView& view, const ViewImage& image);

    std::vector<std::vector<SurfacePoint>> onObject;  ///< parallel to view.objects
    DepthMap scene;  ///< of points that are on no object, over the whole image
};

/// The scan's points. A point is of the object whose centre is nearest, among the boxes (grown by
/// the margin) that hold it; points near a box's bottom are road and of nobody. With a mask
/// (parallel to view.objects, empty if there is none) a point that the image shows outside it is
/// dropped.
ViewGeometry geometryFromScan(const TextureView& view, const ViewImage& image,
                              const std::vector<cv::Mat>& grownMasks,
                              const TextureOptions& options);

/// The same from dense stereo on the part of the image that each object covers. Without a right
/// image there are no points.
ViewGeometry geometryFromStereo(const TextureView& view, const ViewImage& image,
                                const std::vector<cv::Mat>& erodedMasks,
                                const TextureOptions& options);

/// Notes where the scan's rays passed through the object's box and where they ended in it.
void carveFreeSpace(const TextureView& view, const ObjectInView& object, FreeSpace& space);

/// Part of the image that the box covers, grown by `border_px`; empty if it is not wholly in
/// front of the camera.
PixelRect rectOfBox(const geometry::StereoCamera& camera, const geometry::SE3& T_cam_obj,
                    const geometry::Vec3& size_m, int border_px);

}  // namespace djpete::texture
