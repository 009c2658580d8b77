// SPDX-License-Identifier: MIT
#include "root_sph/dynamics/preconditioner.hpp"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <numeric>
#include <utility>

#include "root_sph/core/symmetric.hpp"
#include "root_sph/dynamics/band_cholesky.hpp"
#include "root_sph/dynamics/cell_axes.hpp"
#include "root_sph/dynamics/tangent.hpp"

namespace rootsoil {
namespace {

/// All cells from the base to the tip.
template <int Dim>
std::vector<std::int32_t> order_along_root(const ParticleStore<Dim>& cells) {
  std::vector<std::int32_t> order(cells.size());
  std::iota(order.begin(), order.end(), 0);
  std::sort(order.begin(), order.end(), [&](std::int32_t a, std::int32_t b) {
    return std::pair(-cells.distance_to_tip[a], a) < std::pair(-cells.distance_to_tip[b], b);
  });
  return order;
}

/// Calls body(cell) so that cells whose stencils meet are never worked on at once, and in the same order for any number
/// of threads: the cells along the root in chunks twice as long as a stencil, even ones first.
/// \param rank of each cell along the root
/// \param apart how many cells must lie between stencils that are worked on at once
/// \param make_body makes the body of a chunk
template <int Dim, class MakeBody>
void for_each_chunk(const std::vector<std::int32_t>& order, const std::vector<std::int32_t>& rank,
                    const Stencils<Dim>& stencils, std::int64_t apart, MakeBody&& make_body) {
  std::int64_t reach = 1;
  for (std::size_t i = 0; i < rank.size(); ++i) {
    for (const auto& node : stencils.of(i)) reach = std::max<std::int64_t>(reach, std::abs(rank[node.cell] - rank[i]));
  }
  const std::int64_t length = 2 * reach + apart, cells = std::ssize(order), chunks = (cells + length - 1) / length;
  for (std::int64_t parity = 0; parity < 2; ++parity) {
#pragma omp parallel for schedule(dynamic, 1)
    for (std::int64_t c = parity; c < chunks; c += 2) {
      auto body = make_body();
      for (std::int64_t k = c * length; k < std::min(cells, (c + 1) * length); ++k) body(order[k]);
    }
  }
}

std::vector<std::int32_t> inverse_of(const std::vector<std::int32_t>& order) {
  std::vector<std::int32_t> rank(order.size());
  for (std::size_t k = 0; k < order.size(); ++k) rank[order[k]] = static_cast<std::int32_t>(k);
  return rank;
}

/// A root that nothing holds may move as a whole without any force: the matrix alone must not let it.
void hold_loosely(BandCholesky& matrix) {
  constexpr double share = 1e-6;
  double largest = 0.0;
  for (std::int64_t c = 0; c < matrix.rows(); ++c) largest = std::max(largest, matrix.column(c)[0]);
  for (std::int64_t c = 0; c < matrix.rows(); ++c) matrix.column(c)[0] += share * largest;
}

/// out[e] += sum_v a(v, column) a(v, column + e): a column of a^T a from its diagonal downwards.
template <int Rows>
void add_square(const Eigen::Matrix<double, Rows, Eigen::Dynamic, Eigen::RowMajor>& a, Eigen::Index column,
                double* __restrict out) {
  const Eigen::Matrix<double, Rows, 1> factor = a.col(column);
  const double* const from = a.data() + column;
  const Eigen::Index stride = a.cols(), length = stride - column;
  for (Eigen::Index e = 0; e < length; ++e) {
    double sum = 0.0;
    for (int v = 0; v < Rows; ++v) sum += factor[v] * from[v * stride + e];
    out[e] += sum;
  }
}

/// out[e] += sum_v (a(v, column) b(v, column + e) + b(v, column) a(v, column + e)): the same of a^T b + b^T a.
template <int Rows>
void add_cross(const Eigen::Matrix<double, Rows, Eigen::Dynamic, Eigen::RowMajor>& a,
               const Eigen::Matrix<double, Rows, Eigen::Dynamic, Eigen::RowMajor>& b, Eigen::Index column,
               double* __restrict out) {
  const Eigen::Matrix<double, Rows, 1> of_a = a.col(column), of_b = b.col(column);
  const double *const from_a = a.data() + column, *const from_b = b.data() + column;
  const Eigen::Index stride = a.cols(), length = stride - column;
  for (Eigen::Index e = 0; e < length; ++e) {
    double sum = 0.0;
    for (int v = 0; v < Rows; ++v) sum += of_a[v] * from_b[v * stride + e] + of_b[v] * from_a[v * stride + e];
    out[e] += sum;
  }
}

/// Adds shares of cells to a band. One for each thread: it holds what it works with.
template <int Dim>
class BandAssembly {
 public:
  BandAssembly(const Tissue<Dim>& tissue, const PairTerms<Dim>& terms, const Stencils<Dim>& stencils,
               const FreeCells& free, double dt_h, BandCholesky& matrix)
      : stencils_(stencils), free_(free), share_(tissue, terms, dt_h), matrix_(matrix) {}

