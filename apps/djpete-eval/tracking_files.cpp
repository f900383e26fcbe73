#include "tracking_files.h"

#include <algorithm>
#include <filesystem>
#include <map>

#include "djpete/obs/errors.h"

namespace djpete::apps {

using namespace evaluation;
using obs::InputError;

namespace {

namespace fs = std::filesystem;

struct Files {
    std::vector<std::string> paths;
    bool named = true;  ///< each is on the command line; no folder is
};

Files expanded(const std::vector<std::string>& given) {
    Files files;
    for (const auto& path : given) {
        if (!fs::exists(path)) throw InputError(path + ": no such file or folder");
        if (!fs::is_directory(path)) {
            files.paths.push_back(path);
            continue;
        }
        files.named = false;
        std::vector<std::string> inside;
        for (const auto& entry : fs::directory_iterator(path)) {
            if (entry.path().extension() == ".txt") inside.push_back(entry.path().string());
        }
        if (inside.empty()) throw InputError(path + ": expected files like 0000.txt in the folder");
        std::sort(inside.begin(), inside.end());
        files.paths.insert(files.paths.end(), inside.begin(), inside.end());
    }
    return files;
}

std::string stemOf(const std::string& path) { return fs::path(path).stem().string(); }

std::map<std::string, std::string> byStem(const Files& files) {
    std::map<std::string, std::string> out;
    for (const auto& path : files.paths) {
        if (!out.emplace(stemOf(path), path).second) {
            throw InputError(path + ": a file of this name is there twice; expected one per drive");
        }
    }
    return out;
}

struct PathPair {
    std::string result, label;
};

std::vector<PathPair> pairUp(const Files& results, const Files& labels) {
    std::vector<PathPair> pairs;
    if (results.named && labels.named && results.paths.size() == labels.paths.size()) {
        for (std::size_t i = 0; i < results.paths.size(); ++i) {
            pairs.push_back({results.paths[i], labels.paths[i]});
        }
        return pairs;
    }
    const auto resultOf = byStem(results), labelOf = byStem(labels);
    for (const auto& [stem, result] : resultOf) {
        const auto label = labelOf.find(stem);
        if (label == labelOf.end()) {
            throw InputError(result + ": expected labels in a file " + stem +
                             ".txt among --labels");
        }
        pairs.push_back({result, label->second});
    }
    for (const auto& [stem, label] : labelOf) {
        if (labels.named && resultOf.count(stem) == 0) {
            throw InputError(label + ": expected a result in a file " + stem +
                             ".txt among --tracking");
        }
    }
    return pairs;
}

template <typename Row>
void keepRange(std::vector<Row>& rows, const FrameRange& range) {
    const auto outside = [&](const Row& row) {
        return row.frame < range.begin || row.frame >= range.end;
    };
    rows.erase(std::remove_if(rows.begin(), rows.end(), outside), rows.end());
}

}  // namespace

std::vector<TrackingPair> readTrackingPairs(const std::vector<std::string>& results,
                                            const std::vector<std::string>& labels,
                                            const std::optional<FrameRange>& range) {
    std::vector<TrackingPair> pairs;
    for (const auto& [result, label] : pairUp(expanded(results), expanded(labels))) {
        TrackingPair pair{readTrackingSequence(label), readTrackingSequence(result)};
        if (range) {
            keepRange(pair.labels.boxes, *range);
            keepRange(pair.labels.dontCare, *range);
            keepRange(pair.results.boxes, *range);
        }
        pairs.push_back(std::move(pair));
    }
    return pairs;
}

}  // namespace djpete::apps
