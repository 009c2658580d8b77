// SPDX-License-Identifier: MIT
// Cells divide across their longest axis when it passes a threshold that varies along the root (4.2, Eq. 6).
#pragma once

#include "root_sph/effects/effect_spec.hpp"

namespace rootsoil {

struct DivisionSection {
  double l0_mm = 0.0, c_d = 1.0, s_d_per_mm2 = 0.0, x_d_mm = 0.0;
  std::optional<double> constant_beyond_mm{}, ends_at_mm{};
  Rows table{};  ///< distance from the tip, threshold, mm; empty: Eq. 6
  double scatter = 0.0;
  bool asynchronous = false;
};

/// Division threshold of the longest axis, mm: that of the table, or l(s) = l0 (c_d + s_d (s - x_d)^2), constant beyond
/// a distance (Eq. 6, third). Infinite beyond where division ends.
double division_threshold_mm(const DivisionSection& division, double s_mm);

/// What a cell's threshold is times that of its place. Each cell has its own, at random: with a standard deviation of
/// `scatter` in its logarithm, drawn anew for each daughter, since the sizes at which a plant cell and its mother
/// divide are hardly correlated (Willis et al., PNAS 113, E8238, 2016). A pure function of the numbers of the cell:
/// nothing is kept, and a resumed run draws the same. \param seed of the scene
double division_factor(const DivisionSection& division, std::int64_t seed, std::int64_t cell_id);

/// Mean length of the cells of a steady population over the threshold of its place. Cells grow at one rate, and their
/// number doubles with their length, so that there are 1/l^2 dl of a length l between half of the threshold and the
/// threshold, whose mean is ln 2 (docs/decisions/0023). The threshold is that of the cells which divide: those with a
/// shorter one do so sooner and outnumber the others by 1/threshold, so a scatter takes exp(-scatter^2/2) besides.
double mean_length_over_threshold(const DivisionSection& division);

/// Moves the cells of a file along the root, by a little, so that gaps and overlaps between them even out. Spacing and
/// cell length drift apart by a per cent where the growth rate varies, and a gap doubles relative to its cells in every
/// generation until the file is torn (docs/decisions/0007). Pair by pair and opposite, so the centroid of a file stays.
/// Uses the pairs of the window; runs at its end.
template <int Dim>
void even_out_spacing(Solver<Dim>& solver);

/// Tells growth, however fast, from cells that divide without ever getting below their threshold.
/// \param shorter how many times shorter cells are now than at the start: mean volume^(1/Dim)
/// \return what is wrong; empty: nothing
std::string runaway_division(std::size_t cells, double shorter);

template <int Dim>
class DivisionEffect final : public Effect<Dim> {
 public:
  DivisionEffect(Solver<Dim>& solver, const DivisionSection& division, std::int64_t seed);

 private:
  void divide(Tissue<Dim>& tissue) const;
  void refuse_runaway(const Tissue<Dim>& tissue, const std::vector<char>& divides) const;
  double threshold_mm(const Tissue<Dim>& tissue, std::size_t cell, double s_mm) const;
  double due_above_mm(const Tissue<Dim>& tissue, std::size_t cell) const;

  const Solver<Dim>& solver_;
  DivisionSection division_;
  std::int64_t seed_;
  double mean_volume_;  ///< of a cell at the start
};

EffectSpec division_effect();

/// How many cells one becomes that divides until no axis is longer than the threshold.
template <int Dim>
double cells_when_divided(const Mat<Dim>& shape, double threshold_mm);

}  // namespace rootsoil
