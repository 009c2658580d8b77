// SPDX-License-Identifier: MIT
#include "root_sph/model/initial_cells.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <numeric>
#include <random>

#include "root_sph/core/errors.hpp"
#include "root_sph/effects/division/division.hpp"
#include "root_sph/effects/table.hpp"
#include "root_sph/kernels/wendland.hpp"
#include "root_sph/model/theory.hpp"
#include "root_sph/model/whole_tissue.hpp"

namespace rootsoil {
namespace {

constexpr double clamp_length_cells = 3.0;

/// Uniform in [-1, 1], the same on every platform.
class Noise {
 public:
  explicit Noise(std::int64_t seed) : engine_(static_cast<std::uint64_t>(seed)) {}
  double operator()() { return 2.0 * (static_cast<double>(engine_() >> 11) * 0x1.0p-53) - 1.0; }

 private:
  std::mt19937_64 engine_;
};

template <int Dim>
std::size_t add_cell(Tissue<Dim>& tissue, const Vec<Dim>& position, double volume, const Mat<Dim>& shape,
                     const Mat<Dim>& frame, bool clamped) {
  auto& cells = tissue.cells;
  const std::size_t i = cells.size();
  cells.resize(i + 1);
  cells.position[i] = position;
  cells.volume[i] = volume;
  cells.shape[i] = shape;
  cells.frame[i] = frame;
  cells.clamped[i] = clamped;
  cells.cell_id[i] = tissue.next_cell_id++;
  cells.parent_id[i] = -1;
  return i;
}

/// Q of a cell of this size, volume^(1/Dim), as long and as wide as its place in the lattice. Where the lattice is not
/// stretched this is 4/size^2 to the last bit.
/// \param relative_length of the place, in layers
template <int Dim>
Mat<Dim> lattice_cell_shape(double size_mm, double relative_length, const Lattice& lattice, const Vec<Dim>& axis) {
  const double mean = lattice.mean_stretch * std::pow(relative_length, 1.0 / Dim);
  const double along = std::pow(mean / (lattice.stretch_along * relative_length), 2);
  const double across = std::pow(mean / lattice.stretch_across, 2);
  return 4.0 / (size_mm * size_mm) * (across * Mat<Dim>::Identity() + (along - across) * axis * axis.transpose());
}

/// Rotation in the x-y plane.
template <int Dim>
Mat<Dim> rotation(double angle) {
  Mat<Dim> r = Mat<Dim>::Identity();
  r(0, 0) = r(1, 1) = std::cos(angle);
  r(1, 0) = std::sin(angle);
  r(0, 1) = -r(1, 0);
  return r;
}

/// A row of cells that divide at different times, along the root: where they lie and how long they are, in layers of
/// the lattice. Between two divisions cells are spread evenly over the logarithm of their length, from half of the
/// longest on.
struct Row {
  std::vector<double> middle, length;

