#include "conversion.h"

#include <algorithm>
#include <set>

#include "djpete/geometry/mrpt_bridge.h"
#include "djpete/obs/CObservationDetectedObjects.h"
#include "djpete/obs/errors.h"
#include "djpete/obs/labels.h"
#include "drive_rig.h"
#include "image_files.h"
#include "kitti_oxts.h"
#include "kitti_poses.h"
#include "rawlog_writer.h"
#include "sensor_observations.h"

namespace djpete::kitti2rawlog {

using geometry::SE3;
using mrpt::Clock;
using obs::InputError;
using obs::ObjectDetection;

namespace {

/// Everything that is read from text before the first frame is written.
struct DriveTexts {
    std::vector<SE3> poses;
    std::map<uint64_t, OxtsPacket> oxts;
    FramedDetections labels, detections;
    bool hasLabels = false, hasDetections = false;
};

std::string sourceName(const std::filesystem::path& file) {
    const std::string stem = file.stem().string();
    const bool number =
        std::all_of(stem.begin(), stem.end(), [](unsigned char c) { return std::isdigit(c) != 0; });
    return number ? std::filesystem::absolute(file).parent_path().filename().string() : stem;
}

DriveTexts readTexts(const ConversionJob& job) {
    DriveTexts t;
    const DriveFiles& d = job.drive;
    if (d.poses) t.poses = readPoses(*d.poses);
    t.oxts = readOxts(d);
    if (d.labels) {
        t.labels = std::filesystem::is_directory(*d.labels)
                       ? readDetectionFiles(listFrames(*d.labels, ".txt"), job.labelSigma,
                                            sourceName(*d.labels))
                       : readDetectionFile(*d.labels, job.labelSigma, sourceName(*d.labels));
    } else {
        t.labels = readDetectionFiles(d.frameLabels, job.labelSigma, "label_2");
    }
    t.hasLabels = d.labels.has_value() || !d.frameLabels.empty();
    if (d.detections) {
        t.detections =
            std::filesystem::is_directory(*d.detections)
                ? readDetectionFiles(listFrames(*d.detections, ".txt"), job.detectionSigma,
                                     sourceName(*d.detections))
                : readDetectionFile(*d.detections, job.detectionSigma, sourceName(*d.detections));
        t.hasDetections = true;
    }
    return t;
}

/// All frames with a sensor; of a drive without sensors, all frames with a pose.
std::vector<uint64_t> framesOf(const ConversionJob& job, const DriveTexts& texts) {
    std::set<uint64_t> all;
    for (const auto& images : job.drive.images)
        for (const auto& image : images) all.insert(image.first);
    for (const auto& scan : job.drive.scans) all.insert(scan.first);
    for (const auto& packet : texts.oxts) all.insert(packet.first);
    if (all.empty()) {
        for (uint64_t f = 0; f < texts.poses.size(); ++f) all.insert(f);
    }
    if (all.empty()) {
        throw InputError(job.drive.name +
                         ": no images, scans or OXTS packets; expected at least poses (--poses)");
    }
    std::vector<uint64_t> out;
    std::copy_if(all.begin(), all.end(), std::back_inserter(out),
                 [&](uint64_t f) { return job.range.contains(f); });
    if (out.empty()) {
        throw InputError(job.drive.name +
                         ": no frame in the range asked for; the drive has frames " +
                         std::to_string(*all.begin()) + " to " + std::to_string(*all.rbegin()));
    }
    return out;
}

/// Moves image boxes from camera 2 to camera 0 by the disparity at the box centre.
void shiftBoxesToGray(const KittiCalibration& calibration, std::vector<ObjectDetection>& objects) {
    if (!calibration.P[0] || !calibration.P[2]) return;
    const double fx = (*calibration.P[0])(0, 0);
    const double offset = calibration.cameraOffset_m(2) - calibration.cameraOffset_m(0);
    for (auto& o : objects) {
        const double z = o.T_sensor_obj.translation().z();
        if (!o.box || z <= 1.0) continue;
        const auto shift = static_cast<float>(fx * offset / z);
        o.box->left += shift;
        o.box->right += shift;
    }
}

class Conversion {
  public:
    explicit Conversion(const ConversionJob& job)
        : job_(job),
          texts_(readTexts(job)),
          frames_(framesOf(job, texts_)),
          calibration_(readCalibration(job.drive, frames_)),
          gray_(findPair(job.drive, calibration_, frames_, 0)),
          color_(findPair(job.drive, calibration_, frames_, 2)),
          stamps_(readTimes(job.drive.times, frames_.back())) {
        checkDrive();
        report_.info = driveInfo(job.drive, frames_, gray_, color_);
        T_vehicle_cam0_ = calibration_.T_vehicle_cam0();
        report_.hasLabels = texts_.hasLabels;
        report_.hasDetections = texts_.hasDetections;
        openFiles();
    }

