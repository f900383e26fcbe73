/// What the processor must be able to do.
#pragma once

#include <stdexcept>

namespace djpete::simulator {

/// To be called in files without AVX2 code before code of files with it runs. Throws
/// std::runtime_error if this processor has none.
inline void requireAvx2() {
#if defined(__x86_64__)
    if (__builtin_cpu_supports("avx2") != 0) return;
#endif
    throw std::runtime_error("The simulator needs an x86-64 processor with AVX2");
}

}  // namespace djpete::simulator
