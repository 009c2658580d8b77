// SPDX-License-Identifier: MIT
#include "root_sph/dynamics/pair_loop.hpp"

#include "root_sph/core/choose.hpp"

namespace rootsoil {
namespace {

// The loops go row by row: what belongs to cell i stays in registers while its partners j > i pass by.

/// The non-affine control. It resists e_i + h v_i, v_i = u_j - u_i - grad u_i . r, and e_j + h v_j with grad u_j, by
/// half of c w each, and damps v. What is affine in them is answered by the cells whose gradients it is made of, A_i -=
/// sum_k w f_i r^T/2, which comes into the nominal forces: so the control's force is the derivative of an energy, and
/// keeps angular momentum. Where it acted between pairs only, roots of irregular cells curled by themselves
/// (docs/decisions/0025).
template <int Dim, bool Creeping, bool Damped>
void resist_slips(Tissue<Dim>& tissue, PairTerms<Dim>& terms, SlipAdvance advance) {
  NonAffineControl<Dim>& control = *terms.non_affine;
  const Pair* const pairs = tissue.pairs.pairs.data();
  const std::int64_t* const row = tissue.pairs.row.data();
  const Vec<Dim>* const velocity = tissue.cells.velocity.values().data();
  const Mat<Dim>* const gradient = tissue.velocity_gradient.values().data();
  const Vec<Dim>* const start = control.start_position->values().data();
  const double* const weight = terms.weight.data();
  const double* const damping = Damped ? terms.damping->values().data() : nullptr;
  const double* const retention = Creeping ? control.retention.data() : nullptr;
  PairSlip<Dim>* const slip = control.slip_mm.data();
  Mat<Dim>* const nominal = tissue.nominal_force.values().data();
  Vec<Dim>* const force = tissue.force.values().data();

  for_each_block(tissue.pairs, [&](const PairBlock& block) {
    for (std::int64_t i = block.first_cell; i < block.last_cell; ++i) {
      const Vec<Dim> velocity_i = velocity[i], start_i = start[i];
      const Mat<Dim> gradient_i = gradient[i];
      Vec<Dim> sum = Vec<Dim>::Zero();
      Mat<Dim> reaction = Mat<Dim>::Zero();
      for (std::int64_t k = row[i]; k < row[i + 1]; ++k) {
        const std::int32_t j = pairs[k].j;
        const Vec<Dim> r = start[j] - start_i, du = velocity[j] - velocity_i;
        const Vec<Dim> v_i = du - gradient_i * r, v_j = du - gradient[j] * r;
        const double creep = Creeping ? retention[k] : 1.0;  // implicit
        const double elastic = 0.5 * weight[k] * control.stiffness_MPa * creep;
        double viscous = elastic * advance.used_h;
        if constexpr (Damped) viscous += 0.5 * weight[k] * control.damping * (damping[i] + damping[j]);
        const Vec<Dim> f_i = elastic * slip[k].col(0) + viscous * v_i, f_j = elastic * slip[k].col(1) + viscous * v_j;
        if (advance.kept_h > 0.0) {
          slip[k].col(0) = creep * (slip[k].col(0) + advance.kept_h * v_i);
          slip[k].col(1) = creep * (slip[k].col(1) + advance.kept_h * v_j);
        }
        sum += f_i + f_j;
        force[j] -= f_i + f_j;
        reaction.noalias() += f_i * r.transpose();
        nominal[j].noalias() -= f_j * r.transpose();
      }
      force[i] += sum;
      nominal[i] -= reaction;
    }
  });
}

/// What the stress does, and the artificial viscosity.
template <int Dim, bool Viscous>
void add_stress_forces(Tissue<Dim>& tissue, const PairTerms<Dim>& terms) {
  const Pair* const pairs = tissue.pairs.pairs.data();
  const std::int64_t* const row = tissue.pairs.row.data();
  const PairGradient<Dim>* const gradients = tissue.gradients.data();
  const Mat<Dim>* const nominal = tissue.nominal_force.values().data();
  const Vec<Dim>* const velocity = tissue.cells.velocity.values().data();
  const double* const damping = Viscous ? terms.damping->values().data() : nullptr;
  Vec<Dim>* const force = tissue.force.values().data();

  for_each_block(tissue.pairs, [&](const PairBlock& block) {
    for (std::int64_t i = block.first_cell; i < block.last_cell; ++i) {
      const Mat<Dim> nominal_i = nominal[i];
      Vec<Dim> sum = Vec<Dim>::Zero();
      for (std::int64_t k = row[i]; k < row[i + 1]; ++k) {
        const std::int32_t j = pairs[k].j;
        Vec<Dim> f = nominal_i * gradients[k].at_i - nominal[j] * gradients[k].at_j;
        if constexpr (Viscous) {
          f += terms.weight[k] * terms.viscosity->coefficient * (damping[i] + damping[j]) * (velocity[j] - velocity[i]);
        }
        sum += f;
        force[j] -= f;
      }
      force[i] += sum;
    }
  });
}

template <int Dim, bool NonAffine, bool Creeping, bool Damped, bool Viscous>
void add_forces(Tissue<Dim>& tissue, PairTerms<Dim>& terms, SlipAdvance advance) {
  if constexpr (NonAffine) resist_slips<Dim, Creeping, Damped>(tissue, terms, advance);
  add_stress_forces<Dim, Viscous>(tissue, terms);
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
