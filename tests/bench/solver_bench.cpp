/// Speed of the solver: a local bundle adjustment of the usual size, beside Ceres.
///
///     djpete_bench_solver [repetitions = 5]
#include <algorithm>
#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <vector>

#include "djpete_test/ceres_problem.h"

namespace {

using namespace djpete_test;
using namespace djpete::solver;

double median(std::vector<double> v) {
    std::sort(v.begin(), v.end());
    return v[v.size() / 2];
}

struct Timing {
    double solve_ms = 0, iteration_ms = 0;
    int iterations = 0;
    double cost = 0;
};

Timing timeOurs(const StreetWorld& world, const StartOptions& start, int repetitions) {
    std::vector<double> all;
    Report report;
    for (int r = 0; r < repetitions; ++r) {
        StreetProblem p = stereoProblem(world, start, RobustKernel::huber(2));
        report = solve(p.problem);
        all.push_back(report.time_ms);
    }
    return {median(all), median(all) / report.iterations, report.iterations, report.finalCost};
}

Timing timeCeres(const StreetWorld& world, const StartOptions& start, int repetitions) {
    std::vector<double> all;
    ceres::Solver::Summary summary;
    for (int r = 0; r < repetitions; ++r) {
        CeresStreet p = ceresStereoProblem(
            world, start, +[]() -> ceres::LossFunction* { return new ceres::HuberLoss(2); });
        ceres::Solver::Options options;
        options.linear_solver_type = ceres::DENSE_SCHUR;
        options.num_threads = 2;
        const auto begin = std::chrono::steady_clock::now();
        ceres::Solve(options, p.problem.get(), &summary);
        const std::chrono::duration<double, std::milli> time =
            std::chrono::steady_clock::now() - begin;
        all.push_back(time.count());
    }
    const int iterations = int(summary.iterations.size()) - 1;
    return {median(all), median(all) / iterations, iterations, summary.final_cost};
}

void print(const char* name, const Timing& t) {
    std::printf("| %-28s | %8.1f | %10d | %8.2f | %14.6f |\n", name, t.solve_ms, t.iterations,
                t.iteration_ms, t.cost);
}

}  // namespace

int main(int argc, char** argv) {
    const int repetitions = argc > 1 ? std::max(1, std::atoi(argv[1])) : 5;
    StreetOptions o;
    o.cameras = 20;
    o.points = 2500;
    o.spacing_m = 0.8;
    o.maxCamerasPerPoint = 12;
    o.sigma_px = 0.7;
    o.outliers = 0.03;
    const StreetWorld world = makeStreet(o);
    StartOptions start;
    start.fixedCameras = 5;
    start.camera_m = 0.05;
    start.camera_rad = 0.003;
    start.point_m = 0.2;
    std::printf(
        "local bundle adjustment: %d free + %d fixed keyframes, %d points, %d stereo "
        "observations, Huber; median of %d\n",
        o.cameras - start.fixedCameras, start.fixedCameras, o.points,
        int(world.observations.size()), repetitions);
    std::printf(
        "| solver                       | solve ms | iterations | ms/iter. | final cost     |\n"
        "|------------------------------|----------|------------|----------|----------------|\n");
    const Timing ours = timeOurs(world, start, repetitions);
    const Timing theirs = timeCeres(world, start, repetitions);
    print("djpete, 1 thread", ours);
    print("Ceres DENSE_SCHUR, 2 threads", theirs);
    std::printf("ratio per solve %.2f, per iteration %.2f\n", theirs.solve_ms / ours.solve_ms,
                theirs.iteration_ms / ours.iteration_ms);
    return 0;
}
