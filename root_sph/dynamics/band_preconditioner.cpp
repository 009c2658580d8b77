// SPDX-License-Identifier: MIT
#include <array>
#include <span>

#include "root_sph/dynamics/assembly.hpp"
#include "root_sph/dynamics/preconditioner.hpp"

namespace rootsoil {
namespace {

/// Adds shares of cells to a band. One for each thread: it holds what it works with.
template <int Dim>
class BandAssembly {
 public:
  BandAssembly(const Tissue<Dim>& tissue, const PairTerms<Dim>& terms, const Stencils<Dim>& stencils,
               const FreeCells& free, double dt_h, BandCholesky& matrix)
      : stencils_(stencils), free_(free), share_(tissue, terms, dt_h), matrix_(matrix) {}

  void add(std::size_t cell) {
    const auto nodes = stencils_.of(cell);
    sort_free_nodes(nodes);
    share_.find(cell, nodes);
    gather();
    for (std::size_t b = 0; b < sorted_.size(); ++b) add_columns_of(b);
    if (share_.has_resistance()) add_star();
  }

 private:
  struct FreeNode {
    std::int32_t place, node;
    bool operator<(const FreeNode& other) const { return place < other.place; }
  };
  /// Entry c Dim + d of a block is what displacements along c do to the forces along d.
  using Block = Eigen::Array<double, Dim * Dim, 1>;
  static constexpr int products = voigt_size<Dim> + 2 * Dim;
  /// Of a node, all that a block sums up: sum_m force[m] motion[m], of the node that feels and the one that moves. W
  /// for each entry of the strain, then G X^T + X G^T on the diagonal.
  struct Factors {
    std::array<Block, products> force, motion;
  };

  /// In the order of their places, so that what lies on or below the diagonal is a tail.
  void sort_free_nodes(std::span<const typename Stencils<Dim>::Node> nodes) {
    sorted_.clear();
    for (std::size_t a = 0; a < nodes.size(); ++a) {
      const std::int32_t place = free_.place[nodes[a].cell];
      if (place >= 0) sorted_.push_back({place, static_cast<std::int32_t>(a)});
    }
    std::sort(sorted_.begin(), sorted_.end());
  }

  void gather() {
    factors_.resize(sorted_.size());
    const Mat<Dim> unit = Mat<Dim>::Identity();
    const Eigen::Map<const Block> diagonal(unit.data());
    for (std::size_t a = 0; a < sorted_.size(); ++a) {
      const std::int32_t node = sorted_[a].node;
      Factors& of = factors_[a];
      for (int v = 0; v < voigt_size<Dim>; ++v) {
        for (int c = 0; c < Dim; ++c) {
          for (int d = 0; d < Dim; ++d) {
            of.force[v][c * Dim + d] = share_.strain_root()(v * Dim + d, node);
            of.motion[v][c * Dim + d] = share_.strain_root()(v * Dim + c, node);
          }
        }
      }
      for (int e = 0; share_.has_resistance() && e < Dim; ++e) {
        const int g = voigt_size<Dim> + e, x = g + Dim;
        of.force[g] = of.motion[x] = share_.weights()(e, node) * diagonal;
        of.force[x] = of.motion[g] = share_.resisted()(e, node) * diagonal;
      }
    }
  }

  Block block(const Factors& of_force, const Factors& of_motion) const {
    Block k = of_force.force[0] * of_motion.motion[0];
    for (int m = 1; m < voigt_size<Dim>; ++m) k += of_force.force[m] * of_motion.motion[m];
    if (!share_.has_resistance()) return k;
    for (int m = voigt_size<Dim>; m < products; ++m) k += of_force.force[m] * of_motion.motion[m];
    return k;
  }

  /// Entries on and below the diagonal in the columns of node b.
  void add_columns_of(std::size_t b) {
    const std::int64_t column = std::int64_t{sorted_[b].place} * Dim;
    std::array<double*, Dim> entries;  // of the matrix's row 0, in each column
    for (int c = 0; c < Dim; ++c) entries[c] = matrix_.column(column + c) - (column + c);
    const Block own = block(factors_[b], factors_[b]);
    for (int c = 0; c < Dim; ++c) {
      for (int d = c; d < Dim; ++d) entries[c][column + d] += own[c * Dim + d];
    }
    for (std::size_t a = b + 1; a < sorted_.size(); ++a) {
      const Block k = block(factors_[a], factors_[b]);
      const std::int64_t row = std::int64_t{sorted_[a].place} * Dim;
      for (int c = 0; c < Dim; ++c) {
        Eigen::Map<Eigen::Array<double, Dim, 1>>(entries[c] + row) += k.template segment<Dim>(c * Dim);
      }
    }
  }

