#include "djpete/evaluation/texture_curve.h"

#include <algorithm>
#include <cmath>
#include <filesystem>

#include "djpete/evaluation/statistics.h"
#include "texture_poses.h"
#include "truth_views.h"

namespace djpete::evaluation {

namespace {

/// A model after one view.
struct Snapshot {
    std::size_t frame;
    texture::ObjectModel model;
};
using Snapshots = std::map<int64_t, std::vector<Snapshot>>;

bool hasView(const texture::ObjectModel& model, std::size_t frame) {
    return std::any_of(model.views.begin(), model.views.end(),
                       [frame](obs::FrameId id) { return id.value == frame; });
}

Snapshots takeSnapshots(const EstimatedDrive& estimate, const std::string& rawlog,
                        const RebuildOptions& options) {
    Snapshots out;
    const auto texturer = rebuildTextures(
        estimate, rawlog, options, [&](std::size_t frame, const texture::ObjectTexturer& now) {
            for (const auto& [id, model] : now.models()) {
                if (!hasView(model, frame)) continue;
                out[static_cast<int64_t>(id.value)].push_back({frame, model.clone()});
            }
        });
    for (const auto& [id, model] : texturer.models()) {
        const auto found = out.find(static_cast<int64_t>(id.value));
        if (found != out.end()) found->second.back().model = model.clone();
    }
    return out;
}

std::optional<double> errorOfImages(const texture::ObjectModel& model, int64_t object,
                                    const EstimatedDrive& estimate, const TrueDrive& truth,
                                    const std::map<std::size_t, RgbImage>& images,
                                    const std::map<std::size_t, MaskImage>& masks) {
    double sum = 0;
    std::size_t n = 0;
    for (const auto& [frame, image] : images) {
        const auto T_cam_est = estimate.T_cam_obj(object, frame);
        if (!T_cam_est) continue;
        const auto error = imageErrorOf(model, image, masks.at(frame), truth.camera, *T_cam_est);
        if (!error) continue;
        sum += *error;
        ++n;
    }
    if (n == 0) return std::nullopt;
    return sum / static_cast<double>(n);
}

/// Pairs of each step of each object; emptied into medians when the gain is known.
using StepPairs = std::vector<std::vector<ColourPair>>;

/// Every n-th, so that about so many are left.
std::vector<ColourPair> thinned(const std::vector<ColourPair>& pairs) {
    constexpr std::size_t kEnough = 1500;
    const std::size_t step = std::max<std::size_t>(1, pairs.size() / kEnough);
    std::vector<ColourPair> out;
    for (std::size_t i = 0; i < pairs.size(); i += step) out.push_back(pairs[i]);
    return out;
}

std::size_t countColoured(const texture::ObjectModel& model) {
    std::size_t n = 0;
    for (std::size_t i = 0; i < model.size(); ++i) n += isColoured(model, i) ? 1 : 0;
    return n;
}

}  // namespace

TextureCurves textureCurves(const EstimatedDrive& estimate, const TrueDrive& truth,
                            const std::string& rawlog, const TextureCriteria& criteria,
                            const RebuildOptions& options) {
    TextureCurves out;
    std::vector<StepPairs> pairs;
    TruthViews truthViews(estimate, truth);
    for (const auto& [id, steps] : takeSnapshots(estimate, rawlog, options)) {
        const auto object = estimate.objects.find(id);
        if (object == estimate.objects.end()) continue;
        const auto actor = actorOf(object->second, estimate, truth);
        if (!actor || !std::filesystem::exists(truth.meshFile(*actor))) continue;
        if (nearViews(steps.back().model, *actor, truth, criteria.maxRange_m) < criteria.minViews) {
            continue;
        }
        const TruthMesh mesh = readTruthMesh(truth.meshFile(*actor));
        std::map<std::size_t, RgbImage> images;
        std::map<std::size_t, MaskImage> masks;
        for (std::size_t frame : truthViews.heldOutFrames(id, *actor, criteria)) {
            images.emplace(frame, readRgb(truth.imageFile(frame)));
            masks.emplace(frame, truthViews.mask(*actor, frame));
        }
        ObjectCurve curve;
        curve.objectId = id;
        curve.actorId = *actor;
        StepPairs stepPairs;
        for (const auto& step : steps) {
            const auto T_true_est = poseByBestView(step.model, id, *actor, estimate, truth);
            if (!T_true_est) continue;
            CurvePoint point;
            point.step = curve.points.size() + 1;
            point.frame = step.frame;
            point.points = step.model.size();
            point.colouredPoints = countColoured(step.model);
            point.imageError = errorOfImages(step.model, id, estimate, truth, images, masks);
            stepPairs.push_back(thinned(colourPairs(step.model, *T_true_est, mesh)));
            curve.points.push_back(point);
        }
        if (curve.points.empty()) continue;
        out.objects.push_back(std::move(curve));
        pairs.push_back(std::move(stepPairs));
    }
    std::vector<ColourPair> last;
    for (const auto& p : pairs) last.insert(last.end(), p.back().begin(), p.back().end());
    out.gain = fitGain(last);
    for (std::size_t o = 0; o < pairs.size(); ++o) {
        for (std::size_t s = 0; s < pairs[o].size(); ++s) {
            out.objects[o].points[s].colourError =
                quantile(colourErrors(pairs[o][s], out.gain), 0.5);
        }
    }
    return out;
}

CurveSummary summariseCurves(const TextureCurves& curves, CurveValue value) {
    CurveSummary out;
    for (const auto& o : curves.objects) {
        std::vector<double> values;
        for (const auto& p : o.points) {
            if (p.*value) values.push_back(*(p.*value));
        }
        if (values.size() < 2) continue;
        ++out.objects;
        if (values.back() < values.front()) ++out.objectsFalling;
        for (std::size_t i = 1; i < values.size(); ++i) {
            ++out.steps;
            if (values[i] < values[i - 1]) ++out.stepsFalling;
        }
    }
    return out;
}

std::vector<double> meanCurve(const TextureCurves& curves, CurveValue value) {
    std::size_t longest = 0;
    for (const auto& o : curves.objects) longest = std::max(longest, o.points.size());
    std::vector<double> out;
    for (std::size_t s = 0; s < longest; ++s) {
        double sum = 0, n = 0;
        for (const auto& o : curves.objects) {
            const auto& v = o.points[std::min(s, o.points.size() - 1)].*value;
            if (v) sum += *v, n += 1;
        }
        if (n > 0) out.push_back(sum / n);
    }
    return out;
}

}  // namespace djpete::evaluation
