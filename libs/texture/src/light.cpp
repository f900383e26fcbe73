#include "light.h"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>

namespace djpete::texture {

namespace {

using geometry::Vec3;
using Terms = Eigen::Matrix<double, Light::kTerms, 1>;

constexpr std::size_t kPoints = 1500, kLeastPoints = 100, kLeastObjects = 3;
constexpr int kIterations = 15;
constexpr double kTukey = 0.5;   // of the logarithm: panes and tyres are darker by more
constexpr double kRidge = 0.02;  // share of all points that speak for no light
constexpr double kMostLog = 1.4;
constexpr float kDarkest = 8, kBrightest = 250;

std::array<double, Light::kTerms> basisOf(const Vec3& n) {
    return {n.x(),
            n.y(),
            n.z(),
            n.x() * n.y(),
            n.y() * n.z(),
            n.x() * n.z(),
            n.x() * n.x() - n.y() * n.y(),
            n.z() * n.z() - 1.0 / 3};
}

double median(std::vector<double> values) {
    const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
    std::nth_element(values.begin(), middle, values.end());
    return *middle;
}

}  // namespace

double Light::brightness(const Vec3& normal_world) const {
    const auto basis = basisOf(normal_world);
    double log = 0;
    for (std::size_t k = 0; k < basis.size(); ++k) log += terms[k] * basis[k];
    return std::exp(std::clamp(log, -kMostLog, kMostLog));
}

void Light::shine(const geometry::Mat3& R_world_obj, ObjectModel& model) const {
    for (std::size_t i = 0; i < model.size(); ++i) {
        const auto& n = model.normals[i];
        model.shade[i] = static_cast<float>(brightness(R_world_obj * Vec3(n[0], n[1], n[2])));
    }
}

void LightFit::add(const ObjectModel& model, const geometry::Mat3& R_world_obj) {
    std::vector<Sample> samples;
    const std::size_t step = std::max<std::size_t>(1, model.size() / kPoints);
    for (std::size_t i = 0; i < model.size(); i += step) {
        const ColourSum& colour = model.colours[i];
        if (colour.count == 0) continue;
        const float brightness =
            0.299F * colour.mean[0] + 0.587F * colour.mean[1] + 0.114F * colour.mean[2];
        if (brightness < kDarkest || brightness > kBrightest) continue;
        const auto& n = model.normals[i];
        Sample sample;
        sample.basis = basisOf(R_world_obj * Vec3(n[0], n[1], n[2]));
        sample.logBrightness = std::log(static_cast<double>(brightness));
        samples.push_back(sample);
    }
    if (samples.size() >= kLeastPoints) objects_.push_back(std::move(samples));
}

Light LightFit::solve() const {
    Light light;
    if (objects_.size() < kLeastObjects) return light;
    auto objects = objects_;
    Terms terms = Terms::Zero();
    std::vector<double> paint(objects.size(), 0);
    std::size_t total = 0;
    for (const auto& samples : objects) total += samples.size();
    for (int iteration = 0; iteration < kIterations; ++iteration) {
        Eigen::Matrix<double, Light::kTerms, Light::kTerms> left =
            kRidge * static_cast<double>(total) *
            Eigen::Matrix<double, Light::kTerms, Light::kTerms>::Identity();
        Terms right = Terms::Zero();
        for (std::size_t o = 0; o < objects.size(); ++o) {
            // The paint is what most of the object shows once the light is out.
            std::vector<double> plain;
            for (const auto& s : objects[o]) {
                plain.push_back(s.logBrightness -
                                Eigen::Map<const Terms>(s.basis.data()).dot(terms));
            }
            paint[o] = median(plain);
            // Against the object's own mean, so that its paint does not speak of light.
            Terms meanBasis = Terms::Zero();
            double meanLog = 0, weights = 0;
            for (std::size_t i = 0; i < plain.size(); ++i) {
                const double off = (plain[i] - paint[o]) / kTukey;
                const double inside = std::max(0.0, 1 - off * off);
                auto& s = objects[o][i];
                s.weight = inside * inside;
                meanBasis += s.weight * Eigen::Map<const Terms>(s.basis.data());
                meanLog += s.weight * s.logBrightness;
                weights += s.weight;
            }
            if (weights <= 0) continue;
            meanBasis /= weights;
            meanLog /= weights;
            for (const auto& s : objects[o]) {
                const Terms b = Eigen::Map<const Terms>(s.basis.data()) - meanBasis;
                left += s.weight * b * b.transpose();
                right += s.weight * b * (s.logBrightness - meanLog);
            }
        }
        terms = left.ldlt().solve(right);
    }
    for (int k = 0; k < Light::kTerms; ++k) light.terms[static_cast<std::size_t>(k)] = terms[k];
    return light;
}

}  // namespace djpete::texture
