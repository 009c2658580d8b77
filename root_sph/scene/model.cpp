// SPDX-License-Identifier: MIT
#include "root_sph/scene/model.hpp"

#include "root_sph/core/errors.hpp"
#include "root_sph/scene/presets.hpp"
#include "root_sph/tissue/closed_form.hpp"
#include "root_sph/tissue/hyperbolicity.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace rootsoil {
namespace {

GradientMode gradient_mode(const std::string& name) {
  if (name == "plain") return GradientMode::plain;
  if (name == "linear") return GradientMode::linear;
  if (name == "quadratic") return GradientMode::quadratic;
  return GradientMode::quadratic_at_surface;
}

template <int Dim>
ElasticConstants constants_at(const Scene& scene, double s_mm, double p_MPa) {
  ElasticConstants c = elastic_constants(scene);
  if (scene.tissue.anisotropy) c.E_radial_MPa = radial_modulus_profile(scene, p_MPa)(s_mm);
  return c;
}

template <int Dim>
AxialRadial closed_form_rates(const Scene& scene, double s_mm) {
  if (!scene.growth || !scene.pressure) return {0.0, 0.0};
  const double p = initial_pressure_MPa(scene);
  const double lambda = softening_profile(scene, p)(s_mm);
  return growth_rate<Dim>(stiffness<Dim>(constants_at<Dim>(scene, s_mm, p)), p, lambda / scene.tissue.rho0_ug_mm3);
}

/// sigma = p 1, the matching mass, and the closed form's velocity: what steady growth looks like, so that a run does
/// not begin with a start from rest that inertia has to work off.
template <int Dim>
void start_in_equilibrium(const Scene& scene, Solver<Dim>& solver) {
  Tissue<Dim>& tissue = solver.tissue();
  auto& cells = tissue.cells;
  const double p = initial_pressure_MPa(scene);
  const RootAxis<Dim>& axis = solver.axis();
  const bool straight = scene.root.curvature_per_mm == 0.0;

  std::vector<double> flow{0.0};
  const double bin = axis.bin_mm();
  while (static_cast<double>(flow.size() - 1) * bin < axis.length_mm() + 2.0 * bin) {
    // Simpson's rule over a bin
    const double s = static_cast<double>(flow.size() - 1) * bin;
    const double mean = (closed_form_axial_rate<Dim>(scene, s) + 4.0 * closed_form_axial_rate<Dim>(scene, s + 0.5 * bin) +
                         closed_form_axial_rate<Dim>(scene, s + bin)) / 6.0;
    flow.push_back(flow.back() + bin * mean);
  }
  solver.axis().set_flow(flow);
  const double tip_speed = axis.flow_mm_h(axis.length_mm());

  for (std::size_t i = 0; i < cells.size(); ++i) {
    const double s = cells.distance_to_tip[i];
    const Stiffness<Dim> k = stiffness<Dim>(constants_at<Dim>(scene, s, p));
    cells.stress[i].template head<Dim>().setConstant(p);
    const double density_ratio = scene.tissue.law == "pressure_deviator"
                                     ? 1.0 - p / bulk_modulus<Dim>(k)
                                     : 1.0 / (1.0 + volume_strain<Dim>(k, cells.stress[i]));
    cells.mass[i] = scene.tissue.rho0_ug_mm3 * density_ratio * cells.volume[i];
    if (cells.clamped[i]) continue;
    Vec<Dim> u = Vec<Dim>::Zero();
    if (straight && scene.root.base == "clamped") {
      u = closed_form_radial_rate<Dim>(scene, s) * cells.position[i];
      u[0] = tip_speed - axis.flow_mm_h(s);
    }
    cells.velocity[i] = u;
  }
}

/// Tip speed at the scene's end by the closed form, mm/h: a root that begins shorter than its growth zone gains speed.
template <int Dim>
double final_tip_speed_mm_h(const Scene& scene, double length_mm) {
  constexpr int parts = 50;
  double speed = closed_form_flow<Dim>(scene, length_mm).tip_speed_mm_h;
  for (int k = 0; k < parts; ++k) {
    length_mm += speed * scene.scene.duration_h / parts;
    speed = closed_form_flow<Dim>(scene, length_mm).tip_speed_mm_h;
  }
  return speed;
}

template <int Dim>
double automatic_step_h(const Scene& scene) {
  const double size = scene.root.cells_file.empty() ? scene.root.cell_size_mm : 0.01;
  const StepRule rule = step_rule(scene.numerics.accuracy);
  const double length = scene.root.cells_file.empty() ? scene.root.length_mm : 0.5;
  const double speed = final_tip_speed_mm_h<Dim>(scene, length);
  if (speed > 0.0) return std::min(rule.longest_step_h, rule.tip_cells_per_step * size / speed);
  // Static: critically damped, the slowest mode settles to rounding within some 10 steps a cell along the root.
  return scene.scene.duration_h / std::max(2000.0, 25.0 * length / size);
}

}  // namespace

