#include "report.h"

#include <iomanip>
#include <nlohmann/json.hpp>
#include <sstream>

namespace djpete::apps {

using namespace evaluation;

namespace {

nlohmann::ordered_json jsonOf(const std::optional<double>& value) {
    return value ? nlohmann::ordered_json(*value) : nlohmann::ordered_json(nullptr);
}

std::string shown(const std::optional<double>& value, int digits = 3) {
    if (!value) return "-";
    std::ostringstream out;
    out << std::fixed << std::setprecision(digits) << *value;
    return out.str();
}

void addLine(std::ostream& out, const std::string& name, const std::string& value,
             const std::string& remark = "") {
    out << "  " << std::left << std::setw(34) << name << std::right << std::setw(10) << value
        << (remark.empty() ? "" : "   ") << remark << "\n";
}

void addTrajectory(std::ostream& out, const TrajectoryErrors& t) {
    out << "Trajectory, " << t.frames << " frames\n";
    addLine(out, "ATE, SE(3)-aligned, m", shown(t.ate_se3_m),
            "median " + shown(t.ate_se3_median_m) + ", max " + shown(t.ate_se3_max_m));
    addLine(out, "ATE, not aligned, m", shown(t.ate_unaligned_m));
    addLine(out, "ATE, Sim(3)-aligned, m", shown(t.ate_sim3_m),
            "scale " + shown(t.sim3_scale, 4) + " (diagnostic of scale only)");
    addLine(out, "t_rel, %", shown(t.t_rel_percent),
            t.segments > 0 ? std::to_string(t.segments) + " segments of 100..800 m"
                           : "the truth is shorter than 100 m");
    addLine(out, "r_rel, deg/100 m", shown(t.r_rel_deg_per_100m));
    addLine(out, "RPE frame to frame, m", shown(t.rpe_m, 4));
    addLine(out, "RPE frame to frame, deg", shown(t.rpe_deg, 4));
}

void addLoops(std::ostream& out, const LoopErrors& l) {
    out << "Loops\n";
    std::string frames;
    for (const auto& r : l.revisits) {
        frames += (frames.empty() ? "frames " : ", ") + std::to_string(r.first) + "-" +
                  std::to_string(r.last) + (r.pairs > 0 ? "" : " (missed)");
    }
    addLine(out, "revisits by the truth", std::to_string(l.revisits.size()), frames);
    addLine(out, "found", std::to_string(l.found));
    addLine(out, "pairs of views believed", std::to_string(l.pairs));
    addLine(out, "wrong ones (1 m or 3 deg off)", std::to_string(l.wrong));
    addLine(out, "pair error, m", shown(l.error_m.median), "p90 " + shown(l.error_m.p90));
    addLine(out, "pair error, deg", shown(l.error_deg.median), "p90 " + shown(l.error_deg.p90));
}

void addSummary(std::ostream& out, const std::string& name, const Summary& s) {
    addLine(out, name, shown(s.median),
            "mean " + shown(s.mean) + ", p90 " + shown(s.p90) + ", n " + std::to_string(s.count));
}

void addTracks(std::ostream& out, const std::vector<TrackErrors>& tracks) {
    out << "  track class      frames moves  rows  centre m   BEV m  yaw deg  yaw mod pi  "
           "objects\n";
    for (const auto& t : tracks) {
        out << std::right << std::setw(7) << t.trackId << " " << std::left << std::setw(10)
            << obs::toString(t.objectClass) << std::right << std::setw(7) << t.labelledFrames
            << std::setw(6) << (t.moving ? "yes" : "no") << std::setw(6) << t.matchedRows
            << std::setw(10) << shown(t.centre_m) << std::setw(8) << shown(t.bev_m) << std::setw(9)
            << shown(t.yaw_deg, 2) << std::setw(12) << shown(t.yawModPi_deg, 2) << "  ";
        if (t.objectIds.empty()) out << "missed";
        for (std::size_t i = 0; i < t.objectIds.size(); ++i) {
            out << (i > 0 ? " " : "") << t.objectIds[i];
        }
        out << "\n";
    }
}

void addObjects(std::ostream& out, const ObjectErrors& o) {
    out << "Objects\n";
    addLine(out, "labelled", std::to_string(o.labelled));
    addLine(out, "matched one to one", std::to_string(o.matchedOneToOne));
    addLine(out, "duplicated", std::to_string(o.duplicated));
    addLine(out, "missed", std::to_string(o.missed));
    std::string falseIds;
    for (const auto id : o.falseObjectIds) {
        falseIds += (falseIds.empty() ? "objects " : " ") + std::to_string(id);
    }
    addLine(out, "false", std::to_string(o.falseObjectIds.size()), falseIds);
    addLine(out, "tracks without an identity switch", std::to_string(o.withoutSwitch),
            std::to_string(o.switches) + " switches in all");
    addLine(out, "seen again", std::to_string(o.seenAgain));
    addLine(out, "known again", std::to_string(o.knownAgain));
    out << "Object errors, median over matched rows\n";
    addSummary(out, "centre, m", o.centre_m);
    addSummary(out, "centre from above, m", o.bev_m);
    addSummary(out, "yaw, deg", o.yaw_deg);
    addSummary(out, "yaw modulo pi, deg", o.yawModPi_deg);
    addSummary(out, "length, m", o.length_m);
    addSummary(out, "width, m", o.width_m);
    addSummary(out, "height, m", o.height_m);
    addSummary(out, "velocity of moving, m/s", o.velocity_mps);
    addTracks(out, o.tracks);
}

}  // namespace

std::string jsonReport(const EvaluationResults& results) {
    nlohmann::ordered_json j;
    const auto& t = results.trajectory;
    const auto figure = [&](const std::optional<double> TrajectoryErrors::*member) {
        return jsonOf(t ? (*t).*member : std::nullopt);
    };
    j["ate_se3_m"] = jsonOf(t ? std::optional(t->ate_se3_m) : std::nullopt);
    j["ate_unaligned_m"] = jsonOf(t ? std::optional(t->ate_unaligned_m) : std::nullopt);
    j["ate_sim3_m"] = figure(&TrajectoryErrors::ate_sim3_m);
    j["sim3_scale"] = figure(&TrajectoryErrors::sim3_scale);
    j["t_rel_percent"] = figure(&TrajectoryErrors::t_rel_percent);
    j["r_rel_deg_per_100m"] = figure(&TrajectoryErrors::r_rel_deg_per_100m);
    j["frames"] = results.frames;
    if (const auto& l = results.loops) {
        j["revisits"] = l->revisits.size();
        j["revisits_found"] = l->found;
        j["loop_pairs"] = l->pairs;
        j["loop_pairs_wrong"] = l->wrong;
        j["loop_error_median_m"] = jsonOf(l->error_m.median);
        j["loop_error_median_deg"] = jsonOf(l->error_deg.median);
    }
    if (const auto& o = results.objects) {
        j["objects_labelled"] = o->labelled;
        j["objects_matched_one_to_one"] = o->matchedOneToOne;
        j["objects_duplicated"] = o->duplicated;
        j["objects_missed"] = o->missed;
        j["objects_false"] = o->falseObjectIds.size();
        j["objects_without_switch"] = o->withoutSwitch;
        j["object_switches"] = o->switches;
        j["objects_seen_again"] = o->seenAgain;
        j["objects_known_again"] = o->knownAgain;
        j["centre_error_median_m"] = jsonOf(o->centre_m.median);
        j["centre_error_p90_m"] = jsonOf(o->centre_m.p90);
        j["bev_error_median_m"] = jsonOf(o->bev_m.median);
        j["yaw_error_median_deg"] = jsonOf(o->yaw_deg.median);
        j["yaw_mod_pi_error_median_deg"] = jsonOf(o->yawModPi_deg.median);
    }
    return j.dump(2) + "\n";
}

std::string textReport(const EvaluationResults& results) {
    std::ostringstream out;
    if (results.trajectory) addTrajectory(out, *results.trajectory);
    if (results.loops) addLoops(out, *results.loops);
    if (results.objects) addObjects(out, *results.objects);
    return out.str();
}

}  // namespace djpete::apps
