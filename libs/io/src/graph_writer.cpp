#include "djpete/io/graph_writer.h"

#include <cmath>
#include <iomanip>
#include <map>

#include "djpete/geometry/mrpt_bridge.h"
#include "text_file.h"

namespace djpete::io {

namespace {

using geometry::Mat6;
using geometry::SE3;
using geometry::Vec3;
using mrpt::graphs::TNodeID;

constexpr std::size_t kCovisible = 30;  ///< shared landmarks that make an edge

/// Standard deviations of keyframe-to-keyframe edges. The map keeps no covariance of its
/// cameras, so this is what stereo odometry does over a keyframe's distance.
const Vec3 kSigmaKeyframe_m(0.05, 0.05, 0.05);
const Vec3 kSigmaKeyframe_rad(0.005, 0.005, 0.005);

/// d(twist)/d(x, y, z, yaw, pitch, roll) of T_a_b, twist on the right: rho = R^T dxyz, and phi by
/// the body rates of R = Rz(yaw) Ry(pitch) Rx(roll).
Mat6 twistFromYawPitchRoll(const SE3& T_a_b, double pitch, double roll) {
    Mat6 J = Mat6::Zero();
    J.topLeftCorner<3, 3>() = T_a_b.rotation().transpose();
    const double sp = std::sin(pitch), cp = std::cos(pitch);
    const double sr = std::sin(roll), cr = std::cos(roll);
    J.block<3, 1>(3, 3) << -sp, cp * sr, cp * cr;
    J.block<3, 1>(3, 4) << 0, cr, -sr;
    J.block<3, 1>(3, 5) << 1, 0, 0;
    return J;
}

mrpt::poses::CPose3DPDFGaussianInf edge(const SE3& T_a_b, const Mat6& information) {
    mrpt::poses::CPose3DPDFGaussianInf out;
    out.mean = geometry::toCPose3D(T_a_b.normalised());
    const Mat6 J = twistFromYawPitchRoll(T_a_b, out.mean.pitch(), out.mean.roll());
    const Mat6 turned = J.transpose() * information * J;
    out.cov_inv = mrpt::math::CMatrixDouble66(Mat6(0.5 * (turned + turned.transpose())));
    return out;
}

/// Builds the graph step by step.
class Builder {
  public:
    explicit Builder(const map::SlamMap& map) : map_(map) {
        addKeyframes();
        addCovisibility();
        for (const auto& [id, object] : map_.objects()) {
            if (!object.states.empty()) {
                object.moving ? addMoving(object) : addStatic(object);
            }
        }
    }
    PoseGraph take() { return std::move(out_); }

  private:
    SE3 T_world_vehicle(const map::Keyframe& kf) const {
        return kf.T_world_cam * kf.T_vehicle_cam.inverse();
    }
    TNodeID addNode(const SE3& T_world_node, GraphNode node) {
        node.node = out_.nodes.size();
        out_.graph.nodes[node.node] = geometry::toCPose3D(T_world_node.normalised());
        out_.nodes.push_back(node);
        return node.node;
    }
    void addEdge(TNodeID from, TNodeID to, const SE3& T_from_to, const Mat6& information) {
        out_.graph.insertEdge(from, to, edge(T_from_to, information));
    }

    void addKeyframes() {
        const Mat6 information = obs::diagonalInformation(kSigmaKeyframe_m, kSigmaKeyframe_rad);
        const map::Keyframe* before = nullptr;
        for (const auto& [id, kf] : map_.keyframes()) {
            GraphNode node;
            node.keyframe = id;
            node.frame = kf.frame;
            keyframeNode_[id] = addNode(T_world_vehicle(kf), node);
            if (before != nullptr) {
                const SE3 T_odom_before = before->T_odom_cam * before->T_vehicle_cam.inverse();
                const SE3 T_odom_now = kf.T_odom_cam * kf.T_vehicle_cam.inverse();
                addEdge(keyframeNode_[before->id], keyframeNode_[id],
                        T_odom_before.inverse() * T_odom_now, information);
            }
            before = &kf;
        }
        out_.graph.root = 0;
    }

