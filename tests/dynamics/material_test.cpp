// SPDX-License-Identifier: MIT
// Kinematics of cells, and the cell loop, under imposed motions.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <numbers>
#include <vector>

#include "root_sph/dynamics/material_update.hpp"
#include "root_sph/dynamics/solver.hpp"
#include "tests/support/block.hpp"

namespace rootsoil {
namespace {

using test::Random;

constexpr double dt = 1e-3;

/// A block with free edges whose cells are taken along x(t) = motion(t) x(0): before every step each cell gets the
/// velocity of its way in this step, and being clamped it keeps it whatever the forces.
template <int Dim>
struct MovedBlock {
  Solver<Dim> solver;
  std::vector<Vec<Dim>> start;  ///< by cell id
  std::int64_t step = 0;

  MovedBlock(GradientMode gradient, Stepper stepper, std::function<Mat<Dim>(std::int64_t)> motion)
      : solver([&] {
          SolverOptions options;
          options.step_h = dt;
          options.gradient = gradient;
          options.stepper = stepper;
          return options;
        }()) {
    Random random(1);
    std::array<int, Dim> counts;
    counts.fill(Dim == 2 ? 8 : 5);
    counts[0] = Dim == 2 ? 14 : 7;
    test::fill<Dim>(solver.tissue(), test::lattice<Dim>(counts, 0.01, random, 0.25, 0.3), test::table_1(15000.0));
    start = solver.tissue().cells.position.values();
    for (std::int64_t& clamped : solver.tissue().cells.clamped.values()) clamped = 1;
    for (Mat<Dim>& frame : solver.tissue().cells.frame.values()) frame = random.rotation<Dim>();
    solver.axis().start(solver.tissue());
    solver.hooks().step_loads.emplace_back("motion", [this, motion = std::move(motion)](Tissue<Dim>& tissue) {
      const Mat<Dim> moved = motion(step + 1) - motion(step);
      ++step;
      for (std::size_t i = 0; i < tissue.cells.size(); ++i) {
        tissue.cells.velocity[i] = moved * start[static_cast<std::size_t>(tissue.cells.cell_id[i])] / dt;
      }
    });
    solver.prepare();
  }
};

template <class Dimension>
class Kinematics : public testing::Test {};
TYPED_TEST_SUITE(Kinematics, test::BothDimensions, test::DimensionName);

TYPED_TEST(Kinematics, CayleyRotationTurnsByTwiceTheArcTangentOfHalfTheSpin) {
  constexpr int dim = TypeParam::value;
  for (const double spin : {-3.0, 1e-9, 0.1, 2.0}) {
    const int last = dim - 1;
    Mat<dim> w = Mat<dim>::Zero();
    w(last, 0) = spin;
    w(0, last) = -spin;
    const Mat<dim> expected = test::plane_rotation<dim>(2.0 * std::atan(0.5 * spin), 0, last);
    EXPECT_LT((cayley_rotation<dim>(w) - expected).norm(), 1e-15);
  }
}

TYPED_TEST(Kinematics, CayleyRotationIsOrthogonalAndKeepsItsAxis) {
  constexpr int dim = TypeParam::value;
  Random random(2);
  for (int trial = 0; trial < 20; ++trial) {
    const Mat<dim> a = 3.0 * random.matrix<Mat<dim>>();
    const Mat<dim> w = a - a.transpose();
    const Mat<dim> r = cayley_rotation<dim>(w);
    EXPECT_LT((r.transpose() * r - Mat<dim>::Identity()).norm(), 1e-14);
    EXPECT_NEAR(r.determinant(), 1.0, 1e-14);
    // (1 - W/2) R = 1 + W/2
    EXPECT_LT(((Mat<dim>::Identity() - 0.5 * w) * r - Mat<dim>::Identity() - 0.5 * w).norm(), 1e-13);
  }
}

TYPED_TEST(Kinematics, ARigidlyRotatedBlockStaysWithoutStressAndItsFramesTurnByTheAngle) {
  constexpr int dim = TypeParam::value;
  for (const Stepper stepper : {Stepper::symplectic, Stepper::predictor_corrector}) {
    constexpr double per_step = 0.02;  // rad; 23 degrees in a window
    const auto rotation = [](std::int64_t step) {
      Mat<dim> r = test::plane_rotation<dim>(per_step * static_cast<double>(step));
      if constexpr (dim == 3) r = r * test::plane_rotation<3>(0.5 * per_step * static_cast<double>(step), 0, 2);
      return r;
    };
    MovedBlock<dim> block(GradientMode::quadratic_at_surface, stepper, rotation);
    const auto& cells = block.solver.tissue().cells;
    const std::vector<Mat<dim>> frame_before = cells.frame.values(), shape_before = cells.shape.values();
    const std::vector<double> volume_before = cells.volume.values();
    for (int window = 0; window < 6; ++window) block.solver.advance_window(20);
    EXPECT_EQ(block.solver.gradient_report().degenerate, 0);
    const Mat<dim> turn = rotation(block.step);
    for (std::size_t i = 0; i < cells.size(); ++i) {
      const auto id = static_cast<std::size_t>(cells.cell_id[i]);
      EXPECT_LT(cells.stress[i].norm(), 1e-10 * 1020.0);
      EXPECT_LT((cells.frame[i] - turn * frame_before[id]).norm(), 1e-9);
      EXPECT_NEAR(cells.volume[i], volume_before[id], 1e-10 * volume_before[id]);
      EXPECT_LT((cells.shape[i] - turn * shape_before[id] * turn.transpose()).norm(), 1e-9 * shape_before[id].norm());
    }
  }
}

/// Simple shear x_0 += gamma x_b. The spin of a step is that of its middle, W_b0 = -dgamma/2, constant through the
/// shear, and the Cayley transform makes of it the angle 2 atan(dgamma/4); n steps turn the frames from axis b
/// towards axis 0 by 2 n atan(gamma/(4 n)), which tends to the exact integral of the spin, gamma/2, with an error
/// of gamma^3/(96 n^2).
TYPED_TEST(Kinematics, AShearedBlockTurnsItsFramesByTheIntegralOfTheSpin) {
  constexpr int dim = TypeParam::value;
  constexpr int steps_a_window = 20, windows = 5, steps = steps_a_window * windows;
  constexpr double gamma = 0.5;
  for (int b = 1; b < dim; ++b) {
    const auto shear = [b](std::int64_t step) {
      Mat<dim> f = Mat<dim>::Identity();
      f(0, b) = gamma * static_cast<double>(step) / steps;
      return f;
    };
    MovedBlock<dim> block(GradientMode::quadratic_at_surface, Stepper::symplectic, shear);
    const auto& cells = block.solver.tissue().cells;
    const std::vector<Mat<dim>> before = cells.frame.values();
    for (int window = 0; window < windows; ++window) block.solver.advance_window(steps_a_window);
    const double angle = 2.0 * steps * std::atan(gamma / (4.0 * steps));
    EXPECT_NEAR(angle, 0.5 * gamma, 1.01 * gamma * gamma * gamma / (96.0 * steps * steps));
    const Mat<dim> turn = test::plane_rotation<dim>(-angle, 0, b);
    for (std::size_t i = 0; i < cells.size(); ++i) {
      const auto id = static_cast<std::size_t>(cells.cell_id[i]);
      EXPECT_LT((cells.frame[i] - turn * before[id]).norm(), 1e-9);
    }
  }
}

TYPED_TEST(Kinematics, VolumesAndShapesFollowALinearDeformationExactly) {
  constexpr int dim = TypeParam::value;
  const Mat<dim> rate = 0.2 * Random(3).matrix<Mat<dim>>();
  const auto motion = [&rate](std::int64_t step) {
    return Mat<dim>(Mat<dim>::Identity() + static_cast<double>(step) / 60.0 * rate);
  };
  MovedBlock<dim> block(GradientMode::linear, Stepper::symplectic, motion);
  const auto& cells = block.solver.tissue().cells;
  const std::vector<Mat<dim>> shape_before = cells.shape.values();
  const std::vector<double> volume_before = cells.volume.values();
  for (int window = 0; window < 3; ++window) block.solver.advance_window(20);
  const Mat<dim> f = motion(60);
  for (std::size_t i = 0; i < cells.size(); ++i) {
    const auto id = static_cast<std::size_t>(cells.cell_id[i]);
    EXPECT_NEAR(cells.volume[i], f.determinant() * volume_before[id], 1e-10 * volume_before[id]);
    // the ellipsoid x^T Q x = 1 is carried along: x -> F x
    EXPECT_LT((f.transpose() * cells.shape[i] * f - shape_before[id]).norm(), 1e-9 * shape_before[id].norm());
  }
}

TYPED_TEST(Kinematics, DeformedShapeHoldsTheDeformedPoints) {
  constexpr int dim = TypeParam::value;
  Random random(4);
  Vec<dim> lengths = Vec<dim>::Constant(0.01);
  lengths[0] = 0.04;
  const Mat<dim> q = test::ellipsoid<dim>(lengths, random.rotation<dim>());
  const Mat<dim> f = Mat<dim>::Identity() + 0.4 * random.matrix<Mat<dim>>();
  const Mat<dim> deformed = deformed_shape<dim>(q, f);
  EXPECT_EQ(deformed, Mat<dim>(deformed.transpose()));
  for (int trial = 0; trial < 20; ++trial) {
    Vec<dim> x = random.matrix<Vec<dim>>();
    x /= std::sqrt(x.dot(q * x));
    EXPECT_NEAR((f * x).dot(deformed * (f * x)), 1.0, 1e-12);
  }
  EXPECT_NEAR(deformed.determinant() * f.determinant() * f.determinant(), q.determinant(), 1e-12 * q.determinant());
}

/// F = R U: the strain is ln U whatever R is.
TYPED_TEST(Kinematics, StrainOfAStepIsTheLogarithmOfItsStretch) {
  constexpr int dim = TypeParam::value;
  Random random(3);
  for (const double size : {1e-6, 0.01, 0.1}) {
    const Mat<dim> axes = random.rotation<dim>();
    Vec<dim> logarithms;
    for (int a = 0; a < dim; ++a) logarithms[a] = random.uniform(-size, size);
    const Mat<dim> stretch = axes * logarithms.array().exp().matrix().asDiagonal() * axes.transpose();
    const Mat<dim> expected = axes * logarithms.asDiagonal() * axes.transpose();
    for (const Mat<dim>& turn : {Mat<dim>(Mat<dim>::Identity()), random.rotation<dim>()}) {
      const Mat<dim> strain = step_strain<dim>(turn * stretch - Mat<dim>::Identity());
      EXPECT_LT((strain - expected).norm(), 0.3 * std::pow(size, 5) + 1e-15);
      EXPECT_LT((strain - strain.transpose()).norm(), 1e-15);
    }
  }
}

/// Cells with random states under random velocity gradients, one step of the cell loop.
template <int Dim>
struct LooseCells {
  Random random{5};
  Tissue<Dim> tissue;
  Field<Dim, double>& softening;
  Field<Dim, Stiffness<Dim>>& stiffness_column;

