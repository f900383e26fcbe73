/// Which objects join the backbone's problem, and with which edges.
#include <algorithm>
#include <cmath>
#include <iterator>
#include <map>

#include "djpete/backend/joint.h"

namespace djpete::backend {

namespace {

using geometry::Mat3;
using geometry::SE3;
using geometry::Vec3;
using map::KeyframeId;

/// True if a free camera sees few landmarks of the problem.
bool featuresAreFew(const BackboneProblem& problem, unsigned few) {
    std::vector<unsigned> seen(problem.cameras.size(), 0);
    for (const auto& o : problem.observations) ++seen[o.camera];
    for (std::size_t i = 0; i < seen.size(); ++i) {
        if (!problem.cameras[i].fixed && seen[i] < few) return true;
    }
    return false;
}

double worstSigma_m(const map::ObjectState& state) {
    const Mat3 P = state.covariance.topLeftCorner<3, 3>();
    const Eigen::SelfAdjointEigenSolver<Mat3> eigen(0.5 * (P + P.transpose()),
                                                    Eigen::EigenvaluesOnly);
    return std::sqrt(std::max(0.0, eigen.eigenvalues().maxCoeff()));
}

/// Landmarks within the box; those at its foot and sides may be of the ground and the houses.
unsigned landmarksIn(const BackboneProblem& problem, const SE3& T_world_obj, const Vec3& size_m) {
    constexpr double kShare = 0.45;  // of the size, each way
    const SE3 T_obj_world = T_world_obj.inverse();
    unsigned n = 0;
    for (const auto& p : problem.points) {
        const Vec3 p_obj = (T_obj_world * p.p_world).cwiseAbs();
        if ((p_obj.array() < kShare * size_m.array()).all()) ++n;
    }
    return n;
}

/// Weight of each detection of an object, by the number of neighbours in time whose errors are
/// much the same.
std::map<map::FrameId, double> weights(const map::ObjectTrack& track, const JointOptions& options) {
    std::map<map::FrameId, double> out;
    for (const auto& [frame, o] : track.observations) {
        const uint64_t reach = options.correlatedFrames;
        const auto first = track.observations.lower_bound(
            map::FrameId{frame.value - std::min(frame.value, reach)});
        const auto end = track.observations.upper_bound(map::FrameId{frame.value + reach});
        const auto n = static_cast<double>(std::distance(first, end));
        out[frame] = 1 / (1 + (n - 1) * options.correlation);
    }
    return out;
}

}  // namespace

void addObjects(const map::SlamMap& map, const std::set<map::ObjectId>& solved,
                const JointOptions& options, BackboneProblem& problem) {
    if (problem.cameras.empty() || !featuresAreFew(problem, options.fewLandmarks)) return;
    std::map<KeyframeId, std::size_t> index;
    for (std::size_t i = 0; i < problem.cameras.size(); ++i) index[problem.cameras[i].id] = i;
    const uint32_t world = map.lastKeyframe()->world;
    for (const map::ObjectId id : solved) {
        const auto it = map.objects().find(id);
        if (it == map.objects().end()) continue;
        const map::ObjectTrack& track = it->second;
        if (track.moving || track.observations.size() < options.minObservations) continue;
        const map::ObjectState& state = track.states.rbegin()->second;
        if (map.keyframes().at(state.anchor).world != world) continue;
        if (!(worstSigma_m(state) <= options.maxSigma_m)) continue;
        std::set<std::size_t> cameras;
        bool anyFree = false;
        for (const auto& [frame, o] : track.observations) {
            const auto at = index.find(map.frames().at(frame).reference);
            if (at == index.end()) continue;
            cameras.insert(at->second);
            anyFree = anyFree || !problem.cameras[at->second].fixed;
        }
        if (!anyFree || cameras.size() < options.minCameras) continue;
        const SE3 T_world_obj = map.T_world_obj(state);
        if (landmarksIn(problem, T_world_obj, track.size_m) > options.maxLandmarksInBox) continue;

        const auto weightOf = weights(track, options);
        for (const auto& [frame, o] : track.observations) {
            const auto& pose = map.frames().at(frame);
            const map::Keyframe& keyframe = map.keyframes().at(pose.reference);
            if (keyframe.world != world) continue;
            BackboneProblem::ObjectEdge edge;
            edge.object = problem.objects.size();
            const auto at = index.find(keyframe.id);
            if (at != index.end()) edge.camera = at->second;
            edge.T_world_cam = keyframe.T_world_cam;
            edge.T_cam_obj = pose.T_ref_cam * o.T_cam_obj;
            edge.information = weightOf.at(frame) * o.information;
            problem.objectEdges.push_back(edge);
        }
        problem.objects.push_back({id, T_world_obj});
    }
}

}  // namespace djpete::backend
