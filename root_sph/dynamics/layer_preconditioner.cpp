// SPDX-License-Identifier: MIT
#include <Eigen/LU>
#include <cmath>
#include <span>

#include "root_sph/core/symmetric.hpp"
#include "root_sph/dynamics/assembly.hpp"
#include "root_sph/dynamics/cell_axes.hpp"
#include "root_sph/dynamics/preconditioner.hpp"

namespace rootsoil {
namespace {

/// Layers of cells across the root, and their affine motions: 1 and the place in the layer (scalar s) along each axis
/// c; mode c scalars + s.
template <int Dim>
struct Layers {
  static constexpr int scalars = 1 + Dim;
  static constexpr int modes = Dim * scalars;
  static constexpr double flat = 1e-2;  ///< mean square of places over a cell's, below which there is no spread
  using Scalars = Eigen::Matrix<double, scalars, 1>;

  std::vector<std::int64_t> of_place;  ///< the layer of each place
  std::vector<std::size_t> first{0};   ///< places of layer l: [first[l], first[l + 1])
  std::vector<Scalars> scalar;         ///< of each place

  std::int64_t count() const { return std::ssize(first) - 1; }
  std::int64_t largest() const {
    std::size_t most = 0;
    for (std::size_t l = 0; l + 1 < first.size(); ++l) most = std::max(most, first[l + 1] - first[l]);
    return static_cast<std::int64_t>(most);
  }

  /// The layers that a stencil touches: the first, and how many.
  std::pair<std::int64_t, std::int64_t> touched(std::span<const typename Stencils<Dim>::Node> nodes,
                                                const std::vector<std::int32_t>& place) const {
    std::int64_t low = count(), high = -1;
    for (const auto& node : nodes) {
      const std::int32_t p = place[node.cell];
      if (p < 0) continue;
      low = std::min(low, of_place[p]);
      high = std::max(high, of_place[p]);
    }
    return {low, std::max<std::int64_t>(high - low + 1, 0)};
  }

  Layers() = default;
  /// A layer holds as many cells as fill the root's section.
  Layers(const ParticleStore<Dim>& cells, const FreeCells& free)
      : of_place(free.cell.size()), scalar(free.cell.size(), Scalars::Zero()) {
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
    const auto [first, touched] = layers_.touched(nodes, free_.place);
    if (touched == 0) return;
    share_.find(cell, nodes);
    strain_.setZero(Eigen::NoChange, touched * modes);
    if (share_.has_resistance()) {
      weight_.setZero(Eigen::NoChange, touched * scalars);
      resisted_.setZero(Eigen::NoChange, touched * scalars);
      star_.setZero(Eigen::NoChange, touched * (scalars + 1));
    }
    add_blocks(nodes);
    for (std::size_t a = 0; a < nodes.size(); ++a) {
      const std::int32_t p = free_.place[nodes[a].cell];
      if (p >= 0) add_motion(static_cast<Eigen::Index>(a), layers_.scalar[p], layers_.of_place[p] - first);
    }
    for (Eigen::Index m = 0; m < touched * modes; ++m) {
      add_square<voigt_size<Dim>>(strain_, m, coarse_.column(first * modes + m));
    }
    if (share_.has_resistance()) add_resistance(free_.place[nodes[0].cell], first, touched);
  }

 private:
  /// W^T W and P of every node with itself.
  void add_blocks(std::span<const typename Stencils<Dim>::Node> nodes) {
    const auto& w = share_.strain_root();
    const Eigen::Index count = w.cols();
    block_.setZero(Eigen::NoChange, count);
    int row = 0;
    for (int c = 0; c < Dim; ++c) {
      for (int d = 0; d <= c; ++d, ++row) {
        for (int v = 0; v < voigt_size<Dim>; ++v) {
          const double *const of_c = w.data() + (v * Dim + c) * count, *const of_d = w.data() + (v * Dim + d) * count;
          double* __restrict out = block_.data() + row * count;
          for (Eigen::Index a = 0; a < count; ++a) out[a] += of_c[a] * of_d[a];
        }
      }
    }
    for (Eigen::Index a = 0; a < count; ++a) {
      const std::int32_t p = free_.place[nodes[static_cast<std::size_t>(a)].cell];
      if (p < 0) continue;
      double resistance = 0.0;
      if (share_.has_resistance()) {
        resistance = 2.0 * share_.weights().col(a).dot(share_.resisted().col(a)) + share_.star()[a];
      }
      row = 0;
      for (int c = 0; c < Dim; ++c) {
        for (int d = 0; d <= c; ++d, ++row) diagonal_[p](c, d) += block_(row, a) + (c == d ? resistance : 0.0);
      }
    }
  }

