#include "djpete/obs/detection.h"

#include <algorithm>
#include <array>
#include <cctype>

namespace djpete::obs {

namespace {

constexpr std::array<const char*, 7> kNames{"Car",     "Van",  "Truck", "Pedestrian",
                                            "Cyclist", "Tram", "Misc"};

std::string lower(std::string s) {
    std::transform(s.begin(), s.end(), s.begin(),
                   [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
    return s;
}

}  // namespace

std::string toString(ObjectClass c) { return kNames.at(static_cast<std::size_t>(c)); }

ObjectClass objectClassFromString(const std::string& word) {
    const std::string w = lower(word);
    for (std::size_t i = 0; i < kNames.size(); ++i) {
        if (lower(kNames[i]) == w) return static_cast<ObjectClass>(i);
    }
    if (w == "person_sitting" || w == "person") return ObjectClass::Pedestrian;
    return ObjectClass::Other;
}

bool isVehicle(ObjectClass c) {
    return c == ObjectClass::Car || c == ObjectClass::Van || c == ObjectClass::Truck;
}

ObjectPoints ObjectPoints::in(const geometry::SE3& T_a_b) const {
    const Eigen::Matrix3f R = T_a_b.rotation().cast<float>();
    const Point t = T_a_b.translation().cast<float>();
    ObjectPoints out;
    out.body.reserve(body.size());
    for (const auto& p : body) out.body.push_back(R * p + t);
    out.ground.reserve(ground.size());
    for (const auto& p : ground) out.ground.push_back(R * p + t);
    out.origin = R * origin + t;
    return out;
}

geometry::Mat6 diagonalInformation(const geometry::Vec3& sigma_m, const geometry::Vec3& sigma_rad) {
    geometry::Vec6 d;
    d << sigma_m.cwiseAbs2().cwiseInverse(), sigma_rad.cwiseAbs2().cwiseInverse();
    return d.asDiagonal();
}

}  // namespace djpete::obs
