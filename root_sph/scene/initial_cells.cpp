// SPDX-License-Identifier: MIT
#include "root_sph/scene/initial_cells.hpp"

#include "root_sph/core/errors.hpp"
#include "root_sph/io/cell_file.hpp"
#include "root_sph/kernels/wendland.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <random>

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

/// Rotation in the x-y plane.
template <int Dim>
Mat<Dim> rotation(double angle) {
  Mat<Dim> r = Mat<Dim>::Identity();
  r(0, 0) = r(1, 1) = std::cos(angle);
  r(1, 0) = std::sin(angle);
  r(0, 1) = -r(1, 0);
  return r;
}

template <int Dim>
InitialReport fill_capsule(const Scene& scene, Tissue<Dim>& tissue) {
  const RootSection& root = scene.root;
  const double size = root.cell_size_mm, radius = root.radius_mm, length = root.length_mm;
  const double clamp_mm = root.base == "clamped"
                              ? (root.clamp_length_mm > 0.0 ? root.clamp_length_mm : clamp_length_cells * size)
                              : 0.0;
  const double oblique = std::tan(root.base_obliquity_deg * std::numbers::pi / 180.0);
  const auto layers_before = static_cast<int>(std::ceil((clamp_mm + std::abs(oblique) * radius) / size - 1e-9));
  const auto layers = static_cast<int>(std::lround(length / size));
  const auto across = static_cast<int>(std::lround(2.0 * radius / size));
  Noise noise(scene.scene.seed);

  for (int i = -layers_before; i < layers; ++i) {
    for (int j = 0; j < across; ++j) {
      for (int k = 0; k < (Dim == 3 ? across : 1); ++k) {
        Vec<Dim> x;
        x[0] = (i + 0.5) * size;
        x[1] = (j - 0.5 * (across - 1)) * size;
        if constexpr (Dim == 3) x[2] = (k - 0.5 * (across - 1)) * size;
        const double lateral = x.template tail<Dim - 1>().norm();
        const double beyond = root.cap ? std::max(0.0, x[0] - (length - radius)) : 0.0;
        if (lateral * lateral + beyond * beyond > radius * radius) continue;
        const double from_cut = x[0] - oblique * x[1];
        if (from_cut < -clamp_mm) continue;
        const bool clamped = from_cut < 0.0 && clamp_mm > 0.0;
        if (from_cut < 0.0 && !clamped) continue;

        const double arc = x[0];
        if (!clamped && root.jitter > 0.0) {
          for (int a = 0; a < Dim; ++a) x[a] += root.jitter * size * noise();
        }
        const double volume =
            std::pow(size, Dim) * (root.size_variation > 0.0 ? 1.0 + root.size_variation * noise() : 1.0);
        const double cell_length = std::pow(volume, 1.0 / Dim);
        Mat<Dim> frame = Mat<Dim>::Identity();
        if (root.curvature_per_mm != 0.0) {
          // the straight axis becomes an arc that starts along x
          const double angle = root.curvature_per_mm * x[0];
          frame = rotation<Dim>(angle);
          const double y = x[1];
          x[0] = (1.0 / root.curvature_per_mm - y) * std::sin(angle);
          x[1] = 1.0 / root.curvature_per_mm - (1.0 / root.curvature_per_mm - y) * std::cos(angle);
        }
        const std::size_t cell = add_cell<Dim>(tissue, x, volume,
                                               4.0 / (cell_length * cell_length) * Mat<Dim>::Identity(), frame, clamped);
        tissue.cells.distance_to_tip[cell] = length - arc;
      }
    }
  }
  return {size, 1.0};
}

/// Rotation that takes the named axis of the file ("+x", "-y", ...) to +x.
Mat<3> to_tip_axis(const std::string& name) {
  const int axis = name[1] - 'x';
  Vec<3> from = Vec<3>::Zero();
  from[axis] = name[0] == '-' ? -1.0 : 1.0;
  return Eigen::Quaterniond::FromTwoVectors(from, Vec<3>::UnitX()).toRotationMatrix();
}