  /// What a node adds to its layer's motions.
  void add_motion(Eigen::Index node, const typename Layers<Dim>::Scalars& scalar, std::int64_t layer) {
    const auto add = [&](double* __restrict to, double of_node) {
      for (int s = 0; s < scalars; ++s) to[s] += scalar[s] * of_node;
    };
    for (int v = 0; v < voigt_size<Dim>; ++v) {
      for (int c = 0; c < Dim; ++c) {
        add(&strain_(v, layer * modes + c * scalars), share_.strain_root()(v * Dim + c, node));
      }
    }
    if (!share_.has_resistance()) return;
    for (int c = 0; c < Dim; ++c) {
      add(&weight_(c, layer * scalars), share_.weights()(c, node));
      add(&resisted_(c, layer * scalars), share_.resisted()(c, node));
    }
    if (node == 0) return;
    star_.template middleCols<scalars>(layer * (scalars + 1)) += share_.star()[node] * scalar * scalar.transpose();
    star_.col(layer * (scalars + 1) + scalars) += share_.star()[node] * scalar;
  }

  /// G X^T + X G^T, and sum_a s_a (phi_a - phi_own)(phi_a - phi_own)^T with phi = 0 for held cells: the same along each
  /// axis.
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
    for (std::int64_t l = 0; l < touched; ++l) {
      for (int c = 0; c < Dim; ++c) {
        for (int s = 0; s < scalars; ++s) {
          const std::int64_t column = l * modes + c * scalars + s;
          double* const entries = coarse_.column(first * modes + column) - column;
          for (std::int64_t m = l; m < touched; ++m) {
            for (int t = m == l ? s : 0; t < scalars; ++t) {
              entries[m * modes + c * scalars + t] += resistance_(m * scalars + t, l * scalars + s);
            }
          }
        }
      }
    }
  }

  const Stencils<Dim>& stencils_;
  const FreeCells& free_;
  const Layers<Dim>& layers_;
  CellStiffness<Dim> share_;
  std::vector<Mat<Dim>>& diagonal_;  ///< only their lower halves
  BandCholesky& coarse_;
  NodeRows<voigt_size<Dim>> block_;  ///< of each node with itself, the lower half
  // of the layers that a cell's stencil touches
  NodeRows<voigt_size<Dim>> strain_;
  NodeRows<Dim> weight_, resisted_;
  Eigen::MatrixXd resistance_;                           ///< only its lower half
  Eigen::Matrix<double, scalars, Eigen::Dynamic> star_;  ///< for each layer sum s phi phi^T and sum s phi, over its
                                                         ///< nodes but the cell itself
};

/// Blocks of single cells, added to a coarse space: the affine motions of every layer of cells. A cell's stencil holds
/// so many neighbours that the largest eigenvalue of K over its diagonal blocks is about four: what single cells add is
/// scaled by it, and is then no larger than what the layers add (growth_3d: 2,400 iterations instead of 3,800).
template <int Dim>
class LayerPreconditioner final : public Preconditioner<Dim> {
  static constexpr int scalars = Layers<Dim>::scalars, modes = Layers<Dim>::modes;
  static constexpr double single_cells = 0.25;

 public:
  void assemble(const Tissue<Dim>& tissue, const PairTerms<Dim>& terms, const FreeCells& free, double dt_h) override {
    const auto& cells = tissue.cells;
    const Stencils<Dim> stencils(tissue.pairs);
    layers_ = Layers<Dim>(cells, free);
    diagonal_.assign(free.cell.size(), Mat<Dim>::Zero());
    tissue_.reset(layers_.count() * modes, half_band(stencils, free.place));
    const std::vector<std::int32_t> order = order_along_root<Dim>(cells);
    // two stencils that share no cell may share a layer
    for_each_chunk(order, inverse_of(order), stencils, 2 * layers_.largest(), [&] {
      return [assembly = LayerAssembly<Dim>(tissue, terms, stencils, free, layers_, dt_h, diagonal_, tissue_)](
                 std::size_t i) mutable { assembly.add(i); };
    });
    for (std::int64_t c = 0; c < tissue_.rows(); ++c) {
      if (tissue_.column(c)[0] <= 0.0) tissue_.column(c)[0] = 1.0;  // a motion that its layer does not have
    }
    if (free.cell.size() == cells.size()) hold_loosely(tissue_);
  }

  bool factor(const std::vector<Mat<Dim>>& contact) override {
    coarse_ = tissue_;
    inverse_.resize(diagonal_.size());
    for (std::size_t p = 0; p < diagonal_.size(); ++p) {
      Mat<Dim> block = diagonal_[p].template selfadjointView<Eigen::Lower>();
      if (!contact.empty()) {
        block += contact[p];
        add_to_layer(p, contact[p]);
      }
      inverse_[p] = single_cells * block.inverse();
    }
    return coarse_.factor();
  }

