#include "djpete/solver/problem.h"

#include <string>

namespace djpete::solver {

PoseId Problem::addPose(const SE3& T, bool constant) {
    values_.poses.push_back(T);
    constant_[0].push_back(constant);
    return {numPoses() - 1};
}

PointId Problem::addPoint(const Vec3& p, bool constant) {
    values_.points.push_back(p);
    constant_[1].push_back(constant);
    return {numPoints() - 1};
}

VectorId Problem::addVector6(const Vec6& v, bool constant) {
    values_.vectors.push_back(v);
    constant_[2].push_back(constant);
    return {numVectors() - 1};
}

int Problem::numResiduals() const {
    int n = 0;
    for (const Group& g : groups_) n += g.residuals->size();
    return n;
}

int Problem::findGroup(const void* tag) const {
    for (int g = 0; g < numGroups(); ++g) {
        if (groups_[std::size_t(g)].tag == tag) return g;
    }
    return -1;
}

int Problem::addGroup(const void* tag, std::unique_ptr<detail::ResidualGroup> residuals) {
    groups_.push_back({tag, std::move(residuals)});
    return numGroups() - 1;
}

void Problem::requireKnown(std::initializer_list<std::pair<detail::Kind, int>> variables,
                           const char* name) const {
    for (auto a = variables.begin(); a != variables.end(); ++a) {
        const int count = a->first == detail::Kind::Pose    ? numPoses()
                          : a->first == detail::Kind::Point ? numPoints()
                                                            : numVectors();
        if (a->second < 0 || a->second >= count) {
            throw std::invalid_argument(std::string("Problem::add: ") + name +
                                        " has a variable that is not of this problem");
        }
        for (auto b = variables.begin(); b != a; ++b) {
            if (*a == *b) {
                throw std::invalid_argument(std::string("Problem::add: ") + name +
                                            " has the same variable twice");
            }
        }
    }
}

}  // namespace djpete::solver
