// SPDX-License-Identifier: MIT
// A prescribed force on a part of the root, as a force sensor or a weight exerts it.
#pragma once

#include "root_sph/effects/effect_spec.hpp"

namespace rootsoil {

struct ForceSection {
  std::optional<double> axial_N;                  ///< along the root; positive pushes back
  std::optional<std::array<double, 3>> vector_N;  ///< fixed in space
  Rows table;                                     ///< (h, factor); empty: 1
  std::array<double, 2> distance_to_tip_mm{};     ///< the band that it acts on; after reading not empty
};

/// Acts on the cells of the band, shared by their volumes at the window's start. Axial forces follow the axis of each
/// cell.
template <int Dim>
class ForceEffect final : public Effect<Dim> {
 public:
  ForceEffect(Solver<Dim>& solver, ForceSection force);
  Vec<Dim> external_force_N() const override { return applied_N_; }
  Vec<Dim> tip_force_N(double within_mm) const override;
  std::vector<std::pair<std::string, double>> history() const override;

 private:
  const Solver<Dim>& solver_;
  ForceSection force_;
  std::vector<std::size_t> loaded_;  ///< cells of the band, in the window under way
  std::vector<double> weight_;       ///< of each; together 1
  std::vector<Vec<Dim>> share_N_;    ///< on each of them, at the latest forces; empty before
  Vec<Dim> applied_N_ = Vec<Dim>::Zero();
};

EffectSpec force_effect();

}  // namespace rootsoil