  void add(std::size_t cell) {
    const auto nodes = stencils_.of(cell);
    share_.find(cell, nodes);
    sort_free_nodes(nodes);
    for (std::size_t b = 0; b < sorted_.size(); ++b) add_columns_of(b);
  }

 private:
  struct FreeNode {
    std::int64_t place;
    Eigen::Index node;
  };

  /// In the order of their places, so that what lies on or below the diagonal is a tail.
  void sort_free_nodes(std::span<const typename Stencils<Dim>::Node> nodes) {
    sorted_.clear();
    for (std::size_t a = 0; a < nodes.size(); ++a) {
      const std::int32_t place = free_.place[nodes[a].cell];
      if (place >= 0) sorted_.push_back({place, static_cast<Eigen::Index>(a)});
    }
    std::sort(sorted_.begin(), sorted_.end(), [](const FreeNode& a, const FreeNode& b) { return a.place < b.place; });
    const auto count = static_cast<Eigen::Index>(sorted_.size());
    root_.resize(Eigen::NoChange, count * Dim);
    for (Eigen::Index a = 0; a < count; ++a) {
      root_.template middleCols<Dim>(a * Dim) = share_.strain_root().template middleCols<Dim>(sorted_[a].node * Dim);
    }
    if (!share_.has_resistance()) return;
    weights_.resize(Eigen::NoChange, count);
    resisted_.resize(Eigen::NoChange, count);
    star_.resize(count);
    hub_ = -1;
    for (Eigen::Index a = 0; a < count; ++a) {
      weights_.col(a) = share_.weights().col(sorted_[a].node);
      resisted_.col(a) = share_.resisted().col(sorted_[a].node);
      star_[a] = share_.star()[sorted_[a].node];
      if (sorted_[a].node == 0) hub_ = a;
    }
  }

  /// Entries from node b on, in the columns of node b.
  void add_columns_of(std::size_t b) {
    const auto at = static_cast<Eigen::Index>(b), tail = static_cast<Eigen::Index>(sorted_.size()) - at;
    if (share_.has_resistance()) {
      resistance_.setZero(tail);
      add_cross<Dim>(weights_, resisted_, at, resistance_.data());
      resistance_[0] += star_[at];
      if (at == hub_) {
        resistance_.tail(tail - 1) -= star_.tail(tail - 1);
      } else if (hub_ > at) {
        resistance_[hub_ - at] -= star_[at];
      }
    }
    for (int c = 0; c < Dim; ++c) {
      column_.setZero(tail * Dim);
      add_square<voigt_size<Dim>>(root_, at * Dim + c, column_.data() + c);
      if (share_.has_resistance()) {
        for (Eigen::Index a = 0; a < tail; ++a) column_[a * Dim + c] += resistance_[a];
      }
      const std::int64_t diagonal = sorted_[b].place * Dim + c;
      double* const entries = matrix_.column(diagonal) - diagonal;
      for (int d = c; d < Dim; ++d) entries[diagonal - c + d] += column_[d];  // the rest lies above the diagonal
      for (Eigen::Index a = 1; a < tail; ++a) {
        double* const of_node = entries + sorted_[b + static_cast<std::size_t>(a)].place * Dim;
        for (int d = 0; d < Dim; ++d) of_node[d] += column_[a * Dim + d];
      }
    }
  }

