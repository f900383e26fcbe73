#include "silhouette_report.h"

#include <cstdio>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <sstream>

#include "djpete/evaluation/statistics.h"
#include "djpete/figures/silhouette_strips.h"
#include "djpete/obs/errors.h"

namespace djpete::apps {

using namespace evaluation;
using obs::InputError;
namespace fs = std::filesystem;

namespace {

std::string number(const std::optional<double>& v) {
    if (!v) return "-";
    char text[32];
    std::snprintf(text, sizeof(text), "%.3f", *v);
    return text;
}

std::size_t withoutTruth(const DriveSilhouettes& all) {
    std::size_t out = 0;
    for (const auto& o : all.objects) {
        if (o.masked.empty() && o.boxed.empty()) ++out;
    }
    return out;
}

std::size_t aloneFrames(const DriveSilhouettes& all) {
    std::size_t out = 0;
    for (const auto& o : all.objects) out += o.alone.size();
    return out;
}

std::string table(const DriveSilhouettes& all) {
    std::ostringstream out;
    out << "object views frames  masks   IoU cuboid excess missing  boxes  boxIoU alone\n";
    for (const auto& o : all.objects) {
        char line[160];
        std::snprintf(line, sizeof(line), "%5lld%s %5zu %6zu %6zu %5s %6s %6s %7s %6zu  %6s %5zu\n",
                      static_cast<long long>(o.object), o.moving ? "*" : " ", o.nearViews,
                      o.frames(), o.masked.size(), number(o.iou).c_str(),
                      number(o.cuboidIou).c_str(), number(o.excess).c_str(),
                      number(o.missing).c_str(), o.boxed.size(), number(o.boxIou).c_str(),
                      o.alone.size());
        out << line;
    }
    out << "* moves. cuboid: IoU of its projection's box and the mask's; low where the object's "
           "pose or "
           "size is wrong\n(or much is hidden). excess: share of the silhouette that is not mask; "
           "missing: of the mask, not\nsilhouette. alone: frames in which no truth's box overlaps. "
           "Medians over frames.\n\n";
    const Summary iou = summarise(all.ious()), box = summarise(all.boxIous());
    out << "silhouette IoU with masks, median over " << iou.count
        << " objects: " << number(iou.median) << "\n"
        << "IoU of the silhouette's box with boxes, median over " << box.count
        << " objects: " << number(box.median) << "\n"
        << withoutTruth(all) << " of " << all.objects.size()
        << " objects never had a truth; in all " << aloneFrames(all) << " views had none\n"
        << "models left out: " << all.noVehicle << " no vehicle, " << all.fewViews
        << " with fewer than 3 near views, " << all.withoutFrame << " with no frame that counts\n"
        << "views left out: " << all.cut << " cut by the image's border, " << all.hidden
        << " hidden by other models or too small\n"
        << "frames: " << all.framesWithMasks << " with masks, " << all.framesWithBoxes
        << " with boxes only, " << all.framesEmpty << " with nothing detected, "
        << all.framesWithoutTruth << " without detections, " << all.keyframes
        << " keyframes (not compared)\ntruths:";
    for (const auto& [source, count] : all.sources) {
        out << ' ' << count << " of " << (source.empty() ? "(unnamed)" : source);
    }
    out << "\n";
    return out.str();
}

nlohmann::json jsonOf(const std::optional<double>& v) {
    if (!v) return nullptr;
    return *v;
}

std::string json(const DriveSilhouettes& all) {
    nlohmann::json out;
    const Summary iou = summarise(all.ious()), box = summarise(all.boxIous());
    out["objects"] = all.objects.size();
    out["objects_with_masks"] = iou.count;
    out["silhouette_iou_median"] = jsonOf(iou.median);
    out["objects_with_boxes"] = box.count;
    out["box_iou_median"] = jsonOf(box.median);
    out["objects_without_truth"] = withoutTruth(all);
    out["views_without_truth"] = aloneFrames(all);
    out["models_no_vehicle"] = all.noVehicle;
    out["models_with_few_views"] = all.fewViews;
    out["models_without_frame"] = all.withoutFrame;
    out["views_cut"] = all.cut;
    out["views_hidden"] = all.hidden;
    out["frames_with_masks"] = all.framesWithMasks;
    out["frames_with_boxes"] = all.framesWithBoxes;
    out["frames_with_nothing_detected"] = all.framesEmpty;
    out["frames_without_detections"] = all.framesWithoutTruth;
    out["keyframes"] = all.keyframes;
    out["sources"] = all.sources;
    out["per_object"] = nlohmann::json::array();
    for (const auto& o : all.objects) {
        nlohmann::json row;
        row["object"] = o.object;
        row["moving"] = o.moving;
        row["near_views"] = o.nearViews;
        row["frames"] = o.frames();
        row["frames_with_mask"] = o.masked.size();
        row["frames_with_box"] = o.boxed.size();
        row["silhouette_iou"] = jsonOf(o.iou);
        row["cuboid_iou"] = jsonOf(o.cuboidIou);
        row["excess"] = jsonOf(o.excess);
        row["missing"] = jsonOf(o.missing);
        row["box_iou"] = jsonOf(o.boxIou);
        for (const auto& c : o.masked) row["ious"][std::to_string(c.frame)] = c.fit->iou;
        for (const auto& c : o.boxed) row["box_ious"][std::to_string(c.frame)] = *c.boxIou;
        out["per_object"].push_back(row);
    }
    return out.dump(2) + "\n";
}

std::string driveOf(const SilhouetteSettings& settings) {
    if (settings.rawlog) return *settings.rawlog;
    const fs::path file(settings.detections);
    const std::string stem = file.stem().string();
    for (const std::string end : {"_masks", "_objects"}) {
        if (stem.size() > end.size() && stem.substr(stem.size() - end.size()) == end) {
            return (file.parent_path() / (stem.substr(0, stem.size() - end.size()) + ".rawlog"))
                .string();
        }
    }
    return settings.detections;  // detections inside the drive's own rawlog
}

}  // namespace

std::string silhouetteReport(const SilhouetteSettings& settings, bool asJson) {
    EstimatedDrive estimate = readEstimatedDrive(settings.resultFolder);
    estimate.disturbance = settings.disturbance;
    const ObjectModels models = savedModels(estimate);
    if (models.empty()) {
        throw InputError(settings.resultFolder +
                         "/objects: no .object file; expected a result of djpete-slam with "
                         "textures (texture = true in section [pipeline])");
    }
    const std::string drive = driveOf(settings);
    const auto all =
        evaluateSilhouettes(models, estimate, drive, settings.detections, SilhouetteCriteria());
    if (!settings.stripFolder.empty()) {
        figures::drawSilhouetteStrips(all, models, estimate, drive, settings.stripFolder);
    }
    return asJson ? json(all) : table(all);
}

}  // namespace djpete::apps
