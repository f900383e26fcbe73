#include "sensor_observations.h"

#include "djpete/geometry/mrpt_bridge.h"
#include "djpete/obs/errors.h"
#include "djpete/obs/labels.h"

namespace djpete::kitti2rawlog {

namespace fs = std::filesystem;

namespace {

mrpt::img::TCamera cameraParams(const geometry::StereoCamera& model) {
    mrpt::img::TCamera out;
    out.ncols = static_cast<uint32_t>(model.width_px);
    out.nrows = static_cast<uint32_t>(model.height_px);
    out.setIntrinsicParamsFromValues(model.fx, model.fy, model.cx, model.cy);
    return out;
}

}  // namespace

ExternalFiles::ExternalFiles(const fs::path& rawlog, bool copy)
    : images_(rawlog.parent_path() / (rawlog.stem().string() + "_Images")), copy_(copy) {}

std::string ExternalFiles::put(const fs::path& image, std::size_t camera) {
    return place(image, "image_" + std::to_string(camera));
}

std::string ExternalFiles::putScan(const fs::path& scan) { return place(scan, "velodyne"); }

std::string ExternalFiles::place(const fs::path& file, const std::string& folder) {
    if (!copy_) return fs::absolute(file).lexically_normal().string();
    std::error_code error;
    fs::create_directories(images_ / folder, error);
    const fs::path name = fs::path(folder) / file.filename();
    if (!error) fs::copy_file(file, images_ / name, fs::copy_options::overwrite_existing, error);
    if (error) {
        throw obs::InputError(file.string() + ": cannot be copied to " + (images_ / name).string() +
                              " (" + error.message() + ")");
    }
    return name.string();
}

mrpt::obs::CObservationStereoImages::Ptr stereoObservation(const obs::RigCamera& camera,
                                                           const std::string& left,
                                                           const std::string& right,
                                                           mrpt::Clock::time_point stamp,
                                                           const std::string& label) {
    auto o = mrpt::obs::CObservationStereoImages::Create();
    o->sensorLabel = label;
    o->timestamp = stamp;
    mrpt::img::TStereoCamera params;
    params.leftCamera = cameraParams(camera.model);
    params.rightCamera = params.leftCamera;
    params.rightCameraPose.x = camera.model.baseline_m;
    o->setStereoCameraParams(params);
    o->cameraPose = mrpt::poses::CPose3DQuat(geometry::toCPose3D(camera.T_vehicle_cam));
    o->imageLeft.setExternalStorage(left);
    o->imageRight.setExternalStorage(right);
    o->hasImageRight = true;
    return o;
}

mrpt::obs::CObservationImage::Ptr monoObservation(const obs::RigCamera& camera,
                                                  const std::string& image,
                                                  mrpt::Clock::time_point stamp,
                                                  const std::string& label) {
    auto o = mrpt::obs::CObservationImage::Create();
    o->sensorLabel = label;
    o->timestamp = stamp;
    o->cameraParams = cameraParams(camera.model);
    o->cameraPose = geometry::toCPose3D(camera.T_vehicle_cam);
    o->image.setExternalStorage(image);
    return o;
}

mrpt::obs::CObservationPointCloud::Ptr scanObservation(const std::string& file,
                                                       mrpt::Clock::time_point stamp) {
    auto o = mrpt::obs::CObservationPointCloud::Create();
    o->sensorLabel = obs::label::kVelodyne;
    o->timestamp = stamp;
    o->setAsExternalStorage(file,
                            mrpt::obs::CObservationPointCloud::ExternalStorageFormat::KittiBinFile);
    return o;
}

mrpt::obs::CObservationRobotPose::Ptr truthObservation(const geometry::SE3& T_world_vehicle,
                                                       mrpt::Clock::time_point stamp) {
    auto o = mrpt::obs::CObservationRobotPose::Create();
    o->sensorLabel = obs::label::kGroundTruth;
    o->timestamp = stamp;
    o->pose.mean = geometry::toCPose3D(T_world_vehicle);
    return o;
}

}  // namespace djpete::kitti2rawlog
