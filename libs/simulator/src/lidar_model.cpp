#include "lidar_model.h"

#include <algorithm>
#include <cmath>

#include "noise.h"

namespace djpete::simulator {

namespace {

constexpr double kRadPerDeg = M_PI / 180.0;

/// A part of the own car: beams below `top_deg` between two azimuths do not get out.
struct Obstacle {
    double from_deg, to_deg;  // counter-clockwise from ahead, 0 .. 360
    double top_deg;           // elevation
    double widening;          // degrees to either side per degree below the top
};
constexpr std::array<Obstacle, 6> kOwnCar{{
    {352, 368, -20.6, 3.0},      // bonnet
    {158.5, 164.5, -13.0, 0.0},  // posts of the roof rack, behind
    {195.5, 201.5, -13.0, 0.0},  //
    {157, 204, -18.2, 1.6},      // what they carry
    {286, 296, -15.6, 1.3},      // aerial, right
    {130, 134, -19.6, 1.0},      // corner of the roof
}};

bool isPlant(Material m) {
    return m == Material::Leaf || m == Material::Grass || m == Material::Trunk;
}

/// Share of near infrared that a surface scatters back, face on.
float infrared(const SurfacePoint& point, const Shade& shade) {
    const Material m = point.finish.material;
    if (isPlant(m))
        return std::min(0.85F, 0.34F + 0.5F * shade.albedo.mean());  // leaves are bright beyond red
    if (m == Material::Asphalt) return std::min(0.85F, shade.reflectance + 0.18F);
    if (m == Material::Pavement || m == Material::Kerb) return 0.24F + 0.6F * shade.albedo.mean();
    if (m == Material::CarBody || m == Material::Tyre || m == Material::Sign)
        return shade.reflectance;
    return std::min(0.85F, shade.reflectance + 0.12F);
}

/// Signs and plates.
bool isRetroReflecting(const SurfacePoint& point, const Shade& shade) {
    const Material m = point.finish.material;
    return (m == Material::Sign || m == Material::CarBody) && shade.reflectance > 0.9F;
}

bool isMirrorLike(const SurfacePoint& point, const Shade& shade) {
    return (point.finish.material == Material::CarBody && shade.reflectance < 0.7F) ||
           point.finish.material == Material::Glass;
}

}  // namespace

double nominalElevation_rad(int beam) {
    const double deg = beam < 32 ? 2.0 - beam / 3.0 : -8.83 - 0.5 * (beam - 32);
    return deg * kRadPerDeg;
}

Laser laserOf(int beam, const LidarOptions& options) {
    const uint32_t h = hash(0x48444C36U, static_cast<uint32_t>(beam));
    Laser laser;
    laser.elevation_rad =
        nominalElevation_rad(beam) + 0.04 * kRadPerDeg * static_cast<double>(gaussian(hash(h, 1U)));
    laser.bias_m = options.beamBias_m * static_cast<double>(gaussian(hash(h, 2U)));
    laser.gain = 1.F + 0.15F * gaussian(hash(h, 3U));
    return laser;
}

bool hiddenByOwnCar(double azimuth_rad, double elevation_rad) {
    const double azimuth = azimuth_rad / kRadPerDeg, elevation = elevation_rad / kRadPerDeg;
    for (const Obstacle& o : kOwnCar) {
        if (elevation > o.top_deg) continue;
        const double wider = o.widening * (o.top_deg - elevation);
        for (const double turn : {0.0, 360.0}) {
            if (azimuth + turn > o.from_deg - wider && azimuth + turn < o.to_deg + wider)
                return true;
        }
    }
    return false;
}

Echo echoOf(const SurfacePoint& point, const Shade& shade, float facing, float range_m) {
    const float albedo = infrared(point, shade);
    Echo echo;
    if (isRetroReflecting(point, shade)) {  // bright from any side and distance
        echo.reflectance = 0.99F;
        echo.strength = 10.F;
        return echo;
    }
    const bool glossy = isMirrorLike(point, shade);
    // Rough surfaces scatter back more than a cosine when seen from the side, paint less.
    const float back = albedo * (glossy ? 0.10F + 0.90F * facing : 0.28F + 0.72F * facing);
    // Something of 5 % comes back from 50 m, of 13 % from 80 m.
    echo.strength = 50.F * std::sqrt(back / 0.05F) / std::max(1.F, range_m);
    // The scanner corrects what it states for distance and angle, up to 25 m or so.
    const float stated = glossy ? back : albedo * (0.75F + 0.25F * facing);
    const float far = std::max(0.F, range_m - 22.F) / 14.F;
    echo.reflectance = stated / (1.F + far * far) - (glossy ? 0.08F : 0.03F);
    // Behind house windows, curtains and blinds send most pulses back; car windows let half of
    // them through or mirror them away.
    echo.returns = shade.returns;
    if (point.finish.material == Material::Glass) echo.returns = 0.9F;
    if (point.car != nullptr && shade.returns < 1) echo.returns = 0.5F;
    return echo;
}

double rangeSigma_m(const LidarOptions& options, double range_m) {
    return std::hypot(options.rangeNoise_m, options.rangeNoisePerMetre * range_m);
}

}  // namespace djpete::simulator
