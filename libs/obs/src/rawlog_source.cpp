#include "djpete/obs/rawlog_source.h"

#include <mrpt/io/CFileGZInputStream.h>
#include <mrpt/io/lazy_load_path.h>
#include <mrpt/obs/CObservationComment.h>
#include <mrpt/obs/CSensoryFrame.h>
#include <mrpt/serialization/CArchive.h>

#include <algorithm>
#include <deque>

#include "djpete/obs/errors.h"
#include "djpete/obs/frame_assembler.h"

namespace djpete::obs {

namespace {

using mrpt::obs::CObservation;

/// Counts bytes, so that the end of the file can be told from a torn object.
class CountingStream : public mrpt::io::CStream {
  public:
    explicit CountingStream(const std::string& file) : in_(file) {}
    std::size_t Read(void* buffer, std::size_t count) override {
        const std::size_t n = in_.Read(buffer, count);
        if (n > count) throw std::runtime_error("damaged gzip data");  // gzread's -1
        bytes_ += n;
        return n;
    }
    std::size_t Write(const void*, std::size_t) override { throw std::logic_error("read only"); }
    uint64_t Seek(int64_t, CStream::TSeekOrigin) override { throw std::logic_error("no seek"); }
    uint64_t getTotalBytesCount() const override { return in_.getTotalBytesCount(); }
    uint64_t getPosition() const override { return in_.getPosition(); }
    std::string getStreamDescription() const override { return in_.getStreamDescription(); }
    uint64_t bytes() const { return bytes_; }

  private:
    mrpt::io::CFileGZInputStream in_;
    uint64_t bytes_ = 0;
};

/// The observations of a rawlog in file order, whichever of MRPT's two formats it has.
class ObservationReader {
  public:
    explicit ObservationReader(const std::filesystem::path& file) : path_(file.string()) {
        registerObservationClasses();
        if (!std::filesystem::is_regular_file(file)) {
            throw InputError(path_ + ": no such rawlog");
        }
        try {
            stream_ = std::make_unique<CountingStream>(path_);
            archive_ = mrpt::serialization::archiveUniquePtrFrom(*stream_);
        } catch (const std::exception&) {
            throw InputError(path_ + ": cannot be opened as a rawlog");
        }
    }

    CObservation::Ptr next() {
        while (pending_.empty()) {
            const auto object = readObject();
            if (!object) return nullptr;
            if (auto o = std::dynamic_pointer_cast<CObservation>(object)) pending_.push_back(o);
            if (auto sf = std::dynamic_pointer_cast<mrpt::obs::CSensoryFrame>(object)) {
                for (const auto& o : *sf) pending_.push_back(o);
            }
        }
        auto out = pending_.front();
        pending_.pop_front();
        return out;
    }
    const std::string& path() const { return path_; }

  private:
    mrpt::serialization::CSerializable::Ptr readObject() {
        const uint64_t before = stream_->bytes();
        try {
            auto object = archive_->ReadObject();
            ++entries_;
            return object;
        } catch (const std::exception& e) {
            if (stream_->bytes() == before &&
                dynamic_cast<const mrpt::serialization::CExceptionEOF*>(&e)) {
                return nullptr;
            }
            throw InputError(
                path_ + ": entry " + std::to_string(entries_) +
                " cannot be read; expected an MRPT observation, the file is damaged, cut "
                "short or no rawlog (" +
                reason(e) + ")");
        }
    }
    static std::string reason(const std::exception& e) {
        const std::string what = e.what();
        const auto at = what.find("not registered");
        if (at != std::string::npos) return "a class in it is not registered";
        if (dynamic_cast<const mrpt::serialization::CExceptionEOF*>(&e)) return "unexpected end";
        return "broken data";
    }

