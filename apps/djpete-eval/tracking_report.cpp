#include "tracking_report.h"

#include <iomanip>
#include <nlohmann/json.hpp>
#include <sstream>

namespace djpete::apps {

using namespace evaluation;

namespace {

using Json = nlohmann::ordered_json;

Json jsonOf(const std::optional<double>& value) { return value ? Json(*value) : Json(nullptr); }

/// "mota25" for a limit of 0.25.
std::string motaKey(double limit) {
    return "mota" + std::to_string(static_cast<int>(100 * limit + 0.5));
}

Json figures(const TrackingCounts& counts, const Hota& hota) {
    Json j;
    j["motp"] = jsonOf(counts.motp());
    j["ids"] = counts.switches;
    j["frag"] = counts.fragments;
    j["fp"] = counts.falsePositives;
    j["fn"] = counts.misses;
    j["labels"] = counts.labels;
    j["recall"] = jsonOf(counts.recall());
    j["precision"] = jsonOf(counts.precision());
    j["hota"] = hota.hota;
    j["deta"] = hota.detA;
    j["assa"] = hota.assA;
    j["loca"] = hota.locA;
    return j;
}

std::string percent(const std::optional<double>& value) {
    if (!value) return "-";
    std::ostringstream out;
    out << std::fixed << std::setprecision(2) << 100 * *value;
    return out.str();
}

std::string limitName(double limit) {
    std::ostringstream out;
    out << std::setprecision(2) << limit;
    return out.str();
}

void addRow(std::ostream& out, const std::string& name, const std::vector<std::string>& cells) {
    out << std::left << std::setw(16) << name << std::right;
    for (const auto& cell : cells) out << " " << std::setw(9) << cell;
    out << "\n";
}

void addCounts(std::vector<std::string>& cells, const TrackingCounts& c) {
    cells.push_back(percent(c.motp()));
    for (const std::size_t n : {c.switches, c.fragments, c.falsePositives, c.misses, c.labels}) {
        cells.push_back(std::to_string(n));
    }
}

void addHota(std::vector<std::string>& cells, const Hota& h) {
    for (const double v : {h.hota, h.detA, h.assA, h.locA}) cells.push_back(percent(v));
}

}  // namespace

std::string trackingJson(const TrackingErrors& errors) {
    Json j = figures(errors.limits.front().counts, errors.hota);
    for (const auto& limit : errors.limits) j[motaKey(limit.limit)] = jsonOf(limit.counts.mota());
    j["samota"] = jsonOf(errors.limits.front().sAmota);
    j["score"] = jsonOf(errors.limits.front().score);
    j["sequences"] = Json::array();
    for (const auto& sequence : errors.sequences) {
        Json s;
        s["name"] = sequence.name;
        s.update(figures(sequence.joint.front(), sequence.hota));
        for (std::size_t i = 0; i < errors.limits.size(); ++i) {
            const std::string key = motaKey(errors.limits[i].limit);
            s[key] = jsonOf(sequence.joint[i].mota());
            s["own_" + key] = jsonOf(sequence.own[i].counts.mota());
        }
        s["own_samota"] = jsonOf(sequence.own.front().sAmota);
        j["sequences"].push_back(s);
    }
    return j.dump(2) + "\n";
}

std::string trackingTable(const TrackingErrors& errors) {
    std::ostringstream out;
    const auto& first = errors.limits.front();
    out << "Tracked cars, %, overlap of at least " << limitName(first.limit)
        << " if not said otherwise; ";
    if (first.score) {
        out << "track score of at least " << *first.score << " (best MOTA)\n";
    } else {
        out << "all tracks\n";
    }
    std::vector<std::string> head;
    for (const auto& limit : errors.limits) head.push_back("MOTA@" + limitName(limit.limit));
    for (const char* name :
         {"sAMOTA", "MOTP", "IDS", "FRAG", "FP", "FN", "labels", "HOTA", "DetA", "AssA", "LocA"}) {
        head.push_back(name);
    }
    addRow(out, "drive", head);
    for (const auto& sequence : errors.sequences) {
        std::vector<std::string> cells;
        for (const auto& counts : sequence.joint) cells.push_back(percent(counts.mota()));
        cells.push_back("");
        addCounts(cells, sequence.joint.front());
        addHota(cells, sequence.hota);
        addRow(out, sequence.name, cells);
    }
    std::vector<std::string> cells;
    for (const auto& limit : errors.limits) cells.push_back(percent(limit.counts.mota()));
    cells.push_back(percent(first.sAmota));
    addCounts(cells, first.counts);
    addHota(cells, errors.hota);
    addRow(out, "all", cells);
    out << "Each drive at its own best threshold\n";
    for (const auto& sequence : errors.sequences) {
        std::vector<std::string> own;
        for (const auto& limit : sequence.own) own.push_back(percent(limit.counts.mota()));
        own.push_back(percent(sequence.own.front().sAmota));
        addCounts(own, sequence.own.front().counts);
        addRow(out, sequence.name, own);
    }
    return out.str();
}

}  // namespace djpete::apps
