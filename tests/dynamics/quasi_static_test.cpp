// SPDX-License-Identifier: MIT
// The balance of a step: its matrix against the forces themselves, and equilibria that are known.
#include "root_sph/dynamics/quasi_static.hpp"

#include <gtest/gtest.h>

#include <Eigen/Cholesky>
#include <array>
#include <cmath>
#include <functional>
#include <optional>
#include <vector>

#include "root_sph/dynamics/band_cholesky.hpp"
#include "root_sph/dynamics/material_update.hpp"
#include "root_sph/dynamics/pair_loop.hpp"
#include "tests/support/block.hpp"

namespace rootsoil {
namespace {

using test::Random;

TEST(BandCholesky, SolvesAsADenseMatrixDoes) {
  Random random(3);
  for (const auto& [rows, band] : {std::pair{1, 0}, {2, 5}, {47, 3}, {96, 95}, {200, 60}, {331, 47}, {150, 0}}) {
    const int reach = std::min(band, rows - 1);
    Eigen::MatrixXd dense = Eigen::MatrixXd::Zero(rows, rows);
    for (int c = 0; c < rows; ++c) {
      dense(c, c) = 2.0 * (reach + 1);
      for (int r = c + 1; r <= std::min(rows - 1, c + reach); ++r) dense(r, c) = random.uniform(-1.0, 1.0);
    }
    BandCholesky matrix;
    matrix.reset(rows, band);
    EXPECT_EQ(matrix.band(), reach);
    for (int c = 0; c < rows; ++c) {
      for (int r = c; r <= std::min(rows - 1, c + reach); ++r) matrix.column(c)[r - c] = dense(r, c);
    }
    Eigen::VectorXd b(rows);
    for (int r = 0; r < rows; ++r) b[r] = random.uniform(-1.0, 1.0);
    Eigen::VectorXd x = b;
    ASSERT_TRUE(matrix.factor()) << rows << " rows, band " << band;
    matrix.solve(x);
    const Eigen::VectorXd back = dense.selfadjointView<Eigen::Lower>() * x;
    EXPECT_LT((back - b).norm(), 1e-13 * b.norm()) << rows << " rows, band " << band;
  }
}

TEST(BandCholesky, SaysWhereThereIsNoFactor) {
  BandCholesky matrix;
  matrix.reset(100, 2);
  for (int c = 0; c < 100; ++c) matrix.column(c)[0] = c == 70 ? -1.0 : 1.0;
  EXPECT_FALSE(matrix.factor());
}

constexpr double step_h = 0.1;

/// An irregular block of cells held at one end, without stress, with what a step needs.
template <int Dim>
struct Block {
  Tissue<Dim> tissue;
  PairTerms<Dim> terms;

  explicit Block(std::optional<double> resistance) {
    tissue.step_h = step_h;
    terms = make_pair_terms<Dim>(tissue.cells, 1020.0, resistance ? std::optional<double>(0.0) : std::nullopt,
                                 resistance.value_or(0.0), 0.0);
    Random random(7);
    std::array<int, Dim> counts;
    counts.fill(Dim == 2 ? 6 : 4);
    counts[0] = Dim == 2 ? 24 : 9;
    test::fill<Dim>(tissue, test::lattice<Dim>(counts, 0.01, random, 0.2, 0.2), test::table_1(8000.0));
    double first = 1e300;
    for (const Vec<Dim>& x : tissue.cells.position.values()) first = std::min(first, x[0]);
    for (std::size_t i = 0; i < tissue.cells.size(); ++i) {
      tissue.cells.clamped[i] = tissue.cells.position[i][0] < first + 0.025;
      tissue.cells.frame[i] = test::plane_rotation<Dim>(0.3);
      tissue.window_index[i] = -1;
      if (!terms.non_affine) continue;
      (*terms.non_affine->start_position)[i] = tissue.cells.position[i];
      (*terms.non_affine->start_frame)[i] = tissue.cells.frame[i];
    }
    test::build_operators<Dim>(tissue, 1.5, GradientMode::quadratic_at_surface);
    rebuild_pair_terms<Dim>(tissue, {}, terms);
  }

  void evaluate(const std::vector<Vec<Dim>>& displacement) {
    for (std::size_t i = 0; i < tissue.cells.size(); ++i) tissue.cells.velocity[i] = displacement[i] / step_h;
    compute_velocity_gradients<Dim>(tissue);
    choose_material_loop<Dim>(tissue.material, MaterialStep::predict)(tissue, step_h);
    choose_force_loop<Dim>(terms, false)(tissue, terms, {step_h, 0.0});
  }

