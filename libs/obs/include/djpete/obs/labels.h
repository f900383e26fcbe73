/// Sensor labels of a drive's rawlog.
#pragma once

namespace djpete::obs::label {

constexpr const char* kStereoGray =
    "stereo_gray";  ///< CObservationStereoImages, KITTI cameras 0, 1
constexpr const char* kStereoColor = "stereo_color";  ///< CObservationStereoImages, cameras 2, 3
constexpr const char* kImageGray = "image_0";   ///< CObservationImage, when only camera 0 exists
constexpr const char* kImageColor = "image_2";  ///< CObservationImage, when only camera 2 exists
constexpr const char* kVelodyne = "velodyne";   ///< CObservationPointCloud
constexpr const char* kGps = "gps";             ///< CObservationGPS
constexpr const char* kImu = "oxts_imu";        ///< CObservationIMU
constexpr const char* kGroundTruth = "ground_truth";  ///< CObservationRobotPose, T_world_vehicle
constexpr const char* kCalibration = "calibration";   ///< CObservationComment with INI text; MRPT
                                                      ///< 2.5 does not store its label
constexpr const char* kDetections = "detections";     ///< CObservationDetectedObjects
constexpr const char* kKeyframes = "keyframes";       ///< CObservationVisualKeyframe

}  // namespace djpete::obs::label
