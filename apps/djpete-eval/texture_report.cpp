#include "texture_report.h"

#include <cstdio>
#include <nlohmann/json.hpp>
#include <sstream>

#include "djpete/evaluation/statistics.h"
#include "djpete/evaluation/texture_curve.h"
#include "djpete/obs/errors.h"

namespace djpete::apps {

using namespace evaluation;
using obs::InputError;

namespace {

template <class Value>
std::vector<double> valuesOf(const TextureErrors& errors, const Value& value) {
    std::vector<double> out;
    for (const auto& o : errors.objects) {
        const std::optional<double> v = value(o);
        if (v) out.push_back(*v);
    }
    return out;
}

struct Figures {
    Summary coverage10, coverage5, keyframe10, colour, albedo, ownGain, light, psnr, flat, spread,
        iou;
    std::optional<double> pointsBleeding, samplesBleeding;
};

Figures figuresOf(const TextureErrors& e) {
    using O = ObjectTexture;
    Figures f;
    f.coverage10 = summarise(valuesOf(e, [](const O& o) { return o.coverage.share10(); }));
    f.coverage5 = summarise(valuesOf(e, [](const O& o) { return o.coverage.share5(); }));
    f.keyframe10 = summarise(valuesOf(e, [](const O& o) { return o.keyframeCoverage.share10(); }));
    f.colour = summarise(valuesOf(e, [](const O& o) { return o.colourError; }));
    f.albedo = summarise(valuesOf(e, [](const O& o) { return o.albedoError; }));
    f.ownGain = summarise(valuesOf(e, [](const O& o) { return o.ownGainError; }));
    f.light = summarise(valuesOf(e, [](const O& o) { return o.lightError; }));
    f.psnr = summarise(valuesOf(e, [](const O& o) { return o.psnr_dB; }));
    f.flat = summarise(valuesOf(e, [](const O& o) { return o.flatPsnr_dB; }));
    f.spread = summarise(valuesOf(e, [](const O& o) { return o.spread; }));
    f.iou = summarise(valuesOf(e, [](const O& o) { return o.iou; }));
    Bleeding all;
    for (const auto& o : e.objects) {
        all.samples += o.bleeding.samples, all.wrongSamples += o.bleeding.wrongSamples;
        all.points += o.bleeding.points, all.wrongPoints += o.bleeding.wrongPoints;
    }
    if (all.points > 0) {
        f.pointsBleeding = static_cast<double>(all.wrongPoints) / static_cast<double>(all.points);
        f.samplesBleeding =
            static_cast<double>(all.wrongSamples) / static_cast<double>(all.samples);
    }
    return f;
}

std::string number(const std::optional<double>& v, const char* format, double scale = 1) {
    if (!v) return "-";
    char text[32];
    std::snprintf(text, sizeof(text), format, scale * *v);
    return text;
}

std::string table(const TextureErrors& e) {
    std::ostringstream out;
    out << "object actor  views near points coloured  cover10 cover5   kf10 albedo   dE00  light   "
           "PSNR "
           "  flat   IoU  bleed  spread held\n";
    for (const auto& o : e.objects) {
        char line[256];
        const double n = static_cast<double>(std::max<std::size_t>(1, o.bleeding.points));
        std::snprintf(line, sizeof(line),
                      "%6lld %5lld%s %5zu %4zu %6zu %8zu  %6s%% %5s%% %5s%% %6s %6s %6s %6s %6s "
                      "%5s %5.2f%% %7s "
                      "%4zu\n",
                      static_cast<long long>(o.objectId), static_cast<long long>(o.actorId),
                      o.moving ? "*" : " ", o.views, o.nearViews, o.points, o.colouredPoints,
                      number(o.coverage.share10(), "%.1f", 100).c_str(),
                      number(o.coverage.share5(), "%.1f", 100).c_str(),
                      number(o.keyframeCoverage.share10(), "%.1f", 100).c_str(),
                      number(o.albedoError, "%.2f").c_str(), number(o.colourError, "%.2f").c_str(),
                      number(o.lightError, "%.2f").c_str(), number(o.psnr_dB, "%.2f").c_str(),
                      number(o.flatPsnr_dB, "%.2f").c_str(), number(o.iou, "%.2f").c_str(),
                      100 * static_cast<double>(o.bleeding.wrongPoints) / n,
                      number(o.spread, "%.1f").c_str(), o.heldOut);
        out << line;
    }
    const Figures f = figuresOf(e);
    const auto row = [&out](const char* name, const std::string& value) {
        char line[160];
        std::snprintf(line, sizeof(line), "%-62s %s\n", name, value.c_str());
        out << line;
    };
    out << "\n"
        << e.objects.size() << " objects with enough near views; " << e.fewViews << " have fewer, "
        << e.withoutActor << " are no actor, " << e.withoutMesh << " have no mesh. * moves.\n";
    row("surface seen that is coloured within 0.10 m, median",
        number(f.coverage10.median, "%.1f %%", 100));
    row("  the same, mean", number(f.coverage10.mean, "%.1f %%", 100));
    row("  within 0.05 m, median", number(f.coverage5.median, "%.1f %%", 100));
    row("  of what any keyframe saw, within 0.10 m, median",
        number(f.keyframe10.median, "%.1f %%", 100));
    row("albedo error of objects, CIEDE2000, median", number(f.albedo.median, "%.2f"));
    row("colour error (light and all), CIEDE2000, median", number(f.colour.median, "%.2f"));
    row("  of the images' own pixels (light alone), median", number(f.light.median, "%.2f"));
    row("  with a gain for each object", number(f.ownGain.median, "%.2f"));
    for (const auto& [name, side] : {std::pair{"  points that face the sun", &e.sunny},
                                     std::pair{"  points that face away", &e.shady}}) {
        if (!*side) continue;
        row(name, number((*side)->colourError, "%.2f") + ", with a gain of their own " +
                      number((*side)->ownGainError, "%.2f") + " (gain " +
                      number((*side)->ownGain, "%.3f") + "; " +
                      number((*side)->share, "%.0f %%", 100) + " of points)");
    }
    row("held-out PSNR, median (dB)", number(f.psnr.median, "%.2f"));
    row("  of an even grey, median (dB)", number(f.flat.median, "%.2f"));
    row("points that bleed", number(f.pointsBleeding, "%.2f %%", 100));
    row("samples that bleed", number(f.samplesBleeding, "%.2f %%", 100));
    row("spread of a point's colours between views (0..255), median",
        number(f.spread.median, "%.2f"));
    row("silhouette IoU, median", number(f.iou.median, "%.3f"));
    row("exposure gain in linear light: models, pixels",
        number(e.gain, "%.3f") + ", " + number(e.lightGain, "%.3f"));
    return out.str();
}

const std::pair<const char*, CurveValue> kCurveValues[] = {
    {"image_error", &CurvePoint::imageError}, {"colour_error", &CurvePoint::colourError}};

std::string curveTable(const TextureCurves& curves) {
    std::ostringstream out;
    for (const auto& [name, value] : kCurveValues) {
        const CurveSummary c = summariseCurves(curves, value);
        out << name << " after all views below that after the first: " << c.objectsFalling << " of "
            << c.objects << " objects; falls in " << c.stepsFalling << " of " << c.steps
            << " steps; mean after 1, 2, ... views:";
        for (double v : meanCurve(curves, value)) out << ' ' << number(v, "%.2f");
        out << "\n";
    }
    return out.str();
}

nlohmann::json jsonOf(const std::optional<double>& v) {
    if (!v) return nullptr;
    return *v;
}

std::string json(const TextureErrors& e, const std::optional<TextureCurves>& curves) {
    const Figures f = figuresOf(e);
    nlohmann::json out;
    out["objects"] = e.objects.size();
    out["objects_with_few_views"] = e.fewViews;
    out["objects_without_actor"] = e.withoutActor;
    out["objects_without_mesh"] = e.withoutMesh;
    out["coverage_10cm_median"] = jsonOf(f.coverage10.median);
    out["coverage_10cm_mean"] = jsonOf(f.coverage10.mean);
    out["coverage_5cm_median"] = jsonOf(f.coverage5.median);
    out["coverage_10cm_of_keyframes_median"] = jsonOf(f.keyframe10.median);
    out["albedo_error_de2000_median"] = jsonOf(f.albedo.median);
    out["colour_error_de2000_median"] = jsonOf(f.colour.median);
    out["colour_error_gain_per_object_de2000_median"] = jsonOf(f.ownGain.median);
    for (const auto& [name, side] : {std::pair{"sunny", &e.sunny}, std::pair{"shady", &e.shady}}) {
        if (!*side) continue;
        nlohmann::json part;
        part["share"] = (*side)->share;
        part["colour_error_de2000_median"] = jsonOf((*side)->colourError);
        part["colour_error_own_gain_de2000_median"] = jsonOf((*side)->ownGainError);
        part["own_gain"] = (*side)->ownGain;
        out[name] = part;
    }
    out["light_error_de2000_median"] = jsonOf(f.light.median);
    out["held_out_psnr_db_median"] = jsonOf(f.psnr.median);
    out["held_out_flat_psnr_db_median"] = jsonOf(f.flat.median);
    out["bleeding_points"] = jsonOf(f.pointsBleeding);
    out["bleeding_samples"] = jsonOf(f.samplesBleeding);
    out["colour_spread_median"] = jsonOf(f.spread.median);
    out["silhouette_iou_median"] = jsonOf(f.iou.median);
    out["exposure_gain"] = e.gain;
    out["exposure_gain_of_pixels"] = e.lightGain;
    for (const auto& o : e.objects) {
        nlohmann::json row;
        row["object"] = o.objectId;
        row["actor"] = o.actorId;
        row["moving"] = o.moving;
        row["views"] = o.views;
        row["points"] = o.points;
        row["coloured_points"] = o.colouredPoints;
        row["coverage_10cm"] = jsonOf(o.coverage.share10());
        row["coverage_5cm"] = jsonOf(o.coverage.share5());
        row["albedo_error_de2000"] = jsonOf(o.albedoError);
        row["colour_error_de2000"] = jsonOf(o.colourError);
        row["light_error_de2000"] = jsonOf(o.lightError);
        row["held_out_psnr_db"] = jsonOf(o.psnr_dB);
        row["silhouette_iou"] = jsonOf(o.iou);
        row["bleeding_points"] = o.bleeding.wrongPoints;
        row["colour_spread"] = jsonOf(o.spread);
        out["per_object"].push_back(row);
    }
    if (curves) {
        for (const auto& [name, value] : kCurveValues) {
            const CurveSummary c = summariseCurves(*curves, value);
            nlohmann::json row;
            row["objects"] = c.objects;
            row["objects_falling"] = c.objectsFalling;
            row["steps"] = c.steps;
            row["steps_falling"] = c.stepsFalling;
            row["mean_after_views"] = meanCurve(*curves, value);
            out["curve_" + std::string(name)] = row;
        }
    }
    return out.dump(2) + "\n";
}

std::string withoutSlash(std::string folder) {
    while (folder.size() > 1 && folder.back() == '/') folder.pop_back();
    return folder;
}

/// The result's own `.object` files if there are any; else made again from the drive's rawlog.
ObjectModels modelsOf(const TextureSettings& settings, const EstimatedDrive& estimate,
                      const std::string& drive) {
    ObjectModels models;
    if (!settings.rebuild) models = savedModels(estimate);
    if (!models.empty()) return models;
    const auto texturer = rebuildTextures(estimate, settings.rawlog.value_or(drive + ".rawlog"),
                                          RebuildOptions(), AfterView());
    for (const auto& [id, model] : texturer.models()) {
        models.emplace(static_cast<int64_t>(id.value), model.clone());
    }
    return models;
}

}  // namespace

evaluation::Disturbance parseDisturbance(const std::string& text) {
    Disturbance out;
    char comma = 0, rest = 0;
    std::istringstream in(text);
    if (!(in >> out.shift_m >> comma >> out.turn_deg) || comma != ',' || in >> rest ||
        out.shift_m < 0 || out.turn_deg < 0) {
        throw InputError("disturbance '" + text + "': expected metres and degrees, e.g. 0.2,3");
    }
    return out;
}

std::string textureReport(const TextureSettings& settings, bool asJson) {
    const std::string drive = withoutSlash(settings.driveFolder);
    const TrueDrive truth = readTrueDrive(drive);
    EstimatedDrive estimate = readEstimatedDrive(withoutSlash(settings.resultFolder));
    estimate.disturbance = settings.disturbance;
    TextureCriteria criteria;
    criteria.stripFolder = settings.stripFolder;
    std::optional<TextureCurves> curves;
    if (!settings.curveFile.empty()) {
        curves = textureCurves(estimate, truth, settings.rawlog.value_or(drive + ".rawlog"),
                               criteria, RebuildOptions());
        writeCurvesCsv(*curves, settings.curveFile);
        plotCurves(*curves, settings.curveFile + ".png");
    }
    const auto errors =
        evaluateTextures(modelsOf(settings, estimate, drive), estimate, truth, criteria);
    if (asJson) return json(errors, curves);
    return table(errors) + (curves ? curveTable(*curves) : "");
}

}  // namespace djpete::apps
