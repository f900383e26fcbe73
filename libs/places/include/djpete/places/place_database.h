/// Which keyframes may show the same place: a search by how corners look, without geometry.
#pragma once

#include <mrpt/config/CLoadableOptions.h>

#include <cstddef>
#include <functional>
#include <memory>
#include <vector>

#include "djpete/places/place_view.h"

namespace djpete::places {

/// Section [places].
struct DatabaseOptions : public mrpt::config::CLoadableOptions {
    /// Hash tables; each keeps 8 bytes per corner. More tables find more of the true pairs.
    unsigned tables = 5;
    /// Bits of the descriptor that make a key. More bits: shorter lists, fewer pairs found.
    unsigned keyBits = 18;
    /// Corners with at most so many differing bits (of 256) vote for their keyframe.
    unsigned maxHamming = 44;
    /// Longer lists of a table are not read: what looks like everything tells nothing.
    unsigned maxListLength = 80;
    /// So many keyframes before and after one are its neighbours: the same place.
    unsigned neighbours = 5;
    /// Views with fewer corners are not searched for: they tell nothing.
    unsigned minCorners = 30;

    void loadFromConfigFile(const mrpt::config::CConfigFileBase& source,
                            const std::string& section) override;
    void saveToConfigFile(mrpt::config::CConfigFileBase& target,
                          const std::string& section) const override;
};

/// Keeps the views of all keyframes and finds those that look like a given one. Locality-sensitive
/// hashing: some bits of a descriptor are a key into a table; a corner votes for the keyframes of
/// the corners found under its keys whose whole descriptor is near. Each corner has one vote, which
/// the keyframes share: what is seen everywhere tells little. Deterministic; not thread safe.
class PlaceDatabase {
  public:
    explicit PlaceDatabase(const DatabaseOptions& options = {});
    ~PlaceDatabase();
    PlaceDatabase(PlaceDatabase&&) noexcept;
    PlaceDatabase& operator=(PlaceDatabase&&) noexcept;

    /// Ids must rise from call to call.
    void add(PlaceView view);

    struct Candidate {
        map::KeyframeId id;
        double score = 0;  ///< share of the corners that are most alike here, 0..1
    };
    /// Best first (ties: the older), at most `most`, only views for which `allowed` is true.
    /// Neighbouring keyframes of one place count as one: the best of each run of neighbours.
    std::vector<Candidate> query(const PlaceView& view, std::size_t most,
                                 const std::function<bool(map::KeyframeId)>& allowed) const;

    /// Nothing if there is no such view. Valid until the next add().
    const PlaceView* find(map::KeyframeId id) const;

    std::size_t size() const;   ///< views
    std::size_t bytes() const;  ///< memory of views and tables, about

  private:
    struct Impl;
    std::unique_ptr<Impl> impl_;
};

}  // namespace djpete::places