    std::string path_;
    std::unique_ptr<CountingStream> stream_;
    mrpt::serialization::CArchive::UniquePtr archive_;
    std::deque<CObservation::Ptr> pending_;
    uint64_t entries_ = 0;
};

void setLazyLoadFolder(const std::filesystem::path& rawlog) {
    const auto file = std::filesystem::absolute(rawlog);
    const auto images = file.parent_path() / (file.stem().string() + "_Images");
    const auto base = std::filesystem::is_directory(images) ? images : file.parent_path();
    mrpt::io::setLazyLoadPathBase(base.string());
}

/// The head that kitti2rawlog writes, if `o` is one. MRPT 2.5 does not keep a comment's label, so
/// its text tells.
std::optional<DriveInfo> headOf(const CObservation::Ptr& o, const std::string& origin) {
    const auto comment = std::dynamic_pointer_cast<mrpt::obs::CObservationComment>(o);
    if (!comment || comment->text.find("[DRIVE]") == std::string::npos) return std::nullopt;
    return driveInfoFromIniText(comment->text, origin);
}

void requireAllFrames(const DriveInfo& info, uint64_t count, const std::string& path) {
    const uint64_t missing = std::min<uint64_t>(info.frameCount, info.missing.size());
    const uint64_t expected = info.frameCount - missing;
    if (count < expected) {
        throw InputError(path + ": ends after " + std::to_string(count) + " of " +
                         std::to_string(expected) + " frames; the file is cut short");
    }
}

}  // namespace

struct RawlogSource::Impl {
    Impl(const std::filesystem::path& file, RawlogSourceOptions options) : reader(file) {
        setLazyLoadFolder(file);
        const auto first = reader.next();
        if (!first) throw InputError(reader.path() + ": the rawlog is empty");
        const auto head = headOf(first, reader.path());
        if (head) info = *head;
        frames = FrameAssembler({options.stampSpread_s, info.firstFrame, info.missing});
        if (!head) frames.add(first);
    }

    std::optional<SensorFrame> next() {
        std::optional<SensorFrame> frame;
        while (!frame) {
            const auto o = read();
            if (!o) break;
            frame = frames.add(o);
        }
        if (!frame) frame = frames.flush();
        if (frame) {
            ++count;
        } else {
            checkComplete();
        }
        return frame;
    }

    /// A torn observation ends the last frame; the error comes with the call after it.
    CObservation::Ptr read() {
        if (!failure.empty()) return nullptr;
        try {
            return reader.next();
        } catch (const InputError& e) {
            failure = e.what();
            return nullptr;
        }
    }

    void checkComplete() const {
        if (!failure.empty()) throw InputError(failure);
        requireAllFrames(info, count, reader.path());
    }

    ObservationReader reader;
    DriveInfo info;
    FrameAssembler frames;
    std::string failure;
    uint64_t count = 0;
};

RawlogSource::RawlogSource(const std::filesystem::path& rawlog, RawlogSourceOptions options)
    : impl_(std::make_unique<Impl>(rawlog, options)) {}
RawlogSource::~RawlogSource() = default;
RawlogSource::RawlogSource(RawlogSource&&) noexcept = default;
RawlogSource& RawlogSource::operator=(RawlogSource&&) noexcept = default;

const DriveInfo& RawlogSource::info() const { return impl_->info; }
const std::string& RawlogSource::path() const { return impl_->reader.path(); }
std::optional<SensorFrame> RawlogSource::next() { return impl_->next(); }

std::vector<CObservationDetectedObjects::Ptr> readDetections(const std::filesystem::path& rawlog) {
    ObservationReader reader(rawlog);
    std::vector<CObservationDetectedObjects::Ptr> out;
    DriveInfo info;
    while (auto o = reader.next()) {
        if (auto head = headOf(o, reader.path())) info = *head;
        if (auto d = std::dynamic_pointer_cast<CObservationDetectedObjects>(o)) out.push_back(d);
    }
    requireAllFrames(info, out.size(), reader.path());
    return out;
}

}  // namespace djpete::obs