template <int Dim>
double closed_form_axial_rate(const Scene& scene, double s_mm) {
  return closed_form_rates<Dim>(scene, s_mm).axial;
}

template <int Dim>
double closed_form_radial_rate(const Scene& scene, double s_mm) {
  return closed_form_rates<Dim>(scene, s_mm).radial;
}

template <int Dim>
ClosedFormFlow closed_form_flow(const Scene& scene, double length_mm) {
  ClosedFormFlow flow;
  constexpr int parts = 2000;
  for (int k = 0; k < parts; ++k) {
    const double rate = closed_form_axial_rate<Dim>(scene, (k + 0.5) * length_mm / parts);
    flow.tip_speed_mm_h += rate * length_mm / parts;
    flow.peak_rate_per_h = std::max(flow.peak_rate_per_h, rate);
  }
  return flow;
}

template <int Dim>
void refuse_unstable_law(const Scene& scene) {
  if (scene.tissue.law != "pressure_deviator" || scene.scene.allow_unstable) return;
  const double p = initial_pressure_MPa(scene);
  const double length = scene.root.cells_file.empty() ? scene.root.length_mm : 5.0;
  for (int k = 0; k <= 50; ++k) {
    const double s = length * k / 50.0;
    const ElasticConstants c = constants_at<Dim>(scene, s, p);
    const AcousticFinding finding = scan_acoustic_tensor<Dim>(pressure_deviator_tangent<Dim>(c));
    if (finding.hyperbolic) continue;
    scene.origins.fail(
        "tissue.law",
        fmt::format("the law is not hyperbolic {:.3g} mm from the tip: waves at {:.0f} degrees from the axis grow by "
                    "themselves (acoustic tensor: smallest real part {:.4g} MPa, imaginary part {:.4g} MPa)",
                    s, finding.angle_deg, finding.smallest_real_MPa, finding.largest_imaginary_MPa),
        fmt::format("pressure_deviator with E_R/E_A = {:.3g}, G = {:.4g} MPa", c.E_radial_MPa / c.E_axial_MPa, c.G_MPa),
        "E_R/E_A below about 4, or the law elastic_growth",
        "use law = \"elastic_growth\", or set scene.allow_unstable = true to see what happens");
  }
}

template <int Dim>
double choose_step_h(const Scene& scene) {
  const double wanted = scene.numerics.step_h ? *scene.numerics.step_h : automatic_step_h<Dim>(scene);
  const double every = scene.output.every_h;
  return every / std::ceil(every / wanted - 1e-9);
}

