#include "kitti_poses.h"

#include <cmath>
#include <cstdio>

#include "djpete/obs/errors.h"
#include "text_table.h"

namespace djpete::kitti2rawlog {

using geometry::Mat3;
using geometry::SE3;
using geometry::Vec3;
using mrpt::Clock;
using obs::InputError;

namespace {

constexpr int64_t kTicksPerSecond = 10'000'000;  // mrpt::Clock counts 100 ns

/// Days from 1970-01-01 of a Gregorian date (Howard Hinnant's days_from_civil).
int64_t daysFromCivil(int64_t y, int64_t m, int64_t d) {
    y -= m <= 2 ? 1 : 0;
    const int64_t era = (y >= 0 ? y : y - 399) / 400;
    const int64_t yearOfEra = y - era * 400;
    const int64_t dayOfYear = (153 * (m + (m > 2 ? -3 : 9)) + 2) / 5 + d - 1;
    return era * 146097 + yearOfEra * 365 + yearOfEra / 4 - yearOfEra / 100 + dayOfYear - 719468;
}

Clock::time_point fromTicks(int64_t ticksSince1970) {
    return Clock::fromDouble(0.0) + Clock::duration(ticksSince1970);
}

const int64_t kEpochTicks = daysFromCivil(2011, 9, 26) * 86400 * kTicksPerSecond;

int64_t ticksOfDate(const TextRow& row) {
    int year = 0, month = 0, day = 0, hour = 0, minute = 0, used = 0;
    double second = 0;
    const std::string text = row.words[0] + " " + row.words[1];
    const int n = std::sscanf(text.c_str(), "%4d-%2d-%2d %2d:%2d:%lf%n", &year, &month, &day, &hour,
                              &minute, &second, &used);
    if (n != 6 || used != static_cast<int>(text.size()) || month < 1 || month > 12 || day < 1 ||
        day > 31 || hour < 0 || hour > 23 || minute < 0 || minute > 59 ||
        !(second >= 0 && second < 61)) {
        throw InputError(row.where + ": '" + text +
                         "' is no time; expected e.g. 2011-09-26 13:04:32.351950336");
    }
    const int64_t seconds = daysFromCivil(year, month, day) * 86400 + hour * 3600 + minute * 60;
    return seconds * kTicksPerSecond + std::llround(second * kTicksPerSecond);
}

int64_t ticksOf(const TextRow& row) {
    if (row.words.size() == 2) return ticksOfDate(row);
    return kEpochTicks + std::llround(row.numbers(0, 1, "a time in seconds")[0] * kTicksPerSecond);
}

}  // namespace

std::vector<SE3> readPoses(const std::filesystem::path& file) {
    std::vector<SE3> out;
    for (const auto& row : readRows(file, "poses in KITTI's format")) {
        const auto v = row.numbers(0, 12, "a 3x4 pose matrix row by row");
        Mat3 R;
        R << v[0], v[1], v[2], v[4], v[5], v[6], v[8], v[9], v[10];
        if ((R * R.transpose() - Mat3::Identity()).cwiseAbs().maxCoeff() > 1e-2 ||
            R.determinant() < 0) {
            throw InputError(row.where + ": the 3x3 part is no rotation; expected a pose matrix");
        }
        out.push_back(SE3(R, Vec3(v[3], v[7], v[11])).normalised());
    }
    if (out.empty()) throw InputError(file.string() + ": empty; expected one pose per line");
    return out;
}

std::vector<Clock::time_point> readTimes(const std::optional<std::filesystem::path>& file,
                                         uint64_t lastFrame) {
    std::vector<Clock::time_point> out;
    if (!file) {
        for (uint64_t f = 0; f <= lastFrame; ++f)
            out.push_back(fromTicks(kEpochTicks + static_cast<int64_t>(f) * kTicksPerSecond / 10));
        return out;
    }
    for (const auto& row : readRows(*file, "one time per frame")) {
        if (out.size() > lastFrame) break;
        out.push_back(fromTicks(ticksOf(row)));
        if (out.size() > 1 && out.back() <= out[out.size() - 2]) {
            throw InputError(row.where +
                             ": time does not increase; expected one later than that "
                             "of the line before");
        }
    }
    if (out.size() <= lastFrame) {
        throw InputError(file->string() + ": " + std::to_string(out.size()) +
                         " times; expected at least " + std::to_string(lastFrame + 1) +
                         ", as there is a frame " + std::to_string(lastFrame));
    }
    return out;
}

}  // namespace djpete::kitti2rawlog