  /// Springs from every node to the cell itself, which may be held.
  void add_star() {
    std::int32_t hub = -1;
    for (const FreeNode& n : sorted_) {
      if (n.node == 0) hub = n.place;
    }
    for (const FreeNode& n : sorted_) {
      const double spring = share_.star()[n.node];
      for (int c = 0; c < Dim; ++c) {
        matrix_.column(std::int64_t{n.place} * Dim + c)[0] += spring;
        if (hub < 0 || n.place == hub) continue;
        matrix_.column(std::int64_t{std::min(n.place, hub)} * Dim + c)[std::int64_t{std::abs(n.place - hub)} * Dim] -=
            spring;
      }
    }
  }

  const Stencils<Dim>& stencils_;
  const FreeCells& free_;
  CellStiffness<Dim> share_;
  BandCholesky& matrix_;
  std::vector<FreeNode> sorted_;
  std::vector<Factors> factors_;  ///< of the sorted nodes
};

/// Of the free cells that one cell's displacements reach, the last place less the first.
template <int Dim>
std::int64_t widest_stencil(const Stencils<Dim>& stencils, const std::vector<std::int32_t>& place) {
  std::int64_t widest = 0;
  for (std::size_t i = 0; i < place.size(); ++i) {
    std::int32_t first = -1, last = -1;
    for (const auto& node : stencils.of(i)) {
      const std::int32_t p = place[node.cell];
      if (p < 0) continue;
      if (first < 0 || p < first) first = p;
      last = std::max(last, p);
    }
    widest = std::max<std::int64_t>(widest, last - first);
  }
  return widest;
}

template <int Dim>
class BandPreconditioner final : public Preconditioner<Dim> {
 public:
  void assemble(const Tissue<Dim>& tissue, const PairTerms<Dim>& terms, const FreeCells& free, double dt_h) override {
    const Stencils<Dim> stencils(tissue.pairs);
    tissue_.reset(std::ssize(free.cell) * Dim, widest_stencil(stencils, free.place) * Dim + Dim - 1);
    const std::vector<std::int32_t> order = order_along_root<Dim>(tissue.cells);
    for_each_chunk(order, inverse_of(order), stencils, 0, [&] {
      return [assembly = BandAssembly<Dim>(tissue, terms, stencils, free, dt_h, tissue_)](std::size_t i) mutable {
        assembly.add(i);
      };
    });
    if (free.cell.size() == tissue.cells.size()) hold_loosely(tissue_);
  }

  bool factor(const std::vector<Mat<Dim>>& contact) override {
    factor_ = tissue_;
    for (std::size_t p = 0; p < contact.size(); ++p) {
      for (int c = 0; c < Dim; ++c) {
        double* const column = factor_.column(static_cast<std::int64_t>(p) * Dim + c);
        for (int r = c; r < Dim; ++r) column[r - c] += contact[p](r, c);
      }
    }
    return factor_.factor();
  }

  void apply(const Eigen::VectorXd& r, Eigen::VectorXd& z) const override {
    z = r;
    factor_.solve(z);
  }

  std::vector<double> save() const override { return tissue_.save(); }
  void restore(const std::vector<double>& saved) override { tissue_.restore(saved); }

 private:
  BandCholesky tissue_, factor_;  ///< the tissue's stiffness, and the factor of it with what it touches
};

}  // namespace

template <int Dim>
double band_work(const PairList& pairs, const FreeCells& free) {
  const auto band = static_cast<double>(widest_stencil(Stencils<Dim>(pairs), free.place) * Dim);
  return static_cast<double>(free.cell.size()) * Dim * band * band;
}

template <int Dim>
std::unique_ptr<Preconditioner<Dim>> make_band_preconditioner() {
  return std::make_unique<BandPreconditioner<Dim>>();
}

template double band_work<2>(const PairList&, const FreeCells&);
template double band_work<3>(const PairList&, const FreeCells&);
template std::unique_ptr<Preconditioner<2>> make_band_preconditioner<2>();
template std::unique_ptr<Preconditioner<3>> make_band_preconditioner<3>();

}  // namespace rootsoil
