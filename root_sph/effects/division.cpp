// SPDX-License-Identifier: MIT
#include "root_sph/effects/division.hpp"

#include <algorithm>
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
void even_out_spacing(Solver<Dim>& solver) {
  constexpr double rate_over_strain_rate = 25.0;  // fast against a generation; mature tissue is left alone
  constexpr double adjacent = 1.3;       // ellipsoids this near to touching are neighbours in a file; diagonals are at 1.41
  constexpr double along = 0.8;          // cosine to the root axis
  Tissue<Dim>& tissue = solver.tissue();
  auto& cells = tissue.cells;
  std::vector<double> share(cells.size()), shift(cells.size(), 0.0);
#pragma omp parallel for schedule(static)
  for (std::size_t i = 0; i < cells.size(); ++i) {
    const double rate = rate_over_strain_rate * std::max(0.0, solver.axis().strain_rate_per_h(cells.distance_to_tip[i]));
    share[i] = 0.25 * std::min(0.2, rate * solver.window_h());
  }
  for_each_block(tissue.pairs, [&](const PairBlock& block) {
    for (std::int64_t k = block.first_pair; k < block.last_pair; ++k) {
      const auto [i, j] = tissue.pairs.pairs[k];
      const Vec<Dim> r = cells.position[j] - cells.position[i];
      // 1 where two ellipsoids of equal shape touch
      const double distance2 = 0.125 * r.dot((cells.shape[i] + cells.shape[j]) * r);
      if (distance2 > adjacent * adjacent) continue;
      const double length = r.norm();
      const Vec<Dim> n = r / length;
      const double cosine = n.dot(cells.frame[i].col(0));
      if (std::abs(cosine) < along) continue;
      const double half_i = 1.0 / std::sqrt(n.dot(cells.shape[i] * n)), half_j = 1.0 / std::sqrt(n.dot(cells.shape[j] * n));
      const double gap = (length - half_i - half_j) * (cosine > 0.0 ? 1.0 : -1.0);
      const double moved = (share[i] + share[j]) * gap;
      shift[i] += moved;
      shift[j] -= moved;
    }
  });
#pragma omp parallel for schedule(static)
  for (std::size_t i = 0; i < cells.size(); ++i) {
    if (cells.clamped[i]) continue;
    const Vec<Dim> moved = shift[i] * cells.frame[i].col(0);
    cells.velocity[i] += tissue.velocity_gradient[i] * tissue.deformation[i].inverse() * moved;
    cells.position[i] += moved;
  }
}

template <int Dim>
DivisionEffect<Dim>::DivisionEffect(Solver<Dim>& solver, DivisionThresholdProfile threshold) {
  solver.hooks().window_end.emplace_back("even spacing", [&solver](Tissue<Dim>&) { even_out_spacing<Dim>(solver); });
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
template void even_out_spacing<2>(Solver<2>&);
template void even_out_spacing<3>(Solver<3>&);
template class DivisionEffect<2>;
template class DivisionEffect<3>;

}  // namespace rootsoil