  void apply(const Eigen::VectorXd& r, Eigen::VectorXd& z) const override {
    z.resize(r.size());
    Eigen::VectorXd c(layers_.count() * modes);
#pragma omp parallel for schedule(static)
    for (std::int64_t l = 0; l < layers_.count(); ++l) {
      Eigen::Matrix<double, scalars, Dim> sum = Eigen::Matrix<double, scalars, Dim>::Zero();
      for (std::size_t p = layers_.first[l]; p < layers_.first[l + 1]; ++p) {
        sum += layers_.scalar[p] * r.segment<Dim>(static_cast<Eigen::Index>(p) * Dim).transpose();
      }
      c.segment<modes>(l * modes) = Eigen::Map<const Eigen::Matrix<double, modes, 1>>(sum.data());
    }
    coarse_.solve(c);
#pragma omp parallel for schedule(static)
    for (std::size_t p = 0; p < inverse_.size(); ++p) {
      const auto at = static_cast<Eigen::Index>(p) * Dim;
      const Eigen::Map<const Eigen::Matrix<double, scalars, Dim>> of_layer(c.data() + layers_.of_place[p] * modes);
      z.segment<Dim>(at) = inverse_[p] * r.segment<Dim>(at) + of_layer.transpose() * layers_.scalar[p];
    }
  }

  std::vector<double> save() const override {
    std::vector<double> saved{static_cast<double>(layers_.scalar.size()), static_cast<double>(layers_.count())};
    saved.insert(saved.end(), layers_.first.begin(), layers_.first.end());
    for (const auto& scalar : layers_.scalar) saved.insert(saved.end(), scalar.begin(), scalar.end());
    for (const Mat<Dim>& block : diagonal_) {
      saved.insert(saved.end(), block.reshaped().begin(), block.reshaped().end());
    }
    const std::vector<double> of_tissue = tissue_.save();
    saved.insert(saved.end(), of_tissue.begin(), of_tissue.end());
    return saved;
  }

  void restore(const std::vector<double>& saved) override {
    const auto places = static_cast<std::size_t>(saved.at(0)), count = static_cast<std::size_t>(saved.at(1));
    const double* from = saved.data() + 2;
    layers_ = {};
    layers_.first.assign(from, from + count + 1);
    from += count + 1;
    for (std::size_t l = 0; l < count; ++l) {
      layers_.of_place.resize(layers_.first[l + 1], static_cast<std::int64_t>(l));
    }
    for (std::size_t p = 0; p < places; ++p, from += scalars) {
      layers_.scalar.push_back(Eigen::Map<const typename Layers<Dim>::Scalars>(from));
    }
    diagonal_.clear();
    for (std::size_t p = 0; p < places; ++p, from += Dim * Dim) diagonal_.push_back(Eigen::Map<const Mat<Dim>>(from));
    tissue_.restore({from, saved.data() + saved.size()});
  }

 private:
  /// What a cell touches, for the motions of its layer.
  void add_to_layer(std::size_t place, const Mat<Dim>& contact) {
    if (contact.isZero(0.0)) return;
    Eigen::Matrix<double, Dim, modes> motion = Eigen::Matrix<double, Dim, modes>::Zero();
    for (int c = 0; c < Dim; ++c) {
      motion.template block<1, scalars>(c, c * scalars) = layers_.scalar[place].transpose();
    }
    const Eigen::Matrix<double, modes, modes> block = motion.transpose() * contact * motion;
    for (int m = 0; m < modes; ++m) {
      Eigen::Map<Eigen::VectorXd>(coarse_.column(layers_.of_place[place] * modes + m), modes - m) +=
          block.col(m).tail(modes - m);
    }
  }

  std::int64_t half_band(const Stencils<Dim>& stencils, const std::vector<std::int32_t>& place) const {
    std::int64_t widest = 0;
    for (std::size_t i = 0; i < place.size(); ++i) {
      widest = std::max(widest, layers_.touched(stencils.of(i), place).second - 1);
    }
    return widest * modes + modes - 1;
  }

  Layers<Dim> layers_;
  std::vector<Mat<Dim>> diagonal_;  ///< of each place, the tissue's, the lower half
  BandCholesky tissue_;             ///< what it resists of the layers' motions
  // with what it touches
  std::vector<Mat<Dim>> inverse_;  ///< of each place
  BandCholesky coarse_;
};

}  // namespace

template <int Dim>
std::unique_ptr<Preconditioner<Dim>> make_layer_preconditioner() {
  return std::make_unique<LayerPreconditioner<Dim>>();
}

template std::unique_ptr<Preconditioner<2>> make_layer_preconditioner<2>();
template std::unique_ptr<Preconditioner<3>> make_layer_preconditioner<3>();

}  // namespace rootsoil
