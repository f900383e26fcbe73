#include "djpete/pipeline/frame_prefetcher.h"

namespace djpete::pipeline {

LoadedFrame loadFrame(const obs::SensorFrame& frame) {
    LoadedFrame out;
    out.frame = frame;
    out.images = frame.loadMainImages();
    out.scan = frame.loadScan();
    return out;
}

FramePrefetcher::FramePrefetcher(obs::RawlogSource& source, obs::FrameId begin, obs::FrameId end)
    : source_(source), begin_(begin), end_(end) {
    start();
}

FramePrefetcher::~FramePrefetcher() {
    if (ahead_.valid()) ahead_.wait();
}

void FramePrefetcher::start() {
    ahead_ = std::async(std::launch::async, [this]() -> std::optional<LoadedFrame> {
        auto frame = source_.next();
        while (frame && frame->id < begin_) frame = source_.next();
        if (!frame || frame->id >= end_) return std::nullopt;
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
