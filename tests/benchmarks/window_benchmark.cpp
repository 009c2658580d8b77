// SPDX-License-Identifier: MIT
// What a window of 20 steps costs: pairs a second, with the rebuild of neighbours and operators that it begins with.
// cmake --preset release -DROOTSOIL_BENCHMARKS=ON, then build/release/benchmark_window
#include <benchmark/benchmark.h>

#include <array>
#include <cstdint>

#include "root_sph/dynamics/solver.hpp"
#include "tests/support/block.hpp"

namespace rootsoil {
namespace {

template <int Dim>
void window(benchmark::State& state, Stepper stepper) {
  constexpr int steps = 20;
  SolverOptions options;
  options.step_h = 1e-3;
  options.stepper = stepper;
  Solver<Dim> solver(options);
  solver.pair_terms() = make_pair_terms<Dim>(solver.tissue().cells, 1020.0, 0.5, 0.05, 0.0);
  test::Random random(1);
  std::array<int, Dim> counts;
  counts.fill(Dim == 2 ? 20 : 10);
  counts[0] = Dim == 2 ? 100 : 40;
  test::fill<Dim>(solver.tissue(), test::lattice<Dim>(counts, 0.01, random, 0.1, 0.1), test::table_1(5000.0));
  solver.axis().start(solver.tissue());
  solver.prepare();
  std::int64_t pairs = 0;
  for (auto unused : state) {
    solver.advance_window(steps);
    pairs += steps * static_cast<std::int64_t>(solver.tissue().pairs.pairs.size());
  }
  state.SetItemsProcessed(pairs);
  state.counters["cells"] = static_cast<double>(solver.tissue().cells.size());
}

BENCHMARK_CAPTURE(window<2>, symplectic, Stepper::symplectic)->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(window<3>, symplectic, Stepper::symplectic)->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(window<2>, predictor_corrector, Stepper::predictor_corrector)->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(window<3>, predictor_corrector, Stepper::predictor_corrector)->Unit(benchmark::kMillisecond);

}  // namespace
}  // namespace rootsoil

BENCHMARK_MAIN();
