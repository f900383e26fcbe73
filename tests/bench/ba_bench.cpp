/// Local bundle adjustment beside Ceres, to equal cost: ours stops as it does in the back end;
/// Ceres stops as soon as it is as low.
///
///     djpete_bench_ba [DRIVE.rawlog [frames = 300]]
///     djpete_bench_ba --ours
#include <time.h>

#include <chrono>
#include <cstdio>
#include <cstdlib>

#include "ba_problem.h"
#include "ba_windows.h"

namespace {

using namespace djpete_bench;
namespace solver = djpete::solver;

constexpr int kRepetitions = 7;

double median(std::vector<double> v) {
    if (v.empty()) return 0;
    std::sort(v.begin(), v.end());
    return v[v.size() / 2];
}

/// Processor time of all threads: other programs beside do not count.
double cpu_ms() {
    timespec t{};
    clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &t);
    return 1e3 * double(t.tv_sec) + 1e-6 * double(t.tv_nsec);
}

/// Stops Ceres at a cost.
class StopAt final : public ceres::IterationCallback {
  public:
    explicit StopAt(double cost) : cost_(cost) {}
    ceres::CallbackReturnType operator()(const ceres::IterationSummary& s) override {
        if (s.cost > cost_) return ceres::SOLVER_CONTINUE;
        reached = true;
        return ceres::SOLVER_TERMINATE_SUCCESSFULLY;
    }
    bool reached = false;

  private:
    double cost_;
};

struct Outcome {
    double ms = 0, cost = 0;
    int iterations = 0;
    bool reached = true;
    double cpu = 0;
};

Outcome runOurs(const BackboneProblem& in, const BackboneOptions& options) {
    auto problem = ourProblem(in, options.huberScale);
    solver::Options lm;
    lm.maxIterations = int(options.firstIterations);
    lm.functionTolerance = 1e-4;
    const double begin = cpu_ms();
    const auto report = solver::solve(problem, lm);
    return {report.time_ms, report.finalCost, report.iterations, true, cpu_ms() - begin};
}

Outcome runCeres(const BackboneProblem& in, const BackboneOptions& options, int threads,
                 double cost) {
    CeresProblem problem(in, options.huberScale);
    StopAt stop(cost * (1 + 1e-6));
    ceres::Solver::Options o;
    o.linear_solver_type = ceres::DENSE_SCHUR;
    o.num_threads = threads;
    o.max_num_iterations = 100;
    o.function_tolerance = o.parameter_tolerance = o.gradient_tolerance = 1e-14;
    o.callbacks.push_back(&stop);
    o.linear_solver_ordering = std::make_shared<ceres::ParameterBlockOrdering>();
    for (auto& p : problem.points) o.linear_solver_ordering->AddElementToGroup(p.data(), 0);
    for (auto& p : problem.poses) o.linear_solver_ordering->AddElementToGroup(p.data(), 1);
    ceres::Solver::Summary summary;
    const double beginCpu = cpu_ms();
    const auto begin = std::chrono::steady_clock::now();
    ceres::Solve(o, problem.problem.get(), &summary);
    const std::chrono::duration<double, std::milli> time = std::chrono::steady_clock::now() - begin;
    return {time.count(), summary.final_cost, int(summary.iterations.size()) - 1, stop.reached,
            cpu_ms() - beginCpu};
}

template <class Run>
Outcome medianOf(Run run) {
    Outcome out;
    std::vector<double> all, cpu;
    for (int i = 0; i < kRepetitions; ++i) {
        out = run();
        all.push_back(out.ms);
        cpu.push_back(out.cpu);
    }
    out.ms = median(all);
    out.cpu = median(cpu);
    return out;
}

struct Row {
    std::size_t free = 0;
    Outcome ours, ceres1, ceres2;
    double backend_ms = 0;
    double ratio() const { return ceres2.ms / ours.ms; }
};

Row measure(const BackboneProblem& in, const BackboneOptions& options) {
    Row row;
    for (const auto& c : in.cameras) row.free += c.fixed ? 0U : 1U;
    row.ours = medianOf([&] { return runOurs(in, options); });
    row.ceres1 = medianOf([&] { return runCeres(in, options, 1, row.ours.cost); });
    row.ceres2 = medianOf([&] { return runCeres(in, options, 2, row.ours.cost); });
    row.backend_ms = medianOf([&] {
                         return Outcome{djpete::backend::solve(in, options).time_ms, 0, 0, true};
                     }).ms;
    return row;
}

