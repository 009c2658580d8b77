// SPDX-License-Identifier: MIT
// A block of tissue made from a cloud, ready for the parts of the solver to be called one by one.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <vector>

#include "root_sph/dynamics/gradient.hpp"
#include "root_sph/dynamics/pair_loop.hpp"
#include "root_sph/kernels/wendland.hpp"
#include "tests/support/clouds.hpp"

namespace rootsoil::test {

/// Table 1 of the paper, with a chosen E_R.
inline ElasticConstants table_1(double E_radial_MPa = 1020.0) { return {1020.0, E_radial_MPa, 0.06, 0.3, 481.0}; }

/// Cells of the cloud with the material axes of the space, at rest and without stress.
template <int Dim>
void fill(Tissue<Dim>& tissue, const Cloud<Dim>& cloud, const ElasticConstants& constants = table_1()) {
  constexpr double rho0 = 1000.0;
  tissue.material.E_axial_MPa = constants.E_axial_MPa;
  tissue.material.rho0_ug_mm3 = rho0;
  tissue.material.uniform = stiffness<Dim>(constants);
  auto& cells = tissue.cells;
  cells.resize(cloud.size());
  double tip = -1e300;
  for (const Vec<Dim>& x : cloud.position) tip = std::max(tip, x[0]);
  for (std::size_t i = 0; i < cloud.size(); ++i) {
    cells.position[i] = cloud.position[i];
    cells.shape[i] = cloud.shape[i];
    cells.volume[i] = cloud.volume[i];
    cells.mass[i] = rho0 * cloud.volume[i];
    cells.frame[i].setIdentity();
    cells.distance_to_tip[i] = tip - cloud.position[i][0];
    cells.cell_id[i] = tissue.next_cell_id++;
    cells.parent_id[i] = -1;
    tissue.deformation[i].setIdentity();
  }
}

/// Neighbours and gradient operators for the cells where they are.
template <int Dim>
GradientReport build_operators(Tissue<Dim>& tissue, double eta, GradientMode mode) {
  auto& cells = tissue.cells;
  std::vector<Mat<Dim>> metrics;
  for (std::size_t i = 0; i < cells.size(); ++i) metrics.push_back(cell_metric<Dim>(cells.shape[i], eta));
  tissue.pairs = find_pairs<Dim>(cells.position.values(), metrics);
  return build_gradients<Dim>(cells.position.values(), metrics, cells.volume.values(), tissue.pairs, mode,
                              tissue.gradients, tissue.kernel);
}

}  // namespace rootsoil::test