  const Stencils<Dim>& stencils_;
  const FreeCells& free_;
  CellStiffness<Dim> share_;
  BandCholesky& matrix_;
  std::vector<FreeNode> sorted_;
  // of the sorted nodes
  Eigen::Matrix<double, voigt_size<Dim>, Eigen::Dynamic, Eigen::RowMajor> root_;
  Eigen::Matrix<double, Dim, Eigen::Dynamic, Eigen::RowMajor> weights_, resisted_;
  Eigen::VectorXd star_, column_, resistance_;
  Eigen::Index hub_ = -1;  ///< the cell itself, -1: it is held
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
  bool build(const Tissue<Dim>& tissue, const PairTerms<Dim>& terms, const FreeCells& free,
             const std::vector<Mat<Dim>>& contact, double dt_h) override {
    const Stencils<Dim> stencils(tissue.pairs);
    matrix_.reset(std::ssize(free.cell) * Dim, widest_stencil(stencils, free.place) * Dim + Dim - 1);
    const std::vector<std::int32_t> order = order_along_root<Dim>(tissue.cells);
    for_each_chunk(order, inverse_of(order), stencils, 0, [&] {
      return [assembly = BandAssembly<Dim>(tissue, terms, stencils, free, dt_h, matrix_)](std::size_t i) mutable {
        assembly.add(i);
      };
    });
    for (std::size_t i = 0; i < contact.size(); ++i) {
      if (free.place[i] < 0) continue;
      for (int c = 0; c < Dim; ++c) {
        double* const column = matrix_.column(std::int64_t{free.place[i]} * Dim + c);
        for (int r = c; r < Dim; ++r) column[r - c] += contact[i](r, c);
      }
    }
    if (free.cell.size() == tissue.cells.size()) hold_loosely(matrix_);
    return matrix_.factor();
  }

  void apply(const Eigen::VectorXd& r, Eigen::VectorXd& z) const override {
    z = r;
    matrix_.solve(z);
  }

  std::vector<double> save() const override { return matrix_.save(); }
  void restore(const std::vector<double>& saved) override { matrix_.restore(saved); }

 private:
  BandCholesky matrix_;
};

/// Layers of cells across the root, and their affine motions: Dim components times 1 and the place in the layer.
template <int Dim>
struct Layers {
  static constexpr int scalars = 1 + Dim;
  static constexpr int modes = Dim * scalars;
  static constexpr double flat = 1e-2;  ///< mean square of places over a cell's, below which there is no spread
  using Scalars = Eigen::Matrix<double, scalars, 1>;

  std::vector<std::int64_t> of_place;  ///< the layer of each place
  std::vector<std::size_t> first;      ///< places of layer l: [first[l], first[l + 1])
  std::vector<Scalars> scalar;         ///< of each place

  std::int64_t count() const { return std::ssize(first) - 1; }
  std::int64_t largest() const {
    std::size_t most = 0;
    for (std::size_t l = 0; l + 1 < first.size(); ++l) most = std::max(most, first[l + 1] - first[l]);
    return static_cast<std::int64_t>(most);
  }

  /// A layer holds as many cells as fill the root's section.
  Layers(const ParticleStore<Dim>& cells, const FreeCells& free)
      : of_place(free.cell.size()), first{0}, scalar(free.cell.size(), Scalars::Zero()) {
    const std::size_t n = free.cell.size();
    if (n == 0) return;
    double volume = 0.0, filled = 0.0;
    for (const std::int32_t i : free.cell) volume += cells.volume[i];
    const double length = cells.distance_to_tip[free.cell.front()] - cells.distance_to_tip[free.cell.back()];
    const double section = length > 0.0 ? volume / length : volume;
    for (std::size_t p = 0; p < n; ++p) {
      const auto i = static_cast<std::size_t>(free.cell[p]);
      of_place[p] = count();
      filled += 0.5 * cells.volume[i] / half_extent<Dim>(cells.shape[i], cells.frame[i].col(0));
      if (filled < section && p + 1 < n) continue;
      close(cells, free, p + 1);
      filled = 0.0;
    }
  }

