// SPDX-License-Identifier: MIT
#include "root_sph/dynamics/pair_loop.hpp"

#include "root_sph/core/choose.hpp"

namespace rootsoil {
namespace {

// Both loops go row by row: what belongs to cell i stays in registers while its partners j > i pass by.

template <int Dim, bool NonAffine, bool Creeping, bool Damped, bool Viscous>
void add_forces(Tissue<Dim>& tissue, PairTerms<Dim>& terms, SlipAdvance advance) {
  const Pair* const pairs = tissue.pairs.pairs.data();
  const std::int64_t* const row = tissue.pairs.row.data();
  const PairGradient<Dim>* const gradients = tissue.gradients.data();
  const Mat<Dim>* const nominal = tissue.nominal_force.values().data();
  const Vec<Dim>* const velocity = tissue.cells.velocity.values().data();
  const Mat<Dim>* const gradient = tissue.velocity_gradient.values().data();
  const double* const weight = terms.weight.data();
  const double* const damping = terms.damping ? terms.damping->values().data() : nullptr;
  const Vec<Dim>* const start = NonAffine ? terms.non_affine->start_position->values().data() : nullptr;
  Vec<Dim>* const slip = NonAffine ? terms.non_affine->slip_mm.data() : nullptr;
  const double* const retention = Creeping ? terms.non_affine->retention.data() : nullptr;
  const double control_damping = NonAffine ? terms.non_affine->damping : 0.0;
  const double control_stiffness = NonAffine ? terms.non_affine->stiffness_MPa : 0.0;
  const double viscosity = Viscous ? terms.viscosity->coefficient : 0.0;
  Vec<Dim>* const force = tissue.force.values().data();

  for_each_block(tissue.pairs, [&](const PairBlock& block) {
    for (std::int64_t i = block.first_cell; i < block.last_cell; ++i) {
      const Mat<Dim> nominal_i = nominal[i];
      const Vec<Dim> velocity_i = velocity[i];
      const Mat<Dim> gradient_i = gradient[i];
      Vec<Dim> sum = Vec<Dim>::Zero();
      for (std::int64_t k = row[i]; k < row[i + 1]; ++k) {
        const std::int32_t j = pairs[k].j;
        Vec<Dim> f = nominal_i * gradients[k].at_i - nominal[j] * gradients[k].at_j;
        if constexpr (NonAffine || Viscous) {
          const Vec<Dim> du = velocity[j] - velocity_i;
          const double both = Damped || Viscous ? damping[i] + damping[j] : 0.0;
          Vec<Dim> resisted = Vec<Dim>::Zero();
          if constexpr (NonAffine) {
            const Vec<Dim> r = start[j] - start[i];
            const Vec<Dim> v = du - 0.5 * ((gradient_i + gradient[j]) * r);
            const Vec<Dim> e = slip[k];
            const double creep = Creeping ? retention[k] : 1.0;  // implicit
            resisted += control_stiffness * creep * (e + advance.used_h * v);
            if constexpr (Damped) resisted += control_damping * both * v;
            if (advance.kept_h > 0.0) slip[k] = creep * (e + advance.kept_h * v);
          }
          if constexpr (Viscous) resisted += viscosity * both * du;
          f += weight[k] * resisted;
        }
        sum += f;
        force[j] -= f;
      }
      force[i] += sum;
    }
  });
}

}  // namespace

template <int Dim>
void compute_velocity_gradients(Tissue<Dim>& tissue) {
  const Pair* const pairs = tissue.pairs.pairs.data();
  const std::int64_t* const row = tissue.pairs.row.data();
  const PairGradient<Dim>* const gradients = tissue.gradients.data();
  const Vec<Dim>* const velocity = tissue.cells.velocity.values().data();
  Mat<Dim>* const gradient = tissue.velocity_gradient.values().data();
#pragma omp parallel for schedule(static)
  for (std::size_t i = 0; i < tissue.cells.size(); ++i) gradient[i].setZero();
  for_each_block(tissue.pairs, [&](const PairBlock& block) {
    for (std::int64_t i = block.first_cell; i < block.last_cell; ++i) {
      const Vec<Dim> velocity_i = velocity[i];
      Mat<Dim> sum = Mat<Dim>::Zero();
      for (std::int64_t k = row[i]; k < row[i + 1]; ++k) {
        const std::int32_t j = pairs[k].j;
        const Vec<Dim> du = velocity[j] - velocity_i;
        sum.noalias() += du * gradients[k].at_i.transpose();
        gradient[j].noalias() -= du * gradients[k].at_j.transpose();
      }
      gradient[i] += sum;
    }
  });
}

template <int Dim>
ForceLoop<Dim> choose_force_loop(const PairTerms<Dim>& terms, bool grows) {
  const auto& control = terms.non_affine;
  return choose(terms.viscosity.has_value(), [&](auto viscous) {
    return choose(control.has_value(), [&](auto non_affine) -> ForceLoop<Dim> {
      if constexpr (!non_affine) return add_forces<Dim, false, false, false, viscous>;
      return choose(grows, [&](auto creeping) {
        return choose(control->damping > 0.0,
                      [&](auto damped) -> ForceLoop<Dim> { return add_forces<Dim, true, creeping, damped, viscous>; });
      });
    });
  });
}

template void compute_velocity_gradients<2>(Tissue<2>&);
template void compute_velocity_gradients<3>(Tissue<3>&);
template ForceLoop<2> choose_force_loop<2>(const PairTerms<2>&, bool);
template ForceLoop<3> choose_force_loop<3>(const PairTerms<3>&, bool);

}  // namespace rootsoil