template <int Dim>
BuiltModel<Dim> build_model(const Scene& scene) {
  refuse_unstable_law<Dim>(scene);
  SolverOptions options;
  options.step_h = choose_step_h<Dim>(scene);
  options.eta = scene.numerics.eta;
  options.gradient = gradient_mode(scene.numerics.gradient);
  options.stepper = scene.numerics.stepper == "symplectic" ? Stepper::symplectic : Stepper::predictor_corrector;
  options.inertia = scene.numerics.inertia == "tensor" ? InertiaMode::tensor : InertiaMode::scalar;
  options.mass_damping_per_h = scene.numerics.mass_damping_per_h;
  if (!scene.growth && !scene.numerics.mass_damping_per_h) options.mass_damping_per_h = std::nullopt;
  else if (!scene.numerics.mass_damping_per_h) options.mass_damping_per_h = 0.0;

  // cells first: the isotropic kernel needs their size, and probes look for the nearest one
  BuiltModel<Dim> built{std::make_unique<Model<Dim>>(options), {}};
  Model<Dim>& model = *built.model;
  Tissue<Dim>& tissue = model.solver.tissue();
  built.initial = make_initial_cells<Dim>(scene, tissue, scene.numerics.eta);
  if (scene.numerics.kernel == "isotropic") {
    model.solver.use_isotropic_kernel(scene.numerics.H_bar * std::sqrt(double(Dim)) * built.initial.cell_size_mm);
  }

  Material<Dim>& material = tissue.material;
  material.law = scene.tissue.law == "elastic_growth" ? TissueLaw::elastic_growth : TissueLaw::pressure_deviator;
  material.E_axial_MPa = scene.tissue.E_axial_MPa;
  material.rho0_ug_mm3 = scene.tissue.rho0_ug_mm3;
  material.uniform = stiffness<Dim>(elastic_constants(scene));
  if (material.law == TissueLaw::pressure_deviator) {
    material.deviatoric_stress = &tissue.cells.template declare<Voigt<Dim>>(
        {"deviatoric_stress", "MPa", "tau of Eq. 1, material frame"}, on_division::copy<Dim, Voigt<Dim>>);
  }
  for (const EffectEntry& entry : effect_table()) {
    if (!entry.called_for(scene)) continue;
    if constexpr (Dim == 2) {
      entry.add_2d(scene, model);
    } else {
      entry.add_3d(scene, model);
    }
  }
  model.solver.axis().start(tissue);
  if (scene.numerics.start == "equilibrium") start_in_equilibrium<Dim>(scene, model.solver);
  model.solver.prepare();
  return built;
}

template <int Dim>
SoilContactEffect<Dim>& add_soil_contact(const Scene& scene, Model<Dim>& model, SoilContactParameters parameters,
                                         std::unique_ptr<SoilPort> port) {
  parameters.free_growth = {[scene](double s_mm) { return closed_form_axial_rate<Dim>(scene, s_mm); },
                            1.0 - (Dim - 1) * scene.tissue.nu_axial};
  auto effect = std::make_unique<SoilContactEffect<Dim>>(model.solver, std::move(parameters), std::move(port));
  SoilContactEffect<Dim>& added = *effect;
  model.effects.push_back(std::move(effect));
  return added;
}

template double closed_form_axial_rate<2>(const Scene&, double);
template double closed_form_axial_rate<3>(const Scene&, double);
template double closed_form_radial_rate<2>(const Scene&, double);
template double closed_form_radial_rate<3>(const Scene&, double);
template ClosedFormFlow closed_form_flow<2>(const Scene&, double);
template ClosedFormFlow closed_form_flow<3>(const Scene&, double);
template void refuse_unstable_law<2>(const Scene&);
template void refuse_unstable_law<3>(const Scene&);
template double choose_step_h<2>(const Scene&);
template double choose_step_h<3>(const Scene&);
template BuiltModel<2> build_model<2>(const Scene&);
template BuiltModel<3> build_model<3>(const Scene&);
template SoilContactEffect<2>& add_soil_contact<2>(const Scene&, Model<2>&, SoilContactParameters,
                                                   std::unique_ptr<SoilPort>);
template SoilContactEffect<3>& add_soil_contact<3>(const Scene&, Model<3>&, SoilContactParameters,
                                                   std::unique_ptr<SoilPort>);

}  // namespace rootsoil
