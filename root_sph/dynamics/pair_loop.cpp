// SPDX-License-Identifier: MIT
#include "root_sph/dynamics/pair_loop.hpp"

namespace rootsoil {
namespace {

template <int Dim, bool NonAffine, bool Viscous>
void add_forces(Tissue<Dim>& tissue, PairTerms<Dim>& terms, SlipAdvance advance) {
  const Pair* const pairs = tissue.pairs.pairs.data();
  const PairGradient<Dim>* const gradients = tissue.gradients.data();
  const Mat<Dim>* const nominal = tissue.nominal_force.values().data();
  Vec<Dim>* const force = tissue.force.values().data();
  const Vec<Dim>* const velocity = tissue.cells.velocity.values().data();

  for_each_block(tissue.pairs, [&](const PairBlock& block) {
    for (std::int64_t k = block.first_pair; k < block.last_pair; ++k) {
      const auto [i, j] = pairs[k];
      const PairGradient<Dim>& g = gradients[k];
      Vec<Dim> f = nominal[i] * g.at_i - nominal[j] * g.at_j;
      if constexpr (NonAffine || Viscous) {
        const Vec<Dim> du = velocity[j] - velocity[i];
        const double damping = (*terms.damping)[i] + (*terms.damping)[j];
        Vec<Dim> resisted = Vec<Dim>::Zero();
        if constexpr (NonAffine) {
          NonAffineControl<Dim>& control = *terms.non_affine;
          const Vec<Dim> r = (*control.start_position)[j] - (*control.start_position)[i];
          const Vec<Dim> v = du - 0.5 * ((tissue.velocity_gradient[i] + tissue.velocity_gradient[j]) * r);
          Vec<Dim>& slip = control.slip_mm[k];
          resisted += control.damping * damping * v + control.stiffness_MPa * (slip + advance.used_h * v);
          slip += advance.kept_h * v;
        }
        if constexpr (Viscous) resisted += terms.viscosity->coefficient * damping * du;
        f += terms.weight[k] * resisted;
      }
      force[i] += f;
      force[j] -= f;
    }
  });
}

}  // namespace

template <int Dim>
void compute_velocity_gradients(Tissue<Dim>& tissue) {
  const Pair* const pairs = tissue.pairs.pairs.data();
  const PairGradient<Dim>* const gradients = tissue.gradients.data();
  const Vec<Dim>* const velocity = tissue.cells.velocity.values().data();
  Mat<Dim>* const gradient = tissue.velocity_gradient.values().data();
#pragma omp parallel for schedule(static)
  for (std::size_t i = 0; i < tissue.cells.size(); ++i) gradient[i].setZero();
  for_each_block(tissue.pairs, [&](const PairBlock& block) {
    for (std::int64_t k = block.first_pair; k < block.last_pair; ++k) {
      const auto [i, j] = pairs[k];
      const Vec<Dim> du = velocity[j] - velocity[i];
      gradient[i].noalias() += du * gradients[k].at_i.transpose();
      gradient[j].noalias() -= du * gradients[k].at_j.transpose();
    }
  });
}

template <int Dim>
ForceLoop<Dim> choose_force_loop(const PairTerms<Dim>& terms) {
  if (terms.non_affine) return terms.viscosity ? add_forces<Dim, true, true> : add_forces<Dim, true, false>;
  return terms.viscosity ? add_forces<Dim, false, true> : add_forces<Dim, false, false>;
}

template void compute_velocity_gradients<2>(Tissue<2>&);
template void compute_velocity_gradients<3>(Tissue<3>&);
template ForceLoop<2> choose_force_loop<2>(const PairTerms<2>&);
template ForceLoop<3> choose_force_loop<3>(const PairTerms<3>&);

}  // namespace rootsoil