    ConversionReport run(const Progress& progress) {
        for (std::size_t i = 0; i < frames_.size(); ++i) {
            if (progress) progress(i, frames_.size());
            writeFrame(frames_[i]);
            ++report_.frames;
        }
        if (progress) progress(frames_.size(), frames_.size());
        return report_;
    }

  private:
    void checkDrive() const {
        if (job_.drive.layout == Layout::Odometry && !job_.drive.times) {
            throw InputError(job_.drive.calibration.parent_path().string() +
                             ": no times.txt; expected one time per frame");
        }
        if (!calibration_.T_cam0_velo && !job_.drive.scans.empty()) {
            throw InputError(calibration_.origin +
                             ": no calibration of the Velodyne; expected an entry Tr, as the drive "
                             "has scans");
        }
        if (job_.drive.poses && frames_.front() >= texts_.poses.size()) {
            throw InputError(
                job_.drive.poses->string() + ": has " + std::to_string(texts_.poses.size()) +
                " poses; expected one for frame " + std::to_string(frames_.front()) + " at least");
        }
    }

    void openFiles() {
        sensors_.emplace(job_.out, report_.info, stamp(frames_.front()));
        report_.files.push_back(job_.out);
        if (texts_.hasDetections) openCompanion(detectionFile_, "_objects");
        if (texts_.hasLabels)
            openCompanion(labelFile_, texts_.hasDetections ? "_labels" : "_objects");
        store_.emplace(job_.out, job_.copyFiles);
    }

    void openCompanion(std::optional<RawlogWriter>& writer, const std::string& suffix) {
        const auto file = job_.out.parent_path() / (job_.out.stem().string() + suffix + ".rawlog");
        writer.emplace(file, report_.info, stamp(frames_.front()));
        report_.files.push_back(file);
    }

    Clock::time_point stamp(uint64_t frame) const {
        return stamps_.at(static_cast<std::size_t>(frame));
    }

    void writeFrame(uint64_t frame) {
        writeImages(frame, gray_, obs::label::kStereoGray, obs::label::kImageGray);
        writeImages(frame, color_, obs::label::kStereoColor, obs::label::kImageColor);
        writeScan(frame);
        writeOxts(frame);
        writeTruth(frame);
        if (labelFile_) {
            auto objects = objectsAt(texts_.labels, frame);
            const auto masks = job_.drive.instances.find(frame);
            if (masks != job_.drive.instances.end())
                attachMasks(masks->second, maskSize(), objects);
            report_.labels += objects.size();
            writeObjects(*labelFile_, frame, std::move(objects));
        }
        if (detectionFile_) {
            auto objects = objectsAt(texts_.detections, frame);
            report_.detections += objects.size();
            writeObjects(*detectionFile_, frame, std::move(objects));
        }
    }

