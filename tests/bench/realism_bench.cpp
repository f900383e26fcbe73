/// How alike drives are: image, stereo, LiDAR and odometry statistics side by side.
///
///     djpete_bench_realism [--frames A:B] [--poses FILE] [--cars RAW_DRIVE LABELS] DRIVE...
///     djpete_bench_realism --pictures FOLDER [--frames A:B] DRIVE
///
/// Drives have the layout of KITTI odometry; the first is the reference, usually a real one. Rows
/// whose ratio to it lies outside 0.8 .. 1.25 are marked "out". `--poses`: true poses of drives
/// without a poses.txt. `--cars`: a labelled drive in KITTI's raw layout that stands in for the
/// reference where points per car are counted. `--pictures`: no table, but pictures of frame A of
/// the (one) drive as PNG of at most 600 kB.
#include <cstdio>
#include <iostream>

#include "realism_pictures.h"
#include "realism_statistics.h"

namespace {

using namespace djpete_bench;

struct Arguments {
    std::size_t begin = 0, end = 40;
    std::filesystem::path poses, cars, labels, pictures;
    std::vector<std::filesystem::path> drives;
};

Arguments parse(int argc, char** argv) {
    Arguments out;
    const std::vector<std::string> words(argv + 1, argv + argc);
    for (std::size_t i = 0; i < words.size(); ++i) {
        const auto value = [&] {
            if (++i == words.size()) throw std::runtime_error(words[i - 1] + ": expected a value");
            return words[i];
        };
        if (words[i] == "--frames") {
            char rest = 0;
            const std::string range = value();
            if (std::sscanf(range.c_str(), "%zu:%zu%c", &out.begin, &out.end, &rest) != 2 ||
                out.end <= out.begin)
                throw std::runtime_error("--frames " + range + ": expected A:B with A < B");
        } else if (words[i] == "--poses") {
            out.poses = value();
        } else if (words[i] == "--pictures") {
            out.pictures = value();
        } else if (words[i] == "--cars") {
            out.cars = value();
            out.labels = value();
        } else if (words[i].rfind("--", 0) == 0) {
            throw std::runtime_error(words[i] + ": no such option");
        } else {
            out.drives.emplace_back(words[i]);
        }
    }
    if (out.drives.empty()) throw std::runtime_error("expected at least one drive");
    return out;
}

Statistics measure(const RealismDrive& drive, const RealismDrive& cars) {
    Statistics all;
    for (auto part : {imageStatistics(drive), trackStatistics(drive), stereoStatistics(drive),
                      lidarStatistics(drive, cars), odometryStatistics(drive)})
        all.insert(all.end(), part.begin(), part.end());
    return all;
}

std::string number(const std::optional<double>& x) {
    if (!x) return "n/a";
    char text[32];
    const double size = std::abs(*x);
    std::snprintf(text, sizeof text, size >= 1000 ? "%.0f" : (size >= 10 ? "%.1f" : "%.3f"), *x);
    return text;
}

std::string ratio(const Statistic& reference, const Statistic& other) {
    if (!reference.value || !other.value || *reference.value == 0.0) return "";
    const double r = *other.value / *reference.value;
    char text[32];
    std::snprintf(text, sizeof text, "%.2f%s", r,
                  reference.information ? " info" : (r < 0.8 || r > 1.25 ? " out" : ""));
    return text;
}

void print(const std::vector<std::string>& names, const std::vector<Statistics>& columns) {
    std::printf("| %-44s |", "");
    for (const auto& name : names) std::printf(" %12s | %9s |", name.c_str(), "ratio");
    std::printf("\n");
    std::vector<int> outside(columns.size(), 0);
    for (std::size_t row = 0; row < columns.front().size(); ++row) {
        const auto& reference = columns.front()[row];
        std::printf("| %-44s |", reference.name.c_str());
        for (std::size_t c = 0; c < columns.size(); ++c) {
            const std::string r = c == 0 ? "" : ratio(reference, columns[c][row]);
            std::printf(" %12s | %9s |", number(columns[c][row].value).c_str(), r.c_str());
            if (r.find("out") != std::string::npos) ++outside[c];
        }
        std::printf("\n");
    }
    for (std::size_t c = 1; c < columns.size(); ++c)
        std::printf("%s: %d rows out\n", names[c].c_str(), outside[c]);
}

}  // namespace

int main(int argc, char** argv) {
    try {
        const auto arguments = parse(argc, argv);
        if (!arguments.pictures.empty()) {
            const auto drive = openOdometryDrive(arguments.drives.front(), arguments.begin,
                                                 arguments.end, arguments.poses);
            writePictures(drive, drive.frames.front(), arguments.pictures);
            return 0;
        }
        std::vector<std::string> names;
        std::vector<Statistics> columns;
        for (const auto& dir : arguments.drives) {
            const auto drive =
                openOdometryDrive(dir, arguments.begin, arguments.end, arguments.poses);
            const bool standIn = columns.empty() && !arguments.cars.empty();
            columns.push_back(
                measure(drive, standIn ? openRawDrive(arguments.cars, arguments.labels) : drive));
            names.push_back(drive.name);
        }
        print(names, columns);
        return 0;
    } catch (const std::exception& e) {
        std::cerr << "djpete_bench_realism: " << e.what() << "\n";
        return 1;
    }
}
