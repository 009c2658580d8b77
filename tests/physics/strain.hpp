// SPDX-License-Identifier: MIT
// Case 1 run to equilibrium.
#pragma once

#include "harness.hpp"
#include "scenes.hpp"

namespace rootsoil::physics {

/// Kinetic energy of a root at rest, as a share of the elastic one.
inline constexpr double at_rest = 1e-8;

/// Runs the scene to equilibrium and checks that it is one, stresses against p, and the largest errors of strains over
/// bins of 0.1 mm.
template <int Dim>
void expect_theoretical_strain(const std::string& text, const std::vector<std::string>& overrides, double from_mm,
                               double to_mm) {
  SceneRun<Dim> run(text, overrides);
  run.advance_to(run.scene.scene.duration_h);
  const Energies e = energies(run.tissue);
  record("cells", static_cast<double>(run.tissue.cells.size()));
  record("steps", static_cast<double>(run.solver.steps()));
  record("kinetic/elastic energy", e.kinetic / e.elastic);
  EXPECT_LT(e.kinetic, at_rest * e.elastic);
  EXPECT_LT(relative_momentum_residual(run.tissue), rounding_of_balance);

  const double p = run.tissue.pressure_MPa;
  const StressScatter stress = stress_scatter<Dim>(run.tissue, 0.0, to_mm, p);
  expect_within_record("axial stress: rms of sigma/p - 1", stress.axial);
  expect_within_record("radial stress: rms of sigma/p - 1", stress.radial);
  expect_within_record("shear stress: rms over p", stress.shear);

  const AxialRadial error = worst_strain_error<Dim>(run, from_mm, to_mm);
  expect_within_record("axial strain: largest error of a bin", error.axial);
  expect_within_record("radial strain: largest error of a bin", error.radial);
}

}  // namespace rootsoil::physics
