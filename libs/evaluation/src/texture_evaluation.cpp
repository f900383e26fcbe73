#include "djpete/evaluation/texture_evaluation.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <filesystem>

#include "djpete/evaluation/silhouette.h"
#include "djpete/evaluation/statistics.h"
#include "djpete/evaluation/texture_strip.h"
#include "texture_poses.h"
#include "truth_views.h"

namespace djpete::evaluation {

namespace {

using geometry::SE3;

std::vector<TruthView> viewsAt(TruthViews& views, int64_t object, int64_t actor,
                               const TruthMesh& mesh, const std::vector<std::size_t>& frames) {
    std::vector<TruthView> out;
    for (std::size_t frame : frames) {
        if (auto view = views.view(object, actor, mesh, frame)) out.push_back(std::move(*view));
    }
    return out;
}

std::vector<std::size_t> framesOf(const texture::ObjectModel& model) {
    std::vector<std::size_t> out;
    for (obs::FrameId id : model.views) out.push_back(static_cast<std::size_t>(id.value));
    return out;
}

/// Pixels of the mesh that something else hides.
MaskImage hiddenPixels(const TruthView& view) {
    MaskImage out{view.mask.width_px, view.mask.height_px, {}};
    out.pixels.assign(view.mask.pixels.size(), 0);
    for (int v = view.view.y0; v < view.view.y0 + view.view.height; ++v) {
        for (int u = view.view.x0; u < view.view.x0 + view.view.width; ++u) {
            const bool onMesh = view.view.vertex[*view.view.at(u, v)] != MeshView::kNothing;
            if (onMesh && view.mask.at(u, v) == 0) out.pixels[out.index(u, v)] = 255;
        }
    }
    return out;
}

void measureHeldOut(const texture::ObjectModel& model, const std::vector<TruthView>& views,
                    const TrueDrive& truth, ObjectTexture& out) {
    std::vector<double> psnr, flat, iou;
    texture::RenderOptions seenOnly;
    seenOnly.onlySeen = true;
    for (const auto& view : views) {
        const auto colours = renderModel(model, truth.camera, view.T_cam_est, seenOnly);
        const auto match = matchImages(colours, readRgb(truth.imageFile(view.frame)), view.mask);
        if (match) {
            psnr.push_back(match->psnr_dB);
            flat.push_back(match->flatPsnr_dB);
        }
        const auto shape = renderModel(model, truth.camera, view.T_cam_est);
        constexpr double kGap_m = 0.06;
        const int radius_px = std::max(
            1, static_cast<int>(std::lround(kGap_m * truth.camera.fx /
                                            std::max(1.0, view.T_cam_est.translation().z()))));
        const auto overlap =
            silhouetteIou(closedSilhouette(shape, radius_px), view.mask, hiddenPixels(view));
        if (overlap) iou.push_back(*overlap);
    }
    out.heldOut = views.size();
    out.psnr_dB = quantile(psnr, 0.5);
    out.flatPsnr_dB = quantile(flat, 0.5);
    out.iou = quantile(iou, 0.5);
}

void measureSurface(const texture::ObjectModel& model, const TruthMesh& mesh,
                    const std::vector<TruthView>& views, const std::vector<TruthView>& keyframes,
                    const SE3& T_true_est, const TrueDrive& truth, double maxRange_m,
                    ObjectTexture& out) {
    out.coverage =
        coverageOf(model, T_true_est, mesh, seenVertices(mesh, views, truth.camera, maxRange_m));
    out.keyframeCoverage = coverageOf(model, T_true_est, mesh,
                                      seenVertices(mesh, keyframes, truth.camera, maxRange_m));
    out.pairs = colourPairs(model, T_true_est, mesh);
    out.albedoPairs = albedoPairs(model, T_true_est, mesh);
    for (const auto& view : views) {
        if (view.T_cam_true.translation().norm() > maxRange_m) continue;
        const auto pairs = pixelPairs(readRgb(truth.imageFile(view.frame)), view, mesh, 4);
        out.lightPairs.insert(out.lightPairs.end(), pairs.begin(), pairs.end());
    }
    if (truth.sun_world) {
        const auto T_world_obj = truth.actors.at(out.actorId).T_world_obj.at(views.front().frame);
        markSunny(out.pairs, T_world_obj.rotation().transpose() * *truth.sun_world);
    }
    out.bleeding = bleedingOf(model, views, truth.camera);
    out.spread = colourSpread(model);
}

std::string stripFile(const std::string& folder, int64_t object) {
    char name[32];
    std::snprintf(name, sizeof(name), "/%04lld.png", static_cast<long long>(object));
    return folder + name;
}

void writeStrip(const texture::ObjectModel& model, const TruthView& view, const TruthMesh& mesh,
                const TrueDrive& truth, double gain, const std::string& file) {
    const auto strip = textureStrip(model, view, mesh, readRgb(truth.imageFile(view.frame)),
                                    truth.camera, 1 / gain);
    if (strip) writeRgb(*strip, file);
}

SideErrors sideErrors(const std::vector<ColourPair>& all, bool sunny, double gain) {
    std::vector<ColourPair> pairs;
    std::copy_if(all.begin(), all.end(), std::back_inserter(pairs),
                 [sunny](const ColourPair& p) { return p.sunny == sunny; });
    SideErrors out;
    if (all.empty()) return out;
    out.share = static_cast<double>(pairs.size()) / static_cast<double>(all.size());
    out.colourError = quantile(colourErrors(pairs, gain), 0.5);
    out.ownGain = fitGain(pairs);
    out.ownGainError = quantile(colourErrors(pairs, out.ownGain), 0.5);
    return out;
}

void fitExposure(bool sunKnown, TextureErrors& out) {
    std::vector<ColourPair> pairs, light, albedo;
    for (const auto& o : out.objects) {
        pairs.insert(pairs.end(), o.pairs.begin(), o.pairs.end());
        albedo.insert(albedo.end(), o.albedoPairs.begin(), o.albedoPairs.end());
        light.insert(light.end(), o.lightPairs.begin(), o.lightPairs.end());
    }
    out.gain = fitGain(pairs);
    out.lightGain = fitGain(light);
    out.albedoGain = fitGain(albedo);
    if (sunKnown) {
        out.sunny = sideErrors(pairs, true, out.gain);
        out.shady = sideErrors(pairs, false, out.gain);
    }
    for (auto& o : out.objects) {
        o.colourError = quantile(colourErrors(o.pairs, out.gain), 0.5);
        o.ownGainError = quantile(colourErrors(o.pairs, fitGain(o.pairs)), 0.5);
        o.albedoError = quantile(colourErrors(o.albedoPairs, out.albedoGain), 0.5);
        o.lightError = quantile(colourErrors(o.lightPairs, out.lightGain), 0.5);
    }
}

}  // namespace

std::optional<int64_t> actorOf(const EstimatedObject& object, const EstimatedDrive& estimate,
                               const TrueDrive& truth) {
    constexpr double kGate_m = 2;
    std::map<int64_t, std::size_t> votes;
    for (const auto& [frame, pose] : object.T_world_obj) {
        const auto T_cam_est = estimate.T_cam_obj(object.id, frame);
        if (!T_cam_est) continue;
        double best = kGate_m;
        std::optional<int64_t> nearest;
        for (const auto& [id, actor] : truth.actors) {
            const auto T_cam_true = truth.T_cam_obj(id, frame);
            if (!T_cam_true) continue;
            const geometry::Vec3 d = T_cam_true->translation() - T_cam_est->translation();
            const double distance = std::hypot(d.x(), d.z());
            if (distance < best) best = distance, nearest = id;
        }
        if (nearest) ++votes[*nearest];
    }
    const auto most =
        std::max_element(votes.begin(), votes.end(),
                         [](const auto& a, const auto& b) { return a.second < b.second; });
    if (most == votes.end()) return std::nullopt;
    return most->first;
}

TextureErrors evaluateTextures(const ObjectModels& models, const EstimatedDrive& estimate,
                               const TrueDrive& truth, const TextureCriteria& criteria) {
    TextureErrors out;
    if (!criteria.stripFolder.empty()) std::filesystem::create_directories(criteria.stripFolder);
    TruthViews truthViews(estimate, truth);
    for (const auto& [id, model] : models) {
        const auto object = estimate.objects.find(id);
        if (object == estimate.objects.end()) continue;
        const auto actor = actorOf(object->second, estimate, truth);
        if (!actor) {
            ++out.withoutActor;
            continue;
        }
        const auto T_true_est = poseByBestView(model, id, *actor, estimate, truth);
        const std::size_t near = nearViews(model, *actor, truth, criteria.maxRange_m);
        if (near < criteria.minViews || !T_true_est) {
            ++out.fewViews;
            continue;
        }
        if (!std::filesystem::exists(truth.meshFile(*actor))) {
            ++out.withoutMesh;
            continue;
        }
        const TruthMesh mesh = readTruthMesh(truth.meshFile(*actor));
        ObjectTexture result;
        result.objectId = id;
        result.actorId = *actor;
        result.moving = object->second.moving;
        result.points = model.size();
        for (std::size_t i = 0; i < model.size(); ++i) {
            if (isColoured(model, i)) ++result.colouredPoints;
        }
        result.views = model.views.size();
        result.nearViews = near;
        std::vector<std::size_t> keyframes;
        for (const auto& [frame, pose] : object->second.T_world_obj) {
            if (estimate.keyframes.count(frame) > 0) keyframes.push_back(frame);
        }
        const auto views = viewsAt(truthViews, id, *actor, mesh, framesOf(model));
        measureSurface(model, mesh, views, viewsAt(truthViews, id, *actor, mesh, keyframes),
                       *T_true_est, truth, criteria.maxRange_m, result);
        const auto heldOut = truthViews.heldOutFrames(id, *actor, criteria);
        const auto heldOutViews = viewsAt(truthViews, id, *actor, mesh, heldOut);
        measureHeldOut(model, heldOutViews, truth, result);
        if (!criteria.stripFolder.empty() && !heldOutViews.empty()) {
            writeStrip(model, heldOutViews[heldOutViews.size() / 2], mesh, truth,
                       fitGain(result.lightPairs), stripFile(criteria.stripFolder, id));
        }
        out.objects.push_back(std::move(result));
    }
    fitExposure(truth.sun_world.has_value(), out);
    return out;
}

}  // namespace djpete::evaluation
