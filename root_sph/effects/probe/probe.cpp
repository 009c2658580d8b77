// SPDX-License-Identifier: MIT
#include "root_sph/effects/probe/probe.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <utility>

#include "root_sph/core/vec3.hpp"
#include "root_sph/dynamics/cell_axes.hpp"
#include "root_sph/dynamics/nearest_cell.hpp"
#include "root_sph/scene/checks.hpp"
#include "root_sph/scene/schema_keys.hpp"

namespace rootsoil {
namespace {

void check_probe(const ProbeSection& probe, std::size_t index, const Origins& origins) {
  const std::string element = fmt::format("probe[{}]", index + 1);
  check_one_of(element, "position_mm", "distance_to_tip_mm", origins);
  if (probe.distance_to_tip_mm && !((*probe.distance_to_tip_mm)[0] < (*probe.distance_to_tip_mm)[1])) {
    const auto [from, to] = *probe.distance_to_tip_mm;
    origins.fail(element + ".distance_to_tip_mm", "the bin is empty", toml_text(Numbers{from, to}),
                 "[from, to] with from below to", "exchange or move its ends");
  }
}

void complete_probes(Scene& scene) {
  auto& probes = scene.all<ProbeSection>();
  complete_names(probes, "probe", scene.origins);
  for (std::size_t i = 0; i < probes.size(); ++i) check_probe(probes[i], i, scene.origins);
}

// clang-format off
SectionSpec probe_section() {
  using namespace sections;
  using Pb = ProbeSection;
  return section<Pb>("probe", repeated, "The tissue followed over time: at a cell, or in a bin along the root.", {
    key(&Pb::name, "name", "-", any_text, "For outputs; unique.", "-").defaults_to("probe_1, ..."),
    key(&Pb::position_mm, "position_mm", "mm", place_mm, "The cell nearest to it at the start; this or the bin.", "-"),
    key(&Pb::distance_to_tip_mm, "distance_to_tip_mm", "mm", at_least(0).up_to(1e3, microns),
        "Bin [from, to] along the root; this or the position. No cell in it: the table has empty fields.", "-"),
  }).completed_by(complete_probes);
}
// clang-format on

/// A probe that would follow a cell far from where it is put.
template <int Dim>
void refuse_far_point(const Scene& scene, const Tissue<Dim>& tissue, const ProbeSection& probe, std::size_t index) {
  constexpr double farthest_cells = 3.0;  // beside the root, but meant for it
  const Vec<Dim> point = shortened<Dim>(*probe.position_mm);
  const NearestCell nearest = nearest_cell<Dim>(tissue, point);
  if (nearest.cell_lengths <= farthest_cells) return;
  const Vec<Dim>& x = tissue.cells.position[nearest.cell];
  scene.origins.fail(fmt::format("probe[{}].position_mm", index + 1),
                     fmt::format("there is no cell near the probe \"{}\"", probe.name),
                     fmt::format("({:.4g}) mm: the nearest cell is at ({:.4g}) mm, {:.3g} mm away",
                                 fmt::join(point.data(), point.data() + Dim, ", "),
                                 fmt::join(x.data(), x.data() + Dim, ", "), (x - point).norm()),
                     fmt::format("a point at most {} cell lengths from a cell", farthest_cells),
                     "move it into the root: the base is at x = 0, the tip at the largest x; is it in mm?");
}

/// A bin that holds no cell now and, by the closed form, none later.
template <int Dim>
void refuse_bin_out_of_reach(const Scene& scene, const Tissue<Dim>& tissue, const FreeGrowth& growth,
                             const ProbeSection& probe, std::size_t index) {
  const double from = (*probe.distance_to_tip_mm)[0], to = (*probe.distance_to_tip_mm)[1];
  const auto& distance = tissue.cells.distance_to_tip.values();
  if (std::any_of(distance.begin(), distance.end(), [from, to](double s) { return s >= from && s < to; })) return;
  const double length_mm = *std::max_element(distance.begin(), distance.end());
  const double reached_mm = length_mm + growth.fastest_tip_speed_mm_h * scene.scene.duration_h;
  if (from >= length_mm && from <= reached_mm) return;  // the root may grow there
  scene.origins.fail(
      fmt::format("probe[{}].distance_to_tip_mm", index + 1),
      fmt::format("there is no cell in the bin of the probe \"{}\"", probe.name), toml_text(Numbers{from, to}),
      reached_mm > length_mm ? fmt::format("0 to {:.4g} mm now, {:.4g} mm when the root has grown for {} h", length_mm,
                                           reached_mm, scene.scene.duration_h)
                             : fmt::format("0 to {:.4g} mm: the root does not grow", length_mm),
      from < length_mm ? "make the bin wider than a cell" : "move the bin towards the tip; is it in mm?");
}

}  // namespace

template <int Dim>
ProbeEffect<Dim>::ProbeEffect(Solver<Dim>& solver, ProbeSection section)
    : section_(std::move(section)), solver_(solver) {
  if (!section_.position_mm) return;
  auto& cells = solver.tissue().cells;
  followed_ = &cells.template declare<std::int64_t>(
      {"probe " + section_.name, "1", "1 for the probed cell and its descendants"},
      on_division::copy<Dim, std::int64_t>);
  const Vec<Dim> target = shortened<Dim>(*section_.position_mm);
  if (cells.size() > 0) (*followed_)[nearest_cell<Dim>(solver.tissue(), target).cell] = 1;
}

template <int Dim>
ProbeReading ProbeEffect<Dim>::read() const {
  const Tissue<Dim>& tissue = solver_.tissue();
  const auto& cells = tissue.cells;
  ProbeReading sum{};
  for (std::size_t i = 0; i < cells.total(); ++i) {
    const double s = cells.distance_to_tip[i];
    const bool inside = followed_ ? (*followed_)[i] != 0
                                  : s >= (*section_.distance_to_tip_mm)[0] && s < (*section_.distance_to_tip_mm)[1];
    if (!inside) continue;
    const double v = cells.volume[i];
    sum.cells += 1.0;
    sum.volume += v;
    sum.x_mm += v * cells.position[i][0];
    sum.y_mm += v * cells.position[i][1];
    if constexpr (Dim == 3) sum.z_mm += v * cells.position[i][2];
    sum.distance_to_tip_mm += v * s;
    sum.axial_strain_rate_per_h += v * solver_.axial_strain_rate_per_h(i);
    sum.axial_stress_MPa += v * cells.stress[i][0];
    sum.radial_stress_MPa += v * cells.stress[i].template segment<Dim - 1>(1).mean();
    sum.density_ug_mm3 += cells.mass[i];
    sum.cell_length_mm += v * longest_axis<Dim>(cells.shape[i]).length_mm;
  }
  // without a cell 0/0: not a number, which the table leaves empty
  for (double* mean : {&sum.x_mm, &sum.y_mm, &sum.z_mm, &sum.distance_to_tip_mm, &sum.axial_strain_rate_per_h,
                       &sum.axial_stress_MPa, &sum.radial_stress_MPa, &sum.density_ug_mm3, &sum.cell_length_mm}) {
    *mean /= sum.volume;
  }
  return sum;
}

template <int Dim>
std::optional<SideTable> ProbeEffect<Dim>::side_table() const {
  return SideTable{
      "probe_" + section_.name + ".csv",
      {"cells", Dim == 2 ? "volume_mm2" : "volume_mm3", "x_mm", "y_mm", "z_mm", "distance_to_tip_mm",
       "axial_strain_rate_per_h", "axial_stress_MPa", "radial_stress_MPa", "density_ug_mm3", "cell_length_mm"}};
}

EffectSpec probe_effect() {
  return {.name = "probe",
          .called_by = "[[probe]]",
          .what = "a point or a bin of the tissue followed over time",
          .exact = "means over its cells",
          .sections = {probe_section()},
          .called_for = [](const Scene& scene) { return scene.find<ProbeSection>() != nullptr; },
          .build =
              [](auto assembly) {
                for (const ProbeSection& p : assembly.scene.template all<ProbeSection>()) {
                  assembly.template add<ProbeEffect<assembly.dimension>>(p);
                }
              },
          .check_start =
              [](const Scene& scene, const auto& tissue, const FreeGrowth& growth) {
                const auto& probes = scene.all<ProbeSection>();
                for (std::size_t i = 0; i < probes.size(); ++i) {
                  if (probes[i].position_mm) {
                    refuse_far_point(scene, tissue, probes[i], i);
                  } else {
                    refuse_bin_out_of_reach(scene, tissue, growth, probes[i], i);
                  }
                }
              }};
}

template class ProbeEffect<2>;
template class ProbeEffect<3>;

}  // namespace rootsoil
