// SPDX-License-Identifier: MIT
// Growth and anisotropy follow the soil's strength (the paper's Eq. 7, scene/response.hpp): that of the prescribed
// pressure, or what the root perceives of the bodies that it meets.
#pragma once

#include "root_sph/effects/effect_spec.hpp"
#include "root_sph/scene/response.hpp"

namespace rootsoil {

/// The solution of dq/dt = (now - q)/over_h after dt_h, where `now` stays as it is; over_h = 0: at once.
double low_pass(double q, double now, double dt_h, double over_h);

/// Sets Tissue::tip_thrust_MPa at each window's end: what bodies outside exert on the root's tip, against its growth,
/// over its mean section, through a low pass. What responds follows it in the next window: the balance of a window is
/// found with parameters that are given.
template <int Dim>
class PerceptionEffect final : public Effect<Dim> {
 public:
  /// \param effects of the run, also those that are still to be built
  PerceptionEffect(Solver<Dim>& solver, const EffectList<Dim>& effects, const ResponseSection& response);
  void save(NamedReals& reals) const override;
  void restore(const NamedReals& reals) override;
  std::vector<std::pair<std::string, double>> history() const override;

 private:
  double tip_thrust_MPa() const;  ///< now

  Solver<Dim>& solver_;
  const EffectList<Dim>& effects_;
  double tip_length_mm_;
};

EffectSpec response_effect();

}  // namespace rootsoil
