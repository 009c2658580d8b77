// SPDX-License-Identifier: MIT
#pragma once

#include <cmath>

#include "root_sph/tissue/laws/law.hpp"

namespace rootsoil {

/// sigma = tau - P 1, P = K (rho/rho0 - 1), d tau/dt = Lambda C : D, dm/dt = V lambda (rho0/rho - rho0/rho_Y) where
/// that is positive, rho_Y = rho0 (1 - Y/K): 1 and Eq. 2 without a yield stress.
///
/// Lambda takes the isotropic part away. Its tangent K 1(x)1 + Lambda C is not symmetric unless C:1 is parallel to 1,
/// and in anisotropic tissue waves grow by themselves: from E_R/E_A = 2.7 (3D: 3.0) with Table 1's nu and its default
/// for G, earlier with a smaller G.
template <int Dim>
struct PressureDeviator {
  static constexpr int dimension = Dim;
  static constexpr std::string_view name = "pressure_deviator";
  static constexpr std::string_view meaning = "Eq. 1-4 to the letter";
  static constexpr std::string_view source = "paper Eq. 1-4";
  static constexpr bool always_hyperbolic = false;
  static constexpr std::array<LawColumn, 1> columns{{{"deviatoric_stress", "MPa", "tau of Eq. 1, material frame"}}};
  using State = LawState<Dim, columns.size()>;

  static void step(const LawStep<Dim>& s, State& cell) {
    const double mass_at_rho0 = s.rho0_ug_mm3 * s.volume;
    cell.mass = mass_at_rho0 * grown_density_ratio(cell.mass / mass_at_rho0, s.dt_h * s.lambda_ug_mm3_h / s.rho0_ug_mm3,
                                                   density_ratio(s.stiffness, s.yield_MPa));
    Voigt<Dim>& deviatoric = cell.columns[0];
    deviatoric += deviator<Dim>(elastic_stress<Dim>(s.stiffness, s.strain));
    cell.stress = deviatoric;
    cell.stress.template head<Dim>().array() -= bulk_modulus<Dim>(s.stiffness) * (cell.mass / mass_at_rho0 - 1.0);
  }

  /// Eq. 2: mass source per volume, ug/(mm^3 h); zero where the tissue is denser than at yield, rho/rho0 = `at_yield`.
  static double mass_source(double lambda_ug_mm3_h, double density_ratio, double at_yield = 1.0) {
    const double stretch = 1.0 / density_ratio - 1.0 / at_yield;
    return stretch > 0.0 ? lambda_ug_mm3_h * stretch : 0.0;
  }

  /// rho/rho0 after a step of Eq. 2 at constant volume, with the source at the step's end: r = r0 + a (1/r - 1/r_Y),
  /// a = lambda dt/rho0. With the source at its start, before the mass of the step is there, growth is too fast by the
  /// factor 1 + a.
  static double grown_density_ratio(double density_ratio, double lambda_dt_over_rho0, double at_yield = 1.0) {
    if (density_ratio >= at_yield) return density_ratio;
    const double b = density_ratio - lambda_dt_over_rho0 / at_yield;
    return 0.5 * (b + std::sqrt(b * b + 4.0 * lambda_dt_over_rho0));
  }

  static VoigtMat<Dim> tangent(const Stiffness<Dim>& k) {
    VoigtMat<Dim> a = elastic_tangent<Dim>(k);
    for (int column = 0; column < voigt_size<Dim>; ++column) a.col(column) = deviator<Dim>(a.col(column));
    a.template topLeftCorner<Dim, Dim>().array() += bulk_modulus<Dim>(k);
    return a;
  }

  /// -P = p without deviatoric stress.
  static double density_ratio(const Stiffness<Dim>& k, double p_MPa) { return 1.0 - p_MPa / bulk_modulus<Dim>(k); }

  /// Without deviatoric stress the strain is along S:1, and its trace is log(rho0/rho).
  static AxialRadial equilibrium_strain(const Stiffness<Dim>& k, double p_MPa) {
    return pressure_strain<Dim>(k, -bulk_modulus<Dim>(k) * std::log(density_ratio(k, p_MPa)));
  }

  /// At constant density the volume grows as the mass does, by lambda/rho (rho0/rho - 1), and again along S:1.
  static AxialRadial growth_rate(const Stiffness<Dim>& k, double p_MPa, double lambda_over_rho0_per_h,
                                 double yield_MPa = 0.0) {
    const double ratio = density_ratio(k, p_MPa), at_yield = density_ratio(k, yield_MPa);
    return pressure_strain<Dim>(k, bulk_modulus<Dim>(k) * mass_source(lambda_over_rho0_per_h, ratio, at_yield) / ratio);
  }
};

}  // namespace rootsoil
