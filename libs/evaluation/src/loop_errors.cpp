#include "djpete/evaluation/loop_errors.h"

#include <cmath>
#include <map>
#include <utility>

#include "djpete/obs/errors.h"
#include "text_file.h"

namespace djpete::evaluation {

namespace {

constexpr std::size_t kColumns = 16;

bool parseFlag(const std::string& field, const std::string& where, const std::string& what) {
    if (field != "0" && field != "1") {
        throw obs::InputError(where + ": expected 0 or 1 as " + what + ", got '" + field + "'");
    }
    return field == "1";
}

LoopRow parseRow(const TextLine& line) {
    const auto fields = splitAtCommas(line.text);
    const std::string& where = line.where;
    if (fields.size() != kColumns) {
        throw obs::InputError(where + ": expected 16 columns separated by commas, got " +
                              std::to_string(fields.size()));
    }
    LoopRow row;
    row.line = line.number;
    row.olderDrive = parseCount(fields[0], where, "older_drive");
    row.olderFrame = parseCount(fields[1], where, "older_frame");
    row.newerDrive = parseCount(fields[2], where, "newer_drive");
    row.newerFrame = parseCount(fields[3], where, "newer_frame");
    row.features = parseCount(fields[4], where, "features");
    row.near = parseFlag(fields[5], where, "near");
    row.joined = parseFlag(fields[6], where, "joined");
    row.correction_m = parseNumber(fields[7], where, "correction_m");
    row.correction_deg = parseNumber(fields[8], where, "correction_deg");
    row.T_older_newer = parseQuaternionPose(fields, 9, where);
    return row;
}

/// Finds older frames near a place without looking at all of them.
class Places {
  public:
    explicit Places(double cell_m) : cell_m_(cell_m) {}
    void add(std::size_t frame, const geometry::Vec3& p) { cells_[cellOf(p)].push_back(frame); }
    template <class F>
    bool any(const geometry::Vec3& p, F good) const {
        const auto [cx, cz] = cellOf(p);
        for (int64_t x = cx - 1; x <= cx + 1; ++x) {
            for (int64_t z = cz - 1; z <= cz + 1; ++z) {
                const auto it = cells_.find({x, z});
                if (it == cells_.end()) continue;
                for (const std::size_t frame : it->second) {
                    if (good(frame)) return true;
                }
            }
        }
        return false;
    }

  private:
    /// Cameras move in their x-z plane, more or less.
    std::pair<int64_t, int64_t> cellOf(const geometry::Vec3& p) const {
        return {static_cast<int64_t>(std::floor(p.x() / cell_m_)),
                static_cast<int64_t>(std::floor(p.z() / cell_m_))};
    }
    double cell_m_;
    std::map<std::pair<int64_t, int64_t>, std::vector<std::size_t>> cells_;
};

std::vector<Revisit> revisitsOf(const Trajectory& truth, const LoopCriteria& c) {
    std::vector<Revisit> out;
    Places places(c.revisit_m);
    for (std::size_t i = 0; i < truth.size(); ++i) {
        if (i >= c.minGapFrames) {
            const std::size_t old = i - c.minGapFrames;
            places.add(old, truth[old].translation());
        }
        const bool again = places.any(truth[i].translation(), [&](std::size_t j) {
            const auto T_j_i = truth[j].inverse() * truth[i];
            return T_j_i.translation().norm() < c.revisit_m &&
                   T_j_i.angle_rad() < c.revisit_deg * M_PI / 180;
        });
        if (!again) continue;
        if (out.empty() || i - out.back().last > c.mergeGapFrames) out.push_back({i, i, 0});
        out.back().last = i;
    }
    return out;
}

}  // namespace

std::vector<LoopRow> readLoopsCsv(const std::string& path) {
    std::vector<LoopRow> out;
    const auto lines = readLines(path);
    if (lines.front().text.rfind("older_drive,", 0) != 0) {
        throw obs::InputError(lines.front().where +
                              ": expected the header of loops.csv, which begins with older_drive");
    }
    for (std::size_t i = 1; i < lines.size(); ++i) out.push_back(parseRow(lines[i]));
    return out;
}

LoopErrors evaluateLoops(const std::vector<LoopRow>& rows, const Trajectory& truth,
                         const std::string& origin, const LoopCriteria& criteria) {
    LoopErrors out;
    out.revisits = revisitsOf(truth, criteria);
    std::vector<double> errors_m, errors_deg;
    for (const auto& row : rows) {
        for (const std::size_t frame : {row.olderFrame, row.newerFrame}) {
            if (frame < truth.size()) continue;
            throw obs::InputError(origin + ":" + std::to_string(row.line) + ": frame " +
                                  std::to_string(frame) + " is not among the " +
                                  std::to_string(truth.size()) + " frames of the truth");
        }
        const auto error =
            (truth[row.olderFrame].inverse() * truth[row.newerFrame]).inverse() * row.T_older_newer;
        errors_m.push_back(error.translation().norm());
        errors_deg.push_back(error.angle_rad() * 180 / M_PI);
        ++out.pairs;
        if (errors_m.back() > criteria.wrong_m || errors_deg.back() > criteria.wrong_deg) {
            ++out.wrong;
            continue;
        }
        for (auto& visit : out.revisits) {
            if (row.newerFrame >= visit.first && row.newerFrame <= visit.last) ++visit.pairs;
        }
    }
    for (const auto& visit : out.revisits) out.found += visit.pairs > 0 ? 1U : 0U;
    out.error_m = summarise(errors_m);
    out.error_deg = summarise(errors_deg);
    return out;
}

}  // namespace djpete::evaluation
