// SPDX-License-Identifier: MIT
// Mature tissue that does not move falls asleep: from the base up to a margin beyond the last cell that moves or grows,
// cells leave all loops. Those of the margin are held, as at the base, and go on as partners of the cells that move.
// When the axial stress of the margin changes (thrust, bending, a neighbour that moves), or the pressure differential,
// or the soil's force on a cell that sleeps, all wake. Cells in contact with an obstacle do not fall asleep; those
// among grains do: their markers stand still, and the force on them goes to the cells as ever.
#pragma once

#include "root_sph/effects/effect_spec.hpp"

namespace rootsoil {

/// Mature tissue that does not move leaves all loops.
struct SleepSection {
  std::optional<double> strain_rate_per_h;
  std::optional<double> mean_over_h;    ///< absent: ten windows, two without inertia
  std::optional<double> stress_change;  ///< over the pressure differential
};

struct SleepParameters {
  /// Cells that strain no faster along the root, and move no faster than this times its length, do not move: mean from
  /// look to look.
  double strain_rate_per_h = 1e-4;
  std::int64_t windows_between_looks = 10;
  /// Of axial stress of held cells, or of the soil's force on the face of one that sleeps, over the pressure
  /// differential, that wakes the root.
  double stress_change = 0.05;
};

template <int Dim>
class SleepEffect final : public Effect<Dim> {
 public:
  /// \param effects of the scene: what they push with is what wakes the root
  SleepEffect(Solver<Dim>& solver, SleepParameters parameters, const EffectList<Dim>& effects);

  void prepare() override;
  void add_columns(const Tissue<Dim>& tissue, std::vector<FrameColumn>& columns) const override;

  void save(NamedReals& reals) const override;
  void restore(const NamedReals& reals) override;
  std::vector<std::pair<std::string, double>> history() const override;

 private:
  /// e of the non-affine control between two cells of which one rests at least.
  struct RestingSlip {
    std::int64_t first_id, second_id;  ///< first < second
    PairSlip<Dim> slip_mm;             ///< from the first to the second
  };

  void carry_resting(Tissue<Dim>& tissue);
  bool moves(const Tissue<Dim>& tissue, std::size_t cell) const;
  void look(Tissue<Dim>& tissue);
  void fall_asleep(Tissue<Dim>& tissue);
  void keep_slips(const Tissue<Dim>& tissue, const std::vector<char>& goes_to_rest);
  void give_slips_back(const Tissue<Dim>& tissue);
  void wake(Tissue<Dim>& tissue);
  void watch(const Tissue<Dim>& tissue);

  /// A force from outside that cells at rest feel as well.
  struct Load {
    const Field<Dim, Vec<Dim>>* now;
    Field<Dim, Vec<Dim>>* asleep;  ///< when the cell fell asleep
  };

  Solver<Dim>& solver_;
  SleepParameters parameters_;
  const EffectList<Dim>& effects_;
  std::vector<Load> loads_;
  Field<Dim, std::int64_t>& asleep_;              ///< 1 from when the cell falls asleep until the root wakes
  Field<Dim, std::int64_t>& neighbours_at_rest_;  ///< when the cell went to rest
  Field<Dim, Vec<Dim>>& looked_at_;               ///< mm, place at the latest look
  Field<Dim, double>& strain_;                    ///< axial, since the latest look
  Field<Dim, double>& stress_asleep_;             ///< MPa, axial, of held cells when they fell asleep
  std::vector<RestingSlip> slips_;
  std::int64_t windows_ = 0;       ///< since the start, or since the root woke
  double looked_h_ = 0.0;          ///< time of the latest look
  double asleep_beyond_mm_ = 0.0;  ///< of the tip: where cells fall asleep before the next window; 0: none do
  double rest_beyond_mm_ = 0.0;    ///< and where they go to rest
  double length_mm_ = 0.0;         ///< at the latest update of the resting cells' distances
  double pressure_MPa_ = 0.0;      ///< when cells fell asleep
  double perceived_MPa_ = 0.0;     ///< then, what parameters respond to
  bool wake_wanted_ = false;       ///< before the next window
  bool slips_wanted_ = false;      ///< in this window
  std::int64_t woken_ = 0;         ///< times
};

EffectSpec sleep_effect();

}  // namespace rootsoil
