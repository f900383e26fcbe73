/// The rows that frames add to a drive's tables, kept per frame until the drive is complete.
#pragma once

#include <array>
#include <cstdint>
#include <filesystem>
#include <string>

namespace djpete::simulator {

/// Rows of one frame, each ending in a new line.
struct FrameRows {
    std::array<std::string, 5> of;  ///< in the order of kTables
    std::string& labels() { return of[0]; }
    std::string& detections() { return of[1]; }
    std::string& objects() { return of[2]; }
    std::string& exposure() { return of[3]; }
    std::string& moving() { return of[4]; }
};
constexpr std::array<const char*, 5> kTables{"label_02.txt", "detections.txt", "objects.txt",
                                             "exposure.txt", "moving.txt"};

/// One file per frame in the drive's folder `unfinished`, written when all else of the frame is:
/// what a broken run leaves behind tells which frames are complete. Its calls throw
/// std::runtime_error naming the file that cannot be read or written.
class RowStore {
  public:
    explicit RowStore(const std::filesystem::path& drive);
    /// Forgets what an earlier run left.
    void clear() const;
    /// Takes the tables of a complete drive apart again, if there are any.
    void reopen() const;
    bool has(uint64_t frame) const;
    void put(uint64_t frame, const FrameRows& rows) const;
    /// Writes the tables, frame by frame, and removes the folder. Frames without rows are left out.
    void close(uint64_t begin, uint64_t end) const;

  private:
    std::filesystem::path fileOf(uint64_t frame) const;
    std::filesystem::path drive_, folder_;
};

}  // namespace djpete::simulator
