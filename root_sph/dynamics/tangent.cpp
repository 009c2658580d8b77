// SPDX-License-Identifier: MIT
#include "root_sph/dynamics/tangent.hpp"

#include <Eigen/Cholesky>
#include <cmath>

namespace rootsoil {
namespace {

/// Engineering strain in the material frame of a displacement field d (x) h, as a matrix that acts on d in the frame of
/// space.
template <int Dim>
Eigen::Matrix<double, voigt_size<Dim>, Dim> strain_operator(const Vec<Dim>& h_material, const Mat<Dim>& frame) {
  Eigen::Matrix<double, voigt_size<Dim>, Dim> b = Eigen::Matrix<double, voigt_size<Dim>, Dim>::Zero();
  const Vec<Dim>& h = h_material;
  for (int a = 0; a < Dim; ++a) b(a, a) = h[a];
  if constexpr (Dim == 2) {
    b(2, 0) = h[1];
    b(2, 1) = h[0];
  } else {
    b(3, 1) = b(4, 0) = h[2];
    b(3, 2) = b(5, 0) = h[1];
    b(4, 2) = b(5, 1) = h[0];
  }
  return b * frame.transpose();
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
  nodes_ = nodes.size();
  const auto columns = static_cast<Eigen::Index>(nodes_);
  strain_root_.resize(Eigen::NoChange, columns * Dim);
  weights_.resize(Eigen::NoChange, columns);

  // F of the step's end, at the displacement that the tissue has now
  const Mat<Dim> deformation = tissue_.deformation[i] + dt_h_ * tissue_.velocity_gradient[i];
  const Mat<Dim> carry = deformation.inverse().transpose();
  const double growth = material.softening ? dt_h_ * (*material.softening)[i] / material.rho0_ug_mm3 : 0.0;
  const double factor = std::sqrt(cells.volume[i] * deformation.determinant() / (1.0 + growth));
  const VoigtMat<Dim> elastic = elastic_tangent<Dim>(material.stiffness_of(i));
  const VoigtMat<Dim> root = factor * VoigtMat<Dim>(elastic.llt().matrixU());
  const Mat<Dim>& frame = cells.frame[i];
  const auto set_node = [&](Eigen::Index node, const Vec<Dim>& weight) {
    weights_.col(node) = weight;
    strain_root_.template middleCols<Dim>(node * Dim) =
        root * strain_operator<Dim>(frame.transpose() * (carry * weight), frame);
  };
  Vec<Dim> own = Vec<Dim>::Zero();
  for (Eigen::Index node = 1; node < columns; ++node) {
    const auto& n = nodes[static_cast<std::size_t>(node)];
    const Vec<Dim>& g = n.second ? tissue_.gradients[n.pair].at_j : tissue_.gradients[n.pair].at_i;
    set_node(node, g);
    own -= g;
  }
  set_node(0, own);
  if (!terms_.non_affine) return;

  // P = sum_j s_j z_j z_j^T, z_j = (1 at j) - (1 at i) - (g_k . r_j at k)
  star_.resize(columns);
  star_[0] = 0.0;
  resisted_.setZero(Dim, columns);  // first Y = E^T s R, then X = G M/2 - Y
  Mat<Dim> moment = Mat<Dim>::Zero();
  for (Eigen::Index node = 1; node < columns; ++node) {
    const auto& n = nodes[static_cast<std::size_t>(node)];
    const double creep = terms_.non_affine->retention.empty() ? 1.0 : terms_.non_affine->retention[n.pair];
    const double s = 0.5 * terms_.non_affine->stiffness_MPa * terms_.weight[n.pair] * creep;
    const Vec<Dim> r = (*terms_.non_affine->start_position)[n.cell] - (*terms_.non_affine->start_position)[i];
    star_[node] = s;
    star_[0] += s;
    resisted_.col(node) = -s * r;
    resisted_.col(0) += s * r;
    moment += s * r * r.transpose();
  }
  resisted_.noalias() += 0.5 * moment * weights_;
}

template struct Stencils<2>;
template struct Stencils<3>;
template class CellStiffness<2>;
template class CellStiffness<3>;

}  // namespace rootsoil
