/// One alignment of a patch, for two builds of the same code.
#pragma once

#include <array>
#include <opencv2/core.hpp>
#include <optional>

#include "djpete/geometry/types.h"

namespace djpete_test {

struct PatchTask {
    cv::Mat from, to;
    double u_px = 0, v_px = 0, startU_px = 0, startV_px = 0;
    djpete::geometry::Mat2 stepsPerPixel = djpete::geometry::Mat2::Identity();
    bool sheared = false;
};

/// Found (1 or 0), column, row, shear, correlation, sigma; upright and warped template.
using AlignedPatch = std::array<double, 12>;

template <class Template, class Prior, class Place>
AlignedPatch align(const PatchTask& task) {
    Prior prior{0.5, task.sheared ? 0.15 : 0.0};
    Place start;
    start.u_px = task.startU_px;
    start.v_px = task.startV_px;
    AlignedPatch out{};
    std::size_t at = 0;
    for (const auto& t :
         {Template::from(task.from, task.u_px, task.v_px, prior),
          Template::warped(task.from, task.u_px, task.v_px, task.stepsPerPixel, prior)}) {
        const auto p = t ? t->align(task.to, start, {6.0, 6.0}) : std::nullopt;
        const std::array<double, 6> row =
            p ? std::array<double, 6>{1, p->u_px, p->v_px, p->shear, p->correlation, p->sigma_px}
              : std::array<double, 6>{};
        for (const double x : row) out[at++] = x;
    }
    return out;
}

AlignedPatch alignScalar(const PatchTask& task);

}  // namespace djpete_test
