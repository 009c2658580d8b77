// SPDX-License-Identifier: MIT
// A root without cap and pressure as a beam: a force on its last layer of cells, and the theory of the slender beam.
// With inertia, mass damping is tuned to its lowest bending mode.
#pragma once

#include "harness.hpp"

namespace rootsoil::physics {

inline constexpr double beam_length_mm = 0.6;
inline constexpr double beam_depth_mm = 0.12;

inline std::string beam_case(int dimension, int cells_across, double length_mm = beam_length_mm) {
  return "[scene]\nname = \"beam\"\nduration_h = 100\ndimension = " + std::to_string(dimension) +
         "\n[root]\ncap = false\nlength_mm = " + std::to_string(length_mm) +
         "\nradius_mm = " + std::to_string(0.5 * beam_depth_mm) +
         "\ncell_size_mm = " + std::to_string(beam_depth_mm / cells_across) +
         "\n[tissue]\nE_axial_MPa = 1020\n[non_affine_control]\n[numerics]\nstart = \"rest\"\nstep_h = 1e-3\n"
         "[output]\nevery_h = 1\n";
}

/// Section of the beam as its cells make it up, and its stiffnesses. 2D per unit of depth.
struct Section {
  double area = 0.0, second_moment = 0.0;
  double EI = 0.0, kGA = 0.0;
};

template <int Dim>
Section section_of(const SceneRun<Dim>& run) {
  Section section;
  const double size = run.scene.root.cell_size_mm;
  const double volume = std::pow(size, Dim);
  const auto layers = static_cast<double>(std::lround(run.scene.root.length_mm / size));
  double cells = 0.0, yy = 0.0;
  for (std::size_t i = 0; i < run.tissue.cells.size(); ++i) {
    if (run.tissue.cells.clamped[i]) continue;
    const Vec<Dim>& x = run.tissue.cells.position[i];
    cells += 1.0;
    yy += x[1] * x[1];
  }
  section.area = cells / layers * volume / size;
  section.second_moment = section.area * (yy / cells + size * size / 12.0);
  // rectangle 5/6 (Timoshenko); circle 6 (1 + nu)/(7 + 6 nu) (Cowper 1966)
  const double nu = run.scene.tissue.nu_axial;
  const double kappa = Dim == 2 ? 5.0 / 6.0 : 6.0 * (1.0 + nu) / (7.0 + 6.0 * nu);
  section.EI = run.scene.tissue.E_axial_MPa * section.second_moment;
  section.kGA = kappa * *run.scene.tissue.G_MPa * section.area;
  return section;
}

/// Tip deflection of a cantilever, Timoshenko: F L^3/(3 E I) + F L/(kappa G A).
inline double cantilever_deflection(const Section& s, double force, double length_mm) {
  return force * (std::pow(length_mm, 3) / (3.0 * s.EI) + length_mm / s.kGA);
}

/// pi^2 E I/(4 L^2) of a clamped-free column, softened by shear: P/(1 + P/(kappa G A)) (Engesser).
inline double euler_load(const Section& s, double length_mm) {
  const double p = std::numbers::pi * std::numbers::pi * s.EI / (4.0 * length_mm * length_mm);
  return p / (1.0 + p / s.kGA);
}

struct BeamResult {
  double deflection_mm = 0.0;  ///< of the loaded layer
  double load_at_mm = 0.0;     ///< of the loaded layer's centre, from x = 0
  double clamp_at_mm = 0.0;    ///< the first held layer's centre
  // The held end is not a rigid wall: its own layers strain, and it acts as one three quarters of a cell behind the
  // first held layer. Beyond a section one depth from it the root is a beam again, held by the tangent there:
  double beyond_mm = 0.0;     ///< length between that section and the load
  double relative_mm = 0.0;   ///< deflection of the loaded layer from that section's tangent
  double slope = 0.0;         ///< of that tangent
  double last_change = 0.0;   ///< relative change of the deflection over the last tenth of the run
  double still_moving = 0.0;  ///< kinetic energy over the work of the force
  double steps = 0.0;
  double cells = 0.0;
  Section section;
};

/// The damping that brings the beam to rest soonest, 1/h; 0 without inertia.
/// \param slowdown how much lower than that of the free cantilever the lowest frequency is
template <int Dim>
double settling_damping_per_h(const std::string& text, const std::vector<std::string>& overrides, double slowdown) {
  SceneRun<Dim> trial(text, overrides);
  if (!trial.tissue.inertia) return 0.0;
  // The lowest bending frequency, 1.875^2/L^2 sqrt(E I/m), m the numerical inertia per length across the axis.
  const Section s = section_of(trial);
  trial.advance_to(trial.tissue.step_h * trial.scene.numerics.steps_a_window());
  double inertia = 0.0;
  for (const Vec<Dim>& inverse : trial.tissue.inertia->inverse.values()) {
    if (inverse[1] > 0.0) inertia += 1.0 / inverse[1];
  }
  const double length = trial.scene.root.length_mm;
  // slightly less than critical, so that nothing creeps
  return 1.6 * 3.516 * std::sqrt(s.EI / (inertia * std::pow(length, 3))) * slowdown;
}

/// Bends the beam until it rests. Forces act on the last layer of cells and keep their direction.
/// \param axial_force compressive > 0
/// \param slowdown how much lower than that of the free cantilever the lowest frequency is
template <int Dim>
BeamResult bend(const std::string& text, const std::vector<std::string>& overrides, double lateral_force,
                double axial_force = 0.0, double slowdown = 1.0) {
  const double damping = settling_damping_per_h<Dim>(text, overrides, slowdown);
  std::vector<std::string> damped = overrides;
  if (damping > 0.0) damped.push_back("numerics.mass_damping_per_h=" + std::to_string(damping));
  SceneRun<Dim> run(text, damped);
  BeamResult result;
  result.section = section_of(run);

  const double size = run.scene.root.cell_size_mm;
  std::vector<char> loaded(static_cast<std::size_t>(run.tissue.next_cell_id), 0);
  double count = 0.0;
  for (const auto& [id, x] : run.start) {
    // jittered cells lie within half a spacing of their layer
    if (x[0] < run.scene.root.length_mm - size) continue;
    loaded[static_cast<std::size_t>(id)] = 1;
    count += 1.0;
    result.load_at_mm += x[0];
  }
  result.load_at_mm /= count;
  result.clamp_at_mm = -0.5 * size;
  Vec<Dim> share = Vec<Dim>::Zero();
  share[0] = -axial_force / count;
  share[1] = lateral_force / count;
  run.solver.hooks().forces.emplace_back("test load", [&loaded, share](Tissue<Dim>& t, SlipAdvance) {
    for (std::size_t i = 0; i < t.cells.size(); ++i) {
      if (loaded[static_cast<std::size_t>(t.cells.cell_id[i])]) t.force[i] += share;
    }
  });
  const auto deflection = [&] {
    double sum = 0.0;
    for (std::size_t i = 0; i < run.tissue.cells.size(); ++i) {
      const std::int64_t id = run.tissue.cells.cell_id[i];
      if (loaded[static_cast<std::size_t>(id)]) sum += run.tissue.cells.position[i][1] - run.start.at(id)[1];
    }
    return sum / count;
  };
  // without inertia every step ends at rest; operators found anew where the beam is bent change it a little
  const double end_h = damping > 0.0 ? 14.0 / (0.5 * damping) : 6.0 * run.tissue.step_h;
  run.advance_to(damping > 0.0 ? 0.9 * end_h : 5.0 * run.tissue.step_h);
  const double before = deflection();
  run.advance_to(end_h);
  result.deflection_mm = deflection();
  result.last_change = std::abs(result.deflection_mm / before - 1.0);
  {
    // parabola through the displacements within half a depth of the section
    const double at = beam_depth_mm, half = 0.5 * beam_depth_mm;
    Mat<3> normal = Mat<3>::Zero();
    Vec<3> right = Vec<3>::Zero();
    for (std::size_t i = 0; i < run.tissue.cells.size(); ++i) {
      const Vec<Dim>& x0 = run.start.at(run.tissue.cells.cell_id[i]);
      if (std::abs(x0[0] - at) > half) continue;
      const Vec<3> row(1.0, x0[0] - at, (x0[0] - at) * (x0[0] - at));
      normal += row * row.transpose();
      right += row * (run.tissue.cells.position[i][1] - x0[1]);
    }
    const Vec<3> fit = normal.inverse() * right;
    result.slope = fit[1];
    result.beyond_mm = result.load_at_mm - at;
    result.relative_mm = result.deflection_mm - fit[0] - fit[1] * result.beyond_mm;
  }
  result.still_moving = energies(run.tissue).kinetic / std::abs(lateral_force * result.deflection_mm);
  result.steps = static_cast<double>(run.solver.steps());
  result.cells = static_cast<double>(run.tissue.cells.size());
  record("steps", result.steps);
  return result;
}

/// Deflection over theory, with the beam held at x = 0 (first) and at the centre of the first held layer (second).
/// And of the part beyond one depth, against the tangent there: F l^3/(3 E I), shear is part of the tangent.
struct Ratio {
  double edge = 0.0, first_layer = 0.0, beam = 0.0;
  double steps = 0.0, cells = 0.0;  ///< of all runs together, of one
  double last_change = 0.0;         ///< the largest of the runs
};

template <int Dim>
Ratio cantilever(int cells_across, const std::vector<std::string>& overrides = {}) {
  // small: 0.2 % of the length
  const double slender = 1020.0 * (Dim == 2 ? std::pow(beam_depth_mm, 3) / 12.0
                                            : std::numbers::pi * std::pow(0.5 * beam_depth_mm, 4) / 4.0);
  const double force = 0.002 * beam_length_mm * 3.0 * slender / std::pow(beam_length_mm, 3);
  const BeamResult r = bend<Dim>(beam_case(Dim, cells_across), overrides, force);
  EXPECT_LT(r.last_change, 1e-3);
  const Ratio ratio{r.deflection_mm / cantilever_deflection(r.section, force, r.load_at_mm),
                    r.deflection_mm / cantilever_deflection(r.section, force, r.load_at_mm - r.clamp_at_mm),
                    r.relative_mm / (force * std::pow(r.beyond_mm, 3) / (3.0 * r.section.EI)),
                    r.steps,
                    r.cells,
                    r.last_change};
  const std::string name = std::to_string(Dim) + "D " + std::to_string(cells_across) + " across: ";
  record(name + "deflection/theory, clamp at edge", ratio.edge);
  record(name + "deflection/theory, at first layer", ratio.first_layer);
  record(name + "deflection/theory beyond one depth", ratio.beam);
  record(name + "change in the last tenth", r.last_change);
  record(name + "EI of the lattice/nominal", r.section.EI / slender);
  return ratio;
}

/// Measured over theoretical Euler load of the clamped-free root.
///
/// The amplification of a lateral force F by an axial one N gives the load without the root ever buckling: a
/// cantilever of length l bends by F/N (tan(kl)/k - l), k^2 = N/(E I) (Timoshenko & Gere, Theory of Elastic Stability,
/// 1.11). `edge` compares deflections with and without N over the whole length: 3 (tan b - b)/b^3 with
/// b = pi/2 sqrt(N/P); `beam` the part beyond one depth, where the force across its tangent is F + N slope.
template <int Dim>
Ratio buckling(int cells_across, const std::vector<std::string>& overrides = {}) {
  const double force = 1e-5;
  const BeamResult plain = bend<Dim>(beam_case(Dim, cells_across), overrides, force);
  const double theory = euler_load(plain.section, plain.load_at_mm);
  const double axial = 0.5 * theory;
  const BeamResult pressed = bend<Dim>(beam_case(Dim, cells_across), overrides, force, axial, 0.7);
  EXPECT_LT(plain.last_change, 1e-3);
  EXPECT_LT(pressed.last_change, 1e-3);

  constexpr double right_angle = 0.5 * std::numbers::pi;
  // b with 3 (tan b - b)/b^3 = a
  const auto solve = [&](double a) {
    double low = 1e-3, high = right_angle - 1e-9;
    for (int k = 0; k < 60; ++k) {
      const double b = 0.5 * (low + high);
      (3.0 * (std::tan(b) - b) / (b * b * b) < a ? low : high) = b;
    }
    return 0.5 * (low + high);
  };
  const double b = solve(pressed.deflection_mm / plain.deflection_mm);
  const double whole = axial * std::pow(right_angle / b, 2);
  // E I of the part beyond one depth from its own bending: a = deflection/(F' l^3/(3 E I)) with N = (b/l)^2 E I
  const double l = pressed.beyond_mm;
  const double across = force + axial * pressed.slope;
  double low = 0.2 * plain.section.EI, high = 5.0 * plain.section.EI;
  for (int k = 0; k < 60; ++k) {
    const double EI = 0.5 * (low + high), k_per_mm = std::sqrt(axial / EI);
    const double bent = k_per_mm * l < right_angle ? across / axial * (std::tan(k_per_mm * l) / k_per_mm - l) : 1e300;
    (bent > pressed.relative_mm ? low : high) = EI;
  }
  Section measured = plain.section;
  measured.EI = 0.5 * (low + high);

  const Ratio ratio{whole / theory,
                    whole / euler_load(plain.section, plain.load_at_mm - plain.clamp_at_mm),
                    euler_load(measured, plain.load_at_mm) / theory,
                    plain.steps + pressed.steps,
                    plain.cells,
                    std::max(plain.last_change, pressed.last_change)};
  const std::string name = std::to_string(Dim) + "D " + std::to_string(cells_across) + " across: ";
  record(name + "Euler load/theory, clamp at edge", ratio.edge);
  record(name + "Euler load/theory, at first layer", ratio.first_layer);
  record(name + "Euler load/theory beyond one depth", ratio.beam);
  return ratio;
}

}  // namespace rootsoil::physics
