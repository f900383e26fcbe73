/// The objects that a detector saw in one frame, as an MRPT observation.
#pragma once

#include <mrpt/obs/CObservation.h>
#include <mrpt/opengl/Visualizable.h>
#include <mrpt/poses/CPose3D.h>

#include <vector>

#include "djpete/obs/detection.h"

namespace djpete::obs {

/// Detections of one frame. `sensorPose` is T_vehicle_sensor, and each detection's pose is given in
/// that sensor's frame (velo for LiDAR detectors, cam for labels and image detectors). Image boxes
/// and masks refer to the left image of the same timestamp. Shown in 3D as boxes with class and
/// score.
class CObservationDetectedObjects : public mrpt::obs::CObservation,
                                    public mrpt::opengl::Visualizable {
    DEFINE_SERIALIZABLE(CObservationDetectedObjects, djpete::obs)

  public:
    std::vector<ObjectDetection> detections;
    mrpt::poses::CPose3D sensorPose;

    void getSensorPose(mrpt::poses::CPose3D& out_sensorPose) const override {
        out_sensorPose = sensorPose;
    }
    void setSensorPose(const mrpt::poses::CPose3D& newSensorPose) override {
        sensorPose = newSensorPose;
    }
    void getDescriptionAsText(std::ostream& o) const override;
    bool exportTxtSupported() const override { return true; }
    std::string exportTxtHeader() const override;
    std::string exportTxtDataRow() const override;
    void getVisualizationInto(mrpt::opengl::CSetOfObjects& o) const override;
};

/// Registers both observation classes of this room with MRPT; needed once by programs that read
/// them.
void registerObservationClasses();

}  // namespace djpete::obs
