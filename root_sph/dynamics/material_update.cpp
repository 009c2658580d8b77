// SPDX-License-Identifier: MIT
#include "root_sph/dynamics/material_update.hpp"

#include "root_sph/tissue/laws.hpp"

namespace rootsoil {
namespace {

template <int Dim>
Mat<Dim> nominal_force_of(const ParticleStore<Dim>& cells, std::size_t i, const Mat<Dim>& inverse_deformation,
                          double pressure_MPa) {
  Mat<Dim> total = cells.frame[i] * to_matrix<Dim>(cells.stress[i]) * cells.frame[i].transpose();
  total.diagonal().array() -= pressure_MPa;
  return cells.volume[i] * total * inverse_deformation.transpose();
}

template <int Dim, TissueLaw Law, bool Varying, bool Growing>
void update_material(Tissue<Dim>& tissue, double dt_h) {
  auto& cells = tissue.cells;
  const Material<Dim>& material = tissue.material;
#pragma omp parallel for schedule(static)
  for (std::size_t i = 0; i < cells.size(); ++i) {
    const Mat<Dim>& gradient = tissue.velocity_gradient[i];
    const Mat<Dim> before = tissue.deformation[i];
    const Mat<Dim> after = before + dt_h * gradient;
    const Mat<Dim> middle = 0.5 * (before + after);
    const Mat<Dim> l = dt_h * gradient * middle.inverse();
    const Mat<Dim> strain_matrix = 0.5 * (l + l.transpose());
    cells.frame[i] = (cayley_rotation<Dim>(0.5 * (l - l.transpose())) * cells.frame[i]).eval();
    const Mat<Dim>& frame = cells.frame[i];
    const Voigt<Dim> strain = to_strain_voigt<Dim>(frame.transpose() * strain_matrix * frame);
    tissue.axial_strain[i] += strain[0];
    tissue.deformation[i] = after;
    cells.volume[i] *= after.determinant() / before.determinant();

    const Stiffness<Dim>& k = Varying ? (*material.stiffness)[i] : material.uniform;
    if constexpr (Law == TissueLaw::elastic_growth) {
      const double growth = Growing ? dt_h * (*material.softening)[i] / material.rho0_ug_mm3 : 0.0;
      const double gained = elastic_growth_step<Dim>(k, strain, growth, cells.stress[i]);
      if constexpr (Growing) cells.mass[i] *= 1.0 + gained;
    } else {
      const double reference = material.rho0_ug_mm3 * cells.volume[i];  // mass at rho0
      if constexpr (Growing) {
        cells.mass[i] += dt_h * cells.volume[i] * mass_source((*material.softening)[i], cells.mass[i] / reference);
      }
      cells.stress[i] =
          pressure_deviator_step<Dim>(k, strain, cells.mass[i] / reference, (*material.deviatoric_stress)[i]);
    }
    tissue.nominal_force[i] = nominal_force_of<Dim>(cells, i, after.inverse(), tissue.pressure_MPa);
    tissue.force[i].setZero();
  }
}

template <int Dim, TissueLaw Law>
MaterialLoop<Dim> choose_columns(const Material<Dim>& m) {
  if (m.stiffness) return m.softening ? update_material<Dim, Law, true, true> : update_material<Dim, Law, true, false>;
  return m.softening ? update_material<Dim, Law, false, true> : update_material<Dim, Law, false, false>;
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
MaterialLoop<Dim> choose_material_loop(const Material<Dim>& material) {
  return material.law == TissueLaw::elastic_growth ? choose_columns<Dim, TissueLaw::elastic_growth>(material)
                                                   : choose_columns<Dim, TissueLaw::pressure_deviator>(material);
}

template <int Dim>
void update_nominal_forces(Tissue<Dim>& tissue) {
#pragma omp parallel for schedule(static)
  for (std::size_t i = 0; i < tissue.cells.size(); ++i) {
    tissue.nominal_force[i] =
        nominal_force_of<Dim>(tissue.cells, i, tissue.deformation[i].inverse(), tissue.pressure_MPa);
    tissue.force[i].setZero();
  }
}

template MaterialLoop<2> choose_material_loop<2>(const Material<2>&);
template MaterialLoop<3> choose_material_loop<3>(const Material<3>&);
template void update_nominal_forces<2>(Tissue<2>&);
template void update_nominal_forces<3>(Tissue<3>&);

}  // namespace rootsoil
