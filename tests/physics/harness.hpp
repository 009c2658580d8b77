// SPDX-License-Identifier: MIT
// Runs a small scene and measures it: strains, flow, tip speed, stress scatter.
#pragma once

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <functional>
#include <limits>
#include <map>
#include <memory>
#include <numbers>
#include <string>
#include <vector>

#include "root_sph/effects/anisotropy/anisotropy.hpp"
#include "root_sph/effects/pressure/pressure.hpp"
#include "root_sph/model/model.hpp"
#include "tests/physics/recorded.hpp"

namespace rootsoil::physics {

/// What rounding leaves of a sum of forces that cancel, over the sum of their sizes: 1e-17 to 3e-16 are measured.
inline constexpr double rounding_of_balance = 1e-15;

/// Unless text or overrides choose a stepper, with inertia: its errors are what most tests of this folder measure.
inline std::vector<std::string> with_inertia(const std::string& text, std::vector<std::string> overrides) {
  const bool chooses = std::any_of(overrides.begin(), overrides.end(),
                                   [](const std::string& o) { return o.starts_with("numerics.stepper="); });
  if (!chooses && text.find("\nstepper = ") == std::string::npos) overrides.push_back("numerics.stepper=symplectic");
  return overrides;
}

/// A scene in progress. Cells are told apart by their ids: the solver reorders them.
template <int Dim>
class SceneRun {
 public:
  explicit SceneRun(const std::string& text, const std::vector<std::string>& overrides = {})
      : scene(parse_scene(text, "test.toml", with_inertia(text, overrides))),
        model(build_model<Dim>(scene)),
        solver(model->solver),
        tissue(solver.tissue()) {
    for (std::size_t i = 0; i < tissue.cells.size(); ++i) {
      start[tissue.cells.cell_id[i]] = tissue.cells.position[i];
    }
  }

  /// Advances to the time, whole windows at a time; `after_window` sees every window's end.
  void advance_to(double time_h, const std::function<void()>& after_window = {}) {
    std::int64_t left = std::llround((time_h - tissue.time_h) / tissue.step_h);
    while (left > 0) {
      const auto steps = static_cast<int>(std::min<std::int64_t>(left, scene.numerics.steps_a_window()));
      solver.advance_window(steps);
      left -= steps;
      if (after_window) after_window();
    }
  }

