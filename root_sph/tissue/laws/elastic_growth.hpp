// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <cmath>

#include "root_sph/tissue/laws/law.hpp"

namespace rootsoil {

/// d sigma/dt = C : (D - D_g), D_g = phi (lambda/rho0) S : sigma; dm/dt = m tr(D_g).
///
/// phi = 1 where tissue is in tension, 0 where tr(S:sigma) <= 0. In between, where tr(S:sigma) is less than a tenth of
/// the sum of the elastic strains' magnitudes, it rises linearly: if it jumped, so would the stress that a step leaves
/// in a cell between tension and compression, and there would be no balance (docs/decisions/0021).
///
/// Eq. 2 with the direction of growth made explicit: the growth strain follows the elastic strain, so that an
/// isotropic tension p grows the tissue along S:1, the anisotropy that Eq. 1, 3 and 4 produce. It also relaxes
/// deviatoric stress in the growth zone.
template <int Dim>
struct ElasticGrowth {
  static constexpr int dimension = Dim;
  static constexpr std::string_view name = "elastic_growth";
  static constexpr std::string_view meaning = "full stress, growth along the elastic strain";
  static constexpr std::string_view source = "paper Eq. 1-4, docs/physics.md 3";
  static constexpr bool always_hyperbolic = true;  // C is symmetric and positive
  static constexpr std::array<LawColumn, 0> columns{};
  using State = LawState<Dim, columns.size()>;
  static constexpr double full_from = 0.1;  ///< tr(S:sigma) over the sum of magnitudes from which phi is 1

  /// Implicit in the growth term: sigma <- (sigma + C : strain)/(1 + dt lambda/rho0).
  static void step(const LawStep<Dim>& s, State& cell) {
    cell.stress += elastic_stress<Dim>(s.stiffness, s.strain);
    if (s.lambda_ug_mm3_h <= 0.0) return;
    const double tension = volume_strain<Dim>(s.stiffness, cell.stress);
    if (tension <= 0.0) return;
    const double share =
        std::min(1.0, tension / (full_from * elastic_strain<Dim>(s.stiffness, cell.stress).template lpNorm<1>()));
    const double growth = share * s.dt_h * s.lambda_ug_mm3_h / s.rho0_ug_mm3;
    cell.stress /= 1.0 + growth;
    cell.mass *= std::exp(growth * tension / (1.0 + growth));  // strains add up, so masses multiply
  }

  static VoigtMat<Dim> tangent(const Stiffness<Dim>& k) { return elastic_tangent<Dim>(k); }

  /// tr(S : sigma) is the volume strain rho0/rho - 1.
  static double density_ratio(const Stiffness<Dim>& k, double p_MPa) {
    return 1.0 / (1.0 + volume_strain<Dim>(k, isotropic<Dim>(p_MPa)));
  }

  static AxialRadial equilibrium_strain(const Stiffness<Dim>& k, double p_MPa) {
    return pressure_strain<Dim>(k, p_MPa);
  }

  /// lambda/rho0 times the strains above; tissue under negative pressure does not grow back.
  static AxialRadial growth_rate(const Stiffness<Dim>& k, double p_MPa, double lambda_over_rho0_per_h) {
    const AxialRadial e = pressure_strain<Dim>(k, p_MPa);
    if (e.axial + (Dim - 1) * e.radial <= 0.0) return {0.0, 0.0};
    return {lambda_over_rho0_per_h * e.axial, lambda_over_rho0_per_h * e.radial};
  }
};

}  // namespace rootsoil
