#include "djpete/solver/solve.h"
#include "normal_equations.h"
#include "reduced_system.h"

namespace djpete::solver {

namespace {

using geometry::Mat6;

/// Keeps a point that one ray alone constrains from making the system singular: it says nothing
/// about the poses along that ray, and with this damping it says (almost) nothing.
constexpr double kPointDamping = 1e-12;
/// Below this a pivot is rounding.
constexpr double kSingularPivot = 1e-10;
constexpr int kDenseUpTo = 60;

std::vector<std::optional<Mat6>> covariancesOf(const Problem& problem, detail::Kind kind,
                                               const std::vector<int>& indices) {
    std::vector<std::optional<Mat6>> out(indices.size());
    const Structure structure(problem);
    if (structure.numSixes() == 0) return out;
    NormalEquations equations(problem, structure);
    if (!equations.linearise(problem.values(), kPointDamping)) return out;
    if (!equations.reduce(0, kPointDamping)) return out;
    const auto system = makeReducedSystem(structure, kDenseUpTo);
    if (!system->factorise(equations.reducedBlocks())) return out;
    if (!(system->smallestPivotRatio() > kSingularPivot)) return out;
    std::vector<int> sixOf(
        std::size_t(kind == detail::Kind::Pose ? problem.numPoses() : problem.numVectors()), -1);
    for (int s = 0; s < structure.numSixes(); ++s) {
        const auto [k, index] = structure.sixes[std::size_t(s)];
        if (k == kind) sixOf[std::size_t(index)] = s;
    }
    for (std::size_t k = 0; k < indices.size(); ++k) {
        const int six = sixOf.at(std::size_t(indices[k]));
        if (six < 0) continue;
        Mat6 C;
        for (int c = 0; c < 6; ++c) {
            const Eigen::VectorXd unit =
                Eigen::VectorXd::Unit(6 * structure.numSixes(), 6 * six + c);
            C.col(c) = system->solve(unit).segment<6>(6 * six);
        }
        if (C.allFinite()) out[k] = 0.5 * (C + C.transpose());
    }
    return out;
}

template <class Id>
std::vector<std::optional<Mat6>> covariancesOfIds(const Problem& problem, detail::Kind kind,
                                                  const std::vector<Id>& ids) {
    std::vector<int> indices;
    for (const Id& id : ids) indices.push_back(id.index);
    return covariancesOf(problem, kind, indices);
}

}  // namespace

std::vector<std::optional<Mat6>> covariances(const Problem& problem,
                                             const std::vector<PoseId>& poses) {
    return covariancesOfIds(problem, detail::Kind::Pose, poses);
}

std::vector<std::optional<Mat6>> covariances(const Problem& problem,
                                             const std::vector<VectorId>& vectors) {
    return covariancesOfIds(problem, detail::Kind::Vector, vectors);
}

std::optional<Mat6> covariance(const Problem& problem, PoseId pose) {
    return covariances(problem, std::vector<PoseId>{pose}).front();
}

std::optional<Mat6> covariance(const Problem& problem, VectorId vector) {
    return covariances(problem, std::vector<VectorId>{vector}).front();
}

}  // namespace djpete::solver
