// SPDX-License-Identifier: MIT
#include "root_sph/effects/division.hpp"

#include <cmath>

namespace rootsoil {

template <int Dim>
LongestAxis<Dim> longest_axis(const Mat<Dim>& shape) {
  const Eigen::SelfAdjointEigenSolver<Mat<Dim>> solver(shape);  // iterative: exact axes even for near-spheres
  Vec<Dim> direction = solver.eigenvectors().col(0);
  // the sign of an eigenvector is arbitrary; fix it so that daughters keep their order
  Eigen::Index largest = 0;
  direction.cwiseAbs().maxCoeff(&largest);
  if (direction[largest] < 0.0) direction = -direction;
  return {direction, 2.0 / std::sqrt(solver.eigenvalues()[0])};
}

template <int Dim>
DivisionEffect<Dim>::DivisionEffect(Solver<Dim>& solver, DivisionThresholdProfile threshold) {
  solver.hooks().window_start.emplace_back("division", [threshold](Tissue<Dim>& tissue) {
    auto& cells = tissue.cells;
    const std::size_t mothers = cells.size();
    std::vector<char> may_divide(mothers);
#pragma omp parallel for schedule(static)
    for (std::size_t i = 0; i < mothers; ++i) {
      const double l = threshold(cells.distance_to_tip[i]);
      const Mat<Dim> above = cells.shape[i] - 4.0 / (l * l) * Mat<Dim>::Identity();
      // positive definite: every axis is shorter than the threshold. Cheaper than the axes themselves
      may_divide[i] = !cells.clamped[i] && above.llt().info() != Eigen::Success;
    }
    for (std::size_t i = 0; i < mothers; ++i) {
      if (!may_divide[i]) continue;
      const LongestAxis<Dim> axis = longest_axis<Dim>(cells.shape[i]);
      if (axis.length_mm <= threshold(cells.distance_to_tip[i])) continue;
      const std::int64_t first = tissue.next_cell_id;
      tissue.next_cell_id += 2;
      cells.divide(i, axis.direction, axis.length_mm, first, first + 1);
    }
  });
}

template LongestAxis<2> longest_axis<2>(const Mat<2>&);
template LongestAxis<3> longest_axis<3>(const Mat<3>&);
template class DivisionEffect<2>;
template class DivisionEffect<3>;

}  // namespace rootsoil
