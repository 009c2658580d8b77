// SPDX-License-Identifier: MIT
#include "root_sph/effects/force/force.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

#include "root_sph/core/vec3.hpp"
#include "root_sph/scene/checks.hpp"
#include "root_sph/scene/schema_keys.hpp"
#include "root_sph/scene/value_table.hpp"

namespace rootsoil {
namespace {

void complete_force(Scene& scene) {
  ForceSection& force = *scene.find<ForceSection>();
  check_one_of("force", "axial_N", "vector_N", scene.origins);
  check_increasing(force.table, "force.table", "times", scene.origins);
  const auto [from, to] = force.distance_to_tip_mm;
  if (scene.origins.has("force.distance_to_tip_mm")) {
    if (from < to) return;
    scene.origins.fail("force.distance_to_tip_mm", "the band is empty", toml_text(Numbers{from, to}),
                       "[from, to] with from below to", "exchange or move its ends");
  }
  if (!scene.root.is_lattice()) {
    scene.origins.fail("force", "the band that the force acts on is not given", {}, {},
                       "give distance_to_tip_mm = [from, to]; the radius of cells from a file is not known here");
  }
  force.distance_to_tip_mm = {0.0, scene.root.radius_mm};
}

/// Whether the force acts on a cell of this distance from the tip.
bool is_in_band(const ForceSection& force, double s_mm) {
  return s_mm >= force.distance_to_tip_mm[0] && s_mm <= force.distance_to_tip_mm[1];
}

/// The axis of a cell, where a balance is looked for turned since the step's start: a force that follows it has no
/// potential, and a column under it stands where a weight of the same size would bend it (Beck's column).
template <int Dim>
Vec<Dim> axis_now(const Tissue<Dim>& tissue, std::size_t cell, SlipAdvance advance) {
  Vec<Dim> axis = tissue.cells.frame[cell].col(0);
  const double ahead_h = advance.used_h - advance.kept_h;
  if (ahead_h == 0.0) return axis;
  return step_rotation<Dim>(ahead_h * tissue.velocity_gradient[cell] * tissue.deformation[cell].inverse()) * axis;
}

/// A band without a cell that could move. Later, when the root has changed, the run stops there.
template <int Dim>
void refuse_empty_band(const Scene& scene, const Tissue<Dim>& tissue) {
  const ForceSection& force = *scene.find<ForceSection>();
  double farthest_mm = 0.0;  // of the cells that can move
  for (std::size_t i = 0; i < tissue.cells.size(); ++i) {
    if (tissue.cells.clamped[i]) continue;
    const double s = tissue.cells.distance_to_tip[i];
    if (is_in_band(force, s)) return;
    farthest_mm = std::max(farthest_mm, s);
  }
  const auto [from, to] = force.distance_to_tip_mm;
  scene.origins.fail("force.distance_to_tip_mm",
                     "the force has nothing to act on: no cell that can move is in its band",
                     toml_text(Numbers{from, to}), fmt::format("a band within 0 to {:.4g} mm", farthest_mm),
                     from < farthest_mm ? "make the band wider than a cell" : "move it towards the tip; is it in mm?");
}

// clang-format off
SectionSpec force_section() {
  using namespace sections;
  using Fc = ForceSection;
  return section<Fc>("force", optional, "A prescribed force on a part of the root, as force sensors and weights exert it.", {
    key(&Fc::axial_N, "axial_N", "N (2D: N/mm)", between(-1e3, 1e3),
        "Along the root, positive: against its growth; this or vector_N.", "docs/physics.md 3"),
    key(&Fc::vector_N, "vector_N", "N (2D: N/mm)", between(-1e3, 1e3), "Fixed in space; this or axial_N.", "-"),
    key(&Fc::table, "table", "h, -", between(-1e3, 1e3),
        "[[time, factor], ...] on the force: linear in between, constant before the first and after the last.", "-"),
    key(&Fc::distance_to_tip_mm, "distance_to_tip_mm", "mm", at_least(0).up_to(1e3, microns),
        "Band [from, to] along the root that it acts on.", "-").defaults_to("the tip: one radius"),
  }).completed_by(complete_force);
}
// clang-format on

}  // namespace

template <int Dim>
ForceEffect<Dim>::ForceEffect(Solver<Dim>& solver, ForceSection force) : solver_(solver), force_(std::move(force)) {
  solver.hooks().parameters.emplace_back("force", [this](Tissue<Dim>& t) {
    loaded_.clear();
    weight_.clear();
    double volume = 0.0;
    for (std::size_t i = 0; i < t.cells.size(); ++i) {
      if (t.cells.clamped[i] || !is_in_band(force_, t.cells.distance_to_tip[i])) continue;
      loaded_.push_back(i);
      weight_.push_back(t.cells.volume[i]);
      volume += t.cells.volume[i];
    }
    if (loaded_.empty()) {
      throw UnphysicalError(
          fmt::format("[force] has nothing to act on at {:.5g} h: no cell that can move lies {:.4g} to "
                      "{:.4g} mm from the tip (force.distance_to_tip_mm)",
                      t.time_h, force_.distance_to_tip_mm[0], force_.distance_to_tip_mm[1]));
    }
    for (double& w : weight_) w /= volume;
  });
  solver.hooks().forces.emplace_back("force", [this](Tissue<Dim>& t, SlipAdvance advance) {
    const double factor = force_.table.empty() ? 1.0 : value_at(force_.table, t.time_h);
    applied_N_.setZero();
    share_N_.clear();
    for (std::size_t k = 0; k < loaded_.size(); ++k) {
      const std::size_t i = loaded_[k];
      const Vec<Dim> whole =
          force_.axial_N ? Vec<Dim>(-*force_.axial_N * axis_now<Dim>(t, i, advance)) : shortened<Dim>(*force_.vector_N);
      const Vec<Dim> share = factor * weight_[k] * whole;
      share_N_.push_back(share);
      t.force[i] += share;
      applied_N_ += share;
    }
  });
}

template <int Dim>
Vec<Dim> ForceEffect<Dim>::tip_force_N(double within_mm) const {
  Vec<Dim> sum = Vec<Dim>::Zero();
  for (std::size_t k = 0; k < share_N_.size(); ++k) {
    if (solver_.tissue().cells.distance_to_tip[loaded_[k]] <= within_mm) sum += share_N_[k];
  }
  return sum;
}

template <int Dim>
std::vector<std::pair<std::string, double>> ForceEffect<Dim>::history() const {
  return {{"prescribed_force_N", applied_N_.norm()}};
}

EffectSpec force_effect() {
  return {.name = "force",
          .called_by = "[force]",
          .what = "prescribed force on the tip or a band of the root, constant or over time",
          .exact = "growth rate falls as 1 - F/(p (1 - nu_A) W)",
          .push = Push::arrest,
          .sections = {force_section()},
          .called_for = [](const Scene& scene) { return scene.find<ForceSection>() != nullptr; },
          .build =
              [](auto assembly) {
                assembly.template add<ForceEffect<assembly.dimension>>(*assembly.scene.template find<ForceSection>());
              },
          .check_start = [](const Scene& scene, const auto& tissue,
                            const FreeGrowth&) { refuse_empty_band(scene, tissue); }};
}

template class ForceEffect<2>;
template class ForceEffect<3>;

}  // namespace rootsoil
