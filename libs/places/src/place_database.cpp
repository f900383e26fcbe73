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

    std::vector<double> scores(const PlaceView& view, const std::vector<bool>& allowed) const;
};

namespace {

/// Bits set in a word.
unsigned bitsOf(uint32_t x) {
    x -= (x >> 1) & 0x55555555U;
    x = (x & 0x33333333U) + ((x >> 2) & 0x33333333U);
    x = (x + (x >> 4)) & 0x0F0F0F0FU;
    return (x * 0x01010101U) >> 24;
}

/// The nearest corner of each view to one corner.
class NearestOfViews {
  public:
    explicit NearestOfViews(std::size_t views) : distance_(views, kNone) {}
    void clear() {
        for (const std::size_t v : seen_) distance_[v] = kNone;
        seen_.clear();
    }
    void offer(std::size_t view, unsigned distance) {
        if (distance_[view] == kNone) seen_.push_back(view);
        distance_[view] = std::min(distance_[view], distance);
    }
    unsigned of(std::size_t view) const { return distance_[view]; }
    const std::vector<std::size_t>& seen() const { return seen_; }

  private:
    static constexpr unsigned kNone = 257;
    std::vector<unsigned> distance_;
    std::vector<std::size_t> seen_;
};

}  // namespace

/// Each corner of the view has one vote. It is shared among the views that hold a corner like it,
/// by how near each comes to the nearest of all.
std::vector<double> PlaceDatabase::Impl::scores(const PlaceView& view,
                                                const std::vector<bool>& allowed) const {
    constexpr double kSpread2 = 2 * 8.0 * 8.0;  // differing bits that are still as good, 1-sigma
    // Of 32 bits a near corner differs in its share; a few more pass.
    const unsigned maxSignature = 3 + options.maxHamming / 8;
    const HammingFunction hamming = hammingFunction();
    std::vector<double> out(views.size(), 0.0);
    NearestOfViews found(views.size());
    std::vector<CornerName> near;
    const auto descriptorOf = [&](CornerName name) -> const obs::Descriptor& {
        return views[name.view()].corners[name.corner()].descriptor;
    };
    for (const auto& corner : view.corners) {
        const obs::Descriptor& d = corner.descriptor;
        found.clear();
        near.clear();
        for (const HashTable& table : tables) {
            const uint32_t key = table.bits().key(d), signature = table.bits().signature(d);
            if (table.length(key) > options.maxListLength) continue;
            table.forEach(key, [&](const HashTable::Entry& e) {
                if (!allowed[e.name.view()]) return;
                if (bitsOf(signature ^ e.signature) > maxSignature) return;
                near.push_back(e.name);
                __builtin_prefetch(&descriptorOf(e.name));
            });
        }
        for (const CornerName name : near) {
            const unsigned h = hamming(d, descriptorOf(name));
            if (h <= options.maxHamming) found.offer(name.view(), h);
        }
        unsigned best = Nearest::kNone;
        for (const std::size_t v : found.seen()) best = std::min(best, found.of(v));
        const auto weight = [&](std::size_t v) {
            const double more = found.of(v) - best;
            return std::exp(-more * more / kSpread2);
        };
        double sum = 0;
        for (const std::size_t v : found.seen()) sum += weight(v);
        for (const std::size_t v : found.seen()) out[v] += weight(v) / sum;
    }
    for (double& s : out) s /= static_cast<double>(view.corners.size());
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
    std::vector<bool> allowedView;
    for (const auto& v : views) allowedView.push_back(allowed(v.id));
    const std::vector<double> scores = impl_->scores(view, allowedView);
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
