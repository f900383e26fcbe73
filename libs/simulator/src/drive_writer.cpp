#include "djpete/simulator/drive_writer.h"

#include <algorithm>
#include <fstream>
#include <memory>
#include <stdexcept>

#include "djpete/simulator/false_detections.h"
#include "djpete/simulator/map_view.h"
#include "frame_files.h"
#include "image_files.h"
#include "object_meshes.h"
#include "option_file.h"
#include "rig_files.h"
#include "row_store.h"
#include "truth_writer.h"
#include "write_queue.h"

namespace djpete::simulator {

namespace fs = std::filesystem;
using geometry::SE3;

namespace {

/// Renders frames of one world with one rig.
struct Rig {
    const DriveOptions& options;
    World world;
    geometry::StereoCamera camera;
    SE3 T_vehicle_left, T_vehicle_right;

    static WorldOptions worldOptions(const DriveOptions& o) {
        WorldOptions out = o.world;
        out.frames = std::max(out.frames, o.end);
        return out;
    }
    explicit Rig(const DriveOptions& o)
        : options(o),
          world(worldOptions(o)),
          camera(rigCamera(o.width_px, o.height_px)),
          T_vehicle_left(T_vehicle_camera()),
          T_vehicle_right(T_vehicle_left * SE3(geometry::Mat3::Identity(),
                                               geometry::Vec3(camera.baseline_m, 0, 0))) {}

    /// Made when it is needed first: a drive without a frame to render needs none.
    Renderer& renderer() {
        if (!renderer_) {
            CameraModel model;
            model.exposureSwing = amountOf(options.faults, FaultKind::ExposureSwing);
            renderer_ = std::make_unique<Renderer>(world, options.threads, model);
        }
        return *renderer_;
    }

    FrameData render(uint64_t frame) {
        FrameData data;
        data.frame = frame;
        data.left = renderer().renderCamera(frame, camera, T_vehicle_left, 0);
        data.right = renderer().renderCamera(frame, camera, T_vehicle_right, 1);
        data.labels =
            makeLabels(renderer(), world, frame, camera, T_vehicle_left, data.left, options.labels);
        if (options.scans) data.scan = renderer().scan(frame, options.lidar);
        data.oxts = oxtsRow(world, frame, options.oxts);
        return data;
    }

    FrameRows rowsOf(const FrameData& data) const {
        FrameRows rows;
        for (const auto& l : data.labels) rows.labels() += toKittiRow(l) + "\n";
        const auto right = makeDetections(data.labels, options.detector, world.driveSeed());
        for (const auto& d : right) rows.detections() += toPointRcnnRow(d) + "\n";
        for (const auto& d :
             makeFalseDetections(world, data.frame, camera, T_vehicle_left, right.size(),
                                 options.detector, options.labels.maxRange_m))
            rows.detections() += toPointRcnnRow(d) + "\n";
        rows.objects() = objectRows(world, data.frame, data.left, options.objectRange_m);
        rows.moving() = movingRow(world, data.frame, data.left);
        rows.exposure() = exposureRow(data.frame, data.left, data.right);
        return rows;
    }

  private:
    std::unique_ptr<Renderer> renderer_;
};

/// Everything that is the same for all frames.
void writeDriveFiles(const Rig& rig, const fs::path& folder) {
    const DriveOptions& o = rig.options;
    writeCalibration(rig.camera, rig.T_vehicle_left, o.faults, folder);
    writeTimesAndPoses(rig.world, o.end, rig.T_vehicle_left, o.faults, folder);
    std::error_code ignored;
    if (o.faults.empty())
        fs::remove(folder / "faults.txt", ignored);
    else
        writeWhole(folder / "faults.txt", faultTable(o.faults));
    writeWhole(folder / "drive_options.txt", optionText(o));
}

/// Of the rows "frame share"; 0 without rows.
double meanMovingShare(const fs::path& file) {
    std::ifstream in(file);
    double sum = 0, frame = 0, share = 0;
    int rows = 0;
    while (in >> frame >> share) sum += share, ++rows;
    return rows > 0 ? sum / rows : 0;
}

}  // namespace

DriveReport writeDrive(const DriveOptions& options, const fs::path& folder,
                       const Progress& progress) {
    const bool begun = options.resume && wasBegunWith(options, folder);
    makeFolders(folder, options);
    const RowStore store(folder);
    if (begun)
        store.reopen();
    else
        store.clear();
    Rig rig(options);
    writeDriveFiles(rig, folder);
    {
        // A frame's files are written while the next one is rendered.
        const unsigned writers = std::max(1U, options.threads / 4);
        WriteQueue queue(writers, writers);
        for (uint64_t f = options.begin; f < options.end; ++f) {
            const bool dropped = isFaulty(options.faults, FaultKind::DroppedFrames, f);
            const bool kept = begun && store.has(f) && frameIsComplete(f, folder, options);
            if (dropped) {
                removeFrameFiles(f, folder, options);
            } else if (!kept) {
                const auto data = std::make_shared<const FrameData>(rig.render(f));
                queue.push([&rig, &store, &options, folder, data] {
                    writeFrameFiles(*data, folder, options);
                    store.put(data->frame, rig.rowsOf(*data));
                });
            }
            if (progress) progress(f + 1 - options.begin, options.end - options.begin);
        }
        queue.finish();
    }
    store.close(options.begin, options.end);
    if (options.map) {
        constexpr int kMapSide_px = 1400;
        writePng(colourOf(renderMap(rig.renderer(), rig.world, options.begin, kMapSide_px)),
                 folder / "map.png");
    }
    if (options.meshTexel_m > 0)
        writeObjectMeshes(rig.world, labelledIds(folder / "label_02.txt"), options.meshTexel_m,
                          folder / "objects", options.threads);
    return {meanMovingShare(folder / "moving.txt")};
}

}  // namespace djpete::simulator