  Row(int cells, Noise& noise) {
    for (int k = 0; k < cells; ++k) length.push_back(std::exp2(0.5 * noise()));
    const double unit = static_cast<double>(cells) / std::accumulate(length.begin(), length.end(), 0.0);
    double end = 0.0;
    for (double& l : length) {
      l *= unit;
      middle.push_back(end + 0.5 * l);
      end += l;
    }
  }
};

template <int Dim>
InitialReport fill_capsule(const Scene& scene, Tissue<Dim>& tissue) {
  const RootSection& root = scene.root;
  const double radius = root.radius_mm, length = root.length_mm;
  const Lattice lattice = fit_lattice(root, Dim);
  Vec<Dim> spacing = Vec<Dim>::Constant(lattice.across_mm);
  spacing[0] = lattice.along_mm;
  const double cell_volume =
      std::pow(root.cell_size_mm, Dim) * lattice.stretch_along * std::pow(lattice.stretch_across, Dim - 1);
  const double clamp_mm = root.is_clamped() ? root.clamp_length_mm.value_or(clamp_length_cells * spacing[0]) : 0.0;
  const double oblique = std::tan(root.base_obliquity_deg * std::numbers::pi / 180.0);
  const auto layers_before = static_cast<int>(std::ceil((clamp_mm + std::abs(oblique) * radius) / spacing[0] - 1e-9));
  Noise noise(scene.scene.seed);
  const auto* const division = scene.find<DivisionSection>();
  std::vector<Row> rows;
  for (int row = 0; division && division->asynchronous && row < std::pow(lattice.across, Dim - 1); ++row) {
    rows.emplace_back(lattice.layers, noise);
  }

  for (int i = -layers_before; i < lattice.layers; ++i) {
    for (int j = 0; j < lattice.across; ++j) {
      for (int k = 0; k < (Dim == 3 ? lattice.across : 1); ++k) {
        const Row* const row = rows.empty() || i < 0 ? nullptr : &rows[Dim == 3 ? j * lattice.across + k : j];
        const double relative_length = row ? row->length[i] : 1.0;
        Vec<Dim> x;
        x[0] = (row ? row->middle[i] : i + 0.5) * spacing[0];
        x[1] = (j - 0.5 * (lattice.across - 1)) * spacing[1];
        if constexpr (Dim == 3) x[2] = (k - 0.5 * (lattice.across - 1)) * spacing[2];
        const double lateral = x.template tail<Dim - 1>().norm();
        // half an ellipsoid where the outermost centres are not as far out as the tissue
        const double beyond = root.cap ? lattice.outer_mm / radius * std::max(0.0, x[0] - (length - radius)) : 0.0;
        if (lateral * lateral + beyond * beyond > lattice.outer_mm * lattice.outer_mm) continue;
        const double from_cut = x[0] - oblique * x[1];
        if (from_cut < -clamp_mm) continue;
        const bool clamped = from_cut < 0.0 && clamp_mm > 0.0;
        if (from_cut < 0.0 && !clamped) continue;

        const double arc = x[0];
        if (!clamped && root.jitter > 0.0) {
          for (int a = 0; a < Dim; ++a) x[a] += root.jitter * spacing[a] * noise();
        }
        const double volume =
            relative_length * cell_volume * (root.size_variation > 0.0 ? 1.0 + root.size_variation * noise() : 1.0);
        const double cell_size = std::pow(volume, 1.0 / Dim);
        Mat<Dim> frame = Mat<Dim>::Identity();
        if (root.curvature_per_mm != 0.0) {
          // the straight axis becomes an arc that starts along x
          const double angle = root.curvature_per_mm * x[0];
          frame = rotation<Dim>(angle);
          const double y = x[1];
          x[0] = (1.0 / root.curvature_per_mm - y) * std::sin(angle);
          x[1] = 1.0 / root.curvature_per_mm - (1.0 / root.curvature_per_mm - y) * std::cos(angle);
        }
        const std::size_t cell =
            add_cell<Dim>(tissue, x, volume, lattice_cell_shape<Dim>(cell_size, relative_length, lattice, frame.col(0)),
                          frame, clamped);
        tissue.cells.distance_to_tip[cell] = length - arc;
      }
    }
  }
  return {.cell_size_mm = root.cell_size_mm * lattice.mean_stretch,
          .lattice = lattice,
          .across = static_cast<double>(lattice.across)};
}

/// Diameter of the cylinder with this tissue's volume and length, in cells.
double cells_across(const Tissue<3>& tissue, double cell_size_mm) {
  const auto& volume = tissue.cells.volume.values();
  const auto& distance = tissue.cells.distance_to_tip.values();
  const double length_mm = *std::max_element(distance.begin(), distance.end()) + cell_size_mm;  // to the cells' ends
  const double section = std::accumulate(volume.begin(), volume.end(), 0.0) / length_mm;
  return std::sqrt(4.0 / std::numbers::pi * section) / cell_size_mm;
}

InitialReport fill_from_file(const Scene& scene, Tissue<3>& tissue) {
  const MeasuredRoot root = read_measured_root(scene);
  const double scale = root.report.hull_mm3 / root.report.cells_mm3;
  Vec<3> centre = Vec<3>::Zero();
  // A clamp holds whatever it grips. Cells that reach into it, and could move, would grow against those around them.
  constexpr double gripped = 0.8;  // of the half length: a cell that ends where the clamp does is not
  const auto half_length = [](const MeasuredCell& cell) { return std::sqrt(5.0 * covariance(cell)(0, 0)); };
  double base = 1e300, tip = -1e300, size = 0.0;
  std::int64_t highest = -1;
  for (const MeasuredCell& cell : root.cells) {
    base = std::min(base, cell.position_mm[0] - half_length(cell));
    tip = std::max(tip, cell.position_mm[0]);
    centre += cell.position_mm / static_cast<double>(root.cells.size());
    size += std::cbrt(scale * cell.volume_mm3) / static_cast<double>(root.cells.size());
    highest = std::max(highest, cell.label);
  }
  const double clamp_mm =
      scene.root.is_clamped() ? scene.root.clamp_length_mm.value_or(clamp_length_cells * size) : 0.0;
  const Vec<3> origin(base + clamp_mm, centre[1], centre[2]);
  for (const MeasuredCell& cell : root.cells) {
    const Vec<3> x = cell.position_mm - origin;
    const std::size_t i = add_cell<3>(tissue, x, scale * cell.volume_mm3, shape_matrix(cell), Mat<3>::Identity(),
                                      clamp_mm > 0.0 && x[0] < gripped * half_length(cell));
    tissue.cells.cell_id[i] = cell.label;
    tissue.cells.distance_to_tip[i] = tip - cell.position_mm[0];
  }
  tissue.next_cell_id = highest + 1;
  return {.cell_size_mm = size,
          .volume_scale = scale,
          .lattice = {},
          .measured = root.report,
          .across = cells_across(tissue, size)};
}

template <int Dim>
std::vector<Mat<Dim>> kernel_metrics(const NumericsSection& numerics, const Tissue<Dim>& tissue, double eta,
                                     double cell_size_mm) {
  if (numerics.kernel == Kernel::isotropic) {
    return std::vector<Mat<Dim>>(tissue.cells.size(),
                                 isotropic_metric<Dim>(isotropic_kernel_mm(numerics, Dim, cell_size_mm)));
  }
  std::vector<Mat<Dim>> metrics;
  metrics.reserve(tissue.cells.size());
  for (const Mat<Dim>& shape : tissue.cells.shape.values()) metrics.push_back(cell_metric<Dim>(shape, eta));
  return metrics;
}

}  // namespace

template <int Dim>
InitialReport make_initial_cells(const Scene& scene, Tissue<Dim>& tissue, double eta) {
  InitialReport report;
  if (scene.root.is_lattice()) {
    report = fill_capsule<Dim>(scene, tissue);
  } else if constexpr (Dim == 3) {
    report = fill_from_file(scene, tissue);
  } else {
    throw InputError({scene.file, 0, "root.cells_file", "cells measured by microscopy are three-dimensional",
                      "dimension = 2", "dimension = 3", "set scene.dimension = 3"});
  }
  auto& cells = tissue.cells;
  for (std::size_t i = 0; i < cells.size(); ++i) {
    if (!cells.clamped[i]) report.volume += cells.volume[i];
  }
  for (std::size_t i = 0; i < cells.size(); ++i) cells.mass[i] = scene.tissue.rho0_ug_mm3 * cells.volume[i];
  const auto free = std::count(cells.clamped.values().begin(), cells.clamped.values().end(), 0);
  if (free < 3) {
    throw InputError({scene.file, 0, "root", fmt::format("only {} cells can move", free), "", "",
                      "make the root longer or its cells smaller"});
  }
  refuse_torn_lattice<Dim>(scene, tissue);
  refuse_thread<Dim>(scene, tissue);
  refuse_lonely_cells<Dim>(scene, tissue, kernel_metrics<Dim>(scene.numerics, tissue, eta, report.cell_size_mm));
  refuse_hasty_division<Dim>(scene, tissue);
  const FreeGrowth growth = free_growth<Dim>(scene);
  for (const EffectSpec& effect : effect_table()) {
    if (effect.called_for(scene)) effect.check_start(scene, tissue, growth);
  }
  return report;
}

template <int Dim>
void refuse_unfit_cells(const Scene& scene) {
  Tissue<Dim> tissue;
  make_initial_cells<Dim>(scene, tissue, scene.numerics.eta);
}

template void refuse_unfit_cells<2>(const Scene&);
template void refuse_unfit_cells<3>(const Scene&);
template InitialReport make_initial_cells<2>(const Scene&, Tissue<2>&, double);
template InitialReport make_initial_cells<3>(const Scene&, Tissue<3>&, double);

}  // namespace rootsoil
