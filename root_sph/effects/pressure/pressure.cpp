// SPDX-License-Identifier: MIT
#include "root_sph/effects/pressure/pressure.hpp"

#include <algorithm>
#include <utility>

#include "root_sph/scene/checks.hpp"
#include "root_sph/scene/schema_keys.hpp"
#include "root_sph/scene/value_table.hpp"

namespace rootsoil {
namespace {

void complete_pressure(Scene& scene) {
  check_one_of("pressure", "differential_MPa", "table", scene.origins);
  const Rows& table = scene.find<PressureSection>()->table;
  check_increasing(table, "pressure.table", "times", scene.origins);
  const auto [low, high] =
      std::minmax_element(table.begin(), table.end(), [](const auto& a, const auto& b) { return a[1] < b[1]; });
  scene.facts.pressure_MPa = {(*low)[1], (*high)[1]};
}

/// One table, and two ways to write it.
SectionSpec pressure_section() {
  using namespace sections;
  using Pr = PressureSection;
  return section<Pr>(
             "pressure", optional, "Pressure differential, uniform over the root.",
             {constant_or_table(&Pr::table, "differential_MPa", "MPa", pressure,
                                "Constant pressure differential: turgor less what the soil takes; this or table.",
                                "paper Eq. 5, Table 1"),
              key(&Pr::table, "table", "h, MPa", pressure,
                  "[[time, pressure], ...]: linear in between, constant before the first and after the last.",
                  "docs/physics.md 3")
                  .written_when([](const Pr& s) { return s.table.size() > 1; })})
      .completed_by(complete_pressure);
}

}  // namespace

double pressure_MPa(const Scene& scene, double time_h) {
  const PressureSection* pressure = scene.find<PressureSection>();
  return pressure ? value_at(pressure->table, time_h) : 0.0;
}

template <int Dim>
PressureEffect<Dim>::PressureEffect(Solver<Dim>& solver, Rows table) {
  solver.tissue().pressure_MPa = value_at(table, 0.0);
  if (table.size() == 1) return;  // constant: nothing to do in a step
  const auto set = [table = std::move(table)](Tissue<Dim>& tissue) {
    tissue.pressure_MPa = value_at(table, tissue.time_h);
  };
  solver.hooks().loads.emplace_back("pressure", set);
  solver.hooks().step_loads.emplace_back("pressure", set);
}

EffectSpec pressure_effect() {
  return {.name = "pressure",
          .called_by = "[pressure]",
          .what = "uniform pressure differential, constant or a table over time (Eq. 5)",
          .exact = "strains of a root without growth: Eq. 8",
          .sections = {pressure_section()},
          .called_for = [](const Scene& scene) { return scene.find<PressureSection>() != nullptr; },
          .build =
              [](auto assembly) {
                assembly.template add<PressureEffect<assembly.dimension>>(
                    assembly.scene.template find<PressureSection>()->table);
              }};
}

template class PressureEffect<2>;
template class PressureEffect<3>;

}  // namespace rootsoil
