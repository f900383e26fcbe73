#include "djpete/pipeline/frame_prefetcher.h"

namespace djpete::pipeline {

LoadedFrame loadFrame(const obs::SensorFrame& frame) {
    LoadedFrame out;
    out.frame = frame;
    out.images = frame.loadMainImages();
    out.scan = frame.loadScan();
    return out;
}

FramePrefetcher::FramePrefetcher(obs::RawlogSource& source) : source_(source) { start(); }

FramePrefetcher::~FramePrefetcher() {
    if (ahead_.valid()) ahead_.wait();
}

void FramePrefetcher::start() {
    ahead_ = std::async(std::launch::async, [this]() -> std::optional<LoadedFrame> {
        const auto frame = source_.next();
        if (!frame) return std::nullopt;
        return loadFrame(*frame);
    });
}

std::optional<LoadedFrame> FramePrefetcher::next() {
    if (!ahead_.valid()) return std::nullopt;
    auto out = ahead_.get();  // rethrows; then there is nothing ahead any more
    if (out) start();
    return out;
}

}  // namespace djpete::pipeline
