#include "run_result.h"

#include <algorithm>
#include <filesystem>
#include <set>

#include "canvas.h"
#include "djpete/obs/errors.h"
#include "djpete/obs/rawlog_source.h"
#include "djpete/texture/object_file.h"

namespace djpete::figures {

namespace fs = std::filesystem;

namespace {

std::size_t coloured(const texture::ObjectModel& model) {
    return static_cast<std::size_t>(std::count_if(model.colours.begin(), model.colours.end(),
                                                  [](const auto& c) { return c.count > 0; }));
}

}  // namespace

std::vector<int64_t> RunResult::best(std::size_t count) const {
    std::vector<std::pair<std::size_t, int64_t>> order;
    for (const auto& [id, model] : models) {
        if (const std::size_t points = coloured(model); points > 0) order.emplace_back(points, id);
    }
    std::stable_sort(order.begin(), order.end(),
                     [](const auto& a, const auto& b) { return a.first > b.first; });
    std::vector<int64_t> out;
    for (const auto& [points, id] : order) {
        if (out.size() < count) out.push_back(id);
    }
    return out;
}

RunResult readResult(const std::string& folder) {
    if (!fs::is_directory(folder)) {
        throw obs::InputError(folder + ": expected a result folder of djpete-slam");
    }
    RunResult out;
    out.trajectory =
        evaluation::readTrajectory((fs::path(folder) / "trajectory.kitti.txt").string());
    out.objects = evaluation::readObjectsCsv((fs::path(folder) / "objects.csv").string());
    out.cameras = evaluation::estimatedCameras(out.objects, out.trajectory, std::nullopt);
    std::vector<fs::path> files;
    std::error_code none;
    for (const auto& entry : fs::directory_iterator(fs::path(folder) / "objects", none)) {
        if (entry.path().extension() == ".object") files.push_back(entry.path());
    }
    std::sort(files.begin(), files.end());
    for (const auto& file : files) {
        auto saved = texture::loadObject(file);
        const auto id = static_cast<int64_t>(saved.original.id.value);
        out.models.emplace(id, std::move(saved.original));
    }
    return out;
}

DriveFrames readDrive(const std::string& rawlog, const evaluation::CameraPath& cameras,
                      const std::vector<std::size_t>& wanted, ShownImage which) {
    DriveFrames out;
    const std::set<std::size_t> frames(wanted.begin(), wanted.end());
    obs::RawlogSource source(rawlog);
    std::optional<geometry::SE3> T_vehicle_main;
    while (const auto frame = source.next()) {
        const std::size_t number = frame->id.value;
        if (!cameras.contains(number)) continue;
        const bool show = frames.count(number) > 0 && frame->hasImages();
        std::optional<obs::ImageSet> main;
        if (!T_vehicle_main && frame->hasImages()) {
            main = frame->loadMainImages();
            T_vehicle_main = main->camera.T_vehicle_cam;
        }
        if (T_vehicle_main && frame->T_world_vehicle_truth) {
            out.trueCameras[number] = *frame->T_world_vehicle_truth * *T_vehicle_main;
        }
        if (show) {
            const auto images =
                which == ShownImage::Main ? frame->loadMainImages() : frame->loadTextureImages();
            ShownFrame shown;
            shown.frame = number;
            shown.image = colourCopy(images->left);
            shown.camera = images->camera.model;
            shown.T_world_vehicle = cameras.at(number) * T_vehicle_main->inverse();
            shown.T_world_cam = shown.T_world_vehicle * images->camera.T_vehicle_cam;
            shown.scan = frame->loadScan();
            out.shown.emplace(number, std::move(shown));
        }
        frame->unload();
    }
    return out;
}

}  // namespace djpete::figures
