/// One object seen in one frame.
#pragma once

#include <cstdint>
#include <optional>
#include <string>

#include "djpete/geometry/cuboid.h"
#include "djpete/geometry/se3.h"
#include "djpete/obs/appearance.h"
#include "djpete/obs/object_points.h"
#include "djpete/obs/rle_mask.h"

namespace djpete::obs {

enum class ObjectClass : uint8_t { Car = 0, Van, Truck, Pedestrian, Cyclist, Tram, Other };

/// KITTI's spelling ("Car", "Van", ...; Other is "Misc").
std::string toString(ObjectClass c);
/// Case-insensitive; "Person_sitting" is Pedestrian, unknown words are Other.
ObjectClass objectClassFromString(const std::string& word);
/// Things with four wheels that the map keeps as textured objects: Car, Van, Truck.
bool isVehicle(ObjectClass c);

/// Axis-aligned box in the left image, pixels, inclusive-exclusive does not matter at sub-pixel.
struct ImageBox {
    float left = 0, top = 0, right = 0, bottom = 0;
    float width() const { return right - left; }
    float height() const { return bottom - top; }
    float area() const { return width() > 0 && height() > 0 ? width() * height() : 0.F; }
};

struct ObjectDetection {
    ObjectClass objectClass = ObjectClass::Car;
    float score = 1;                 ///< detector's own scale; higher is surer
    geometry::Vec3 size_m{0, 0, 0};  ///< (length, width, height)
    geometry::SE3 T_sensor_obj;      ///< box centre; sensor = frame of the observation's sensorPose
    /// Information of log(T_sensor_obj^-1 T_true), order (x, y, z, rot x, rot y, rot z), frame obj.
    geometry::Mat6 information = geometry::Mat6::Identity();
    std::optional<ImageBox> box;           ///< in the left image
    std::optional<RleMask> mask;           ///< in the left image
    std::optional<Appearance> appearance;  ///< not stored in rawlogs
    ObjectPointsPtr points;                ///< returns around it, frame sensor; may be null
    std::string source;                    ///< e.g. "label_02", "pointrcnn", "geometric"
    std::optional<int32_t> sourceTrackId;  ///< identity as the source gives it; evaluation only
};

/// Information from independent standard deviations: position (m) per axis of obj, and rotation
/// (rad).
geometry::Mat6 diagonalInformation(const geometry::Vec3& sigma_m, const geometry::Vec3& sigma_rad);

}  // namespace djpete::obs
