/// How well places are known again, on a drive with true poses:
///     djpete_bench_places DRIVE TRUTH.txt [--cache FILE] [--pairs N] [--gap KEYFRAMES]
/// DRIVE is a rawlog or a folder of KITTI odometry; each keyframe asks for all older ones.
#include <cstdio>
#include <cstdlib>
#include <iostream>
#include <map>
#include <set>

#include "djpete/places/place_database.h"
#include "djpete/places/view_match.h"
#include "places_drive.h"
#include "places_statistics.h"

namespace {

using namespace djpete_bench;
using djpete::places::PlaceView;

struct Arguments {
    std::string drive, truth, cache;
    std::size_t pairs = 20000;  ///< of places far apart
    std::size_t gap = 30;       ///< keyframes between two visits
};

Arguments parse(int argc, char** argv) {
    Arguments a;
    if (argc < 3 || argc % 2 == 0) {
        throw std::runtime_error(
            "use: djpete_bench_places DRIVE TRUTH.txt [--cache FILE] [--pairs N] [--gap N]");
    }
    a.drive = argv[1];
    a.truth = argv[2];
    for (int i = 3; i + 1 < argc; i += 2) {
        const std::string key = argv[i], value = argv[i + 1];
        if (key == "--cache") {
            a.cache = value;
        } else if (key == "--pairs") {
            a.pairs = std::stoul(value);
        } else if (key == "--gap") {
            a.gap = std::stoul(value);
        } else {
            throw std::runtime_error("unknown option " + key);
        }
    }
    return a;
}

std::vector<PlaceView> viewsOf(const PlacesDrive& drive) {
    std::vector<PlaceView> out;
    std::size_t corners = 0, points = 0;
    StopWatch watch;
    for (const auto& k : drive.keyframes) out.push_back(djpete::places::placeView(k));
    const double ms = watch.ms() / static_cast<double>(out.size());
    for (const auto& v : out) {
        corners += v.corners.size();
        for (const auto& c : v.corners) points += c.p_cam ? 1 : 0;
    }
    std::printf(
        "%zu keyframes, %zu corners and %zu points each, %.2f ms per view; front end %.1f ms "
        "per frame\n",
        out.size(), corners / out.size(), points / out.size(), ms, drive.frontend_ms);
    return out;
}

/// Pairs of keyframes near in time: as the view changes along the way.
void neighbours(const PlacesDrive& drive, const std::vector<PlaceView>& views) {
    std::map<int, PairStatistics> bins, near;
    for (std::size_t i = 0; i < views.size(); ++i) {
        for (std::size_t j = i + 1; j < std::min(views.size(), i + 10); ++j) {
            const Truth truth(drive, i, j);
            if (truth.distance_m > 16 || truth.heading_rad > kHeading_rad) continue;
            const int bin = static_cast<int>(truth.distance_m / 2);
            judge(bins[bin], truth, views[i], views[j], false);
            judge(near[bin], truth, views[i], views[j], true);
        }
    }
    std::printf("\nneighbouring keyframes, by distance\n");
    printHeader();
    for (const auto& [bin, s] : bins) printRow(std::to_string(2 * bin) + " m", s);
    std::printf("the same with a guess that is wrong by 0.5 m and 2 deg\n");
    for (const auto& [bin, s] : near) printRow(std::to_string(2 * bin) + " m", s);
}

/// Every keyframe asks the database of all older ones; what it finds is checked by geometry.
void revisits(const PlacesDrive& drive, const std::vector<PlaceView>& views, std::size_t gap) {
    constexpr std::size_t kCandidates = 3;
    constexpr double kFar_m = 30;
    djpete::places::PlaceDatabase database;
    const djpete::places::MatchOptions options;
    std::map<int, std::array<int, 5>> recall;  // due, found, first, matched, direct
    PairStatistics matches;
    Samples query_ms, add_ms, trueScores, falseScores;
    int asked = 0, wrong = 0, far = 0;
    for (std::size_t i = 0; i < views.size(); ++i) {
        const auto olderThan = [&](djpete::map::KeyframeId id) { return id.value + gap <= i; };
        StopWatch watch;
        const auto candidates = database.query(views[i], kCandidates, olderThan);
        query_ms.add(watch.ms());
        double nearest_m = 1e9;
        std::size_t nearest = 0;
        for (std::size_t j = 0; j + gap <= i; ++j) {
            const Truth truth(drive, j, i);
            if (truth.heading_rad >= kHeading_rad || truth.distance_m >= nearest_m) continue;
            nearest_m = truth.distance_m;
            nearest = j;
        }
        bool found = false, first = false, matched = false;
        for (std::size_t c = 0; c < candidates.size(); ++c) {
            const std::size_t j = candidates[c].id.value;
            const Truth truth(drive, j, i);
            const bool right = truth.distance_m < 8 && truth.heading_rad < 2 * kHeading_rad;
            if (c == 0) (right ? trueScores : falseScores).add(candidates[c].score);
            found = found || right;
            first = first || (right && c == 0);
            const auto match = matchViews(*database.find(candidates[c].id), views[i], options, i);
            ++asked;
            if (!match) continue;
            const bool good = judge(matches, truth, match);
            matched = matched || good;
            wrong += good ? 0 : 1;
            far += truth.distance_m > kFar_m ? 1 : 0;
            if (!good) {
                std::printf(
                    "wrong: frames %lu and %lu, truly %.1f m apart, %zu pairs, share %.3f\n",
                    static_cast<unsigned long>(drive.keyframes[j].frame.value),
                    static_cast<unsigned long>(drive.keyframes[i].frame.value), truth.distance_m,
                    match->features.size(), match->share);
            }
        }
        const bool direct =
            nearest_m < 6 && matchViews(views[nearest], views[i], options, i).has_value();
        for (const int limit : {1, 2, 4, 6}) {
            if (nearest_m > limit) continue;
            auto& r = recall[limit];
            ++r[0];
            r[1] += found ? 1 : 0;
            r[2] += first ? 1 : 0;
            r[3] += matched ? 1 : 0;
            r[4] += direct ? 1 : 0;
        }
        watch = StopWatch();
        database.add(views[i]);
        add_ms.add(watch.ms());
    }
    std::printf("\nrevisits after %zu keyframes or more, heading within 15 deg\n", gap);
    std::printf("%-12s %8s %12s %12s %12s %12s\n", "nearest", "due", "among 3", "first", "matched",
                "nearest does");
    for (const auto& [limit, r] : recall) {
        std::printf("< %-2d m       %8d %12d %12d %12d %12d\n", limit, r[0], r[1], r[2], r[3],
                    r[4]);
    }
    printHeader();
    printRow("matches", matches);
    std::printf("asked %d, wrong %d, of them over %.0f m apart %d\n", asked, wrong, kFar_m, far);
    std::printf(
        "score of the first: right p5 %.4f p50 %.4f, not right p50 %.4f p95 %.4f max %.4f\n",
        trueScores.at(0.05), trueScores.at(0.5), falseScores.at(0.5), falseScores.at(0.95),
        falseScores.at(1));
    std::printf("query ms p50 %.2f max %.2f, add ms p50 %.2f, %.0f bytes per corner\n",
                query_ms.at(0.5), query_ms.at(1), add_ms.at(0.5), bytesPerCorner(database, views));
}

/// How many pairs of corners agree by chance where the places are far apart.
void falsePairs(const PlacesDrive& drive, const std::vector<PlaceView>& views, std::size_t wanted) {
    constexpr double kFar_m = 30;
    djpete::places::MatchOptions open;
    open.minInliers = 8;
    open.minCells = 1;
    open.minShare = 0;
    open.maxSigma_m = 1e9;
    open.maxSigma_rad = 1e9;
    std::map<std::size_t, std::size_t> counts;
    std::size_t done = 0;
    Samples ms, shares;
    const djpete::places::MatchOptions normal;
    PairStatistics matches;
    for (std::size_t n = 0; done < wanted && n < 20 * wanted; ++n) {
        const std::size_t i = scrambled(2 * n) % views.size();
        const std::size_t j = scrambled(2 * n + 1) % views.size();
        if (i >= j || Truth(drive, i, j).distance_m <= kFar_m) continue;
        ++done;
        const StopWatch watch;
        const auto match = matchViews(views[i], views[j], open, n);
        ms.add(watch.ms());
        counts[match ? match->features.size() : 0]++;
        if (match) shares.add(match->share);
        if (match && match->features.size() >= normal.minInliers) {
            judge(matches, Truth(drive, i, j), matchViews(views[i], views[j], normal, n));
        }
    }
    std::printf("\n%zu pairs of views over %.0f m apart: %d matched, of them wrong %d\n", done,
                kFar_m, matches.matched, matches.wrong);
    std::printf("agreeing corners (0: fewer than 8):");
    for (const auto& [count, n] : counts) std::printf(" %zu:%zu", count, n);
    std::printf("\nshare seen again: p95 %.3f p99 %.3f max %.3f", shares.at(0.95), shares.at(0.99),
                shares.at(1));
    std::printf("\nms per pair p50 %.2f p95 %.2f\n", ms.at(0.5), ms.at(0.95));
}

}  // namespace

int main(int argc, char** argv) {
    try {
        const Arguments arguments = parse(argc, argv);
        const auto drive = openPlacesDrive(arguments.drive, arguments.truth, arguments.cache);
        std::setvbuf(stdout, nullptr, _IOLBF, BUFSIZ);
        const auto views = viewsOf(drive);
        neighbours(drive, views);
        revisits(drive, views, arguments.gap);
        falsePairs(drive, views, arguments.pairs);
        return 0;
    } catch (const std::exception& e) {
        std::cerr << "djpete_bench_places: " << e.what() << "\n";
        return 1;
    }
}