 private:
  /// Places of cells from their layer's centre along its principal axes, over their spread; 0 along those on which the
  /// layer has none: it may be flat, or a single cell.
  void close(const ParticleStore<Dim>& cells, const FreeCells& free, std::size_t end) {
    const std::size_t begin = first.back();
    const auto number = static_cast<double>(end - begin);
    Vec<Dim> centre = Vec<Dim>::Zero();
    for (std::size_t p = begin; p < end; ++p) centre += cells.position[free.cell[p]] / number;
    Mat<Dim> moment = Mat<Dim>::Zero();
    double face2 = 0.0;
    for (std::size_t p = begin; p < end; ++p) {
      const Vec<Dim> from_centre = cells.position[free.cell[p]] - centre;
      moment += from_centre * from_centre.transpose() / number;
      face2 += std::pow(cells.volume[free.cell[p]], 2.0 / Dim) / number;
    }
    const SymmetricEigen<Dim> spread = symmetric_eigen<Dim>(moment);
    for (std::size_t p = begin; p < end; ++p) {
      scalar[p][0] = 1.0;
      const Vec<Dim> from_centre = cells.position[free.cell[p]] - centre;
      for (int a = 0; a < Dim; ++a) {
        if (spread.values[a] < flat * face2) continue;
        scalar[p][1 + a] = from_centre.dot(spread.vectors.col(a)) / std::sqrt(spread.values[a]);
      }
    }
    first.push_back(end);
  }
};

/// Adds shares of cells to the blocks of single cells and to the coarse matrix of the layers' motions. One for each
/// thread: it holds what it works with.
template <int Dim>
class LayerAssembly {
  static constexpr int scalars = Layers<Dim>::scalars, modes = Layers<Dim>::modes;

 public:
  LayerAssembly(const Tissue<Dim>& tissue, const PairTerms<Dim>& terms, const Stencils<Dim>& stencils,
                const FreeCells& free, const Layers<Dim>& layers, double dt_h, std::vector<Mat<Dim>>& diagonal,
                BandCholesky& coarse)
      : stencils_(stencils),
        free_(free),
        layers_(layers),
        share_(tissue, terms, dt_h),
        diagonal_(diagonal),
        coarse_(coarse) {}

  void add(std::size_t cell) {
    const auto nodes = stencils_.of(cell);
    // the layers that the stencil touches
    std::int64_t first = layers_.count(), last = -1;
    for (const auto& node : nodes) {
      const std::int32_t p = free_.place[node.cell];
      if (p < 0) continue;
      first = std::min(first, layers_.of_place[p]);
      last = std::max(last, layers_.of_place[p]);
    }
    if (last < 0) return;
    share_.find(cell, nodes);
    const std::int64_t touched = last - first + 1;
    strain_.setZero(voigt_size<Dim>, touched * modes);
    if (share_.has_resistance()) {
      weight_.setZero(Dim, touched * scalars);
      resisted_.setZero(Dim, touched * scalars);
      star_.setZero(scalars, touched * (scalars + 1));
    }
    for (std::size_t a = 0; a < nodes.size(); ++a) {
      const std::int32_t p = free_.place[nodes[a].cell];
      if (p >= 0) add_node(static_cast<Eigen::Index>(a), static_cast<std::size_t>(p), layers_.of_place[p] - first);
    }
    for (Eigen::Index c = 0; c < touched * modes; ++c) {
      add_square<voigt_size<Dim>>(strain_, c, coarse_.column(first * modes + c));
    }
    if (share_.has_resistance()) add_resistance(free_.place[nodes[0].cell], first, touched);
  }

 private:
  void add_node(Eigen::Index node, std::size_t place, std::int64_t layer) {
    const auto& scalar = layers_.scalar[place];
    const Eigen::Matrix<double, voigt_size<Dim>, Dim> w = share_.strain_root().template middleCols<Dim>(node * Dim);
    diagonal_[place].noalias() += w.transpose() * w;
    for (int v = 0; v < voigt_size<Dim>; ++v) {
      double* const row = &strain_(v, layer * modes);
      for (int s = 0; s < scalars; ++s) {
        for (int c = 0; c < Dim; ++c) row[s * Dim + c] += scalar[s] * w(v, c);
      }
    }
    if (!share_.has_resistance()) return;
    const double cross = 2.0 * share_.weights().col(node).dot(share_.resisted().col(node));
    diagonal_[place].diagonal().array() += cross + share_.star()[node];
    for (int s = 0; s < scalars; ++s) {
      weight_.col(layer * scalars + s) += scalar[s] * share_.weights().col(node);
      resisted_.col(layer * scalars + s) += scalar[s] * share_.resisted().col(node);
    }
    if (node == 0) return;
    star_.template middleCols<scalars>(layer * (scalars + 1)) += share_.star()[node] * scalar * scalar.transpose();
    star_.col(layer * (scalars + 1) + scalars) += share_.star()[node] * scalar;
  }

