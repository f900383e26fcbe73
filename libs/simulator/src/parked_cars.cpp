// Cars at the kerbs.
#include <algorithm>
#include <array>
#include <cmath>

#include "actor_body.h"
#include "boxes.h"
#include "noise.h"
#include "traffic.h"

namespace djpete::simulator {

using geometry::SE3;
using geometry::Vec2;
using geometry::Vec3;

namespace {

constexpr double kParking_m = 4.25;  // from the centre line

/// A place at a kerb, and the car that stands there by the streets' seed.
struct Place {
    uint32_t road = 0, seed = 0;
    bool left = false;
    double from_m = 0;  ///< its rear end along the street
    bool gap = false;   ///< nobody stands here
};

struct ParkedCar {
    uint32_t seed = 0;  ///< of Population::addVehicle
    SE3 T;              ///< on the plane
    Vec3 size_m{0, 0, 0};
};

/// True if a parked car would stand in nobody's way.
bool mayPark(const Network& network, const ParkedCar& car, const std::vector<ParkedCar>& parked) {
    constexpr double kJunction_m = 11.0, kOwnHalfWidth_m = 1.0;
    for (double u = -0.5; u <= 0.51; u += 0.25) {
        for (double v : {-0.5, 0.0, 0.5}) {
            const Vec3 p = car.T * Vec3(u * car.size_m.x(), v * car.size_m.y(), 0);
            const Vec2 q = p.head<2>();
            if (network.routeDistance_m(q) < kOwnHalfWidth_m + 0.35) return false;
            if (network.nearest(q).other_m < kJunction_m) return false;
        }
    }
    return std::none_of(parked.begin(), parked.end(), [&](const ParkedCar& other) {
        return gapBetween(car.T, car.size_m, other.T, other.size_m) < 0.4;
    });
}

class Parking {
  public:
    explicit Parking(const Network& network) : network_(network) {}

    /// Along both kerbs of every street; `seed` decides.
    void fill(uint32_t seed) {
        // Masks and labels can tell 999 actors apart: half of them may be parked ones.
        constexpr double kMost = 500, kPitch_m = 8.5;
        double kerbs_m = 0;
        for (const auto& road : network_.roads()) kerbs_m += 2 * road.length_m();
        const auto gaps =
            static_cast<float>(std::max(0.42, 1.0 - kMost / std::max(1.0, kerbs_m / kPitch_m)));
        for (uint32_t r = 0; r < network_.roads().size(); ++r) {
            double s[2] = {5, 5};
            uint32_t n[2] = {0, 0};
            while (std::min(s[0], s[1]) < network_.roads()[r].length_m() - 8) {
                const std::size_t side = s[0] <= s[1] ? 0 : 1;
                const uint32_t h =
                    hash(seed, 400U + static_cast<uint32_t>(side) + 2 * r, n[side]++);
                Place place{r, h, side == 1, s[side], unit(h) < gaps};
                if (place.gap) {
                    s[side] += static_cast<double>(between(hash(h, 1U), 3.F, 12.F));
                    places_.push_back(place);
                    continue;
                }
                const ParkedCar car = carAt(place, h);
                s[side] += car.size_m.x() + static_cast<double>(between(hash(h, 3U), 1.0F, 3.4F));
                place.gap = !park(car);
                places_.push_back(place);
            }
        }
    }

    /// About half of the cars drive away, and others come.
    void change(uint32_t seed) {
        constexpr float kLeave = 0.5F, kCome = 0.6F, kNew = 0.3F;
        std::vector<ParkedCar> before;
        before.swap(cars_);
        std::size_t i = 0;
        std::vector<const Place*> free;
        for (const auto& place : places_) {
            if (place.gap) {
                if (unit(hash(seed, 430U, place.seed)) < kNew) free.push_back(&place);
                continue;
            }
            const ParkedCar& car = before[i++];
            if (unit(hash(seed, 431U, place.seed)) >= kLeave)
                cars_.push_back(car);
            else if (unit(hash(seed, 432U, place.seed)) < kCome)
                free.push_back(&place);
        }
        // Who stays keeps the place; who comes takes what is left.
        for (const auto* place : free) park(carAt(*place, hash(seed, 433U, place->seed)));
    }

    const std::vector<ParkedCar>& cars() const { return cars_; }

  private:
    ParkedCar carAt(const Place& place, uint32_t h) const {
        Population maker;
        ParkedCar car;
        car.seed = hash(h, 5U);
        car.size_m = maker.addVehicle(car.seed).size_m;
        const bool against = place.left != (unit(hash(h, 4U)) < 0.12F);
        const double lateral =
            (place.left ? 1 : -1) *
            (kParking_m + static_cast<double>(between(hash(h, 2U), -0.1F, 0.12F)));
        const double askew = static_cast<double>(between(hash(h, 6U), -0.03F, 0.03F));
        const double middle_m = place.from_m + 0.5 * car.size_m.x();
        car.T = network_.roads()[place.road].poseAt(middle_m, lateral) *
                SE3::fromYaw((against ? M_PI : 0.0) + askew, Vec3::Zero());
        return car;
    }

    bool park(const ParkedCar& car) {
        const bool truck = drawVehicle(hash(car.seed, 1U)).type == ActorType::Truck;
        if (truck || !mayPark(network_, car, cars_)) return false;
        cars_.push_back(car);
        return true;
    }

    const Network& network_;
    std::vector<Place> places_;
    std::vector<ParkedCar> cars_;
};

/// True if the own vehicle, beside its usual way, would scrape along the car.
bool isInTheWay(const ParkedCar& car, const Route& route) {
    const Vec3 own_m(4.4, 1.8, 1.5);
    return std::any_of(
        route.T_world_vehicle.begin(), route.T_world_vehicle.end(), [&](const SE3& T) {
            const SE3 flat =
                SE3::fromYaw(T.yaw_rad(), Vec3(T.translation().x(), T.translation().y(), 0));
            return (flat.translation() - car.T.translation()).norm() < 8 &&
                   gapBetween(flat, own_m, car.T, car.size_m) < 0.25;
        });
}

}  // namespace

void parkCars(Population& population, const Network& network, const Route& route,
              const WorldOptions& options) {
    Parking parking(network);
    parking.fill(options.seed);
    if (options.trafficSeed != 0) parking.change(driveSeed(options));
    for (const auto& car : parking.cars()) {
        if (options.laneOffset_m != 0 && isInTheWay(car, route)) continue;
        population.addVehicle(car.seed);
        const Vec3& p = car.T.translation();
        population.tracks.back().spots = {{p.x(), p.y(), car.T.yaw_rad(), 0}};
    }
}

}  // namespace djpete::simulator
