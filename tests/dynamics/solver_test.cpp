// SPDX-License-Identifier: MIT
// The same bits whatever the number of threads, and after an interruption.
#include "root_sph/dynamics/solver.hpp"

#include <gtest/gtest.h>
#include <omp.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <limits>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "root_sph/core/errors.hpp"
#include "root_sph/io/checkpoint.hpp"
#include "tests/support/block.hpp"

namespace rootsoil {
namespace {

using test::Random;

/// A step without inertia is a window, and finds a balance.
constexpr int steps_a_window(Stepper stepper) { return stepper == Stepper::quasi_static ? 1 : 10; }

/// A short root of irregular cells held at its base, that grows, divides and has every pair term.
template <int Dim>
std::unique_ptr<Solver<Dim>> growing_root(Stepper stepper, bool with_cells) {
  SolverOptions options;
  options.step_h = 1e-3;
  options.stepper = stepper;
  auto solver = std::make_unique<Solver<Dim>>(options);
  Tissue<Dim>& tissue = solver->tissue();
  const bool inertia = tissue.inertia.has_value();
  solver->pair_terms() = make_pair_terms<Dim>(tissue.cells, 1020.0, inertia ? 0.5 : 0.0, 0.05, inertia ? 0.1 : 0.0);
  tissue.material.softening = &tissue.cells.template declare<double>({"softening", "ug/(mm^3 h)", "", Storage::scratch},
                                                                     on_division::recomputed<Dim, double>);
  // what the columns cannot hold must come from the checkpoint: profile material too
  tissue.material.stiffness = &tissue.cells.template declare<Stiffness<Dim>>(
      {"stiffness", "MPa", "", Storage::scratch}, on_division::recomputed<Dim, Stiffness<Dim>>);
  std::array<int, Dim> counts;
  counts.fill(Dim == 2 ? 8 : 4);
  counts[0] = Dim == 2 ? 60 : 40;
  Random random(1);
  if (with_cells) {
    test::fill<Dim>(tissue, test::lattice<Dim>(counts, 0.01, random, 0.2, 0.2), test::table_1(5000.0));
    for (std::size_t i = 0; i < tissue.cells.size(); ++i) {
      tissue.cells.clamped[i] = tissue.cells.position[i][0] < -0.5 * 0.01 * (counts[0] - 6);
      tissue.cells.velocity[i] =
          tissue.cells.clamped[i] ? Vec<Dim>(Vec<Dim>::Zero()) : random.matrix<Vec<Dim>>() * 1e-3;
    }
    solver->axis().start(tissue);
  } else {
    test::fill<Dim>(tissue, {}, test::table_1(5000.0));
  }
  tissue.pressure_MPa = 1.0;
  Solver<Dim>* running = solver.get();
  solver->hooks().division.emplace_back("division", [running, steps = steps_a_window(stepper)](Tissue<Dim>& t) {
    if (running->steps() % (2 * steps) != steps) return;  // in every other window
    for (const std::size_t mother : {t.cells.size() / 3, t.cells.size() / 2}) {
      t.cells.divide(mother, Vec<Dim>::UnitX(), 0.01, t.next_cell_id, t.next_cell_id + 1);
      t.next_cell_id += 2;
    }
  });
  solver->hooks().parameters.emplace_back("profiles", [running](Tissue<Dim>& t) {
    for (std::size_t i = 0; i < t.cells.size(); ++i) {
      const double s = running->mid_window_distance(t.cells.distance_to_tip[i]);
      (*t.material.softening)[i] = t.cells.clamped[i] ? 0.0 : 4e5 * std::exp(-10.0 * s);
      (*t.material.stiffness)[i] = stiffness<Dim>(test::table_1(1020.0 + 8000.0 * s));
    }
  });
  solver->prepare();
  return solver;
}

TEST(SolverTime, IsTheShortestDecimalOfTheStepCount) {
  EXPECT_NE(3 * 0.1, 0.3);
  EXPECT_EQ(step_time_h(3, 0.1), 0.3);
  for (std::int64_t tenth = 1; tenth <= 1000; ++tenth) {
    EXPECT_EQ(step_time_h(300 * tenth, 0.1 / 300.0), static_cast<double>(tenth) / 10.0);
  }
  EXPECT_LT(step_time_h(99'999, 1e-3), step_time_h(100'000, 1e-3));
}

template <class T>
bool same_bits(const std::vector<T>& a, const std::vector<T>& b) {
  return a.size() == b.size() && std::memcmp(a.data(), b.data(), a.size() * sizeof(T)) == 0;
}

template <int Dim>
Checkpoint state_of(const Solver<Dim>& solver) {
  Checkpoint checkpoint;
  store_cells<Dim>(solver.tissue().cells, checkpoint);
  solver.save(checkpoint.reals, checkpoint.integers);
  return checkpoint;
}

void expect_same_bits(const Checkpoint& a, const Checkpoint& b) {
  ASSERT_EQ(a.reals.size(), b.reals.size());
  ASSERT_EQ(a.integers.size(), b.integers.size());
  for (const auto& [name, values] : a.reals) EXPECT_TRUE(same_bits(values, b.reals.at(name))) << name;
  for (const auto& [name, values] : a.integers) EXPECT_TRUE(same_bits(values, b.integers.at(name))) << name;
}

template <class Dimension>
class SolverBits : public testing::Test {};
TYPED_TEST_SUITE(SolverBits, test::BothDimensions, test::DimensionName);

TYPED_TEST(SolverBits, AreTheSameForAnyNumberOfThreads) {
  constexpr int dim = TypeParam::value;
  const int before = omp_get_max_threads();
  for (const Stepper stepper : {Stepper::quasi_static, Stepper::symplectic, Stepper::predictor_corrector}) {
    std::vector<Checkpoint> states;
    for (const int threads : {1, 2, 3, 4, 5}) {
      omp_set_num_threads(threads);
      const auto solver = growing_root<dim>(stepper, true);
      const std::size_t cells = solver->tissue().cells.size();
      for (int window = 0; window < 4; ++window) solver->advance_window(steps_a_window(stepper));
      EXPECT_GE(solver->tissue().pairs.blocks.size(), 4u);
      EXPECT_EQ(solver->tissue().cells.size(), cells + 4);
      states.push_back(state_of<dim>(*solver));
    }
    for (const Checkpoint& state : states) expect_same_bits(states[0], state);
  }
  omp_set_num_threads(before);
}

TYPED_TEST(SolverBits, AreTheSameAfterARestore) {
  constexpr int dim = TypeParam::value;
  for (const Stepper stepper : {Stepper::quasi_static, Stepper::symplectic, Stepper::predictor_corrector}) {
    // interrupted before the first window, before and after windows with divisions
    for (const int interrupted_after : {0, 1, 2, 3}) {
      const auto whole = growing_root<dim>(stepper, true);
      for (int window = 0; window < interrupted_after; ++window) whole->advance_window(steps_a_window(stepper));
      const Checkpoint checkpoint = state_of<dim>(*whole);
      for (int window = 0; window < 3; ++window) whole->advance_window(steps_a_window(stepper));

      const auto resumed = growing_root<dim>(stepper, false);
      restore_cells<dim>(checkpoint, resumed->tissue().cells);
      resumed->restore(checkpoint.reals, checkpoint.integers);
      expect_same_bits(state_of<dim>(*resumed), checkpoint);
      for (int window = 0; window < 3; ++window) resumed->advance_window(steps_a_window(stepper));
      SCOPED_TRACE(interrupted_after);
      expect_same_bits(state_of<dim>(*whole), state_of<dim>(*resumed));
      EXPECT_EQ(whole->tissue().time_h, resumed->tissue().time_h);
    }
  }
}

TYPED_TEST(SolverBits, StateTellsRunsApart) {
  constexpr int dim = TypeParam::value;
  const auto a = growing_root<dim>(Stepper::symplectic, true), b = growing_root<dim>(Stepper::symplectic, true);
  b->tissue().cells.position[40][0] = std::nextafter(b->tissue().cells.position[40][0], 1.0);
  a->advance_window(10);
  b->advance_window(10);
  EXPECT_FALSE(same_bits(state_of<dim>(*a).reals.at("cells/position"), state_of<dim>(*b).reals.at("cells/position")));
}

/// A free elastic block, struck at random: the largest kinetic plus elastic energy of 300 steps over the first.
template <int Dim>
double largest_energy_ratio(Stepper stepper, std::optional<double> damping = {}, double stiffness = 0.0) {
  SolverOptions options;
  options.step_h = 1e-3;
  options.stepper = stepper;
  Solver<Dim> solver(options);
  solver.pair_terms() = make_pair_terms<Dim>(solver.tissue().cells, 1020.0, damping, stiffness, damping.value_or(0.0));
  Random random(2);
  std::array<int, Dim> counts;
  counts.fill(Dim == 2 ? 8 : 4);
  counts[0] = 12;
  test::fill<Dim>(solver.tissue(), test::lattice<Dim>(counts, 0.01, random, 0.2, 0.2), test::table_1(5000.0));
  for (Vec<Dim>& u : solver.tissue().cells.velocity.values()) u = 1e-4 * random.matrix<Vec<Dim>>();
  solver.axis().start(solver.tissue());
  solver.prepare();
  constexpr double rounding_Nmm = 1e-20;  // a balance leaves some 1e-28, and of that more or less
  double first = 0.0, largest = 0.0;
  for (int window = 0; window < 15; ++window) {
    solver.advance_window(20);
    const Energies e = energies<Dim>(solver.tissue());
    if (window == 0) first = std::max(e.kinetic + e.elastic, rounding_Nmm);
    largest = std::max(largest, e.kinetic + e.elastic);
  }
  return largest / first;
}

template <class Dimension>
class SolverEnergy : public testing::Test {};
TYPED_TEST_SUITE(SolverEnergy, test::BothDimensions, test::DimensionName);

// Leapfrog at the limit of its stability keeps energy up to a factor: velocities and stresses are half a step apart.
TYPED_TEST(SolverEnergy, StaysBoundedWithTheSymplecticStepper) {
  EXPECT_LT(largest_energy_ratio<TypeParam::value>(Stepper::symplectic), 2.0);
}

// Strains of the mean velocity: |eigenvalue| = 1 up to w dt = 2. With those of the half step's velocity, as the paper
// prints it, the amplitude would grow by (1 + (w dt)^4/4)^(1/2) a step, 2.2 at w dt = 2 (docs/decisions/0008).
TYPED_TEST(SolverEnergy, StaysBoundedWithThePredictorCorrector) {
  EXPECT_LT(largest_energy_ratio<TypeParam::value>(Stepper::predictor_corrector), 2.0);
}

// Damping acts on the predicted velocity: the limit (w dt)^2/4 + c dt/2 - (c dt)^2/4 <= 1 lies above the leapfrog's.
TYPED_TEST(SolverEnergy, IsNotAddedByStrongPairTerms) {
  for (const Stepper stepper : {Stepper::quasi_static, Stepper::symplectic, Stepper::predictor_corrector}) {
    EXPECT_LT(largest_energy_ratio<TypeParam::value>(stepper, 2.0, 0.5), 1.05);
  }
}

template <class Dimension>
class SolverErrors : public testing::Test {};
TYPED_TEST_SUITE(SolverErrors, test::BothDimensions, test::DimensionName);

TYPED_TEST(SolverErrors, StopWhenACellIsNoLongerANumber) {
  const auto solver = growing_root<TypeParam::value>(Stepper::symplectic, true);
  solver->advance_window(5);
  solver->tissue().cells.stress[40][0] = std::numeric_limits<double>::quiet_NaN();
  try {
    solver->advance_window(5);
    FAIL() << "the run went on";
  } catch (const UnphysicalError& error) {
    // every coordinate of the cell is named
    const std::string text = error.what();
    const std::size_t from = text.find("(position "), to = text.find(" mm, distance");
    ASSERT_LT(from, to) << text;
    EXPECT_EQ(std::count(text.begin() + static_cast<std::ptrdiff_t>(from),
                         text.begin() + static_cast<std::ptrdiff_t>(to), ','),
              TypeParam::value - 1)
        << text;
  }
}

TYPED_TEST(SolverErrors, StopWhenACellCollapsesWithinAWindow) {
  constexpr int dim = TypeParam::value;
  const auto solver = growing_root<dim>(Stepper::symplectic, true);
  // the root runs into itself: 60 per hour for 10 steps of 1e-3 h
  for (std::size_t i = 0; i < solver->tissue().cells.size(); ++i) {
    auto& cells = solver->tissue().cells;
    if (!cells.clamped[i]) cells.velocity[i] = -60.0 * (cells.position[i] + Vec<dim>::Constant(0.2));
  }
  for (Stiffness<dim>& k : solver->tissue().material.stiffness->values()) k.setZero();
  solver->hooks().step_loads.emplace_back("collapse", [](Tissue<dim>& t) {
    for (std::size_t i = 0; i < t.cells.size(); ++i) t.cells.velocity[i] = -60.0 * t.cells.position[i];
  });
  EXPECT_THROW(solver->advance_window(20), UnphysicalError);
}

}  // namespace
}  // namespace rootsoil