  /// G X^T + X G^T, and sum_a s_a (phi_a - phi_own)(phi_a - phi_own)^T with phi = 0 for held cells.
  void add_resistance(std::int32_t own, std::int64_t first, std::int64_t touched) {
    resistance_.setZero(touched * scalars, touched * scalars);
    for (Eigen::Index s = 0; s < touched * scalars; ++s) {
      add_cross<Dim>(weight_, resisted_, s, &resistance_(s, s));
    }
    for (std::int64_t l = 0; l < touched; ++l) {
      resistance_.template block<scalars, scalars>(l * scalars, l * scalars) +=
          star_.template middleCols<scalars>(l * (scalars + 1));
    }
    if (own >= 0) {
      const auto& scalar = layers_.scalar[own];
      const std::int64_t at = layers_.of_place[own] - first;
      for (std::int64_t l = 0; l < touched; ++l) {
        const Eigen::Matrix<double, scalars, scalars> cross =
            star_.col(l * (scalars + 1) + scalars) * scalar.transpose();
        if (l >= at) resistance_.template block<scalars, scalars>(l * scalars, at * scalars) -= cross;
        if (l <= at) resistance_.template block<scalars, scalars>(at * scalars, l * scalars) -= cross.transpose();
      }
      resistance_.template block<scalars, scalars>(at * scalars, at * scalars) +=
          share_.star()[0] * scalar * scalar.transpose();
    }
    for (Eigen::Index s = 0; s < touched * scalars; ++s) {
      for (int c = 0; c < Dim; ++c) {
        double* const column = coarse_.column(first * modes + s * Dim + c);
        for (Eigen::Index t = s; t < touched * scalars; ++t) column[(t - s) * Dim] += resistance_(t, s);
      }
    }
  }

  const Stencils<Dim>& stencils_;
  const FreeCells& free_;
  const Layers<Dim>& layers_;
  CellStiffness<Dim> share_;
  std::vector<Mat<Dim>>& diagonal_;
  BandCholesky& coarse_;
  // of the layers that a cell's stencil touches
  Eigen::Matrix<double, voigt_size<Dim>, Eigen::Dynamic, Eigen::RowMajor> strain_;
  Eigen::Matrix<double, Dim, Eigen::Dynamic, Eigen::RowMajor> weight_, resisted_;
  Eigen::MatrixXd resistance_;  ///< only its lower half
  Eigen::MatrixXd star_;        ///< for each layer sum s phi phi^T and sum s phi, over its nodes but the cell itself
};

/// Blocks of single cells, added to a coarse space: the affine motions of every layer of cells. A cell's stencil holds
/// so many neighbours that the largest eigenvalue of K over its diagonal blocks is about four: what single cells add is
/// scaled by it, and is then no larger than what the layers add (growth_3d: 2,400 iterations instead of 3,800).
template <int Dim>
class LayerPreconditioner final : public Preconditioner<Dim> {
  static constexpr int scalars = Layers<Dim>::scalars, modes = Layers<Dim>::modes;
  static constexpr double single_cells = 0.25;

 public:
  bool build(const Tissue<Dim>& tissue, const PairTerms<Dim>& terms, const FreeCells& free,
             const std::vector<Mat<Dim>>& contact, double dt_h) override {
    const auto& cells = tissue.cells;
    const Stencils<Dim> stencils(tissue.pairs);
    layers_ = std::make_unique<Layers<Dim>>(cells, free);
    std::vector<Mat<Dim>> diagonal(free.cell.size(), Mat<Dim>::Zero());
    coarse_.reset(layers_->count() * modes, half_band(stencils, free.place));
    const std::vector<std::int32_t> order = order_along_root<Dim>(cells);
    // two stencils that share no cell may share a layer
    for_each_chunk(order, inverse_of(order), stencils, 2 * layers_->largest(), [&] {
      return [assembly = LayerAssembly<Dim>(tissue, terms, stencils, free, *layers_, dt_h, diagonal, coarse_)](
                 std::size_t i) mutable { assembly.add(i); };
    });
    for (std::size_t i = 0; i < contact.size(); ++i) {
      const std::int32_t p = free.place[i];
      if (p < 0 || contact[i].isZero(0.0)) continue;
      diagonal[p] += contact[i];
      Eigen::Matrix<double, Dim, modes> motion;
      for (int s = 0; s < scalars; ++s) {
        motion.template middleCols<Dim>(s * Dim) = layers_->scalar[p][s] * Mat<Dim>::Identity();
      }
      const Eigen::Matrix<double, modes, modes> block = motion.transpose() * contact[i] * motion;
      for (int c = 0; c < modes; ++c) {
        Eigen::Map<Eigen::VectorXd>(coarse_.column(layers_->of_place[p] * modes + c), modes - c) +=
            block.col(c).tail(modes - c);
      }
    }
    inverse_.resize(diagonal.size());
    for (std::size_t p = 0; p < diagonal.size(); ++p) inverse_[p] = single_cells * diagonal[p].inverse();
    for (std::int64_t c = 0; c < coarse_.rows(); ++c) {
      if (coarse_.column(c)[0] <= 0.0) coarse_.column(c)[0] = 1.0;  // a motion that its layer does not have
    }
    if (free.cell.size() == cells.size()) hold_loosely(coarse_);
    return coarse_.factor();
  }