    void addCovisibility() {
        std::map<std::pair<map::KeyframeId, map::KeyframeId>, std::size_t> shared;
        for (const auto& [id, landmark] : map_.landmarks()) {
            for (auto a = landmark.observations.begin(); a != landmark.observations.end(); ++a) {
                for (auto b = std::next(a); b != landmark.observations.end(); ++b) {
                    ++shared[{a->first, b->first}];
                }
            }
        }
        const Mat6 information = obs::diagonalInformation(kSigmaKeyframe_m, kSigmaKeyframe_rad);
        for (const auto& [pair, count] : shared) {
            const TNodeID from = keyframeNode_[pair.first], to = keyframeNode_[pair.second];
            if (count < kCovisible || to == from + 1) continue;
            const SE3 T_from_to = T_world_vehicle(map_.keyframes().at(pair.first)).inverse() *
                                  T_world_vehicle(map_.keyframes().at(pair.second));
            addEdge(from, to, T_from_to, information);
        }
    }

    /// T_vehicle_obj of a detection, seen from the vehicle at the keyframe its frame refers to.
    struct Hung {
        map::KeyframeId keyframe;
        SE3 T_vehicle_obj;
        bool atKeyframe = false;
    };
    std::optional<Hung> hung(const map::ObjectObservation& seen) const {
        const auto frame = map_.frames().find(seen.frame);
        if (frame == map_.frames().end()) return std::nullopt;
        const map::Keyframe& kf = map_.keyframes().at(frame->second.reference);
        return Hung{kf.id, kf.T_vehicle_cam * frame->second.T_ref_cam * seen.T_cam_obj,
                    kf.frame == seen.frame};
    }

    void addStatic(const map::ObjectTrack& object) {
        GraphNode node;
        node.object = object.id;
        node.frame = object.states.rbegin()->first;
        const TNodeID id = addNode(map_.T_world_obj(object.states.rbegin()->second), node);
        for (const auto& [frame, seen] : object.observations) {
            if (const auto h = hung(seen)) {
                addEdge(keyframeNode_[h->keyframe], id, h->T_vehicle_obj, seen.information);
            }
        }
    }

    void addMoving(const map::ObjectTrack& object) {
        for (const auto& [frame, seen] : object.observations) {
            const auto h = hung(seen);
            const auto state = object.states.find(frame);
            if (!h || !h->atKeyframe || state == object.states.end()) continue;
            GraphNode node;
            node.object = object.id;
            node.keyframe = h->keyframe;
            node.frame = frame;
            const TNodeID id = addNode(map_.T_world_obj(state->second), node);
            addEdge(keyframeNode_[h->keyframe], id, h->T_vehicle_obj, seen.information);
        }
    }

    const map::SlamMap& map_;
    PoseGraph out_;
    std::map<map::KeyframeId, TNodeID> keyframeNode_;
};

void writeNodeTable(const std::vector<GraphNode>& nodes, const std::string& file) {
    TextFile out(file);
    out.text("node,kind,keyframe_id,object_id,frame\n");
    for (const auto& n : nodes) {
        const char* kind =
            !n.object ? "keyframe" : (n.keyframe ? "moving_object" : "static_object");
        out.text(std::to_string(n.node) + "," + kind + "," +
                 (n.keyframe ? std::to_string(n.keyframe->value) : "") + "," +
                 (n.object ? std::to_string(n.object->value) : "") + "," +
                 std::to_string(n.frame.value) + "\n");
    }
    out.close();
}

}  // namespace

PoseGraph makePoseGraph(const map::SlamMap& map) { return Builder(map).take(); }

void writePoseGraph(const map::SlamMap& map, const std::string& file) {
    const PoseGraph graph = makePoseGraph(map);
    TextFile out(file);
    out.stream() << std::setprecision(15);
    graph.graph.writeAsText(out.stream());
    out.close();
    writeNodeTable(graph.nodes, file + ".nodes.csv");
}

}  // namespace djpete::io
