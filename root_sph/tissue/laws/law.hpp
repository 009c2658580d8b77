// SPDX-License-Identifier: MIT
// What a tissue law is: one file in this folder and one line in laws.hpp.
#pragma once

#include <array>
#include <concepts>
#include <cstddef>
#include <string_view>

#include "root_sph/tissue/elasticity.hpp"

namespace rootsoil {

/// One step of one cell, as the cell loop hands it to a law.
template <int Dim>
struct LawStep {
  const Stiffness<Dim>& stiffness;
  const Voigt<Dim>& strain;  ///< of the step, material frame, engineering shear
  double volume;             ///< at the end of the step
  double dt_h;               ///< length of the step
  double lambda_ug_mm3_h;    ///< softening; 0 where there is no growth
  double rho0_ug_mm3;        ///< density without stress
  double yield_MPa = 0.0;    ///< isotropic stress beyond which the volume grows
};

/// A symmetric tensor in the material frame that a law carries in every cell besides the stress. It belongs to the
/// material, not to an amount of it: both daughters of a division get it as it is.
struct LawColumn {
  std::string_view name, unit, meaning;
};

/// What a step changes; columns are zero in tissue that was never strained.
template <int Dim, std::size_t Columns>
struct LawState {
  Voigt<Dim> stress;  ///< MPa, material frame, tension positive
  double mass;        ///< biological mass
  std::array<Voigt<Dim>, Columns> columns;

  LawState(const Voigt<Dim>& stress_MPa, double mass_) : stress(stress_MPa), mass(mass_) {
    for (Voigt<Dim>& column : columns) column.setZero();
  }
};

/// Everything that the program asks of a law; the functions are pure but for the state that step advances.
template <class Law>
concept IsTissueLaw = requires(const Stiffness<Law::dimension>& k, const LawStep<Law::dimension>& step,
                               typename Law::State& state, double p_MPa, double lambda_over_rho0_per_h,
                               double yield_MPa) {
  // its name in the scene file, what it is in a line, and where it comes from
  { Law::name } -> std::convertible_to<std::string_view>;
  { Law::meaning } -> std::convertible_to<std::string_view>;
  { Law::source } -> std::convertible_to<std::string_view>;
  // whether waves travel in every tissue (hyperbolicity.hpp); false: in some they grow by themselves, and scenes are
  // scanned
  { Law::always_hyperbolic } -> std::convertible_to<bool>;
  // what it carries from step to step
  { Law::columns[0] } -> std::convertible_to<LawColumn>;
  { Law::step(step, state) } -> std::same_as<void>;
  // d stress/d strain of a step without growth, from the state without stress
  { Law::tangent(k) } -> std::same_as<VoigtMat<Law::dimension>>;
  // rho/rho0 of a cell that rests with sigma = p 1
  { Law::density_ratio(k, p_MPa) } -> std::same_as<double>;
  // closed form of a straight root with sigma = p 1: logarithmic strains without growth, and strain rates with it, 1/h
  { Law::equilibrium_strain(k, p_MPa) } -> std::same_as<AxialRadial>;
  { Law::growth_rate(k, p_MPa, lambda_over_rho0_per_h, yield_MPa) } -> std::same_as<AxialRadial>;
};

}  // namespace rootsoil