  void apply(const Eigen::VectorXd& r, Eigen::VectorXd& z) const override {
    z.resize(r.size());
    Eigen::VectorXd c(layers_->count() * modes);
#pragma omp parallel for schedule(static)
    for (std::int64_t l = 0; l < layers_->count(); ++l) {
      Eigen::Matrix<double, Dim, scalars> sum = Eigen::Matrix<double, Dim, scalars>::Zero();
      for (std::size_t p = layers_->first[l]; p < layers_->first[l + 1]; ++p) {
        sum += r.segment<Dim>(static_cast<Eigen::Index>(p) * Dim) * layers_->scalar[p].transpose();
      }
      c.segment<modes>(l * modes) = Eigen::Map<const Eigen::Matrix<double, modes, 1>>(sum.data());
    }
    coarse_.solve(c);
#pragma omp parallel for schedule(static)
    for (std::size_t p = 0; p < inverse_.size(); ++p) {
      const auto at = static_cast<Eigen::Index>(p) * Dim;
      const Eigen::Map<const Eigen::Matrix<double, Dim, scalars>> of_layer(c.data() + layers_->of_place[p] * modes);
      z.segment<Dim>(at) = inverse_[p] * r.segment<Dim>(at) + of_layer * layers_->scalar[p];
    }
  }

 private:
  std::int64_t half_band(const Stencils<Dim>& stencils, const std::vector<std::int32_t>& place) const {
    std::int64_t widest = 0;
    for (std::size_t i = 0; i < place.size(); ++i) {
      std::int64_t first = layers_->count(), last = -1;
      for (const auto& node : stencils.of(i)) {
        const std::int32_t p = place[node.cell];
        if (p < 0) continue;
        first = std::min(first, layers_->of_place[p]);
        last = std::max(last, layers_->of_place[p]);
      }
      widest = std::max(widest, last - first);
    }
    return widest * modes + modes - 1;
  }

  std::unique_ptr<Layers<Dim>> layers_;
  std::vector<Mat<Dim>> inverse_;  ///< of each place
  BandCholesky coarse_;
};

}  // namespace

template <int Dim>
FreeCells order_free_cells(const ParticleStore<Dim>& cells) {
  FreeCells free;
  free.place.assign(cells.size(), -1);
  for (const std::int32_t i : order_along_root<Dim>(cells)) {
    if (cells.clamped[i]) continue;
    free.place[i] = static_cast<std::int32_t>(free.cell.size());
    free.cell.push_back(i);
  }
  return free;
}

template <int Dim>
double band_work(const PairList& pairs, const FreeCells& free) {
  const auto band = static_cast<double>(widest_stencil(Stencils<Dim>(pairs), free.place) * Dim);
  return static_cast<double>(free.cell.size()) * Dim * band * band;
}

template <int Dim>
std::unique_ptr<Preconditioner<Dim>> make_band_preconditioner() {
  return std::make_unique<BandPreconditioner<Dim>>();
}

template <int Dim>
std::unique_ptr<Preconditioner<Dim>> make_layer_preconditioner() {
  return std::make_unique<LayerPreconditioner<Dim>>();
}

template FreeCells order_free_cells<2>(const ParticleStore<2>&);
template FreeCells order_free_cells<3>(const ParticleStore<3>&);
template double band_work<2>(const PairList&, const FreeCells&);
template double band_work<3>(const PairList&, const FreeCells&);
template std::unique_ptr<Preconditioner<2>> make_band_preconditioner<2>();
template std::unique_ptr<Preconditioner<3>> make_band_preconditioner<3>();
template std::unique_ptr<Preconditioner<2>> make_layer_preconditioner<2>();
template std::unique_ptr<Preconditioner<3>> make_layer_preconditioner<3>();

}  // namespace rootsoil