void printHead() {
    std::printf(
        "| free + fixed | points | observ. | ours ms | it. | cost     | Ceres 1 thr. ms | Ceres 2 "
        "thr. ms | it. | cost     | ratio | back end's two rounds ms |\n"
        "|---|---|---|---|---|---|---|---|---|---|---|---|\n");
}

void print(const BackboneProblem& in, const Row& r) {
    std::printf(
        "| %4zu + %2zu | %6zu | %7zu | %7.2f | %2d | %8.1f | %7.1f | %7.1f | %2d | %8.1f%s | %5.1f "
        "| %6.1f |\n",
        r.free, in.cameras.size() - r.free, in.points.size(), in.observations.size(), r.ours.ms,
        r.ours.iterations, r.ours.cost, r.ceres1.ms, r.ceres2.ms, r.ceres2.iterations,
        r.ceres2.cost, r.ceres2.reached ? "" : " never as low", r.ratio(), r.backend_ms);
    std::fflush(stdout);
}

void summary(const std::vector<Row>& rows) {
    std::vector<double> ours, cpu, ratios, cpuRatios, backend;
    std::size_t never = 0;
    for (const auto& r : rows) {
        ours.push_back(r.ours.ms);
        cpu.push_back(r.ours.cpu);
        ratios.push_back(r.ratio());
        cpuRatios.push_back(r.ceres1.cpu / r.ours.cpu);
        backend.push_back(r.backend_ms);
        never += r.ceres2.reached ? 0U : 1U;
    }
    std::printf(
        "%zu windows: ours, median %.2f ms (processor %.2f ms); both rounds of the back end, "
        "median %.2f ms; Ceres (2 threads) / ours, median %.1f, least %.1f; processor time of "
        "Ceres (1 thread) / ours, median %.1f, least %.1f; Ceres never came as low in %zu\n\n",
        rows.size(), median(ours), median(cpu), median(backend), median(ratios),
        *std::min_element(ratios.begin(), ratios.end()), median(cpuRatios),
        *std::min_element(cpuRatios.begin(), cpuRatios.end()), never);
}

void measureAll(const std::vector<BackboneProblem>& windows, const BackboneOptions& options) {
    if (windows.empty()) return;
    printHead();
    std::vector<Row> rows;
    for (const auto& w : windows) {
        rows.push_back(measure(w, options));
        print(w, rows.back());
    }
    summary(rows);
}

/// Our solver alone, for profiling it.
void oursAlone(const std::vector<BackboneProblem>& windows, const BackboneOptions& options) {
    for (const auto& w : windows) {
        const auto ours = medianOf([&] { return runOurs(w, options); });
        std::printf("%6zu points, %7zu observations: %7.2f ms, %d iterations\n", w.points.size(),
                    w.observations.size(), ours.ms, ours.iterations);
    }
}

}  // namespace

int main(int argc, char** argv) {
    const BackboneOptions options;
    std::printf(
        "local bundle adjustment to equal cost, Huber, mono and stereo; medians of %d; ours on 1 "
        "thread, Ceres DENSE_SCHUR with the same analytic Jacobians\nsimulated street\n",
        kRepetitions);
    std::vector<BackboneProblem> windows;
    unsigned seed = 1;
    for (const int free : {10, 15, 20}) {
        for (const int points : {1000, 1500, 2500}) {
            windows.push_back(streetWindow(free, points, seed++));
        }
    }
    if (argc > 1 && std::string(argv[1]) == "--ours") {
        oursAlone(windows, options);
        return 0;
    }
    measureAll(windows, options);
    if (argc < 2) return 0;
    const std::size_t frames = argc > 2 ? std::strtoul(argv[2], nullptr, 10) : 300;
    for (const unsigned size : {10U, 15U, 20U}) {
        std::printf("%s, every 4th keyframe of %zu frames, windows of %u\n", argv[1], frames, size);
        measureAll(driveWindows(argv[1], size, 4, frames), options);
    }
    return 0;
}
