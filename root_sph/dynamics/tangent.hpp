// SPDX-License-Identifier: MIT
// The tissue's stiffness at a step, cell by cell: what a displacement of a cell and of its neighbours adds to the
// forces.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "root_sph/dynamics/pair_terms.hpp"
#include "root_sph/dynamics/tissue.hpp"

namespace rootsoil {

/// Every cell with its neighbours, itself first: pairs seen from both of their cells.
template <int Dim>
struct Stencils {
  struct Node {
    std::int32_t cell;
    std::int32_t pair;  ///< -1: the cell itself
    bool second;        ///< the cell is the second of the pair
  };
  std::vector<Node> nodes;
  std::vector<std::int64_t> first;  ///< nodes of cell i: [first[i], first[i + 1])

  explicit Stencils(const PairList& list);
  std::span<const Node> of(std::size_t cell) const {
    return {nodes.data() + first[cell], static_cast<std::size_t>(first[cell + 1] - first[cell])};
  }
};

/// Rows of numbers, a column for each node of a stencil: loops run along the nodes.
template <int Rows>
using NodeRows = Eigen::Matrix<double, Rows, Eigen::Dynamic, Eigen::RowMajor>;

/// product = factor times rows, for a factor whose size is known.
template <int Rows, int Inner>
void multiply(const Eigen::Matrix<double, Rows, Inner>& factor, const NodeRows<Inner>& rows, NodeRows<Rows>& product) {
  const Eigen::Index columns = rows.cols();
  product.resize(Eigen::NoChange, columns);
  for (int r = 0; r < Rows; ++r) {
    double* __restrict out = product.data() + r * columns;
    for (Eigen::Index n = 0; n < columns; ++n) {
      double sum = 0.0;
      for (int k = 0; k < Inner; ++k) sum += factor(r, k) * rows.data()[k * columns + n];
      out[n] = sum;
    }
  }
}

/// One cell's share of the stiffness matrix K = sum_i (W_i^T W_i + P_i (x) 1), over the nodes of its stencil.
///
/// W^T W = V det F B^T C B (1 - e^-x)/x, x = dt lambda/rho0: of the stress, with the operators carried along by F. P is
/// of the pair resistance, c w/2 |d_j - d_i - G_i r|^2 of each neighbour.
template <int Dim>
class CellStiffness {
 public:
  /// \param dt_h of the step, for growth and creep
  CellStiffness(const Tissue<Dim>& tissue, const PairTerms<Dim>& terms, double dt_h);

  /// For one cell and its nodes.
  void find(std::size_t cell, std::span<const typename Stencils<Dim>::Node> nodes);

  /// W, N^(1/2) mm^(-1/2): row v Dim + c is entry v of the strain under displacements along axis c, a column for each
  /// node. (Voigt Dim) x nodes.
  const auto& strain_root() const { return strain_root_; }
  /// P = diag(star) with its hub + G X^T + X G^T, N/mm; G and X have Dim rows, a column for each node.
  const auto& weights() const { return weights_; }    ///< G, 1/mm
  const auto& resisted() const { return resisted_; }  ///< X, N
  const auto& star() const { return star_; }          ///< of each node to the cell itself; of the cell, their sum
  bool has_resistance() const { return terms_.non_affine.has_value(); }

 private:
  const Tissue<Dim>& tissue_;
  const PairTerms<Dim>& terms_;
  double dt_h_;
  NodeRows<voigt_size<Dim> * Dim> strain_root_;
  NodeRows<Dim> weights_, resisted_, arm_;
  Eigen::VectorXd star_;
};

extern template struct Stencils<2>;
extern template struct Stencils<3>;
extern template class CellStiffness<2>;
extern template class CellStiffness<3>;

}  // namespace rootsoil