  explicit LooseCells(TissueLaw law)
      : softening(tissue.cells.template declare<double>({"softening", "1", ""}, on_division::copy<Dim, double>)),
        stiffness_column(tissue.cells.template declare<Stiffness<Dim>>({"stiffness", "1", ""},
                                                                       on_division::copy<Dim, Stiffness<Dim>>)) {
    use_law(tissue, law);
    std::array<int, Dim> counts;
    counts.fill(2);
    test::fill<Dim>(tissue, test::lattice<Dim>(counts, 0.01, random), test::table_1(5000.0));
    for (std::size_t i = 0; i < tissue.cells.size(); ++i) {
      tissue.cells.frame[i] = random.rotation<Dim>();
      tissue.cells.stress[i] = random.matrix<Voigt<Dim>>();
      tissue.cells.stress[i].template head<Dim>().array() += 2.0;
      tissue.cells.mass[i] *= random.uniform(0.9, 1.1);
      tissue.velocity_gradient[i] = random.matrix<Mat<Dim>>();
      softening[i] = random.uniform(0.0, 4e5);
      stiffness_column[i] = stiffness<Dim>(test::table_1(random.uniform(1000.0, 20000.0)));
      for (Field<Dim, Voigt<Dim>>* column : tissue.material.law_columns) {
        (*column)[i] = deviator<Dim>(random.matrix<Voigt<Dim>>());
      }
    }
    tissue.pressure_MPa = 0.4;
  }

