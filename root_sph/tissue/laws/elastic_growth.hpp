// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <cmath>

#include "root_sph/tissue/laws/law.hpp"
#include "root_sph/tissue/relaxation.hpp"

namespace rootsoil {

/// d sigma/dt = C : (D - D_g), D_g = (lambda/rho0) S : (sigma - b 1), b = min(Y, pi), pi = K tr(S:sigma);
/// dm/dt = m tr(D_g) = m (lambda/rho0) (rho0/rho - 1 - Y/K)+.
///
/// Eq. 2 with the direction of growth made explicit and with a threshold Y: the growth strain follows the elastic
/// strain beyond that of Y 1, so that an isotropic tension p grows the tissue along S:1, the anisotropy that Eq. 1, 3
/// and 4 produce, at a rate in proportion to p - Y (Lockhart, Ortega).
///
/// pi is the isotropic stress that holds the cell's volume. Where it is below Y nothing grows, as Eq. 2 says, but shape
/// flows as it does above: a soft wall yields in shear under any pressure, and a cell keeps its water. The rate is
/// continuous there, and what is dissipated, (sigma - b 1):S:(sigma - b 1) and what lifts pi above Y > 0, is never
/// negative (docs/decisions/0024).
template <int Dim>
struct ElasticGrowth {
  static constexpr int dimension = Dim;
  static constexpr std::string_view name = "elastic_growth";
  static constexpr std::string_view meaning = "full stress, growth along the elastic strain";
  static constexpr std::string_view source = "paper Eq. 1-4, docs/physics.md 3";
  static constexpr bool always_hyperbolic = true;  // C is symmetric and positive
  static constexpr std::array<LawColumn, 0> columns{};
  using State = LawState<Dim, columns.size()>;

  /// Exact where strain comes at a constant rate. sigma = pi 1 + s, and C : strain likewise: the shape's part s always
  /// relaxes, the volume's where pi > Y.
  static void step(const LawStep<Dim>& s, State& cell) {
    const Voigt<Dim> elastic = elastic_stress<Dim>(s.stiffness, s.strain);
    if (s.lambda_ug_mm3_h <= 0.0) {
      cell.stress += elastic;
      return;
    }
    const double relaxed_times = s.dt_h * s.lambda_ug_mm3_h / s.rho0_ug_mm3;
    const auto [kept, gained] = relaxation(relaxed_times);
    const double bulk = bulk_modulus<Dim>(s.stiffness), yield = s.yield_MPa / bulk,
                 tension = volume_strain<Dim>(s.stiffness, cell.stress) - yield,
                 strain = volume_strain<Dim>(s.stiffness, elastic);
    const double tension_after = relaxed_tension(tension, strain, relaxed_times);
    cell.stress = kept * cell.stress + gained * elastic;
    cell.stress.template head<Dim>().array() +=
        bulk * (tension_after + yield - kept * (tension + yield) - gained * strain);
    cell.mass *= std::exp(tension + strain - tension_after);  // strains add up, so masses multiply
  }

  static VoigtMat<Dim> tangent(const Stiffness<Dim>& k) { return elastic_tangent<Dim>(k); }

  /// tr(S : sigma) is the volume strain rho0/rho - 1.
  static double density_ratio(const Stiffness<Dim>& k, double p_MPa) {
    return 1.0 / (1.0 + volume_strain<Dim>(k, isotropic<Dim>(p_MPa)));
  }

  static AxialRadial equilibrium_strain(const Stiffness<Dim>& k, double p_MPa) {
    return pressure_strain<Dim>(k, p_MPa);
  }

  /// lambda/rho0 times the strains that p has beyond the yield stress; tissue below it does not grow back.
  static AxialRadial growth_rate(const Stiffness<Dim>& k, double p_MPa, double lambda_over_rho0_per_h,
                                 double yield_MPa = 0.0) {
    const AxialRadial e = pressure_strain<Dim>(k, std::max(0.0, p_MPa - yield_MPa));
    return {lambda_over_rho0_per_h * e.axial, lambda_over_rho0_per_h * e.radial};
  }
};

}  // namespace rootsoil
