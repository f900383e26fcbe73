#include "djpete/places/place_database.h"

#include <mrpt/core/exceptions.h>

#include <algorithm>
#include <cmath>
#include <deque>

#include "hamming.h"
#include "hash_table.h"

namespace djpete::places {

struct PlaceDatabase::Impl {
    explicit Impl(const DatabaseOptions& o) : options(o) {
        for (unsigned t = 0; t < options.tables; ++t) tables.emplace_back(t, options.keyBits);
    }
    DatabaseOptions options;
    std::deque<PlaceView> views;  // by rising id
    std::vector<HashTable> tables;

    std::vector<double> scores(const PlaceView& view) const;
    void votersOf(const obs::Descriptor& d, std::vector<std::size_t>& lastVoter, std::size_t voter,
                  std::vector<std::size_t>& voted) const;
};

/// The views that hold a corner like `d`, each once. `lastVoter` is scratch, by view.
void PlaceDatabase::Impl::votersOf(const obs::Descriptor& d, std::vector<std::size_t>& lastVoter,
                                   std::size_t voter, std::vector<std::size_t>& voted) const {
    // A corner as near as it may be differs in about this share of any 32 bits; a few more pass.
    const unsigned maxSignature = 3 + options.maxHamming / 8;
    const HammingFunction hamming = hammingFunction();
    voted.clear();
    for (const HashTable& table : tables) {
        const uint32_t signature = table.bits().signature(d);
        table.forEach(table.bits().key(d), options.maxListLength, [&](const HashTable::Entry& e) {
            const std::size_t v = e.name.view();
            if (lastVoter[v] == voter) return;
            if (hammingPortable({signature ^ e.signature, 0, 0, 0}, {}) > maxSignature) return;
            if (hamming(d, views[v].corners[e.name.corner()].descriptor) > options.maxHamming) {
                return;
            }
            lastVoter[v] = voter;
            voted.push_back(v);
        });
    }
}

std::vector<double> PlaceDatabase::Impl::scores(const PlaceView& view) const {
    std::vector<double> out(views.size(), 0.0);
    std::vector<std::size_t> lastVoter(views.size(), 0), voted;
    for (std::size_t i = 0; i < view.corners.size(); ++i) {
        votersOf(view.corners[i].descriptor, lastVoter, i + 1, voted);
        // What is seen in few places tells more of the place.
        const double weight =
            std::log(static_cast<double>(views.size() + 2) / static_cast<double>(voted.size() + 1));
        for (const std::size_t v : voted) out[v] += weight;
    }
    for (std::size_t v = 0; v < out.size(); ++v) {
        const auto corners = static_cast<double>(views[v].corners.size() * view.corners.size());
        out[v] /= std::sqrt(std::max(1.0, corners));
    }
    return out;
}

PlaceDatabase::PlaceDatabase(const DatabaseOptions& options)
    : impl_(std::make_unique<Impl>(options)) {}
PlaceDatabase::~PlaceDatabase() = default;
PlaceDatabase::PlaceDatabase(PlaceDatabase&&) noexcept = default;
PlaceDatabase& PlaceDatabase::operator=(PlaceDatabase&&) noexcept = default;

void PlaceDatabase::add(PlaceView view) {
    auto& views = impl_->views;
    ASSERTMSG_(views.empty() || views.back().id < view.id, "place views must come by rising id");
    ASSERTMSG_(views.size() < CornerName::kMaxViews, "too many place views");
    const std::size_t corners = std::min(view.corners.size(), CornerName::kMaxCorners);
    for (std::size_t i = 0; i < corners; ++i) {
        for (auto& table : impl_->tables) {
            table.add(view.corners[i].descriptor, CornerName::of(views.size(), i));
        }
    }
    views.push_back(std::move(view));
}

std::vector<PlaceDatabase::Candidate> PlaceDatabase::query(
    const PlaceView& view, std::size_t most,
    const std::function<bool(map::KeyframeId)>& allowed) const {
    std::vector<Candidate> out;
    const auto& views = impl_->views;
    if (views.empty() || view.corners.size() < impl_->options.minCorners) return out;
    std::vector<double> scores = impl_->scores(view);
    for (std::size_t v = 0; v < scores.size(); ++v) {
        if (scores[v] > 0 && !allowed(views[v].id)) scores[v] = 0;
    }
    const std::size_t reach = impl_->options.neighbours;
    for (std::size_t v = 0; v < scores.size(); ++v) {
        if (!(scores[v] > 0)) continue;
        const std::size_t last = std::min(scores.size() - 1, v + reach);
        bool best = true;
        for (std::size_t n = v - std::min(v, reach); n <= last && best; ++n) {
            // Of equals, the older.
            best = n == v || scores[n] < scores[v] || (scores[n] == scores[v] && n > v);
        }
        if (best) out.push_back({views[v].id, scores[v]});
    }
    std::stable_sort(out.begin(), out.end(),
                     [](const Candidate& l, const Candidate& r) { return l.score > r.score; });
    if (out.size() > most) out.resize(most);
    return out;
}

const PlaceView* PlaceDatabase::find(map::KeyframeId id) const {
    const auto& views = impl_->views;
    const auto it =
        std::lower_bound(views.begin(), views.end(), id,
                         [](const PlaceView& v, map::KeyframeId k) { return v.id < k; });
    return it != views.end() && it->id == id ? &*it : nullptr;
}

std::size_t PlaceDatabase::size() const { return impl_->views.size(); }

std::size_t PlaceDatabase::bytes() const {
    std::size_t sum = 0;
    for (const auto& view : impl_->views) {
        sum += sizeof(PlaceView) + view.corners.capacity() * sizeof(PlaceView::Corner);
    }
    for (const auto& table : impl_->tables) sum += table.bytes();
    return sum;
}

}  // namespace djpete::places
