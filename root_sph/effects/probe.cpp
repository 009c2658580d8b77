// SPDX-License-Identifier: MIT
#include "root_sph/effects/probe.hpp"

#include "root_sph/effects/division.hpp"

#include <algorithm>
#include <utility>

namespace rootsoil {

template <int Dim>
ProbeEffect<Dim>::ProbeEffect(Solver<Dim>& solver, ProbeParameters parameters)
    : parameters_(std::move(parameters)), solver_(solver) {
  if (!parameters_.position_mm) return;
  auto& cells = solver.tissue().cells;
  followed_ = &cells.template declare<std::int64_t>(
      {"probe " + parameters_.name, "1", "1 for the probed cell and its descendants"},
      on_division::copy<Dim, std::int64_t>);
  const Vec<Dim> target = Eigen::Map<const Vec<Dim>>(parameters_.position_mm->data());
  std::size_t nearest = 0;
  for (std::size_t i = 1; i < cells.size(); ++i) {
    if ((cells.position[i] - target).squaredNorm() < (cells.position[nearest] - target).squaredNorm()) nearest = i;
  }
  if (cells.size() > 0) (*followed_)[nearest] = 1;
}

template <int Dim>
ProbeReading ProbeEffect<Dim>::read(const Tissue<Dim>& tissue) {
  const auto& cells = tissue.cells;
  ProbeReading sum{};
  for (std::size_t i = 0; i < cells.total(); ++i) {
    const double s = cells.distance_to_tip[i];
    const bool inside = followed_ ? (*followed_)[i] != 0
                                  : s >= (*parameters_.distance_to_tip_mm)[0] && s < (*parameters_.distance_to_tip_mm)[1];
    if (!inside) continue;
    const double v = cells.volume[i];
    sum.cells += 1.0;
    sum.volume += v;
    sum.x_mm += v * cells.position[i][0];
    sum.y_mm += v * cells.position[i][1];
    if constexpr (Dim == 3) sum.z_mm += v * cells.position[i][2];
    sum.distance_to_tip_mm += v * s;
    if (solver_.window_h() > 0.0) sum.axial_strain_rate_per_h += v * tissue.axial_strain[i] / solver_.window_h();
    sum.axial_stress_MPa += v * cells.stress[i][0];
    sum.radial_stress_MPa += v * cells.stress[i].template segment<Dim - 1>(1).mean();
    sum.density_ug_mm3 += cells.mass[i];
    sum.cell_length_mm += v * longest_axis<Dim>(cells.shape[i]).length_mm;
  }
  if (sum.volume > 0.0) {
    for (double* mean : {&sum.x_mm, &sum.y_mm, &sum.z_mm, &sum.distance_to_tip_mm, &sum.axial_strain_rate_per_h,
                         &sum.axial_stress_MPa, &sum.radial_stress_MPa, &sum.density_ug_mm3, &sum.cell_length_mm}) {
      *mean /= sum.volume;
    }
  }
  return sum;
}

template <int Dim>
std::vector<std::string> ProbeEffect<Dim>::columns() {
  return {"cells",
          Dim == 2 ? "volume_mm2" : "volume_mm3",
          "x_mm",
          "y_mm",
          "z_mm",
          "distance_to_tip_mm",
          "axial_strain_rate_per_h",
          "axial_stress_MPa",
          "radial_stress_MPa",
          "density_ug_mm3",
          "cell_length_mm"};
}

template class ProbeEffect<2>;
template class ProbeEffect<3>;

}  // namespace rootsoil
