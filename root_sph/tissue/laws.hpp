// SPDX-License-Identifier: MIT
// The two tissue laws, for one cell and one step. Pure functions.
#pragma once

#include "root_sph/tissue/elasticity.hpp"

namespace rootsoil {

/// elastic_growth: d sigma/dt = C : (D - D_g), D_g = (lambda/rho0) S : sigma where tr(S:sigma) > 0, else 0.
///
/// Eq. 2 with the direction of growth made explicit: the growth strain follows the elastic strain, so that an
/// isotropic tension p grows the tissue along S:1, the anisotropy that Eq. 1, 3 and 4 produce. It also relaxes
/// deviatoric stress in the growth zone. Integrated implicitly in the growth term:
/// sigma <- (sigma + C : strain) / (1 + dt lambda/rho0).
///
/// \param strain      total strain of the step in the material frame, engineering shear
/// \param growth      dt lambda/rho0, 0 where there is no growth
/// \param[in,out] stress MPa, material frame, tension positive
/// \return tr(D_g) dt, the relative increase of mass in the step
template <int Dim>
double elastic_growth_step(const Stiffness<Dim>& k, const Voigt<Dim>& strain, double growth, Voigt<Dim>& stress) {
  stress += elastic_stress<Dim>(k, strain);
  if (growth <= 0.0) return 0.0;
  const double tension = volume_strain<Dim>(k, stress);
  if (tension <= 0.0) return 0.0;
  stress /= 1.0 + growth;
  return growth * tension / (1.0 + growth);
}

/// pressure_deviator, the paper's Eq. 1-4 to the letter: P = K (rho/rho0 - 1), d tau/dt = Lambda C : D.
/// K 1(x)1 + Lambda C is not symmetric; see hyperbolicity.hpp before using it.
///
/// \param density_ratio rho/rho0 at the end of the step
/// \param[in,out] deviatoric tau, MPa
/// \return the full stress tau - P 1, tension positive
template <int Dim>
Voigt<Dim> pressure_deviator_step(const Stiffness<Dim>& k, const Voigt<Dim>& strain, double density_ratio,
                                  Voigt<Dim>& deviatoric) {
  deviatoric += deviator<Dim>(elastic_stress<Dim>(k, strain));
  Voigt<Dim> stress = deviatoric;
  stress.template head<Dim>().array() -= bulk_modulus<Dim>(k) * (density_ratio - 1.0);
  return stress;
}

/// Eq. 2: mass source per volume, ug/(mm^3 h); zero in compression.
inline double mass_source(double lambda_ug_mm3_h, double density_ratio) {
  const double stretch = 1.0 / density_ratio - 1.0;
  return stretch > 0.0 ? lambda_ug_mm3_h * stretch : 0.0;
}

}  // namespace rootsoil
