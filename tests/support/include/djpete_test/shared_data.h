/// Real data for tests: `../shared` beside the project, or the folder named by DJPETE_SHARED.
#pragma once

#include <unistd.h>

#include <cstdlib>
#include <filesystem>
#include <optional>
#include <string>

namespace djpete_test {

/// Path of `relative` in the shared folder (e.g. "data/kitti/odometry"), or nothing if it is
/// absent.
inline std::optional<std::filesystem::path> shared(const std::string& relative) {
    const char* env = std::getenv("DJPETE_SHARED");
    const std::filesystem::path root =
        env ? std::filesystem::path(env)
            : std::filesystem::path(DJPETE_SOURCE_DIR) / ".." / "shared";
    const auto path = root / relative;
    if (!std::filesystem::exists(path)) return std::nullopt;
    return std::filesystem::weakly_canonical(path);
}

/// The folder of this test process under the build tree; gone when the process ends.
class ScratchRoot {
  public:
    ScratchRoot()
        : path(std::filesystem::path(DJPETE_BINARY_DIR) / "scratch" / std::to_string(getpid())) {}
    ~ScratchRoot() {
        std::error_code ignored;
        std::filesystem::remove_all(path, ignored);
    }
    const std::filesystem::path path;
};

/// A fresh, empty folder for one test. Processes never share one, so tests may run side by side.
inline std::filesystem::path scratch(const std::string& name) {
    static const ScratchRoot root;
    const auto dir = root.path / name;
    std::filesystem::remove_all(dir);
    std::filesystem::create_directories(dir);
    return dir;
}

}  // namespace djpete_test

/// Binds `var` to a path in the shared data or skips the test, saying so.
#define DJPETE_SHARED_OR_SKIP(var, relative)                                             \
    const auto var##_found = djpete_test::shared(relative);                              \
    if (!var##_found) GTEST_SKIP() << "skipped: needs shared data (" << relative << ")"; \
    const std::filesystem::path var = *var##_found
