// SPDX-License-Identifier: MIT
#include "root_sph/scene/effect_table.hpp"

#include "root_sph/effects/anisotropy.hpp"
#include "root_sph/effects/division.hpp"
#include "root_sph/effects/growth.hpp"
#include "root_sph/effects/inertia_relief.hpp"
#include "root_sph/effects/obstacle.hpp"
#include "root_sph/effects/pressure.hpp"
#include "root_sph/effects/probe.hpp"
#include "root_sph/effects/sleep.hpp"
#include "root_sph/profiles/soil_response.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace rootsoil {
namespace {

template <int Dim, class EffectType, class... Arguments>
void add(Model<Dim>& model, Arguments&&... arguments) {
  model.effects.push_back(std::make_unique<EffectType>(model.solver, std::forward<Arguments>(arguments)...));
}

template <int Dim>
void add_pressure(const Scene& scene, Model<Dim>& model) {
  add<Dim, PressureEffect<Dim>>(model, scene.pressure->table);
}

template <int Dim>
void add_anisotropy(const Scene& scene, Model<Dim>& model) {
  add<Dim, AnisotropyEffect<Dim>>(model, elastic_constants(scene),
                                  [scene](double p) { return radial_modulus_profile(scene, p); });
}

template <int Dim>
void add_growth(const Scene& scene, Model<Dim>& model) {
  add<Dim, GrowthEffect<Dim>>(model, [scene](double p) { return softening_profile(scene, p); });
}

template <int Dim>
void add_division(const Scene& scene, Model<Dim>& model) {
  add<Dim, DivisionEffect<Dim>>(model, division_profile(scene));
}

template <int Dim>
void add_inertia_compensation(const Scene&, Model<Dim>& model) {
  add<Dim, InertiaCompensationEffect<Dim>>(model);
}

template <int Dim>
void add_midline_damping(const Scene& scene, Model<Dim>& model) {
  add<Dim, MidlineDampingEffect<Dim>>(model, midline_damping_per_h(scene));
}

template <int Dim>
void add_pair_terms(const Scene& scene, Model<Dim>& model) {
  const auto& control = scene.non_affine_control;
  model.solver.pair_terms() = make_pair_terms<Dim>(
      model.solver.tissue().cells, scene.tissue.E_axial_MPa,
      control ? std::optional<double>(control->damping) : std::nullopt, control ? control->stiffness : 0.0,
      scene.numerics.artificial_viscosity);
}

template <int Dim>
Vec<Dim> shortened(const std::array<double, 3>& v) {
  return Eigen::Map<const Vec<Dim>>(v.data());
}

template <int Dim>
RigidShape<Dim> rigid_shape(const ObstacleSection& o) {
  if (o.shape == "plane") return Plane<Dim>{shortened<Dim>(o.position_mm), shortened<Dim>(o.normal)};
  if (o.shape == "box") {
    const double angle = o.angle_deg * std::numbers::pi / 180.0;
    Mat<Dim> axes = Mat<Dim>::Identity();
    axes(0, 0) = axes(1, 1) = std::cos(angle);
    axes(1, 0) = std::sin(angle);
    axes(0, 1) = -axes(1, 0);
    return Box<Dim>{shortened<Dim>(o.position_mm), shortened<Dim>(o.half_size_mm), axes};
  }
  return Ball<Dim>{shortened<Dim>(o.position_mm), o.radius_mm};
}

template <int Dim>
void add_obstacles(const Scene& scene, Model<Dim>& model) {
  for (const ObstacleSection& o : scene.obstacles) {
    add<Dim, ObstacleEffect<Dim>>(
        model, ObstacleParameters<Dim>{o.name, rigid_shape<Dim>(o), o.friction, o.contact_modulus_MPa});
  }
}

template <int Dim>
void add_probes(const Scene& scene, Model<Dim>& model) {
  for (const ProbeSection& p : scene.probes) {
    add<Dim, ProbeEffect<Dim>>(model, ProbeParameters{p.name, p.position_mm, p.distance_to_tip_mm});
  }
}

template <int Dim>
void add_sleep(const Scene& scene, Model<Dim>& model) {
  SleepParameters parameters{.strain_rate_per_h = *scene.sleep->strain_rate_per_h, .stress_change = *scene.sleep->stress_change};
  if (scene.sleep->mean_over_h) {
    const double window_h = scene.numerics.window_steps * model.solver.options().step_h;
    parameters.windows_between_looks = std::max<std::int64_t>(1, std::llround(*scene.sleep->mean_over_h / window_h));
  }
  add<Dim, SleepEffect<Dim>>(model, parameters);
}

/// Parts of other effects, or conditions on the cells: nothing of their own to construct.
template <int Dim>
void add_nothing(const Scene&, Model<Dim>&) {}

constexpr EffectEntry table[] = {
    {"pressure", "[pressure]", "uniform pressure differential, constant or a table over time (Eq. 5)", "",
     [](const Scene& s) { return s.pressure.has_value(); }, add_pressure<2>, add_pressure<3>},
    {"anisotropy", "[tissue.anisotropy]", "radial modulus that varies along the root (Eq. 4, 6)", "",
     [](const Scene& s) { return s.tissue.anisotropy.has_value(); }, add_anisotropy<2>, add_anisotropy<3>},
    {"growth", "[growth]", "mass source where the tissue is soft and stretched (Eq. 1, 2, 6)", "",
     [](const Scene& s) { return s.growth.has_value(); }, add_growth<2>, add_growth<3>},
    {"response", "[response]", "growth and anisotropy follow the soil's strength (Eq. 7)", "",
     [](const Scene& s) { return s.response.has_value(); }, add_nothing<2>, add_nothing<3>},
    {"inertia compensation", "[growth]", "cancels the leading error of numerical inertia in steady growth", "",
     [](const Scene& s) {
       return s.growth.has_value() && s.numerics.inertia_compensation && s.root.base == "clamped";
     },
     add_inertia_compensation<2>, add_inertia_compensation<3>},
    {"midline damping", "[growth], [numerics] midline_damping_per_h",
     "keeps numerical inertia from bending a long free root (hose flutter)", "",
     [](const Scene& s) { return midline_damping_per_h(s) > 0.0; }, add_midline_damping<2>, add_midline_damping<3>},
    {"division", "[division]", "cells divide across their longest axis (4.2, Eq. 6)", "",
     [](const Scene& s) { return s.division.has_value(); }, add_division<2>, add_division<3>},
    {"clamped base", "[root] base", "cells at the base are held", "",
     [](const Scene& s) { return s.root.base == "clamped"; }, add_nothing<2>, add_nothing<3>},
    {"pair resistance", "[non_affine_control], [numerics] artificial_viscosity",
     "resists pair motions that no gradient sees; artificial viscosity for comparison", "velocity, history of slip",
     [](const Scene& s) { return s.non_affine_control.has_value() || s.numerics.artificial_viscosity > 0.0; },
     add_pair_terms<2>, add_pair_terms<3>},
    {"obstacle", "[[obstacle]]", "rigid plane, box, disc or sphere: penalty contact with friction", "",
     [](const Scene& s) { return !s.obstacles.empty(); }, add_obstacles<2>, add_obstacles<3>},
    {"soil contact", "[soil]", "surface markers exchange motion and forces with grains in YADE, another process", "",
     [](const Scene& s) { return s.soil.has_value(); }, add_nothing<2>, add_nothing<3>},  // the program hands the soil in
    {"sleep", "[sleep]", "mature tissue that does not move is left out until something moves it", "",
     [](const Scene& s) { return s.sleep.has_value(); }, add_sleep<2>, add_sleep<3>},
    {"probe", "[[probe]]", "a point or a bin of the tissue followed over time", "",
     [](const Scene& s) { return !s.probes.empty(); }, add_probes<2>, add_probes<3>},
};

}  // namespace

