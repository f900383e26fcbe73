#include "djpete/evaluation/hota.h"

#include <cmath>

#include "djpete/solver/assignment.h"

namespace djpete::evaluation {

namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

constexpr double kRounding = 1e-9;  // a similarity of 0.5 reaches the threshold 10 * 0.05

double alpha(std::size_t a) { return 0.05 * static_cast<double>(a + 1); }

/// Sums over one drive's boxes of a track (labels, results) and of pairs of tracks.
struct TrackSums {
    VectorXd labelBoxes, resultBoxes;
    MatrixXd likely;  ///< labels x results: how often two tracks probably were together

    TrackSums(std::size_t labels, std::size_t results)
        : labelBoxes(VectorXd::Zero(static_cast<Index>(labels))),
          resultBoxes(VectorXd::Zero(static_cast<Index>(results))),
          likely(MatrixXd::Zero(static_cast<Index>(labels), static_cast<Index>(results))) {}

    void add(const HotaFrame& frame) {
        const MatrixXd& s = frame.similarity;
        for (std::size_t i = 0; i < frame.labelIds.size(); ++i) {
            const auto row = static_cast<Index>(i), label = static_cast<Index>(frame.labelIds[i]);
            labelBoxes(label) += 1;
            for (std::size_t j = 0; j < frame.resultIds.size(); ++j) {
                const auto column = static_cast<Index>(j);
                if (s(row, column) <= 0) continue;
                const double either = s.row(row).sum() + s.col(column).sum() - s(row, column);
                likely(label, static_cast<Index>(frame.resultIds[j])) += s(row, column) / either;
            }
        }
        for (const auto id : frame.resultIds) resultBoxes(static_cast<Index>(id)) += 1;
    }
    double agreement(std::size_t label, std::size_t result, const MatrixXd& together) const {
        const auto i = static_cast<Index>(label), j = static_cast<Index>(result);
        return together(i, j) / (labelBoxes(i) + resultBoxes(j) - together(i, j));
    }
};

std::vector<std::optional<std::size_t>> pairs(const HotaFrame& frame, const TrackSums& tracks) {
    const auto n = static_cast<Index>(frame.labelIds.size());
    const auto m = static_cast<Index>(frame.resultIds.size());
    MatrixXd cost(n, m);
    for (Index i = 0; i < n; ++i) {
        for (Index j = 0; j < m; ++j) {
            cost(i, j) = 1 - frame.similarity(i, j) *
                                 tracks.agreement(frame.labelIds[static_cast<std::size_t>(i)],
                                                  frame.resultIds[static_cast<std::size_t>(j)],
                                                  tracks.likely);
        }
    }
    return solver::assign(cost, 1.0);
}

}  // namespace

HotaSums sumHota(const std::vector<HotaFrame>& frames, std::size_t labelTracks,
                 std::size_t resultTracks) {
    TrackSums tracks(labelTracks, resultTracks);
    for (const auto& frame : frames) tracks.add(frame);
    HotaSums sums;
    std::vector<MatrixXd> together(HotaSums::kAlphas,
                                   MatrixXd::Zero(tracks.likely.rows(), tracks.likely.cols()));
    for (const auto& frame : frames) {
        const auto columns = pairs(frame, tracks);
        for (std::size_t a = 0; a < HotaSums::kAlphas; ++a) {
            double matches = 0;
            for (std::size_t i = 0; i < columns.size(); ++i) {
                if (!columns[i]) continue;
                const std::size_t j = *columns[i];
                const double s = frame.similarity(static_cast<Index>(i), static_cast<Index>(j));
                if (s < alpha(a) - kRounding) continue;
                matches += 1;
                sums.similarity[a] += s;
                together[a](static_cast<Index>(frame.labelIds[i]),
                            static_cast<Index>(frame.resultIds[j])) += 1;
            }
            sums.matches[a] += matches;
            sums.misses[a] += static_cast<double>(frame.labelIds.size()) - matches;
            sums.falsePositives[a] += static_cast<double>(frame.resultIds.size()) - matches;
        }
    }
    for (std::size_t a = 0; a < HotaSums::kAlphas; ++a) {
        for (std::size_t i = 0; i < labelTracks; ++i) {
            for (std::size_t j = 0; j < resultTracks; ++j) {
                const double n = together[a](static_cast<Index>(i), static_cast<Index>(j));
                if (n > 0) sums.association[a] += n * tracks.agreement(i, j, together[a]);
            }
        }
    }
    return sums;
}

HotaSums& HotaSums::operator+=(const HotaSums& other) {
    for (std::size_t a = 0; a < kAlphas; ++a) {
        matches[a] += other.matches[a];
        misses[a] += other.misses[a];
        falsePositives[a] += other.falsePositives[a];
        association[a] += other.association[a];
        similarity[a] += other.similarity[a];
    }
    return *this;
}

Hota hotaOf(const HotaSums& sums) {
    Hota out;
    for (std::size_t a = 0; a < HotaSums::kAlphas; ++a) {
        const double all = sums.matches[a] + sums.misses[a] + sums.falsePositives[a];
        const double detA = all > 0 ? sums.matches[a] / all : 0;
        const bool any = sums.matches[a] > 0;
        const double assA = any ? sums.association[a] / sums.matches[a] : 0;
        out.detA += detA / HotaSums::kAlphas;
        out.assA += assA / HotaSums::kAlphas;
        out.locA += (any ? sums.similarity[a] / sums.matches[a] : 1) / HotaSums::kAlphas;
        out.hota += std::sqrt(detA * assA) / HotaSums::kAlphas;
    }
    return out;
}

}  // namespace djpete::evaluation
