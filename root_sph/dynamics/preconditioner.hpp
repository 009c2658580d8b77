// SPDX-License-Identifier: MIT
// An approximate inverse of the tissue's stiffness.
#pragma once

#include <memory>
#include <vector>

#include "root_sph/dynamics/pair_terms.hpp"
#include "root_sph/dynamics/tissue.hpp"

namespace rootsoil {

/// The cells that are free to move in the order in which they lie along the root, from the base to the tip.
struct FreeCells {
  std::vector<std::int32_t> cell;   ///< of each place
  std::vector<std::int32_t> place;  ///< of each cell; -1: it is held
};

template <int Dim>
FreeCells order_free_cells(const ParticleStore<Dim>& cells);

/// z = M^-1 r, with M a symmetric positive definite matrix near the stiffness: Dim entries for each free cell, in the
/// order of FreeCells.
template <int Dim>
class Preconditioner {
 public:
  virtual ~Preconditioner() = default;
  /// The tissue's part of the matrix.
  virtual void assemble(const Tissue<Dim>& tissue, const PairTerms<Dim>& terms, const FreeCells& free, double dt_h) = 0;
  /// Makes it ready for use, with what is touched added.
  /// \param contact stiffness of what the cell in each place touches, N/mm, a block for each; empty: nothing touches
  /// \returns false where the matrix is not positive definite
  virtual bool factor(const std::vector<Mat<Dim>>& contact) = 0;
  virtual void apply(const Eigen::VectorXd& r, Eigen::VectorXd& z) const = 0;
  /// The tissue's part, to go on with the same bits.
  virtual std::vector<double> save() const = 0;
  virtual void restore(const std::vector<double>& saved) = 0;
};

/// The stiffness itself as a band along the root: two iterations a step; its cost grows with the square of the number
/// of cells in a section.
template <int Dim>
std::unique_ptr<Preconditioner<Dim>> make_band_preconditioner();

/// Multiplications that factorising it takes, about.
template <int Dim>
double band_work(const PairList& pairs, const FreeCells& free);

/// The blocks of single cells, and affine motions of the layers of cells: the number of iterations does not grow with
/// the root, and nothing is assembled that is larger than a layer's motion.
template <int Dim>
std::unique_ptr<Preconditioner<Dim>> make_layer_preconditioner();

}  // namespace rootsoil
