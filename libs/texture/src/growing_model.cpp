#include "growing_model.h"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>

#include "voxel_key.h"

namespace djpete::texture {

namespace {

constexpr std::size_t kNeighbours = 12;
constexpr std::size_t kSpacingNeighbour = 6;
constexpr float kNeighbourhood_m = 0.4F;
constexpr float kMaxRadius_m = 0.15F;
constexpr double kGrowthBeforeRenewal = 1.5;

std::array<float, 3> toArray(const geometry::Vec3& v) {
    return {static_cast<float>(v.x()), static_cast<float>(v.y()), static_cast<float>(v.z())};
}

geometry::Vec3 toVector(const std::array<float, 3>& v) { return {v[0], v[1], v[2]}; }

std::array<int8_t, 3> packed(const geometry::Vec3& direction) {
    const auto part = [&](int i) { return static_cast<int8_t>(std::lround(127 * direction[i])); };
    return {part(0), part(1), part(2)};
}

geometry::Vec3 unpacked(const std::array<int8_t, 3>& direction) {
    return geometry::Vec3(direction[0], direction[1], direction[2]).normalized();
}

}  // namespace

GrowingModel::GrowingModel(ObjectModel& model, double voxel_m) : model_(&model), voxel_m_(voxel_m) {
    model_->cloud = mrpt::maps::CColouredPointsMap::Create();
}

const GrowingModel::Cell* GrowingModel::find(uint64_t key) const {
    const auto it = std::lower_bound(cells_.begin(), cells_.end(), key,
                                     [](const Cell& c, uint64_t k) { return c.key < k; });
    return it != cells_.end() && it->key == key ? &*it : nullptr;
}

std::size_t GrowingModel::insert(const std::vector<SurfacePoint>& points, std::size_t maxPoints) {
    std::vector<Cell> fresh;  // index: into points
    for (uint32_t i = 0; i < points.size(); ++i) {
        const auto key = voxelKey(points[i].p_obj, voxel_m_);
        if (key && find(*key) == nullptr) fresh.push_back({*key, i});
    }
    std::stable_sort(fresh.begin(), fresh.end(),
                     [](const Cell& a, const Cell& b) { return a.key < b.key; });
    fresh.erase(std::unique(fresh.begin(), fresh.end(),
                            [](const Cell& a, const Cell& b) { return a.key == b.key; }),
                fresh.end());
    const std::size_t room = maxPoints > model_->size() ? maxPoints - model_->size() : 0;
    if (fresh.size() > room) {
        // Keep the points that came first, not a corner of the grid.
        std::sort(fresh.begin(), fresh.end(),
                  [](const Cell& a, const Cell& b) { return a.index < b.index; });
        fresh.resize(room);
        std::sort(fresh.begin(), fresh.end(),
                  [](const Cell& a, const Cell& b) { return a.key < b.key; });
    }
    if (fresh.empty()) return 0;
    for (Cell& cell : fresh) {
        const SurfacePoint& point = points[cell.index];
        const auto p = toArray(point.p_obj);
        cell.index = static_cast<uint32_t>(model_->size());
        model_->addPoint(p, toArray(point.towardsSensor_obj), static_cast<float>(voxel_m_));
        seenFrom_.push_back(packed(point.towardsSensor_obj));
        sources_.push_back(point.source);
    }
    const auto middle = static_cast<std::ptrdiff_t>(cells_.size());
    cells_.insert(cells_.end(), fresh.begin(), fresh.end());
    std::inplace_merge(cells_.begin(), cells_.begin() + middle, cells_.end(),
                       [](const Cell& a, const Cell& b) { return a.key < b.key; });
    renewNormals();
    return fresh.size();
}

std::vector<SurfacePoint> GrowingModel::points() const {
    std::vector<SurfacePoint> out(model_->size());
    for (std::size_t i = 0; i < out.size(); ++i) {
        out[i] = {toVector(model_->point(i)), unpacked(seenFrom_[i]), sources_[i]};
    }
    return out;
}

void GrowingModel::replace(const std::vector<SurfacePoint>& points) {
    model_->cloud = mrpt::maps::CColouredPointsMap::Create();
    model_->colours.clear();
    model_->normals.clear();
    model_->radius_m.clear();
    model_->flags.clear();
    model_->seenIn.clear();
    cells_.clear();
    seenFrom_.clear();
    sources_.clear();
    normalsKnown_ = sizeAtRenewal_ = 0;
    insert(points, points.size());
}

void GrowingModel::shrink() {
    model_->cloud = std::make_shared<mrpt::maps::CColouredPointsMap>(*model_->cloud);  // no tree
    model_->colours.shrink_to_fit();
    model_->normals.shrink_to_fit();
    model_->radius_m.shrink_to_fit();
    model_->flags.shrink_to_fit();
    model_->seenIn.shrink_to_fit();
    cells_.shrink_to_fit();
    seenFrom_.shrink_to_fit();
    sources_.shrink_to_fit();
}

void GrowingModel::renewNormals() {
    const std::size_t size = model_->size();
    std::size_t first = normalsKnown_;
    if (static_cast<double>(size) >= kGrowthBeforeRenewal * static_cast<double>(sizeAtRenewal_)) {
        first = 0;
        sizeAtRenewal_ = size;
    }
    for (std::size_t i = first; i < size; ++i) renewNormal(i);
    normalsKnown_ = size;
}

/// The plane through the neighbours, turned to the sensor; where they make no plane, the
/// direction to the sensor itself.
void GrowingModel::renewNormal(std::size_t index) {
    float x = 0, y = 0, z = 0;
    model_->cloud->getPointFast(index, x, y, z);
    std::vector<std::size_t> neighbours;
    std::vector<float> distances2;
    const std::size_t wanted = std::min(kNeighbours, model_->size());
    model_->cloud->kdTreeNClosestPoint3DIdx(x, y, z, wanted, neighbours, distances2);
    const std::size_t spacing = std::min(kSpacingNeighbour, wanted - 1);
    model_->radius_m[index] =
        std::clamp(std::sqrt(distances2[spacing]), static_cast<float>(voxel_m_), kMaxRadius_m);
    Eigen::Vector3f sum = Eigen::Vector3f::Zero();
    Eigen::Matrix3f products = Eigen::Matrix3f::Zero();
    float count = 0;
    for (std::size_t k = 0; k < neighbours.size(); ++k) {
        if (distances2[k] > kNeighbourhood_m * kNeighbourhood_m) break;
        Eigen::Vector3f q;
        model_->cloud->getPointFast(neighbours[k], q.x(), q.y(), q.z());
        q -= Eigen::Vector3f(x, y, z);
        sum += q;
        products += q * q.transpose();
        count += 1;
    }
    Eigen::Vector3f normal = unpacked(seenFrom_[index]).cast<float>();
    if (count >= 5) {
        const Eigen::Matrix3f scatter = products / count - sum * sum.transpose() / (count * count);
        Eigen::SelfAdjointEigenSolver<Eigen::Matrix3f> solver;
        solver.computeDirect(scatter);
        const Eigen::Vector3f spread = solver.eigenvalues();
        if (spread[1] > 0.03F * spread[2] && spread[0] < 0.4F * spread[1]) {
            const Eigen::Vector3f plane = solver.eigenvectors().col(0);
            normal = plane.dot(normal) < 0 ? Eigen::Vector3f(-plane) : plane;
        }
    }
    model_->normals[index] = {normal.x(), normal.y(), normal.z()};
}

}  // namespace djpete::texture