std::span<const EffectEntry> effect_table() { return table; }

std::vector<std::string> active_effects(const Scene& scene) {
  std::vector<std::string> names;
  for (const EffectEntry& entry : table) {
    if (entry.called_for(scene)) names.emplace_back(entry.name);
  }
  return names;
}

RadialModulusProfile radial_modulus_profile(const Scene& scene, double p_MPa) {
  const AnisotropySection& a = *scene.tissue.anisotropy;
  RadialModulusProfile profile{scene.tissue.E_axial_MPa, a.E_radial_max_MPa, a.x_e_mm, a.s_e_per_mm, a.c_e};
  if (scene.response && scene.response->anisotropy) {
    const auto& r = *scene.response->anisotropy;
    const SoilResponse response{r.p_MPa, scene.response->extrapolate};
    const auto follow = [&](const std::optional<std::array<double, 2>>& set, double& value) {
      if (set) value = response.interpolate(*set, p_MPa);
    };
    follow(r.E_radial_max_MPa, profile.E_radial_max_MPa);
    follow(r.x_e_mm, profile.x_e_mm);
    follow(r.s_e_per_mm, profile.s_e_per_mm);
    follow(r.c_e, profile.c_e);
  }
  return profile;
}

SofteningProfile softening_profile(const Scene& scene, double p_MPa) {
  const GrowthSection& g = *scene.growth;
  SofteningProfile profile{g.lambda0_ug_mm3_h,          g.x_g_mm,         g.s_g_mm, g.c_g,
                           g.mature_at_mm.value_or(-1.0), g.mature_width_mm};
  if (scene.response && scene.response->growth) {
    const auto& r = *scene.response->growth;
    const SoilResponse response{r.p_MPa, scene.response->extrapolate};
    const auto follow = [&](const std::optional<std::array<double, 2>>& set, double& value) {
      if (set) value = response.interpolate(*set, p_MPa);
    };
    follow(r.lambda0_ug_mm3_h, profile.lambda0_ug_mm3_h);
    follow(r.x_g_mm, profile.x_g_mm);
    follow(r.s_g_mm, profile.s_g_mm);
    follow(r.c_g, profile.c_g);
  }
  return profile;
}

DivisionThresholdProfile division_profile(const Scene& scene) {
  const DivisionSection& d = *scene.division;
  return {d.l0_mm, d.c_d, d.s_d_per_mm2, d.x_d_mm, d.constant_beyond_mm.value_or(-1.0)};
}

ElasticConstants elastic_constants(const Scene& scene) {
  const TissueSection& t = scene.tissue;
  return {t.E_axial_MPa, t.E_axial_MPa, t.nu_axial, t.nu_radial, t.G_MPa};
}

double midline_damping_per_h(const Scene& scene) {
  if (scene.numerics.midline_damping_per_h) return *scene.numerics.midline_damping_per_h;
  // where the root is to be bent by contact, nothing but contact and the tissue may resist
  constexpr double faster_than_flutter_per_h = 5.0;
  return scene.growth && scene.root.base == "clamped" && scene.obstacles.empty() && !scene.soil
             ? faster_than_flutter_per_h
             : 0.0;
}

double initial_pressure_MPa(const Scene& scene) {
  return scene.pressure ? pressure_at(scene.pressure->table, 0.0) : 0.0;
}

}  // namespace rootsoil
