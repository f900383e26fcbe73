// The patch code once more, with OpenCV's universal intrinsics in their plain C++ form: the scalar
// twin that simd_test.cpp compares with.
#define CV_FORCE_SIMD128_CPP 1
#include <opencv2/core.hpp>
#include <opencv2/core/hal/intrin.hpp>

#include "djpete/geometry/types.h"
#include "simd_test.h"

#define frontend frontend_scalar
#include "patch_alignment.cpp"
#include "patch_sampling.cpp"
#undef frontend

namespace djpete_test {

AlignedPatch alignScalar(const PatchTask& task) {
    static_assert(std::is_same_v<cv::v_float32x4, cv::v_reg<float, 4>>, "not the plain C++ form");
    return align<djpete::frontend_scalar::PatchTemplate, djpete::frontend_scalar::PlacePrior,
                 djpete::frontend_scalar::PatchPlace>(task);
}

}  // namespace djpete_test
