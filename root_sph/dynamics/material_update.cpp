// SPDX-License-Identifier: MIT
#include "root_sph/dynamics/material_update.hpp"

#include "root_sph/core/choose.hpp"

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

template <int Dim, class Law, bool Varying, bool Growing, bool Yielding, bool Advancing>
void update_material(Tissue<Dim>& tissue, double dt_h) {
  auto& cells = tissue.cells;
  const Material<Dim>& material = tissue.material;
#pragma omp parallel for schedule(static)
  for (std::size_t i = 0; i < cells.size(); ++i) {
    const Mat<Dim>& gradient = tissue.velocity_gradient[i];
    const Mat<Dim>& before = tissue.deformation[i];
    const Mat<Dim> after = before + dt_h * gradient;
    const Mat<Dim> increment = dt_h * gradient * before.inverse();
    const Mat<Dim> frame = step_rotation<Dim>(increment) * cells.frame[i];
    const Voigt<Dim> strain =
        to_strain_voigt<Dim>(cells.frame[i].transpose() * step_strain<Dim>(increment) * cells.frame[i]);
    const double volume = cells.volume[i] * (after.determinant() / before.determinant());
    const Stiffness<Dim>& k = Varying ? (*material.stiffness)[i] : material.uniform;
    const double lambda = Growing ? (*material.softening)[i] : 0.0;
    const double yield_MPa = Yielding ? (*material.yield)[i] : 0.0;
    typename Law::State state(cells.stress[i], cells.mass[i]);
    for (std::size_t c = 0; c < Law::columns.size(); ++c) state.columns[c] = (*material.law_columns[c])[i];
    Law::step({k, strain, volume, dt_h, lambda, material.rho0_ug_mm3, yield_MPa}, state);

    tissue.nominal_force[i] = nominal_force_of<Dim>(frame, state.stress, volume, after.inverse(), tissue.pressure_MPa);
    tissue.force[i].setZero();
    if constexpr (Advancing) {
      cells.frame[i] = frame;
      cells.volume[i] = volume;
      cells.stress[i] = state.stress;
      cells.mass[i] = state.mass;
      for (std::size_t c = 0; c < Law::columns.size(); ++c) (*material.law_columns[c])[i] = state.columns[c];
      tissue.axial_strain[i] += strain[0];
      tissue.deformation[i] = after;
    }
  }
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
Mat<Dim> step_rotation(const Mat<Dim>& increment) {
  const Mat<Dim> l = 2.0 * increment * (2.0 * Mat<Dim>::Identity() + increment).inverse();
  return cayley_rotation<Dim>(0.5 * (l - l.transpose()));
}

template <int Dim>
Mat<Dim> step_strain(const Mat<Dim>& increment) {
  const Mat<Dim> twice = increment + increment.transpose() + increment.transpose() * increment;  // F^T F - 1
  const Mat<Dim> tanh = twice * (2.0 * Mat<Dim>::Identity() + twice).inverse();                  // of ln U
  return tanh + tanh * tanh * tanh / 3.0;
}

template <int Dim>
MaterialLoop<Dim> choose_material_loop(const Material<Dim>& material, MaterialStep step) {
  return visit_law<Dim>(material.law, [&]<class Law>(Law) {
    return choose(material.stiffness != nullptr, [&](auto varying) {
      return choose(material.softening != nullptr, [&](auto growing) {
        return choose(material.yield != nullptr, [&](auto yielding) {
          return choose(step == MaterialStep::advance, [&](auto advancing) -> MaterialLoop<Dim> {
            return update_material < Dim, Law, varying, growing, growing && yielding, advancing > ;
          });
        });
      });
    });
  });
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

template Mat<2> step_rotation<2>(const Mat<2>&);
template Mat<3> step_rotation<3>(const Mat<3>&);
template Mat<2> step_strain<2>(const Mat<2>&);
template Mat<3> step_strain<3>(const Mat<3>&);
template MaterialLoop<2> choose_material_loop<2>(const Material<2>&, MaterialStep);
template MaterialLoop<3> choose_material_loop<3>(const Material<3>&, MaterialStep);
template void update_nominal_forces<2>(Tissue<2>&);
template void update_nominal_forces<3>(Tissue<3>&);

}  // namespace rootsoil
