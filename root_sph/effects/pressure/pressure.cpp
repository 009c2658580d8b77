// SPDX-License-Identifier: MIT
#include "root_sph/effects/pressure/pressure.hpp"

#include <algorithm>
#include <set>
#include <utility>

#include "root_sph/scene/checks.hpp"
#include "root_sph/scene/schema_keys.hpp"
#include "root_sph/scene/value_table.hpp"

namespace rootsoil {
namespace {

/// What others need to know: the range.
void note_range(Scene& scene) {
  const Rows table = pressure_rows(scene);
  const auto [low, high] =
      std::minmax_element(table.begin(), table.end(), [](const auto& a, const auto& b) { return a[1] < b[1]; });
  scene.facts.pressure_MPa = {(*low)[1], (*high)[1]};
}

void complete_pressure(Scene& scene) {
  check_one_of("pressure", "differential_MPa", "table", scene.origins);
  check_increasing(scene.find<PressureSection>()->table, "pressure.table", "times", scene.origins);
  note_range(scene);
}

void complete_turgor(Scene& scene) {
  if (scene.origins.has("pressure")) {
    scene.origins.fail("turgor", "the pressure differential is given already", {}, {}, "remove [pressure] or [turgor]");
  }
  check_one_of("turgor", "turgor_MPa", "table", scene.origins);
  const TurgorSection& section = *scene.find<TurgorSection>();
  check_increasing(section.turgor, "turgor.table", "times", scene.origins);
  check_increasing(section.soil, "turgor.soil_table", "times", scene.origins);
  note_range(scene);
}

/// One table less another.
Rows difference(const Rows& of, const Rows& taken) {
  std::set<double> times;
  for (const Rows* table : {&of, &taken}) {
    for (const auto& row : *table) times.insert(row[0]);
  }
  if (of.size() == 1 && taken.size() == 1) times = {0.0};
  Rows left;
  for (const double t : times) left.push_back({t, value_at(of, t) - value_at(taken, t)});
  return left;
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

// clang-format off
SectionSpec turgor_section() {
  using namespace sections;
  using Tu = TurgorSection;
  return section<Tu>("turgor", optional, "Turgor apart from what the soil takes of it, in the place of [pressure].", {
    constant_or_table(&Tu::turgor, "turgor_MPa", "MPa", pressure, "Constant turgor; this or table.", "paper Eq. 5"),
    key(&Tu::turgor, "table", "h, MPa", pressure,
        "[[time, turgor], ...]: linear in between, constant before the first and after the last.", "paper Eq. 5")
        .written_when([](const Tu& s) { return s.turgor.size() > 1; }),
    constant_or_table(&Tu::soil, "soil_MPa", "MPa", pressure,
        "Pressure of the soil on the root, where no [soil] exerts it.", "paper Eq. 5"),
    key(&Tu::soil, "soil_table", "h, MPa", pressure, "[[time, pressure of the soil], ...] in the place of soil_MPa.",
        "paper Eq. 5").only_without("soil_MPa").written_when([](const Tu& s) { return s.soil.size() > 1; }),
  }).completed_by(complete_turgor);
}
// clang-format on

}  // namespace

Rows pressure_rows(const Scene& scene) {
  if (const PressureSection* pressure = scene.find<PressureSection>()) return pressure->table;
  const TurgorSection* turgor = scene.find<TurgorSection>();
  return turgor ? difference(turgor->turgor, turgor->soil) : Rows{};
}

double pressure_MPa(const Scene& scene, double time_h) {
  const Rows rows = pressure_rows(scene);
  return rows.empty() ? 0.0 : value_at(rows, time_h);
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
          .called_by = "[pressure] or [turgor]",
          .what = "uniform pressure differential, constant or a table over time (Eq. 5)",
          .exact = "strains of a root without growth: Eq. 8",
          .sections = {pressure_section(), turgor_section()},
          .called_for = [](const Scene& scene) { return !pressure_rows(scene).empty(); },
          .build =
              [](auto assembly) {
                assembly.template add<PressureEffect<assembly.dimension>>(pressure_rows(assembly.scene));
              }};
}

template class PressureEffect<2>;
template class PressureEffect<3>;

}  // namespace rootsoil
