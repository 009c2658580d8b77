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

/// One cell's share of the stiffness matrix K = sum_i (W_i^T W_i + P_i (x) 1), over the nodes of its stencil.
///
/// W^T W = V det F B^T C B/(1 + dt lambda/rho0): of the stress, with the operators carried along by F. P is an upper
/// bound of what the pair resistance adds, k w |d_j - d_i - (G_i + G_j) r/2|^2 <= k w/2 (|d_j - d_i - G_i r|^2 + the
/// same with G_j), which needs no neighbours of neighbours.
template <int Dim>
class CellStiffness {
 public:
  /// \param dt_h of the step, for growth and creep
  CellStiffness(const Tissue<Dim>& tissue, const PairTerms<Dim>& terms, double dt_h);

  /// For one cell and its nodes.
  void find(std::size_t cell, std::span<const typename Stencils<Dim>::Node> nodes);

  std::size_t nodes() const { return nodes_; }
  /// W, N^(1/2) mm^(-1/2): a row for each entry of the strain, Dim columns for each node. Voigt x (Dim nodes).
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
  std::size_t nodes_ = 0;
  Eigen::Matrix<double, voigt_size<Dim>, Eigen::Dynamic, Eigen::RowMajor> strain_root_;
  Eigen::Matrix<double, Dim, Eigen::Dynamic, Eigen::RowMajor> weights_, resisted_;
  Eigen::VectorXd star_;
};

extern template struct Stencils<2>;
extern template struct Stencils<3>;
extern template class CellStiffness<2>;
extern template class CellStiffness<3>;

}  // namespace rootsoil
