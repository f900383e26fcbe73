#include <iomanip>
#include <nlohmann/json.hpp>
#include <sstream>

#include "ablation.h"
#include "report.h"

namespace djpete::apps {

using namespace evaluation;

namespace {

std::string shown(const std::optional<double>& value, int digits) {
    if (!value) return "-";
    std::ostringstream out;
    out << std::fixed << std::setprecision(digits) << *value;
    return out.str();
}

void addRow(std::ostream& out, const std::vector<std::string>& cells) {
    out << "  " << std::left << std::setw(7) << cells.front() << std::right;
    for (std::size_t i = 1; i < cells.size(); ++i) out << " " << std::setw(10) << cells[i];
    out << "\n";
}

std::vector<std::string> objectCells(const std::optional<ObjectErrors>& o) {
    if (!o) return std::vector<std::string>(8, "-");
    std::vector<std::string> cells;
    for (const std::size_t n : {o->labelled, o->matchedOneToOne, o->duplicated, o->missed,
                                o->falseObjectIds.size(), o->switches}) {
        cells.push_back(std::to_string(n));
    }
    cells.push_back(shown(o->centre_m.median, 3));
    cells.push_back(shown(o->yaw_deg.median, 2));
    return cells;
}

}  // namespace

std::string ablationTable(const std::vector<AblationDrive>& drives) {
    std::ostringstream out;
    for (const auto& drive : drives) {
        out << drive.name << ", " << drive.runs.front().trajectory.frames << " frames\n";
        addRow(out, {"objects", "ATE m", "t_rel %", "deg/100 m", "same path", "labelled", "1 to 1",
                     "duplicated", "missed", "false", "switches", "centre m", "yaw deg"});
        for (const auto& run : drive.runs) {
            std::vector<std::string> cells{run.mode, shown(run.trajectory.ate_se3_m, 3),
                                           shown(run.trajectory.t_rel_percent, 3),
                                           shown(run.trajectory.r_rel_deg_per_100m, 3),
                                           run.samePathAsOff ? "yes" : "no"};
            for (auto& cell : objectCells(run.objects)) cells.push_back(std::move(cell));
            addRow(out, cells);
        }
    }
    out << "Same path: the same bytes as with objects off. Centre and yaw are medians.\n";
    return out.str();
}

std::string ablationJson(const std::vector<AblationDrive>& drives) {
    nlohmann::ordered_json j = nlohmann::ordered_json::array();
    for (const auto& drive : drives) {
        nlohmann::ordered_json d{{"name", drive.name}, {"runs", nlohmann::ordered_json::array()}};
        for (const auto& run : drive.runs) {
            EvaluationResults results;
            results.frames = run.trajectory.frames;
            results.trajectory = run.trajectory;
            results.objects = run.objects;
            nlohmann::ordered_json r{{"mode", run.mode}, {"same_path_as_off", run.samePathAsOff}};
            r.update(nlohmann::ordered_json::parse(jsonReport(results)));
            d["runs"].push_back(std::move(r));
        }
        j.push_back(std::move(d));
    }
    return j.dump(2) + "\n";
}

}  // namespace djpete::apps
