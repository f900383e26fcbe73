/// Figures known for KITTI tracking 0000, 0006 and 0010: PointRCNN's detections with the identities
/// of the labels.
#include <Eigen/Core>
#include <algorithm>
#include <cstdio>
#include <map>

#include "djpete/evaluation/tracking_errors.h"
#include "djpete/geometry/mrpt_bridge.h"
#include "djpete/obs/overlap.h"
#include "djpete/solver/assignment.h"
#include "evaluation_worlds.h"

using namespace djpete::evaluation;
using namespace evaluation_test;

namespace {

constexpr int64_t kUnmatched = 100000;  // identities of detections start here

/// Rows `frame,type,x1,y1,x2,y2,score,h,w,l,x,y,z,ry,alpha`; identities are the rows' numbers.
std::vector<TrackingBox> readDetections(const std::filesystem::path& file) {
    std::vector<TrackingBox> boxes;
    std::ifstream in(file);
    for (std::string line; std::getline(in, line);) {
        std::replace(line.begin(), line.end(), ',', ' ');
        std::istringstream words(line);
        double v[15];
        for (double& value : v) words >> value;
        TrackingBox box;
        box.frame = static_cast<std::size_t>(v[0]);
        box.trackId = kUnmatched + static_cast<int64_t>(boxes.size());
        box.size_m = {v[9], v[8], v[7]};
        box.T_cam_obj = labelPose({v[10], v[11], v[12]}, v[7], v[13]);
        box.image = {v[2], v[3], v[4], v[5]};
        box.score = v[6];
        boxes.push_back(box);
    }
    return boxes;
}

bool isCarOrVan(const TrackingBox& box) {
    return box.objectClass == djpete::obs::ObjectClass::Car ||
           box.objectClass == djpete::obs::ObjectClass::Van;
}

template <typename Boxes>
auto byFrame(Boxes& boxes) {
    std::map<std::size_t, std::vector<decltype(&boxes.front())>> frames;
    for (auto& box : boxes) {
        if (isCarOrVan(box)) frames[box.frame].push_back(&box);
    }
    return frames;
}

djpete::obs::UprightBox standing(const TrackingBox& box) {
    return djpete::obs::uprightBox(djpete::geometry::opticalToVehicleAxes() * box.T_cam_obj,
                                   box.size_m);
}

/// Gives each detection the identity of the label that it matches best.
void takeIdentities(const std::vector<TrackingBox>& labels, std::vector<TrackingBox>& detections,
                    double limit) {
    auto detectionsOf = byFrame(detections);
    for (const auto& [frame, boxes] : byFrame(labels)) {
        const auto& found = detectionsOf[frame];
        Eigen::MatrixXd cost(boxes.size(), found.size());
        for (std::size_t i = 0; i < boxes.size(); ++i) {
            for (std::size_t j = 0; j < found.size(); ++j) {
                const double overlap =
                    djpete::obs::volumeOverlap(standing(*boxes[i]), standing(*found[j]));
                cost(static_cast<Eigen::Index>(i), static_cast<Eigen::Index>(j)) =
                    overlap < limit ? 1e9 : 1 - overlap;
            }
        }
        const auto columns = djpete::solver::assign(cost, 1e4);
        for (std::size_t i = 0; i < boxes.size(); ++i) {
            if (columns[i]) found[*columns[i]]->trackId = boxes[i]->trackId;
        }
    }
}

std::vector<TrackingPair> perfectIdentities(const std::filesystem::path& data, double limit) {
    std::vector<TrackingPair> pairs;
    for (const std::string name : {"0000", "0006", "0010"}) {
        const auto folder = data / "kitti/tracking";
        TrackingPair pair;
        pair.labels = readTrackingSequence(folder / "training/label_02" / (name + ".txt"));
        pair.results.boxes = readDetections(folder / "detections/pointrcnn_car" / (name + ".txt"));
        takeIdentities(pair.labels.boxes, pair.results.boxes, limit);
        pairs.push_back(std::move(pair));
    }
    return pairs;
}

/// The figure as the published table prints it.
std::string percent(const std::optional<double>& value) {
    char text[32];
    std::snprintf(text, sizeof text, "%.2f", 100 * value.value());
    return text;
}

}  // namespace

TEST(TrackingReference, PerfectIdentitiesOfRawDetections) {
    DJPETE_SHARED_OR_SKIP(data, "data");
    const auto at25 = evaluateTracking(perfectIdentities(data, 0.25), {}).limits.at(0);
    EXPECT_EQ(percent(at25.counts.mota()), "90.04");
    EXPECT_EQ(percent(at25.sAmota), "96.67");
    EXPECT_EQ(percent(at25.counts.motp()), "80.86");
    EXPECT_EQ(at25.counts.switches, 0U);
    EXPECT_EQ(at25.counts.fragments, 17U);
    EXPECT_EQ(at25.counts.falsePositives, 54U);
    EXPECT_EQ(at25.counts.misses, 75U);
    // The published MOTA at 0.5 is that of identities taken over at 0.5 too.
    const auto at50 = evaluateTracking(perfectIdentities(data, 0.5), {}).limits.at(1);
    EXPECT_EQ(percent(at50.counts.mota()), "88.42");
}

TEST(TrackingReference, PerfectIdentitiesWithoutFalseAlarms) {
    DJPETE_SHARED_OR_SKIP(data, "data");
    for (const auto& [limit, mota] : {std::pair{0.25, "94.21"}, std::pair{0.5, "93.36"}}) {
        auto pairs = perfectIdentities(data, limit);
        for (auto& pair : pairs) {
            auto& boxes = pair.results.boxes;
            const auto unmatched = [](const auto& box) { return box.trackId >= kUnmatched; };
            boxes.erase(std::remove_if(boxes.begin(), boxes.end(), unmatched), boxes.end());
        }
        const auto figures = evaluateTracking(pairs, {}).limits.at(limit == 0.25 ? 0 : 1);
        EXPECT_EQ(percent(figures.counts.mota()), mota);
        EXPECT_EQ(figures.counts.falsePositives, 0U);
        if (limit == 0.25) {
            EXPECT_EQ(figures.counts.misses, 75U);
        }
    }
}
