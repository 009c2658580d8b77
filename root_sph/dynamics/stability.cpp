// SPDX-License-Identifier: MIT
#include "root_sph/dynamics/stability.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "root_sph/core/cell_size.hpp"

namespace rootsoil {
namespace {

/// |C| as a matrix over pairs of axes: normal entries on C_ab, shear modulus of the plane (a, b) beside it.
template <int Dim>
void moduli(const Stiffness<Dim>& k, Mat<Dim>& normal, Mat<Dim>& shear) {
  using namespace stiffness_entry;
  normal.setConstant(std::abs(k[c12]));
  shear.setConstant(k[g]);
  normal(0, 0) = k[c11];
  for (int a = 1; a < Dim; ++a) normal(a, a) = k[c22];
  if constexpr (Dim == 3) {
    normal(1, 2) = normal(2, 1) = std::abs(k[c23]);
    shear(1, 2) = shear(2, 1) = k[g23];
  }
}

/// The diagonal d of which diag(d) - m is positive semidefinite, for positive semidefinite m: of 2 m_ab x_a x_b the
/// large entry takes as much of its own size as the small one. m itself where it is diagonal: where neighbours' frames
/// are alike.
template <int Dim>
Vec<Dim> diagonal_bound(const Mat<Dim>& m) {
  Vec<Dim> d = m.diagonal();
  for (int a = 0; a < Dim; ++a) {
    for (int b = 0; b < Dim; ++b) {
      if (a != b && m(b, b) > 0.0) d[a] += std::abs(m(a, b)) * std::sqrt(m(a, a) / m(b, b));
    }
  }
  return d;
}

}  // namespace

template <int Dim>
std::vector<Vec<Dim>> bound_stiffness(const Tissue<Dim>& tissue, const PairTerms<Dim>& terms) {
  const auto& cells = tissue.cells;
  const std::size_t n = cells.size();
  const auto& pairs = tissue.pairs.pairs;

  // Magnitudes of the operator's weights in the material frame, with the cell's own weight -sum_j g_ij.
  std::vector<Vec<Dim>> magnitude(n, Vec<Dim>::Zero()), own(n, Vec<Dim>::Zero());
  for_each_block(tissue.pairs, [&](const PairBlock& block) {
    for (std::int64_t k = block.first_pair; k < block.last_pair; ++k) {
      const auto [i, j] = pairs[k];
      const Vec<Dim> at_i = cells.frame[i].transpose() * tissue.gradients[k].at_i;
      const Vec<Dim> at_j = cells.frame[j].transpose() * tissue.gradients[k].at_j;
      magnitude[i] += at_i.cwiseAbs();
      own[i] += at_i;
      magnitude[j] += at_j.cwiseAbs();
      own[j] += at_j;
    }
  });

  // A unit displacement with weights h strains the cell; row a of its share of K is at most (rows h)_a:
  // normal strain h_a against C_ab S_b, shear h_b against G_ab (S_a + S_b), S the sums of magnitudes.
  std::vector<Mat<Dim>> rows(n);
  std::vector<Mat<Dim>> bound(n);  // in the material frame of the cell that is displaced
#pragma omp parallel for schedule(static)
  for (std::size_t i = 0; i < n; ++i) {
    const Vec<Dim> self = own[i].cwiseAbs();
    const Vec<Dim> s = magnitude[i] + self;
    Mat<Dim> normal, shear;
    moduli<Dim>(tissue.material.stiffness_of(i), normal, shear);
    for (int a = 0; a < Dim; ++a) {
      for (int b = 0; b < Dim; ++b) rows[i](a, b) = a == b ? normal.row(a).dot(s) : shear(a, b) * (s[a] + s[b]);
    }
    rows[i] *= cells.volume[i];
    bound[i] = Vec<Dim>(rows[i] * self).asDiagonal();
  }
  for_each_block(tissue.pairs, [&](const PairBlock& block) {
    for (std::int64_t k = block.first_pair; k < block.last_pair; ++k) {
      const auto [i, j] = tissue.pairs.pairs[k];
      const Vec<Dim> strains_i = rows[i] * (cells.frame[i].transpose() * tissue.gradients[k].at_i).cwiseAbs();
      const Vec<Dim> strains_j = rows[j] * (cells.frame[j].transpose() * tissue.gradients[k].at_j).cwiseAbs();
      const Mat<Dim> turn = cells.frame[i].transpose() * cells.frame[j];
      bound[j] += turn.transpose() * strains_i.asDiagonal() * turn;
      bound[i] += turn * strains_j.asDiagonal() * turn.transpose();
      if (terms.non_affine) {
        const double penalty = 4.0 * terms.non_affine->stiffness_MPa * terms.weight[k];
        bound[i].diagonal().array() += penalty;
        bound[j].diagonal().array() += penalty;
      }
    }
  });
  std::vector<Vec<Dim>> stiffness(n);
#pragma omp parallel for schedule(static)
  for (std::size_t i = 0; i < n; ++i) stiffness[i] = diagonal_bound<Dim>(bound[i]);
  return stiffness;
}

template <int Dim>
void set_inertia(Tissue<Dim>& tissue, PairTerms<Dim>& terms, const std::vector<Vec<Dim>>& stiffness, InertiaMode mode) {
  auto& cells = tissue.cells;
  const std::size_t n = cells.size();
  const double dt = tissue.step_h;
  std::vector<Vec<Dim>> inertia(n);
#pragma omp parallel for schedule(static)
  for (std::size_t i = 0; i < n; ++i) {
    inertia[i] = 0.25 * dt * dt * stiffness[i];
    if (mode == InertiaMode::scalar) inertia[i].setConstant(inertia[i].maxCoeff());
  }
  if (terms.damps()) {
    double factor = terms.viscosity ? terms.viscosity->coefficient : 0.0;
    if (terms.non_affine) factor += terms.non_affine->damping;
    std::vector<double> damped(n, 0.0);
#pragma omp parallel for schedule(static)
    for (std::size_t i = 0; i < n; ++i) {
      // sqrt(E M/V) V^(1/Dim): the impedance of a cell
      (*terms.damping)[i] = 0.5 * std::sqrt(tissue.material.E_axial_MPa * inertia[i][0] / cells.volume[i]) *
                            cell_size_mm<Dim>(cells.volume[i]);
    }
    for_each_block(tissue.pairs, [&](const PairBlock& block) {
      for (std::int64_t k = block.first_pair; k < block.last_pair; ++k) {
        const auto [i, j] = tissue.pairs.pairs[k];
        const double c = factor * terms.weight[k] * ((*terms.damping)[i] + (*terms.damping)[j]);
        damped[i] += c;
        damped[j] += c;
      }
    });
    // velocity damping lowers the limit of the leapfrog: dt^2 K/4 + dt C/2 <= M
#pragma omp parallel for schedule(static)
    for (std::size_t i = 0; i < n; ++i) inertia[i].array() += 0.5 * dt * damped[i];
  }
#pragma omp parallel for schedule(static)
  for (std::size_t i = 0; i < n; ++i) {
    // a lone cell has no stiffness and nothing moves it
    tissue.inertia->inverse[i] = cells.clamped[i] || inertia[i].minCoeff() <= 0.0 ? Vec<Dim>(Vec<Dim>::Zero())
                                                                                  : Vec<Dim>(inertia[i].cwiseInverse());
  }
}

template <int Dim>
double critical_mass_damping(const Tissue<Dim>& tissue) {
  const auto& cells = tissue.cells;
  double inertia = 0.0, volume = 0.0, length = 0.0;
  for (std::size_t i = 0; i < cells.size(); ++i) {
    if (tissue.inertia->inverse[i][0] <= 0.0) continue;
    inertia += 1.0 / tissue.inertia->inverse[i][0];
    volume += cells.volume[i];
    length = std::max(length, cells.distance_to_tip[i]);
  }
  if (inertia <= 0.0 || length <= 0.0) return 0.0;
  return std::numbers::pi / length * std::sqrt(tissue.material.E_axial_MPa * volume / inertia);
}

template std::vector<Vec<2>> bound_stiffness<2>(const Tissue<2>&, const PairTerms<2>&);
template std::vector<Vec<3>> bound_stiffness<3>(const Tissue<3>&, const PairTerms<3>&);
template void set_inertia<2>(Tissue<2>&, PairTerms<2>&, const std::vector<Vec<2>>&, InertiaMode);
template void set_inertia<3>(Tissue<3>&, PairTerms<3>&, const std::vector<Vec<3>>&, InertiaMode);
template double critical_mass_damping<2>(const Tissue<2>&);
template double critical_mass_damping<3>(const Tissue<3>&);

}  // namespace rootsoil