  /// -f(d) of a displacement so small that f is linear, for the free cells.
  Eigen::VectorXd stiffness_times(const Eigen::VectorXd& d, const FreeCells& free) {
    constexpr double small = 1e-9;
    std::vector<Vec<Dim>> displacement(tissue.cells.size(), Vec<Dim>::Zero());
    for (std::size_t p = 0; p < free.cell.size(); ++p) {
      displacement[free.cell[p]] = small * d.segment<Dim>(static_cast<Eigen::Index>(p) * Dim);
    }
    evaluate(displacement);
    Eigen::VectorXd f(d.size());
    for (std::size_t p = 0; p < free.cell.size(); ++p) {
      f.segment<Dim>(static_cast<Eigen::Index>(p) * Dim) = -tissue.force[free.cell[p]] / small;
    }
    evaluate(std::vector<Vec<Dim>>(tissue.cells.size(), Vec<Dim>::Zero()));  // for the matrix
    return f;
  }
};

Eigen::VectorXd random_vector(Eigen::Index size, std::uint64_t seed) {
  Random random(seed);
  Eigen::VectorXd v(size);
  for (double& x : v) x = random.uniform(-1.0, 1.0);
  return v;
}

template <class Dimension>
class StepStiffness : public testing::Test {};
TYPED_TEST_SUITE(StepStiffness, test::BothDimensions, test::DimensionName);

TYPED_TEST(StepStiffness, OfTheStressIsTheDerivativeOfTheForces) {
  constexpr int dim = TypeParam::value;
  Block<dim> block(std::nullopt);
  const FreeCells free = order_free_cells<dim>(block.tissue.cells);
  const Eigen::VectorXd d = random_vector(std::ssize(free.cell) * dim, 1);
  const Eigen::VectorXd f = block.stiffness_times(d, free);
  // a push on each cell, as of a contact, keeps the matrix away from the motions that no gradient sees
  const std::vector<Mat<dim>> contact(free.cell.size(), 10.0 * Mat<dim>::Identity());
  const auto band = make_band_preconditioner<dim>();
  band->assemble(block.tissue, block.terms, free, step_h);
  ASSERT_TRUE(band->factor(contact));
  Eigen::VectorXd z;
  band->apply(f + 10.0 * d, z);
  EXPECT_LT((z - d).norm(), 2.5e-6 * d.norm());
}

TYPED_TEST(StepStiffness, WithPairResistanceIsAnUpperBound) {
  constexpr int dim = TypeParam::value;
  Block<dim> with(0.05), without(std::nullopt);
  const FreeCells free = order_free_cells<dim>(with.tissue.cells);
  const auto band = make_band_preconditioner<dim>();
  with.evaluate(std::vector<Vec<dim>>(with.tissue.cells.size(), Vec<dim>::Zero()));
  band->assemble(with.tissue, with.terms, free, step_h);
  ASSERT_TRUE(band->factor({}));
  for (std::uint64_t seed = 1; seed < 6; ++seed) {
    // r . M^-1 r <= r . K^-1 r: with r = K d, M above K
    const Eigen::VectorXd d = random_vector(std::ssize(free.cell) * dim, seed);
    const Eigen::VectorXd r = without.stiffness_times(d, free);
    Eigen::VectorXd z;
    band->apply(r, z);
    EXPECT_LT(r.dot(z), r.dot(d));
    EXPECT_GT(r.dot(z), 0.1 * r.dot(d));
  }
}

TYPED_TEST(StepStiffness, BothPreconditionersAreSymmetricAndPositive) {
  constexpr int dim = TypeParam::value;
  Block<dim> block(0.05);
  block.evaluate(std::vector<Vec<dim>>(block.tissue.cells.size(), Vec<dim>::Zero()));
  const FreeCells free = order_free_cells<dim>(block.tissue.cells);
  const Eigen::VectorXd a = random_vector(std::ssize(free.cell) * dim, 1), b = random_vector(a.size(), 2);
  for (const auto& inverse : {make_band_preconditioner<dim>(), make_layer_preconditioner<dim>()}) {
    inverse->assemble(block.tissue, block.terms, free, step_h);
    ASSERT_TRUE(inverse->factor({}));
    Eigen::VectorXd of_a, of_b;
    inverse->apply(a, of_a);
    inverse->apply(b, of_b);
    EXPECT_NEAR(a.dot(of_b) / b.dot(of_a), 1.0, 1e-9);
    EXPECT_GT(a.dot(of_a), 0.0);
    EXPECT_GT(b.dot(of_b), 0.0);
  }
}

TYPED_TEST(StepStiffness, ContactsThatComeAndGoLeaveTheTissuesPart) {
  constexpr int dim = TypeParam::value;
  Block<dim> block(0.05);
  block.evaluate(std::vector<Vec<dim>>(block.tissue.cells.size(), Vec<dim>::Zero()));
  const FreeCells free = order_free_cells<dim>(block.tissue.cells);
  const Eigen::VectorXd r = random_vector(std::ssize(free.cell) * dim, 1);
  for (const auto& make : {make_band_preconditioner<dim>, make_layer_preconditioner<dim>}) {
    const auto inverse = make(), restored = make();
    inverse->assemble(block.tissue, block.terms, free, step_h);
    Eigen::VectorXd before, with, after, again;
    ASSERT_TRUE(inverse->factor({}));
    inverse->apply(r, before);
    ASSERT_TRUE(inverse->factor(std::vector<Mat<dim>>(free.cell.size(), 1e4 * Mat<dim>::Identity())));
    inverse->apply(r, with);
    ASSERT_TRUE(inverse->factor({}));
    inverse->apply(r, after);
    restored->restore(inverse->save());
    ASSERT_TRUE(restored->factor({}));
    restored->apply(r, again);
    EXPECT_LT(with.norm(), 0.5 * before.norm());
    EXPECT_EQ(before, after);
    EXPECT_EQ(before, again);
  }
}

/// The balance of the block under 1 MPa. \param disturb changes the forces that were found
template <int Dim>
Balance balance_of(Block<Dim>& block, std::vector<Vec<Dim>>& displacement, const std::function<void()>& disturb) {
  block.tissue.pressure_MPa = 1.0;
  displacement.assign(block.tissue.cells.size(), Vec<Dim>::Zero());
  const auto evaluate = [&](const std::vector<Vec<Dim>>& d) {
    block.evaluate(d);
    disturb();
  };
  return QuasiStatic<Dim>().solve(
      {block.tissue, block.terms, step_h, 1e-6, evaluate, [] { return std::vector<Mat<Dim>>(); }}, displacement);
}

/// Nothing holds this block's cells aside, and its base is pressed: wherever they are, a push would end the balance.
TYPED_TEST(StepStiffness, ABalanceThatCannotBeLeftForAStableOneIsTold) {
  constexpr int dim = TypeParam::value;
  Block<dim> block(0.05);
  std::vector<Vec<dim>> displacement;
  const auto loose = [&] {  // nothing but the thrust on what is held
    auto& cells = block.tissue.cells;
    for (std::size_t i = 0; i < cells.size(); ++i) {
      block.tissue.force[i] = cells.clamped[i] ? Vec<dim>(-cells.frame[i].col(0)) : Vec<dim>(Vec<dim>::Zero());
    }
  };
  const Balance balance = balance_of<dim>(block, displacement, loose);
  EXPECT_TRUE(balance.found);
  EXPECT_FALSE(balance.stable);
}

TYPED_TEST(StepStiffness, FindsTheBalanceUnderPressure) {
  constexpr int dim = TypeParam::value;
  Block<dim> block(0.05);
  std::vector<Vec<dim>> displacement;
  const Balance balance = balance_of<dim>(block, displacement, [] {});
  EXPECT_TRUE(balance.found);
  EXPECT_LE(balance.imbalance, 1e-6);
  EXPECT_LT(balance.iterations, 15);
  double moved_mm = 0.0;
  for (std::size_t i = 0; i < displacement.size(); ++i) {
    if (block.tissue.cells.clamped[i]) {
      EXPECT_EQ(displacement[i], (Vec<dim>(Vec<dim>::Zero())));
    }
    moved_mm += displacement[i].norm();
  }
  EXPECT_GT(moved_mm, 0.0);
}

TYPED_TEST(StepStiffness, SaysThatThereIsNoBalance) {
  constexpr int dim = TypeParam::value;
  Block<dim> block(0.05);
  std::vector<Vec<dim>> displacement;
  const std::size_t pulled = block.tissue.cells.size() - 1;
  double pull_N = 1e-4;
  const Balance balance = balance_of<dim>(block, displacement, [&] {
    pull_N = -pull_N;  // to and fro, whatever the cells do
    block.tissue.force[pulled] += pull_N * Vec<dim>::UnitX();
  });
  EXPECT_FALSE(balance.found);
  EXPECT_GT(balance.worst_imbalance, 1e-6);
  EXPECT_EQ(balance.worst_cell, pulled);
}

}  // namespace
}  // namespace rootsoil
