// SPDX-License-Identifier: MIT
#include "root_sph/dynamics/pair_terms.hpp"

#include <algorithm>
#include <cmath>

namespace rootsoil {
template <int Dim>
PairTerms<Dim> make_pair_terms(ParticleStore<Dim>& cells, double E_axial_MPa, std::optional<double> non_affine_damping,
                               double non_affine_stiffness, double artificial_viscosity) {
  PairTerms<Dim> terms;
  if (non_affine_damping) {
    terms.non_affine.emplace(NonAffineControl<Dim>{
        *non_affine_damping,
        non_affine_stiffness * E_axial_MPa,
        {},
        {},
        &cells.template declare<Vec<Dim>>({"start_position", "mm", "at the start of the window", Storage::scratch},
                                          on_division::recomputed<Dim, Vec<Dim>>),
        &cells.template declare<Mat<Dim>>({"start_frame", "1", "at the start of the window", Storage::scratch},
                                          on_division::recomputed<Dim, Mat<Dim>>)});
  }
  if (artificial_viscosity > 0.0) terms.viscosity = ArtificialViscosity{artificial_viscosity};
  if (terms.damps()) {
    terms.damping = &cells.template declare<double>(
        {"pair_damping", "N h/mm^2", "damping constant of pair motions", Storage::scratch},
        on_division::recomputed<Dim, double>);
  }
  return terms;
}

template <int Dim>
void set_slip_retention(const Tissue<Dim>& tissue, PairTerms<Dim>& terms) {
  const auto* const softening = tissue.material.softening;
  if (!terms.non_affine || !softening) return;
  const auto& pairs = tissue.pairs.pairs;
  terms.non_affine->retention.resize(pairs.size());
#pragma omp parallel for schedule(static)
  for (std::size_t k = 0; k < pairs.size(); ++k) {
    const auto [i, j] = pairs[k];
    const double rate = slip_creep_ratio * 0.5 * ((*softening)[i] + (*softening)[j]) / tissue.material.rho0_ug_mm3;
    terms.non_affine->retention[k] = 1.0 / (1.0 + tissue.step_h * rate);
  }
}

template <int Dim>
void rebuild_pair_terms(const Tissue<Dim>& tissue, const PairList& old_pairs, PairTerms<Dim>& terms) {
  if (!terms.any()) return;
  const auto& cells = tissue.cells;
  const auto& pairs = tissue.pairs.pairs;
  terms.weight.resize(pairs.size());
  std::vector<PairSlip<Dim>> slip;
  if (terms.non_affine) slip.assign(pairs.size(), PairSlip<Dim>::Zero());

#pragma omp parallel for schedule(static)
  for (std::size_t k = 0; k < pairs.size(); ++k) {
    const auto [i, j] = pairs[k];
    const double r2 = (cells.position[j] - cells.position[i]).squaredNorm();
    const double smaller = std::min(cells.volume[i], cells.volume[j]);
    terms.weight[k] = cells.volume[i] * cells.volume[j] * tissue.kernel[k] / (r2 + 0.3 * std::pow(smaller, 2.0 / Dim));

    if (!terms.non_affine) continue;
    std::int64_t a = tissue.window_index[i], b = tissue.window_index[j];
    if (a < 0 || b < 0) continue;  // a new cell has no history
    const bool turned_round = a > b;
    if (turned_round) std::swap(a, b);
    const auto first = old_pairs.pairs.begin() + old_pairs.row[a];
    const auto last = old_pairs.pairs.begin() + old_pairs.row[a + 1];
    const auto found = std::lower_bound(first, last, b, [](const Pair& p, std::int64_t key) { return p.j < key; });
    if (found == last || found->j != b) continue;
    const Mat<Dim> turn = cells.frame[i] * (*terms.non_affine->start_frame)[i].transpose();
    const PairSlip<Dim>& old = terms.non_affine->slip_mm[found - old_pairs.pairs.begin()];
    slip[k] = turn * (turned_round ? reversed<Dim>(old) : old);
  }
  if (terms.non_affine) terms.non_affine->slip_mm.swap(slip);
  set_slip_retention<Dim>(tissue, terms);
}

template PairTerms<2> make_pair_terms<2>(ParticleStore<2>&, double, std::optional<double>, double, double);
template PairTerms<3> make_pair_terms<3>(ParticleStore<3>&, double, std::optional<double>, double, double);
template void set_slip_retention<2>(const Tissue<2>&, PairTerms<2>&);
template void set_slip_retention<3>(const Tissue<3>&, PairTerms<3>&);
template void rebuild_pair_terms<2>(const Tissue<2>&, const PairList&, PairTerms<2>&);
template void rebuild_pair_terms<3>(const Tissue<3>&, const PairList&, PairTerms<3>&);

}  // namespace rootsoil
