// SPDX-License-Identifier: MIT
// Exact answers of the model for a straight root under uniform pressure: initial conditions and tests.
#pragma once

#include "root_sph/tissue/elasticity.hpp"

namespace rootsoil {

/// Strains at equilibrium under a uniform pressure differential, no growth.
/// Eq. 8 with p: axial p (1 - nu_A)/E_A, radial p (1/E_R - nu_A/E_A); 3D: (1 - 2 nu_A), (1 - nu_R)/E_R.
struct AxialRadial {
  double axial, radial;
};

template <int Dim>
AxialRadial equilibrium_strain(const Stiffness<Dim>& k, double p_MPa) {
  return {p_MPa * k[stiffness_entry::axial_trace], p_MPa * k[stiffness_entry::radial_trace]};
}

/// Strain rates of a root that grows freely, 1/h: lambda/rho0 times the strains above (elastic_growth, sigma = p 1), nothing
/// where these do not enlarge the cell: tissue under negative pressure does not grow back.
template <int Dim>
AxialRadial growth_rate(const Stiffness<Dim>& k, double p_MPa, double lambda_over_rho0_per_h) {
  const AxialRadial e = equilibrium_strain<Dim>(k, p_MPa);
  if (e.axial + (Dim - 1) * e.radial <= 0.0) return {0.0, 0.0};
  return {lambda_over_rho0_per_h * e.axial, lambda_over_rho0_per_h * e.radial};
}

}  // namespace rootsoil
