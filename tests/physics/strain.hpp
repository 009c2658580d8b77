// SPDX-License-Identifier: MIT
// Case 1 run to equilibrium.
#pragma once

#include "harness.hpp"
#include "scenes.hpp"

namespace rootsoil::physics {

/// Kinetic energy of a root at rest, as a share of the elastic one.
inline constexpr double at_rest = 1e-8;

/// Runs the scene to equilibrium, checks that it is one, and returns the largest errors of bins of 0.1 mm.
template <int Dim>
AxialRadial strain_error(const std::string& text, const std::vector<std::string>& overrides, double from_mm,
                         double to_mm) {
  SceneRun<Dim> run(text, overrides);
  run.advance_to(run.scene.scene.duration_h);
  const Energies e = energies(run.tissue);
  record("cells", static_cast<double>(run.tissue.cells.size()));
  record("steps", static_cast<double>(run.solver.steps()));
  record("kinetic/elastic energy", e.kinetic / e.elastic);
  EXPECT_LT(e.kinetic, at_rest * e.elastic);
  EXPECT_LT(relative_momentum_residual(run.tissue), 1e-12);

  const double p = run.tissue.pressure_MPa;
  const StressScatter stress = stress_scatter<Dim>(run.tissue, 0.0, to_mm, p);
  record("axial stress, rms of sigma/p - 1", stress.axial);
  record("radial stress, rms of sigma/p - 1", stress.radial);
  record("shear stress, rms over p", stress.shear);
  EXPECT_NEAR(stress.mean_axial, 1.0, 1e-3);
  EXPECT_NEAR(stress.mean_radial, 1.0, 1e-2);

  const AxialRadial error = worst_strain_error<Dim>(run, from_mm, to_mm);
  record("axial strain, largest error of a bin", error.axial);
  record("radial strain, largest error of a bin", error.radial);
  return error;
}

}  // namespace rootsoil::physics
