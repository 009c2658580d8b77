// SPDX-License-Identifier: MIT
#include "root_sph/dynamics/tangent.hpp"

#include <Eigen/Cholesky>
#include <cmath>

#include "root_sph/dynamics/material_update.hpp"
#include "root_sph/tissue/relaxation.hpp"

namespace rootsoil {
namespace {

/// factor times the engineering strain in the material frame of a displacement field d (x) h, as a matrix that acts on
/// h: row v Dim + c is entry v under d along axis c.
template <int Dim>
Eigen::Matrix<double, voigt_size<Dim> * Dim, Dim> strain_operator(const VoigtMat<Dim>& factor, const Mat<Dim>& frame) {
  Eigen::Matrix<double, voigt_size<Dim> * Dim, Dim> all;
  for (int c = 0; c < Dim; ++c) {
    for (int a = 0; a < Dim; ++a) {
      const Mat<Dim> gradient = frame.row(c).transpose() * frame.row(a);
      const Voigt<Dim> strain = factor * to_strain_voigt<Dim>(0.5 * (gradient + gradient.transpose()));
      for (int v = 0; v < voigt_size<Dim>; ++v) all(v * Dim + c, a) = strain[v];
    }
  }
  return all;
}

}  // namespace

template <int Dim>
Stencils<Dim>::Stencils(const PairList& list) {
  const std::size_t cells = list.neighbours.size();
  first.assign(cells + 1, 0);
  for (std::size_t i = 0; i < cells; ++i) first[i + 1] = first[i] + list.neighbours[i] + 1;
  nodes.resize(static_cast<std::size_t>(first[cells]));
  std::vector<std::int64_t> next(first.begin(), first.end() - 1);
  for (std::size_t i = 0; i < cells; ++i) nodes[next[i]++] = {static_cast<std::int32_t>(i), -1, false};
  for (std::size_t k = 0; k < list.pairs.size(); ++k) {
    const auto [i, j] = list.pairs[k];
    nodes[next[i]++] = {j, static_cast<std::int32_t>(k), false};
    nodes[next[j]++] = {i, static_cast<std::int32_t>(k), true};
  }
}

template <int Dim>
CellStiffness<Dim>::CellStiffness(const Tissue<Dim>& tissue, const PairTerms<Dim>& terms, double dt_h)
    : tissue_(tissue), terms_(terms), dt_h_(dt_h) {}

template <int Dim>
void CellStiffness<Dim>::find(std::size_t i, std::span<const typename Stencils<Dim>::Node> nodes) {
  const auto& cells = tissue_.cells;
  const Material<Dim>& material = tissue_.material;
  const auto columns = static_cast<Eigen::Index>(nodes.size());
  weights_.resize(Eigen::NoChange, columns);
  weights_.col(0).setZero();
  for (Eigen::Index node = 1; node < columns; ++node) {
    const auto& n = nodes[static_cast<std::size_t>(node)];
    const Vec<Dim>& g = n.second ? tissue_.gradients[n.pair].at_j : tissue_.gradients[n.pair].at_i;
    weights_.col(node) = g;
    weights_.col(0) -= g;
  }

  // F of the step's end, at the displacement that the tissue has now
  const Mat<Dim> deformation = tissue_.deformation[i] + dt_h_ * tissue_.velocity_gradient[i];
  const double growth = material.softening ? dt_h_ * (*material.softening)[i] / material.rho0_ug_mm3 : 0.0;
  const double factor = std::sqrt(cells.volume[i] * deformation.determinant() * relaxation(growth).gained);
  const VoigtMat<Dim> elastic = elastic_tangent<Dim>(material.stiffness_of(i));
  const VoigtMat<Dim> root = factor * VoigtMat<Dim>(elastic.llt().matrixU());
  const Mat<Dim> frame = step_rotation<Dim>(deformation - Mat<Dim>::Identity()) * cells.frame[i];
  multiply<voigt_size<Dim> * Dim, Dim>(strain_operator<Dim>(root, frame) * deformation.inverse().transpose(), weights_,
                                       strain_root_);
  if (!terms_.non_affine) return;

  // P = sum_j s_j z_j z_j^T, z_j = (1 at j) - (1 at i) - (g_k . r_j at k)
  star_.resize(columns);
  star_[0] = 0.0;
  arm_.setZero(Dim, columns);  // E^T s R
  Mat<Dim> moment = Mat<Dim>::Zero();
  for (Eigen::Index node = 1; node < columns; ++node) {
    const auto& n = nodes[static_cast<std::size_t>(node)];
    const double creep = terms_.non_affine->retention.empty() ? 1.0 : terms_.non_affine->retention[n.pair];
    const double s = 0.5 * terms_.non_affine->stiffness_MPa * terms_.weight[n.pair] * creep;
    const Vec<Dim> r = (*terms_.non_affine->start_position)[n.cell] - (*terms_.non_affine->start_position)[i];
    star_[node] = s;
    star_[0] += s;
    arm_.col(node) = -s * r;
    arm_.col(0) += s * r;
    moment += s * r * r.transpose();
  }
  multiply<Dim, Dim>(0.5 * moment, weights_, resisted_);
  resisted_ += arm_;
}

template struct Stencils<2>;
template struct Stencils<3>;
template class CellStiffness<2>;
template class CellStiffness<3>;

}  // namespace rootsoil
