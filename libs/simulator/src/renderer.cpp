#include "development.h"
#include "exposure_swing.h"
#include "noise.h"
#include "painter.h"
#include "parallel.h"
#include "processor.h"
#include "renderer_impl.h"

namespace djpete::simulator {

using geometry::SE3;

namespace {

/// Size of the picture from which the exposure is found.
constexpr int kPreviewWidth_px = 32, kPreviewHeight_px = 16;

void prepare(RenderedImage& image, const geometry::StereoCamera& camera) {
    image.width_px = camera.width_px;
    image.height_px = camera.height_px;
    const auto n =
        static_cast<std::size_t>(camera.width_px) * static_cast<std::size_t>(camera.height_px);
    image.rgb.resize(n);
    image.actorId.resize(n);
    image.depth_m.resize(n);
}

}  // namespace

double Renderer::Impl::brightness(uint64_t frame) {
    const auto known = brightnessAt.find(frame);
    if (known != brightnessAt.end()) return known->second;
    setFrame(frame);
    const auto camera = rigCamera(kPreviewWidth_px, kPreviewHeight_px);
    const View view(camera, scene.world().T_world_vehicle(frame) * T_vehicle_camera());
    RenderedImage preview;
    prepare(preview, camera);
    std::vector<Look> seen(preview.depth_m.size());
    const Painter painter(scene);
    for (int pair = 0; 2 * pair < camera.height_px; ++pair)
        painter.lookAlongRows(pair, view, seen, preview);
    std::vector<Vec3f> light;
    for (const auto& look : seen) light.push_back(look.colour);
    return brightnessAt[frame] = brightnessOf(light);
}

Exposure Renderer::Impl::exposure(uint64_t frame) {
    const double wanted = automaticExposure(frame);
    return withTotal(cameraModel, wanted * exposureSwing(scene.world().driveSeed(), frame,
                                                         cameraModel.exposureSwing));
}

double Renderer::Impl::automaticExposure(uint64_t frame) {
    if (!cameraModel.autoExposure) return 1;
    const auto memory = static_cast<uint64_t>(std::max(1, cameraModel.memory_frames));
    // What the camera saw before this frame; the first frames repeat the first one.
    double sum = 0;
    for (uint64_t back = memory; back >= 1; --back)
        sum += brightness(frame - std::min(frame, back));
    brightnessAt.erase(brightnessAt.begin(),
                       brightnessAt.lower_bound(frame - std::min(frame, memory)));
    return exposureFor(cameraModel, sum / static_cast<double>(memory));
}

Renderer::Renderer(const World& world, unsigned threads, const CameraModel& cameraModel)
    : impl_((requireAvx2(), std::make_unique<Impl>(world, threads, cameraModel))) {}
Renderer::~Renderer() = default;
unsigned Renderer::threads() const { return impl_->threads; }

RenderedImage Renderer::renderCamera(uint64_t frame, const geometry::StereoCamera& camera,
                                     const SE3& T_vehicle_cam, uint32_t noise_seed) {
    const CameraModel& model = impl_->cameraModel;
    Exposure exposure = impl_->exposure(frame);
    if (noise_seed != 0) exposure.gain *= model.rightGain;
    impl_->setFrame(frame);
    if (model.autoExposure) impl_->brightness(frame);  // while the scene is at this frame
    const World& world = impl_->scene.world();
    RenderedImage out;
    prepare(out, camera);
    out.exposure = exposure.total();
    const SE3 T_world_cam = world.T_world_vehicle(frame) * T_vehicle_cam;
    const View view(camera, T_world_cam);
    const unsigned threads = impl_->threads;
    auto& looks = impl_->looks;
    auto& colours = impl_->colours;
    looks.resize(out.depth_m.size());
    colours.resize(out.depth_m.size());
    const Painter painter(impl_->scene);
    parallelFor((camera.height_px + 1) / 2, threads,
                [&](int pair) { painter.lookAlongRows(pair, view, looks, out); });
    const Development development(
        model, exposure, camera, hash(world.driveSeed(), static_cast<uint32_t>(frame), noise_seed));
    const double open = model.shutterShare * exposure.shutter;  // share of the period
    const bool blurred = open > 0 || model.blur_px > 0;
    parallelFor(camera.height_px, threads, [&](int v) {
        painter.smoothEdgesOfRow(v, view, looks, colours);
        if (!blurred) development.developRow(v, colours, out);
    });
    if (!blurred) return out;
    if (open > 0) {
        const SE3 T_next_cam =
            (world.T_world_vehicle(frame + 1) * T_vehicle_cam).inverse() * T_world_cam;
        blurByMotion(camera, SE3::exp(open * T_next_cam.log()), out.depth_m, threads, colours);
    }
    if (model.blur_px > 0)
        blurLight(static_cast<float>(model.blur_px), camera.width_px, camera.height_px, threads,
                  colours);
    parallelFor(camera.height_px, threads, [&](int v) { development.developRow(v, colours, out); });
    return out;
}

}  // namespace djpete::simulator
