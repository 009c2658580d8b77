// SPDX-License-Identifier: MIT
#include "root_sph/effects/growth/growth.hpp"

#include <algorithm>
#include <cmath>
#include <vector>

#include "root_sph/scene/response.hpp"
#include "root_sph/scene/schema_keys.hpp"
#include "root_sph/scene/value_table.hpp"

namespace rootsoil {
namespace {

void complete_growth(Scene& scene) {
  const Rows& table = scene.find<GrowthSection>()->table;
  check_increasing(table, "growth.table", "distances", scene.origins);
  for (const std::string key : {"lambda0_ug_mm3_h", "x_g_mm", "s_g_mm", "c_g"}) {
    if (table.empty() || !scene.origins.has("response.growth." + key)) continue;
    scene.origins.fail("response.growth." + key, "growth.table does not respond", {}, {},
                       "give the keys of Eq. 6 in place of the table, or remove the pair");
  }
  check_increasing(scene.find<GrowthSection>()->yield, "growth.yield_profile", "distances", scene.origins);
}

// clang-format off
SectionSpec growth_section() {
  using namespace sections;
  using Gr = GrowthSection;
  return section<Gr>("growth", optional,
                     "Walls soften and yield: lambda = lambda0 ((1+c_g)/2 + (1-c_g)/2 (s-x_g)/s_g "
                     "exp(0.5 - (s-x_g)^2/(2 s_g^2))), never below 0.", {
    key(&Gr::lambda0_ug_mm3_h, "lambda0_ug_mm3_h", "ug/mm^3/h", at_least(0),
        "Softening coefficient; measured roots need about a tenth of the printed values. Eq. 6, or table.", "Eq. 6, Table 1, docs/physics.md 4")
        .required().only_without("table").responds(),
    key(&Gr::x_g_mm, "x_g_mm", "mm", place_mm, "Inflection of the bell; its peak lies at x_g + s_g.", "Eq. 6, Table 1")
        .required().only_without("table").responds(),
    key(&Gr::s_g_mm, "s_g_mm", "mm", above(0).up_to(1e3, microns), "Width of the bell.", "Eq. 6, Table 1")
        .required().only_without("table").responds(),
    key(&Gr::c_g, "c_g", "-", fraction, "Scale: far from the tip lambda tends to (1+c_g)/2 lambda0.", "Eq. 6, Table 1")
        .required().only_without("table").responds(),
    key(&Gr::table, "table", "mm, ug/mm^3/h", at_least(0),
        "[[distance from the tip, lambda], ...] in place of Eq. 6: linear in between, constant before and after.",
        "docs/decisions/0023").written_when([](const Gr& s) { return !s.table.empty(); }),
    key(&Gr::mature_at_mm, "mature_at_mm", "mm", above(0).up_to(1e3, microns),
        "Growth ends at this distance from the tip; none: Eq. 6 to the letter.", "docs/physics.md 4"),
    key(&Gr::mature_width_mm, "mature_width_mm", "mm", above(0).up_to(1e3, microns), "Width of that end.", "docs/physics.md 4")
        .only_with("mature_at_mm"),
    constant_or_table(&Gr::yield, "yield_MPa", "MPa", at_least(0).up_to(10, pascals),
        "Tissue grows in proportion to p less this threshold; none: in proportion to p.", "Lockhart 1965, docs/decisions/0024")
        .responds(),
    key(&Gr::yield, "yield_profile", "mm, MPa", at_least(0).up_to(10, pascals),
        "[[distance from the tip, yield stress], ...] in the place of yield_MPa: linear in between, constant beyond.",
        "docs/decisions/0024")
        .only_without("yield_MPa").written_when([](const Gr& s) { return s.yield.size() > 1; }),
  }).completed_by(complete_growth);
}
// clang-format on

const SectionSpec& growth_specification() {
  static const SectionSpec spec = growth_section();
  return spec;
}

/// Eq. 6, second.
double bell_ug_mm3_h(const GrowthSection& g, double s_mm) {
  const double z = (s_mm - g.x_g_mm) / g.s_g_mm;
  const double bell = z * std::exp(0.5 - 0.5 * z * z);
  return g.lambda0_ug_mm3_h * (0.5 * (1.0 + g.c_g) + 0.5 * (1.0 - g.c_g) * bell);
}

}  // namespace

double softening_ug_mm3_h(const GrowthSection& g, double s_mm) {
  const double lambda = g.table.empty() ? bell_ug_mm3_h(g, s_mm) : value_at(g.table, s_mm);
  if (lambda <= 0.0) return 0.0;
  if (!g.mature_at_mm) return lambda;
  if (g.mature_width_mm <= 0.0) return s_mm < *g.mature_at_mm ? lambda : 0.0;
  const double t = std::clamp((*g.mature_at_mm - s_mm) / g.mature_width_mm + 0.5, 0.0, 1.0);
  return lambda * t * t * (3.0 - 2.0 * t);
}

double yield_MPa(const GrowthSection& growth, double s_mm) {
  return growth.yield.empty() ? 0.0 : value_at(growth.yield, s_mm);
}

IntegralFromTip::IntegralFromTip(const std::function<double(double)>& function, double length_mm, double step_mm) {
  const auto intervals = static_cast<std::size_t>(std::max(1.0, std::ceil(length_mm / step_mm)));
  step_mm_ = length_mm / static_cast<double>(intervals);
  slope_.push_back(function(0.0));
  value_.push_back(0.0);
  for (std::size_t k = 0; k < intervals; ++k) {
    const double from = static_cast<double>(k) * step_mm_;
    slope_.push_back(function(from + step_mm_));
    const double mean = (slope_[k] + 4.0 * function(from + 0.5 * step_mm_) + slope_[k + 1]) / 6.0;
    value_.push_back(value_[k] + step_mm_ * mean);
  }
}

double IntegralFromTip::operator()(double s_mm) const {
  const double z = s_mm / step_mm_;
  if (z <= 0.0) return 0.0;
  const std::size_t intervals = value_.size() - 1;
  if (z >= static_cast<double>(intervals)) return value_.back();
  const auto k = static_cast<std::size_t>(z);
  const double t = z - static_cast<double>(k), u = 1.0 - t;
  return u * u * (1.0 + 2.0 * t) * value_[k] + t * t * (1.0 + 2.0 * u) * value_[k + 1] +
         step_mm_ * t * u * (u * slope_[k] - t * slope_[k + 1]);
}

std::optional<GrowthSection> growth_at(const Scene& scene, double p_MPa) {
  if (!scene.find<GrowthSection>()) return std::nullopt;
  return at_pressure<GrowthSection>(scene, growth_specification(), p_MPa);
}

template <int Dim>
GrowthEffect<Dim>::GrowthEffect(Solver<Dim>& solver, const Scene& scene)
    : solver_(solver),
      softening_(solver.tissue().cells.template declare<double>(
          {"softening", "ug/(mm^3 h)", "lambda at the cell, Eq. 6", Storage::scratch},
          on_division::recomputed<Dim, double>)) {
  Tissue<Dim>& tissue = solver.tissue();
  tissue.material.softening = &softening_;
  if (!growth_at(scene, tissue.perceived_MPa())->yield.empty()) {
    yield_ = &tissue.cells.template declare<double>(
        {"yield_stress", "MPa", "beyond which the cell grows", Storage::scratch}, on_division::recomputed<Dim, double>);
    tissue.material.yield = yield_;
  }
  solver.hooks().operators.emplace_back("growth", [this, scene](Tissue<Dim>& t) {
    const GrowthSection growth = *growth_at(scene, t.perceived_MPa());
    const auto softening = [&](double s) { return softening_ug_mm3_h(growth, s); };
    measure(t, softening, softening_);
    if (!yield_) return;
    Field<Dim, double>& yield = *yield_;
    if (growth.yield.size() > 1) {
      measure(
          t, [&](double s) { return softening(s) * yield_MPa(growth, s); }, yield);
    }
#pragma omp parallel for schedule(static)
    for (std::size_t i = 0; i < t.cells.size(); ++i) {
      const bool measured = growth.yield.size() > 1 && softening_[i] > 0.0;
      yield[i] = measured ? yield[i] / softening_[i] : yield_MPa(growth, t.cells.distance_to_tip[i]);
    }
  });
}

template <int Dim>
void GrowthEffect<Dim>::measure(const Tissue<Dim>& t, const std::function<double(double)>& function,
                                Field<Dim, double>& gradient) const {
  const RootAxis<Dim>& axis = solver_.axis();
  const auto& cells = t.cells;
  // held cells do not flow: the integral ends where they begin
  const IntegralFromTip integral(function, axis.moving_length_mm(), 0.25 * axis.bin_mm());
  std::vector<double> flow(cells.size());
#pragma omp parallel for schedule(static)
  for (std::size_t i = 0; i < cells.size(); ++i) {
    flow[i] = cells.clamped[i] ? integral(axis.moving_length_mm())
                               : integral(solver_.mid_window_distance(cells.distance_to_tip[i]));
    gradient[i] = 0.0;
  }
  for_each_block(t.pairs, [&](const PairBlock& block) {
    for (std::int64_t k = block.first_pair; k < block.last_pair; ++k) {
      const auto [i, j] = t.pairs.pairs[k];
      const double difference = flow[i] - flow[j];  // the axis points to the tip, against s
      gradient[i] += difference * t.gradients[k].at_i.dot(cells.frame[i].col(0));
      gradient[j] -= difference * t.gradients[k].at_j.dot(cells.frame[j].col(0));
    }
  });
#pragma omp parallel for schedule(static)
  for (std::size_t i = 0; i < cells.size(); ++i) {
    // the operators act on the window's start, where lengths are shorter than in its middle
    const double stretch = 1.0 + 0.5 * solver_.window_h() * axis.strain_rate_per_h(cells.distance_to_tip[i]);
    gradient[i] = cells.clamped[i] ? 0.0 : std::max(0.0, gradient[i] / stretch);
  }
}

template <int Dim>
void GrowthEffect<Dim>::add_columns(const Tissue<Dim>&, std::vector<FrameColumn>& columns) const {
  columns.push_back({"softening", "ug/(mm^3 h)", "softening coefficient lambda", 1, softening_.values()});
  if (yield_) columns.push_back({"yield_stress", "MPa", "beyond which the cell grows", 1, yield_->values()});
}

EffectSpec growth_effect() {
  return {.name = "growth",
          .called_by = "[growth]",
          .what = "mass source where the tissue is soft and stretched (Eq. 1, 2, 6)",
          .exact = "strain rates, radius and tip speed of a free root: closed form",
          .sections = {growth_specification()},
          .called_for = [](const Scene& scene) { return scene.find<GrowthSection>() != nullptr; },
          .build = [](auto assembly) { assembly.template add<GrowthEffect<assembly.dimension>>(assembly.scene); }};
}

template class GrowthEffect<2>;
template class GrowthEffect<3>;

}  // namespace rootsoil
