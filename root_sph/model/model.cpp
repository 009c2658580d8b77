// SPDX-License-Identifier: MIT
#include "root_sph/model/model.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "root_sph/core/errors.hpp"
#include "root_sph/effects/anisotropy/anisotropy.hpp"
#include "root_sph/effects/pressure/pressure.hpp"
#include "root_sph/scene/presets.hpp"
#include "root_sph/scene/response.hpp"
#include "root_sph/tissue/hyperbolicity.hpp"

namespace rootsoil {
namespace {

/// sigma = p 1, the matching mass, and the closed form's velocity: what steady growth looks like, so that a run does
/// not begin with a start from rest that inertia has to work off.
template <int Dim>
void start_in_equilibrium(const Scene& scene, Solver<Dim>& solver) {
  Tissue<Dim>& tissue = solver.tissue();
  auto& cells = tissue.cells;
  const double p = pressure_MPa(scene, 0.0);
  const RootAxis<Dim>& axis = solver.axis();
  const bool straight = scene.root.curvature_per_mm == 0.0;

  const auto rate = [&](double s) { return closed_form_rates<Dim>(scene, s, p).axial; };
  std::vector<double> flow{0.0};
  const double bin = axis.bin_mm();
  while (static_cast<double>(flow.size() - 1) * bin < axis.length_mm() + 2.0 * bin) {
    // Simpson's rule over a bin
    const double s = static_cast<double>(flow.size() - 1) * bin;
    const double mean = (rate(s) + 4.0 * rate(s + 0.5 * bin) + rate(s + bin)) / 6.0;
    flow.push_back(flow.back() + bin * mean);
  }
  solver.axis().set_flow(flow);
  const double tip_speed = axis.flow_mm_h(axis.length_mm());

  for (std::size_t i = 0; i < cells.size(); ++i) {
    const double s = cells.distance_to_tip[i];
    const Stiffness<Dim> k = stiffness<Dim>(elastic_constants(scene, s, p));
    cells.stress[i].template head<Dim>().setConstant(p);
    const double density_ratio =
        visit_law<Dim>(scene.tissue.law, [&]<class Law>(Law) { return Law::density_ratio(k, p); });
    cells.mass[i] = scene.tissue.rho0_ug_mm3 * density_ratio * cells.volume[i];
    if (cells.clamped[i]) continue;
    Vec<Dim> u = Vec<Dim>::Zero();
    if (straight && scene.root.is_clamped()) {
      u = closed_form_rates<Dim>(scene, s, p).radial * cells.position[i];
      u[0] = tip_speed - axis.flow_mm_h(s);
    }
    cells.velocity[i] = u;
  }
}

/// The next smaller E_R/E_A at which the law is hyperbolic, sought in steps of a percent.
template <int Dim>
std::string hyperbolic_ratio_text(TissueLaw law, ElasticConstants c) {
  for (const double smallest = 1e-2 * c.E_axial_MPa; c.E_radial_MPa > smallest; c.E_radial_MPa /= 1.01) {
    if (scan_acoustic_tensor<Dim>(tangent_of<Dim>(law, stiffness<Dim>(c))).hyperbolic) {
      return fmt::format("E_R/E_A below {:.2g}", c.E_radial_MPa / c.E_axial_MPa);
    }
  }
  return "no E_R";
}

template <int Dim>
double automatic_step_h(const Scene& scene) {
  const double size = scene.root.is_lattice() ? scene.root.cell_size_mm : 0.01;
  const StepRule rule = step_rule(scene.numerics.accuracy);
  const double length = scene.root.is_lattice() ? scene.root.length_mm : 0.5;
  const double speed = fastest_tip_speed_mm_h<Dim>(scene);
  if (!scene.numerics.has_inertia()) {
    if (speed <= 0.0) return std::min(scene.output.every_h, scene.facts.longest_step_h);
    const double peak_rate = fastest_flow<Dim>(scene, length, scene.facts.pressure_MPa[1]).peak_rate_per_h;
    const double growth_h = std::min(rule.growth_per_step / peak_rate, scene.facts.longest_step_h);
    return scene.facts.can_be_arrested ? std::min(growth_h, rule.contact_cells_per_step * size / speed) : growth_h;
  }
  if (speed > 0.0) {
    double cells_per_step = rule.tip_cells_per_step;
    if (scene.facts.can_be_arrested) {
      const double strain = scene.facts.pressure_MPa[1] / scene.tissue.E_axial_MPa;
      cells_per_step = std::min(cells_per_step, rule.arrest_cells_per_strain * strain);
    }
    return std::min(rule.longest_step_h, cells_per_step * size / speed);
  }
  // Static: critically damped, the slowest mode settles to rounding within some 10 steps a cell along the root.
  return scene.scene.duration_h / std::max(2000.0, 25.0 * length / size);
}

}  // namespace

template <int Dim>
void refuse_unstable_law(const Scene& scene) {
  const TissueLawEntry& law = entry_of(scene.tissue.law);
  if (law.always_hyperbolic || scene.scene.allow_unstable) return;
  const double length = scene.root.is_lattice() ? scene.root.length_mm : 5.0;
  constexpr int parts = 50;
  std::vector<std::pair<double, double>> places;  // distance from the tip, pressure
  for (int k = 0; k <= parts; ++k) places.emplace_back(length * k / parts, pressure_MPa(scene, 0.0));
  if (responds_to_perceived(scene)) {
    const auto [low, high] = responding_range_MPa(scene);
    for (int k = 0; k <= parts; ++k) {
      for (const double s : {0.0, 0.5 * length, length}) places.emplace_back(s, low + (high - low) * k / parts);
    }
  }
  for (const auto& [s, p] : places) {
    const ElasticConstants c = elastic_constants(scene, s, p);
    const AcousticFinding finding = scan_acoustic_tensor<Dim>(tangent_of<Dim>(law.value, stiffness<Dim>(c)));
    if (finding.hyperbolic) continue;
    scene.origins.fail(
        "tissue.law",
        fmt::format("the law is not hyperbolic {:.3g} mm from the tip: waves at {:.0f} degrees from the axis grow by "
                    "themselves (acoustic tensor: smallest real part {:.4g} MPa, imaginary part {:.4g} MPa)",
                    s, finding.angle_deg, finding.smallest_real_MPa, finding.largest_imaginary_MPa),
        fmt::format("{} with E_R/E_A = {:.3g}, G = {:.4g} MPa", law.name, c.E_radial_MPa / c.E_axial_MPa, c.G_MPa),
        fmt::format("with this G and these Poisson ratios {}, or the law elastic_growth",
                    hyperbolic_ratio_text<Dim>(law.value, c)),
        "use law = \"elastic_growth\", or set scene.allow_unstable = true to see what happens");
  }
}

template <int Dim>
double choose_step_h(const Scene& scene) {
  const double wanted = scene.numerics.step_h ? *scene.numerics.step_h : automatic_step_h<Dim>(scene);
  const double every = scene.output.every_h;
  const double step_h = every / std::max(1.0, std::ceil(every / wanted - 1e-9));
  // A frame, a checkpoint, --until are counted in steps; all are at most as long as duration_h or 1e4 h.
  constexpr double shortest_h = 1e-9;  // a thousand times what two times are told apart by (step_time_h)
  constexpr double most_steps = 1e12;  // at a microsecond a step eleven days
  const double steps = scene.scene.duration_h / step_h;
  if (step_h >= shortest_h && steps <= most_steps) return step_h;
  // what the step follows from
  const auto [key, remedy] =
      every <= wanted ? std::pair("output.every_h", "write frames less often, and run for longer")
      : scene.origins.has("numerics.step_h") ? std::pair("numerics.step_h", "take a longer step, or leave it out")
      : scene.origins.has("growth")
          ? std::pair("growth", "the step follows from the speed of the tip: lower it, or give numerics.step_h")
          : std::pair("scene.duration_h", "run for longer");
  scene.origins.fail(key,
                     step_h >= shortest_h ? fmt::format("the run would take {:.1e} steps", steps)
                                          : "the step is too short to tell times apart",
                     fmt::format("steps of {:.4g} h for {:.4g} h", step_h, scene.scene.duration_h),
                     fmt::format("steps of at least {:.0e} h, and at most {:.0e} of them", shortest_h, most_steps),
                     fmt::format("{}; are all times in hours?", remedy));
}

template <int Dim>
std::unique_ptr<Model<Dim>> build_model(const Scene& scene, const Services& services) {
  refuse_unstable_law<Dim>(scene);
  SolverOptions options;
  options.step_h = choose_step_h<Dim>(scene);
  options.eta = scene.numerics.eta;
  options.gradient = scene.numerics.gradient;
  options.stepper = scene.numerics.stepper;
  options.inertia = scene.numerics.inertia;
  options.mass_damping_per_h = scene.numerics.mass_damping_per_h;
  options.force_tolerance = scene.numerics.force_tolerance;
  const bool moves_for_ever = scene.origins.has("growth");
  if (!options.mass_damping_per_h && moves_for_ever) options.mass_damping_per_h = 0.0;

  // cells first: the isotropic kernel needs their size, and probes look for the nearest one
  auto model = std::make_unique<Model<Dim>>(options);
  Solver<Dim>& solver = model->solver;
  Tissue<Dim>& tissue = solver.tissue();
  model->initial = make_initial_cells<Dim>(scene, tissue, scene.numerics.eta);
  if (scene.numerics.kernel == Kernel::isotropic) {
    solver.use_isotropic_kernel(isotropic_kernel_mm(scene.numerics, Dim, model->initial.cell_size_mm));
  }

  Material<Dim>& material = tissue.material;
  use_law<Dim>(tissue, scene.tissue.law);
  material.E_axial_MPa = scene.tissue.E_axial_MPa;
  material.rho0_ug_mm3 = scene.tissue.rho0_ug_mm3;
  material.uniform = stiffness<Dim>(isotropic_constants(scene.tissue));
  solver.axis().start(tissue);
  if (scene.numerics.start == Start::equilibrium) start_in_equilibrium<Dim>(scene, solver);
  const FreeGrowth growth = free_growth<Dim>(scene);
  for (const EffectSpec& effect : effect_table()) {
    if (effect.called_for(scene)) effect.build(Assembly<Dim>{scene, solver, model->effects, growth, services});
  }
  for (const auto& effect : model->effects) effect->prepare();
  solver.prepare();
  return model;
}

template void refuse_unstable_law<2>(const Scene&);
template void refuse_unstable_law<3>(const Scene&);
template double choose_step_h<2>(const Scene&);
template double choose_step_h<3>(const Scene&);
template std::unique_ptr<Model<2>> build_model<2>(const Scene&, const Services&);
template std::unique_ptr<Model<3>> build_model<3>(const Scene&, const Services&);

}  // namespace rootsoil
