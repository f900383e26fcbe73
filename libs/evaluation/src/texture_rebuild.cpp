#include "djpete/evaluation/texture_rebuild.h"

#include "djpete/obs/rawlog_source.h"

namespace djpete::evaluation {

namespace {

using geometry::SE3;

std::vector<texture::ObjectInView> objectsInView(const EstimatedDrive& drive, std::size_t frame,
                                                 const SE3& T_world_cam, double range_m) {
    std::vector<texture::ObjectInView> out;
    const SE3 T_cam_world = T_world_cam.inverse();
    for (const auto& [id, object] : drive.objects) {
        const auto T_world_obj = drive.T_world_obj(id, frame);
        if (!T_world_obj) continue;
        const geometry::Vec3 p_cam = T_cam_world * T_world_obj->translation();
        const bool seen = object.T_world_obj.count(frame) > 0;
        if (p_cam.norm() > range_m || (!seen && (object.moving || p_cam.z() < 0))) continue;
        texture::ObjectInView view;
        view.id = map::ObjectId{static_cast<uint64_t>(id)};
        view.objectClass = object.objectClass;
        view.size_m = object.size_m;
        view.T_world_obj = *T_world_obj;
        out.push_back(view);
    }
    return out;
}

}  // namespace

texture::ObjectTexturer rebuildTextures(const EstimatedDrive& drive, const std::string& rawlog,
                                        const RebuildOptions& options, const AfterView& afterView) {
    texture::ObjectTexturer texturer(options.texture);
    obs::RawlogSource source(rawlog);
    while (const auto frame = source.next()) {
        const std::size_t number = frame->id.value;
        if (drive.keyframes.count(number) == 0 || !drive.cameras.contains(number)) continue;
        const auto images = frame->loadTextureImages();
        const auto mainImages = frame->loadMainImages();
        if (!images || !mainImages) continue;
        texture::TextureView view;
        view.frame = frame->id;
        view.images = *images;
        view.T_world_vehicle =
            drive.cameras.at(number) * mainImages->camera.T_vehicle_cam.inverse();
        view.T_world_cam = view.T_world_vehicle * images->camera.T_vehicle_cam;
        view.scan = frame->loadScan();
        view.objects = objectsInView(drive, number, view.T_world_cam, options.range_m);
        if (!view.objects.empty()) texturer.addView(view);
        if (afterView) afterView(number, texturer);
        frame->unload();
    }
    texturer.settle();
    return texturer;
}

}  // namespace djpete::evaluation
