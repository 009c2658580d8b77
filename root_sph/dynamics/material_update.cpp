// SPDX-License-Identifier: MIT
#include "root_sph/dynamics/material_update.hpp"

#include "root_sph/tissue/laws.hpp"

namespace rootsoil {
namespace {

/// V R sigma R^T F^-T - p V F^-T
template <int Dim>
Mat<Dim> nominal_force_of(const Mat<Dim>& frame, const Voigt<Dim>& stress, double volume,
                          const Mat<Dim>& inverse_deformation, double pressure_MPa) {
  Mat<Dim> total = frame * to_matrix<Dim>(stress) * frame.transpose();
  total.diagonal().array() -= pressure_MPa;
  return volume * total * inverse_deformation.transpose();
}

template <int Dim, TissueLaw Law, bool Varying, bool Growing, MaterialStep Step>
void update_material(Tissue<Dim>& tissue, double dt_h) {
  auto& cells = tissue.cells;
  const Material<Dim>& material = tissue.material;
#pragma omp parallel for schedule(static)
  for (std::size_t i = 0; i < cells.size(); ++i) {
    const Mat<Dim>& gradient = tissue.velocity_gradient[i];
    const Mat<Dim>& before = tissue.deformation[i];
    const Mat<Dim> after = before + dt_h * gradient;
    const Mat<Dim> middle = 0.5 * (before + after);
    const Mat<Dim> l = dt_h * gradient * middle.inverse();
    const Mat<Dim> strain_matrix = 0.5 * (l + l.transpose());
    const Mat<Dim> frame = cayley_rotation<Dim>(0.5 * (l - l.transpose())) * cells.frame[i];
    const Voigt<Dim> strain = to_strain_voigt<Dim>(frame.transpose() * strain_matrix * frame);
    const double volume = cells.volume[i] * (after.determinant() / before.determinant());
    Voigt<Dim> stress = cells.stress[i];
    double mass = cells.mass[i];

    const Stiffness<Dim>& k = Varying ? (*material.stiffness)[i] : material.uniform;
    if constexpr (Law == TissueLaw::elastic_growth) {
      const double growth = Growing ? dt_h * (*material.softening)[i] / material.rho0_ug_mm3 : 0.0;
      const double gained = elastic_growth_step<Dim>(k, strain, growth, stress);
      if constexpr (Growing) mass *= 1.0 + gained;
    } else {
      const double reference = material.rho0_ug_mm3 * volume;  // mass at rho0
      if constexpr (Growing) {
        mass += dt_h * volume * mass_source((*material.softening)[i], mass / reference);
      }
      Voigt<Dim> deviatoric = (*material.deviatoric_stress)[i];
      stress = pressure_deviator_step<Dim>(k, strain, mass / reference, deviatoric);
      if constexpr (Step == MaterialStep::advance) (*material.deviatoric_stress)[i] = deviatoric;
    }
    tissue.nominal_force[i] = nominal_force_of<Dim>(frame, stress, volume, after.inverse(), tissue.pressure_MPa);
    tissue.force[i].setZero();
    if constexpr (Step == MaterialStep::advance) {
      cells.frame[i] = frame;
      cells.volume[i] = volume;
      cells.stress[i] = stress;
      cells.mass[i] = mass;
      tissue.axial_strain[i] += strain[0];
      tissue.deformation[i] = after;
    }
  }
}

template <int Dim, TissueLaw Law, MaterialStep Step>
MaterialLoop<Dim> choose_columns(const Material<Dim>& m) {
  if (m.stiffness) {
    return m.softening ? update_material<Dim, Law, true, true, Step> : update_material<Dim, Law, true, false, Step>;
  }
  return m.softening ? update_material<Dim, Law, false, true, Step> : update_material<Dim, Law, false, false, Step>;
}

template <int Dim, MaterialStep Step>
MaterialLoop<Dim> choose_law(const Material<Dim>& m) {
  return m.law == TissueLaw::elastic_growth ? choose_columns<Dim, TissueLaw::elastic_growth, Step>(m)
                                            : choose_columns<Dim, TissueLaw::pressure_deviator, Step>(m);
}

}  // namespace

template <>
Mat<2> cayley_rotation<2>(const Mat<2>& spin_times_dt) {
  const double t = 0.5 * spin_times_dt(1, 0);  // tan of half the angle
  const double c = (1.0 - t * t) / (1.0 + t * t), s = 2.0 * t / (1.0 + t * t);
  Mat<2> r;
  r << c, -s, s, c;
  return r;
}

template <>
Mat<3> cayley_rotation<3>(const Mat<3>& spin_times_dt) {
  const Mat<3> a = 0.5 * spin_times_dt;
  const double square = 0.5 * a.squaredNorm();  // |axial vector|^2
  return Mat<3>::Identity() + 2.0 / (1.0 + square) * (a + a * a);
}

template <int Dim>
MaterialLoop<Dim> choose_material_loop(const Material<Dim>& material, MaterialStep step) {
  return step == MaterialStep::advance ? choose_law<Dim, MaterialStep::advance>(material)
                                       : choose_law<Dim, MaterialStep::predict>(material);
}

template <int Dim>
void update_nominal_forces(Tissue<Dim>& tissue) {
  const auto& cells = tissue.cells;
#pragma omp parallel for schedule(static)
  for (std::size_t i = 0; i < cells.size(); ++i) {
    tissue.nominal_force[i] = nominal_force_of<Dim>(cells.frame[i], cells.stress[i], cells.volume[i],
                                                    tissue.deformation[i].inverse(), tissue.pressure_MPa);
    tissue.force[i].setZero();
  }
}

template MaterialLoop<2> choose_material_loop<2>(const Material<2>&, MaterialStep);
template MaterialLoop<3> choose_material_loop<3>(const Material<3>&, MaterialStep);
template void update_nominal_forces<2>(Tissue<2>&);
template void update_nominal_forces<3>(Tissue<3>&);

}  // namespace rootsoil