  /// Strain of a step of dt from F = 1, in a frame.
  Voigt<Dim> strain(std::size_t i, const Mat<Dim>& frame) const {
    return to_strain_voigt<Dim>(frame.transpose() * step_strain<Dim>(dt * tissue.velocity_gradient[i]) * frame);
  }
};

/// The loop against the law's step, called by hand with what the loop should hand to it.
template <class Law>
void expect_cell_loop_applies(bool varying, bool growing) {
  constexpr int dim = Law::dimension;
  LooseCells<dim> loose(from_name<TissueLaw>(Law::name).value());
  Tissue<dim>& tissue = loose.tissue;
  auto& cells = tissue.cells;
  if (varying) tissue.material.stiffness = &loose.stiffness_column;
  if (growing) tissue.material.softening = &loose.softening;
  std::vector<typename Law::State> expected;
  const std::vector<Mat<dim>> frame_before = cells.frame.values();
  for (std::size_t i = 0; i < cells.size(); ++i) {
    expected.emplace_back(cells.stress[i], cells.mass[i]);
    for (std::size_t c = 0; c < Law::columns.size(); ++c) {
      expected[i].columns[c] = (*tissue.material.law_columns[c])[i];
    }
  }
  choose_material_loop<dim>(tissue.material)(tissue, dt);
  for (std::size_t i = 0; i < cells.size(); ++i) {
    const Voigt<dim> strain = loose.strain(i, frame_before[i]);
    const Stiffness<dim>& k = varying ? loose.stiffness_column[i] : tissue.material.uniform;
    Law::step({k, strain, cells.volume[i], dt, growing ? loose.softening[i] : 0.0, 1000.0}, expected[i]);
    EXPECT_LT((cells.stress[i] - expected[i].stress).norm(), 1e-13 * expected[i].stress.norm());
    EXPECT_NEAR(cells.mass[i], expected[i].mass, 1e-15 * expected[i].mass);
    for (std::size_t c = 0; c < Law::columns.size(); ++c) {
      EXPECT_LT(((*tissue.material.law_columns[c])[i] - expected[i].columns[c]).norm(),
                1e-13 * expected[i].stress.norm());
    }
    EXPECT_NEAR(tissue.axial_strain[i], strain[0], 1e-16);
  }
}

TYPED_TEST(Kinematics, CellLoopAppliesEveryLawInTheMaterialFrame) {
  for (const TissueLawEntry& law : tissue_laws) {
    SCOPED_TRACE(law.name);
    for (const bool varying : {false, true}) {
      for (const bool growing : {false, true}) {
        visit_law<TypeParam::value>(law.value,
                                    [&]<class Law>(Law) { expect_cell_loop_applies<Law>(varying, growing); });
      }
    }
  }
}

TYPED_TEST(Kinematics, CellLoopLeavesTheNominalForceOfTheNewState) {
  constexpr int dim = TypeParam::value;
  LooseCells<dim> loose(law_of<ElasticGrowth>);
  Tissue<dim>& tissue = loose.tissue;
  choose_material_loop<dim>(tissue.material)(tissue, dt);
  const std::vector<Mat<dim>> left = tissue.nominal_force.values();
  update_nominal_forces<dim>(tissue);
  for (std::size_t i = 0; i < tissue.cells.size(); ++i) {
    EXPECT_LT((tissue.nominal_force[i] - left[i]).norm(), 1e-14 * left[i].norm());
    const Mat<dim>& r = tissue.cells.frame[i];
    const Mat<dim> total = r * to_matrix<dim>(tissue.cells.stress[i]) * r.transpose() - 0.4 * Mat<dim>::Identity();
    const Mat<dim> f = Mat<dim>::Identity() + dt * tissue.velocity_gradient[i];
    EXPECT_LT((left[i] * f.transpose() - tissue.cells.volume[i] * total).norm(), 1e-14 * left[i].norm());
  }
}

}  // namespace
}  // namespace rootsoil