  Scene scene;
  std::unique_ptr<Model<Dim>> model;
  Solver<Dim>& solver;
  Tissue<Dim>& tissue;
  std::map<std::int64_t, Vec<Dim>> start;  ///< positions at time 0
};

/// Strains of the cells that began within [from_mm, to_mm) of the tip: slopes of the least-squares lines of x
/// against x at the start, and of y (and z) against y (and z) at the start, less 1.
template <int Dim>
AxialRadial measured_strain(const SceneRun<Dim>& run, double from_mm, double to_mm) {
  const auto& cells = run.tissue.cells;
  double n = 0.0, mean0 = 0.0, mean = 0.0;
  const auto inside = [&](std::size_t i) {
    const double s = run.scene.root.length_mm - run.start.at(cells.cell_id[i])[0];
    return !cells.clamped[i] && s >= from_mm && s < to_mm;
  };
  for (std::size_t i = 0; i < cells.size(); ++i) {
    if (!inside(i)) continue;
    n += 1.0;
    mean0 += run.start.at(cells.cell_id[i])[0];
    mean += cells.position[i][0];
  }
  double xx0 = 0.0, x0x0 = 0.0, yy0 = 0.0, y0y0 = 0.0;
  for (std::size_t i = 0; i < cells.size(); ++i) {
    if (!inside(i)) continue;
    const Vec<Dim>& x0 = run.start.at(cells.cell_id[i]);
    const Vec<Dim>& x = cells.position[i];
    xx0 += (x0[0] - mean0 / n) * (x[0] - mean / n);
    x0x0 += (x0[0] - mean0 / n) * (x0[0] - mean0 / n);
    for (int a = 1; a < Dim; ++a) {
      yy0 += x0[a] * x[a];
      y0y0 += x0[a] * x0[a];
    }
  }
  return {xx0 / x0x0 - 1.0, yy0 / y0y0 - 1.0};
}

/// Eq. 8 at s, with E_R there.
template <int Dim>
AxialRadial theoretical_strain(const Scene& scene, double s_mm) {
  const double p = pressure_MPa(scene, 0.0);
  return pressure_strain<Dim>(stiffness<Dim>(elastic_constants(scene, s_mm, p)), p);
}

/// Largest relative error against Eq. 8, over bins of 0.1 mm.
template <int Dim>
AxialRadial worst_strain_error(const SceneRun<Dim>& run, double from_mm, double to_mm) {
  constexpr double bin_mm = 0.1;
  AxialRadial worst{0.0, 0.0};
  for (int b = 0; from_mm + (b + 1) * bin_mm < to_mm + 1e-9; ++b) {
    const double s = from_mm + b * bin_mm;
    const AxialRadial measured = measured_strain<Dim>(run, s, s + bin_mm);
    const AxialRadial theory = theoretical_strain<Dim>(run.scene, s + 0.5 * bin_mm);
    worst.axial = std::max(worst.axial, std::abs(measured.axial / theory.axial - 1.0));
    worst.radial = std::max(worst.radial, std::abs(measured.radial / theory.radial - 1.0));
  }
  return worst;
}

/// Root mean square of (stress - p)/p over the free cells with s in [from, to).
struct StressScatter {
  double axial = 0.0, radial = 0.0, shear = 0.0;
  std::int64_t cells = 0;
};

template <int Dim>
StressScatter stress_scatter(const Tissue<Dim>& tissue, double from_mm, double to_mm, double p_MPa) {
  StressScatter scatter;
  const auto& cells = tissue.cells;
  for (std::size_t i = 0; i < cells.size(); ++i) {
    if (cells.clamped[i] || cells.distance_to_tip[i] < from_mm || cells.distance_to_tip[i] >= to_mm) continue;
    const Voigt<Dim> s = cells.stress[i] / p_MPa;
    ++scatter.cells;
    scatter.axial += (s[0] - 1.0) * (s[0] - 1.0);
    scatter.radial += (s.template segment<Dim - 1>(1).array() - 1.0).square().mean();
    scatter.shear += s.template tail<voigt_size<Dim> - Dim>().squaredNorm() / (voigt_size<Dim> - Dim);
  }
  const double n = std::max<double>(1.0, static_cast<double>(scatter.cells));
  for (double* value : {&scatter.axial, &scatter.radial, &scatter.shear}) *value = std::sqrt(*value / n);
  return scatter;
}

/// Radius at distances [from, to) of the tip, from the second moment of the volumes about the root's axis there,
/// across the material frames, so that a bent root has the same: 2D y^2 -> R^2/3, 3D y^2 + z^2 -> R^2/2. Weights fade
/// to 0 at both ends: a long cell is not half in.
template <int Dim>
double radius_mm(const Tissue<Dim>& tissue, double from_mm, double to_mm) {
  const auto& cells = tissue.cells;
  double volume = 0.0;
  Vec<Dim> centre = Vec<Dim>::Zero();
  const auto inside = [&](std::size_t i) {
    return !cells.clamped[i] && cells.distance_to_tip[i] >= from_mm && cells.distance_to_tip[i] < to_mm;
  };
  const auto weight = [&](std::size_t i) {
    return cells.volume[i] *
           std::pow(std::sin(std::numbers::pi * (cells.distance_to_tip[i] - from_mm) / (to_mm - from_mm)), 2);
  };
  for (std::size_t i = 0; i < cells.size(); ++i) {
    if (!inside(i)) continue;
    volume += weight(i);
    centre += weight(i) * cells.position[i];
  }
  centre /= volume;
  double moment = 0.0;
  for (std::size_t i = 0; i < cells.size(); ++i) {
    if (!inside(i)) continue;
    const Vec<Dim> r = cells.frame[i].transpose() * (cells.position[i] - centre);
    moment += weight(i) * r.template tail<Dim - 1>().squaredNorm();
  }
  return std::sqrt((Dim == 2 ? 3.0 : 2.0) * moment / volume);
}

}  // namespace rootsoil::physics