/// Factor that makes volumes fill the tissue: ellipsoids leave gaps. In the interior the kernel sum of the volumes,
/// sum_j V_j W_ij, is 1 where volumes fill space, so the factor is the median of its inverse over interior cells;
/// one factor for all cells keeps the measured ratios of their sizes.
double filling_scale(const Tissue<3>& tissue, double eta) {
  const auto& cells = tissue.cells;
  std::vector<Mat<3>> metrics;
  for (std::size_t i = 0; i < cells.size(); ++i) metrics.push_back(cell_metric<3>(cells.shape[i], eta));
  const PairList list = find_pairs<3>(cells.position.values(), metrics);
  std::vector<double> sum(cells.size()), reach(cells.size(), 0.0);
  std::vector<Vec<3>> side(cells.size(), Vec<3>::Zero());
  for (std::size_t i = 0; i < cells.size(); ++i) {
    sum[i] = cells.volume[i] * wendland<3>(0.0, std::sqrt(metrics[i].determinant()));
  }
  for (const auto& [i, j] : list.pairs) {
    const Vec<3> r = cells.position[j] - cells.position[i];
    const Mat<3> metric = 0.5 * (metrics[i] + metrics[j]);
    const double w = wendland<3>(std::sqrt(r.dot(metric * r)), std::sqrt(metric.determinant()));
    sum[i] += cells.volume[j] * w;
    sum[j] += cells.volume[i] * w;
    side[i] += cells.volume[j] * w * r;
    side[j] -= cells.volume[i] * w * r;
    reach[i] += cells.volume[j] * w * r.norm();
    reach[j] += cells.volume[i] * w * r.norm();
  }
  std::vector<double> inverse;
  for (const double most_one_sided : {0.2, 2.0}) {  // a root without interior cells: all of them
    for (std::size_t i = 0; i < cells.size(); ++i) {
      if (reach[i] > 0.0 && side[i].norm() < most_one_sided * reach[i]) inverse.push_back(1.0 / sum[i]);
    }
    if (!inverse.empty()) break;
  }
  if (inverse.empty()) return 1.0;
  std::nth_element(inverse.begin(), inverse.begin() + std::ssize(inverse) / 2, inverse.end());
  return inverse[inverse.size() / 2];
}

InitialReport fill_from_file(const Scene& scene, Tissue<3>& tissue, double eta) {
  const std::vector<MeasuredCell> measured = read_cell_file(scene.root.cells_file);
  const Mat<3> turn = to_tip_axis(scene.root.tip_axis);
  Vec<3> lower = Vec<3>::Constant(1e300), centre = Vec<3>::Zero();
  double size = 0.0;
  std::int64_t highest = -1;
  for (const MeasuredCell& cell : measured) {
    const Vec<3> x = turn * cell.position_mm;
    lower = lower.cwiseMin(x);
    centre += x / static_cast<double>(measured.size());
    size += std::cbrt(volume_mm3(cell)) / static_cast<double>(measured.size());
    highest = std::max(highest, cell.label);
  }
  const double clamp_mm =
      scene.root.base == "clamped"
          ? (scene.root.clamp_length_mm > 0.0 ? scene.root.clamp_length_mm : clamp_length_cells * size)
          : 0.0;
  const Vec<3> origin(lower[0] + clamp_mm, centre[1], centre[2]);
  for (const MeasuredCell& cell : measured) {
    const Vec<3> x = turn * cell.position_mm - origin;
    const std::size_t i = add_cell<3>(tissue, x, volume_mm3(cell), turn * shape_matrix(cell) * turn.transpose(),
                                      Mat<3>::Identity(), clamp_mm > 0.0 && x[0] < 0.0);
    tissue.cells.cell_id[i] = cell.label;
  }
  tissue.next_cell_id = highest + 1;

  const double scale = filling_scale(tissue, eta);
  double tip = -1e300;
  for (std::size_t i = 0; i < tissue.cells.size(); ++i) {
    tissue.cells.volume[i] *= scale;
    tip = std::max(tip, tissue.cells.position[i][0]);
  }
  for (std::size_t i = 0; i < tissue.cells.size(); ++i) {
    tissue.cells.distance_to_tip[i] = tip - tissue.cells.position[i][0];
  }
  return {size * std::cbrt(scale), scale};
}

}  // namespace

template <int Dim>
InitialReport make_initial_cells(const Scene& scene, Tissue<Dim>& tissue, double eta) {
  InitialReport report;
  if (scene.root.cells_file.empty()) {
    report = fill_capsule<Dim>(scene, tissue);
  } else if constexpr (Dim == 3) {
    report = fill_from_file(scene, tissue, eta);
  } else {
    throw InputError({scene.file, 0, "root.cells_file", "cells measured by microscopy are three-dimensional",
                      "dimension = 2", "dimension = 3", "set scene.dimension = 3"});
  }
  auto& cells = tissue.cells;
  for (std::size_t i = 0; i < cells.size(); ++i) cells.mass[i] = scene.tissue.rho0_ug_mm3 * cells.volume[i];
  const auto free = std::count(cells.clamped.values().begin(), cells.clamped.values().end(), 0);
  if (free < 3) {
    throw InputError({scene.file, 0, "root", fmt::format("only {} cells can move", free), "", "",
                      "make the root longer or its cells smaller"});
  }
  return report;
}

template InitialReport make_initial_cells<2>(const Scene&, Tissue<2>&, double);
template InitialReport make_initial_cells<3>(const Scene&, Tissue<3>&, double);

}  // namespace rootsoil
