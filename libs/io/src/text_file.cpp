#include "text_file.h"

#include <cstdio>

#include "djpete/obs/errors.h"

namespace djpete::io {

void throwUnwritable(const std::string& file) {
    throw obs::InputError(file +
                          ": cannot be written; expected an existing folder with room and "
                          "write permission");
}

TextFile::TextFile(const std::string& file, bool binary)
    : file_(file), stream_(file, binary ? std::ios::out | std::ios::binary : std::ios::out) {
    if (!stream_) throwUnwritable(file_);
}

void TextFile::number(double value, char before) {
    char buffer[40];
    const int n = std::snprintf(buffer, sizeof(buffer), "%.12g", value);
    if (before != '\0') stream_.put(before);
    stream_.write(buffer, n);
}

void TextFile::seconds(mrpt::Clock::time_point stamp) {
    // In whole ticks of 100 ns: a double cannot hold UNIX time to that resolution.
    const int64_t ticks = (stamp - mrpt::Clock::fromDouble(0)).count();
    char buffer[40];
    const int n = std::snprintf(buffer, sizeof(buffer), "%lld.%07lld",
                                static_cast<long long>(ticks / 10000000),
                                static_cast<long long>(ticks % 10000000));
    stream_.write(buffer, n);
}

void TextFile::close() {
    stream_.close();
    if (!stream_) throwUnwritable(file_);
}

std::array<double, 7> poseNumbers(const geometry::SE3& T_a_b) {
    Eigen::Quaterniond q(T_a_b.rotation());
    if (q.w() < 0) q.coeffs() = -q.coeffs();
    const auto& t = T_a_b.translation();
    return {t.x(), t.y(), t.z(), q.x(), q.y(), q.z(), q.w()};
}

}  // namespace djpete::io