    void writeImages(uint64_t frame, const CameraPair& pair, const char* stereoLabel,
                     const char* monoLabel) {
        const auto& lefts = job_.drive.images[pair.left];
        const auto& rights = job_.drive.images[pair.right];
        const auto left = lefts.find(frame);
        const auto right = rights.find(frame);
        if (left == lefts.end()) {
            report_.rightOnly += right == rights.end() ? 0U : 1U;
            return;
        }
        checkSize(left->second, pair);
        if (right == rights.end()) {
            sensors_->write(*monoObservation(*pair.mono, store_->put(left->second, pair.left),
                                             stamp(frame), monoLabel));
            ++report_.singleImages;
            return;
        }
        checkSize(right->second, pair);
        sensors_->write(*stereoObservation(*pair.stereo, store_->put(left->second, pair.left),
                                           store_->put(right->second, pair.right), stamp(frame),
                                           stereoLabel));
        ++report_.stereoPairs;
    }

    static void checkSize(const std::filesystem::path& file, const CameraPair& pair) {
        const ImageSize size = pngSize(file);
        if (size == pair.size) return;
        throw InputError(file.string() + ": image is " + std::to_string(size.width_px) + "x" +
                         std::to_string(size.height_px) + " but " +
                         std::to_string(pair.size.width_px) + "x" +
                         std::to_string(pair.size.height_px) +
                         " was expected, the size of the drive's first image");
    }

    void writeScan(uint64_t frame) {
        const auto scan = job_.drive.scans.find(frame);
        if (scan == job_.drive.scans.end()) return;
        checkScanSize(scan->second);
        sensors_->write(*scanObservation(store_->putScan(scan->second), stamp(frame)));
        ++report_.scans;
    }

    void writeOxts(uint64_t frame) {
        const auto packet = texts_.oxts.find(frame);
        if (packet == texts_.oxts.end()) return;
        const SE3 T_vehicle_imu = calibration_.T_velo_imu.value_or(SE3());
        sensors_->write(*gpsObservation(packet->second, stamp(frame), T_vehicle_imu));
        sensors_->write(*imuObservation(packet->second, stamp(frame), T_vehicle_imu));
        ++report_.oxtsPackets;
    }

    void writeTruth(uint64_t frame) {
        if (frame >= texts_.poses.size()) return;
        const SE3 T_world_vehicle = T_vehicle_cam0_ *
                                    texts_.poses[static_cast<std::size_t>(frame)] *
                                    T_vehicle_cam0_.inverse();
        sensors_->write(*truthObservation(T_world_vehicle, stamp(frame)));
        ++report_.truthPoses;
    }

    std::vector<ObjectDetection> objectsAt(const FramedDetections& all, uint64_t frame) const {
        const auto it = all.find(frame);
        auto out = it == all.end() ? std::vector<ObjectDetection>{} : it->second;
        if (!color_.rig()) shiftBoxesToGray(calibration_, out);
        return out;
    }

    ImageSize maskSize() const { return color_.rig() ? color_.size : gray_.size; }

    void writeObjects(RawlogWriter& file, uint64_t frame, std::vector<ObjectDetection> objects) {
        obs::CObservationDetectedObjects o;
        o.sensorLabel = obs::label::kDetections;
        o.timestamp = stamp(frame);
        o.sensorPose = geometry::toCPose3D(T_vehicle_cam0_);
        o.detections = std::move(objects);
        file.write(o);
    }

    const ConversionJob& job_;
    DriveTexts texts_;
    std::vector<uint64_t> frames_;
    KittiCalibration calibration_;
    CameraPair gray_, color_;
    std::vector<Clock::time_point> stamps_;
    SE3 T_vehicle_cam0_;
    std::optional<RawlogWriter> sensors_, detectionFile_, labelFile_;
    std::optional<ExternalFiles> store_;
    ConversionReport report_;
};

}  // namespace

ConversionReport convert(const ConversionJob& job, const Progress& progress) {
    return Conversion(job).run(progress);
}

}  // namespace djpete::kitti2rawlog
