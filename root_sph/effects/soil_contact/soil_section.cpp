// SPDX-License-Identifier: MIT
#include "root_sph/effects/soil_contact/soil_section.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "root_sph/effects/soil_contact/listed_grains.hpp"
#include "root_sph/scene/checks.hpp"
#include "root_sph/scene/schema_keys.hpp"

namespace rootsoil {
namespace {

const char* const axis_name[] = {"x", "y", "z"};

void complete_grains(SoilSection& soil, const Scene& scene) {
  const Origins& origins = scene.origins;
  if (soil.d_range_mm && soil.d_mean_given_mm) {
    origins.fail("soil.d_mean_mm", "d_mean_mm and d_range_mm exclude each other", {}, {}, "give one of them");
  }
  if (!soil.d_range_mm && !soil.d_mean_given_mm) {
    origins.fail("soil", "the grains have no size", {}, {}, "give d_range_mm = [smallest, largest], or d_mean_mm");
  }
  if (soil.d_range_mm) {
    soil.d_min_mm = (*soil.d_range_mm)[0];
    soil.d_max_mm = (*soil.d_range_mm)[1];
    if (soil.d_min_mm > soil.d_max_mm) {
      origins.fail("soil.d_range_mm", "the smallest diameter is above the largest",
                   toml_text(Numbers{soil.d_min_mm, soil.d_max_mm}), "[smallest, largest]", "exchange them");
    }
    soil.d_mean_mm = 0.5 * (soil.d_min_mm + soil.d_max_mm);
    soil.d_spread = (soil.d_max_mm - soil.d_min_mm) / (soil.d_max_mm + soil.d_min_mm);
  } else {
    constexpr double usual_spread = 0.2;
    soil.d_mean_mm = *soil.d_mean_given_mm;
    if (!soil.d_spread_given) soil.d_spread_given = usual_spread;
    soil.d_spread = *soil.d_spread_given;
    soil.d_min_mm = soil.d_mean_mm * (1 - soil.d_spread);
    soil.d_max_mm = soil.d_mean_mm * (1 + soil.d_spread);
  }
  const std::string size_key = soil.d_range_mm ? "soil.d_range_mm" : "soil.d_mean_mm";
  constexpr double grains_across = 4.0;
  double grains = soil.dimension == 2 ? 0.83 : 0.6;
  for (int a = 0; a < soil.dimension; ++a) {
    const double side = soil.box_to_mm[a] - soil.box_from_mm[a];
    if (side < grains_across * soil.d_max_mm) {
      origins.fail(
          size_key,
          fmt::format("the grains are too large for the box, which is {:.6g} mm long in {}", side, axis_name[a]),
          fmt::format("largest diameter {:.6g} mm", soil.d_max_mm),
          fmt::format("at most {:.6g} mm", side / grains_across), "take smaller grains or a larger box");
    }
    grains *= side / soil.d_mean_mm;
  }
  if (grains > most_grains && soil.grains_file.empty()) {
    origins.fail(size_key, fmt::format("the box would hold some {:.0e} grains", grains),
                 fmt::format("mean diameter {:.6g} mm", soil.d_mean_mm),
                 fmt::format("at most {:.0e} grains", most_grains),
                 "are all lengths in mm? Otherwise take larger grains or a smaller box");
  }
  if (!soil.grains_file.empty()) {
    soil.grains_file = existing_file(scene, "soil.grains_file", soil.grains_file);
    soil.grains = read_listed_grains(soil);
  }
}

void check_packing(const SoilSection& soil, const Origins& origins) {
  // solid fractions outside these have never been packed by growing grains between walls (docs/soil.md)
  const auto [low, high] = soil.dimension == 2 ? std::pair(0.10, 0.30) : std::pair(0.30, 0.55);
  if (soil.porosity && !(*soil.porosity >= low && *soil.porosity <= high)) {
    origins.fail("soil.porosity", fmt::format("grains can't be packed like that in {} dimensions", soil.dimension),
                 fmt::format("{}", *soil.porosity), fmt::format("{} to {}", low, high),
                 "leave it out to take what compaction_friction_deg gives");
  }
  if (soil.rolling > 0 && soil.contact_law == ContactLaw::hertz_mindlin) {
    origins.fail("soil.rolling", "hertz_mindlin has no rolling resistance here", fmt::format("{}", soil.rolling), "0",
                 "take contact_law = \"linear\" or \"cohesive\"");
  }
  constexpr double least_damping = 0.01;  // below, packing takes ever longer; at 0 it never ends (docs/soil.md)
  if (soil.grains_file.empty() && soil.damping < least_damping) {
    origins.fail("soil.damping", "grains that hardly lose energy don't come to rest when they are packed",
                 fmt::format("{}", soil.damping), fmt::format("{} to 0.95; less only with grains_file", least_damping),
                 "leave it out to take 0.3, or list the grains in a grains_file");
  }
  constexpr double softest = 20.0;
  if (soil.E_MPa < softest * soil.confining_pressure_MPa) {
    origins.fail("soil.E_MPa", "the confining pressure would press the grains into each other",
                 fmt::format("{}", soil.E_MPa),
                 fmt::format("at least {} times confining_pressure_MPa = {:.6g}", softest,
                             softest * soil.confining_pressure_MPa),
                 "raise E_MPa: 250 times the stress on the tip is a good value");
  }
  const bool nothing_presses = !soil.grains_file.empty() && soil.walls == SoilWalls::rigid && soil.density_N_h2_mm4;
  if (soil.confining_pressure_MPa == 0 && !nothing_presses) {
    origins.fail("soil.confining_pressure_MPa", "without pressure there is nothing to pack by", "0", "above 0",
                 "0 is allowed only with grains_file, walls = \"rigid\" and density_N_h2_mm4");
  }
}

bool is_ball(const SoilObstacle& o) { return o.shape == SoilShape::stone || o.shape == SoilShape::clump; }

/// Distance of a point from the obstacle's surface, 0 inside. A clump counts as the ball around it.
double distance_mm(const SoilObstacle& o, const std::array<double, 3>& point, int dimension) {
  const double dx = point[0] - o.position_mm[0], dy = point[1] - o.position_mm[1];
  const double dz = dimension == 3 ? point[2] - o.position_mm[2] : 0.0;
  if (is_ball(o)) return std::max(0.0, std::hypot(dx, dy, dz) - o.radius_mm);
  const double angle = o.angle_deg * std::numbers::pi / 180;
  const double u = std::cos(angle) * dx + std::sin(angle) * dy, v = -std::sin(angle) * dx + std::cos(angle) * dy;
  const bool plate = o.shape == SoilShape::plate;
  const auto beyond = [](double at, double half) { return std::max(0.0, std::abs(at) - half); };
  return std::hypot(beyond(u, plate ? o.length_mm / 2 : o.half_size_mm[0]),
                    beyond(v, plate ? o.thickness_mm / 2 : o.half_size_mm[1]),
                    dimension == 3 ? beyond(dz, plate ? o.length_mm / 2 : o.half_size_mm[2]) : 0.0);
}

void check_soil_obstacle(const SoilObstacle& o, std::size_t index, const Scene& scene) {
  const Origins& origins = scene.origins;
  const SoilSection& soil = *scene.find<SoilSection>();
  const std::string element = fmt::format("soil.obstacle[{}]", index + 1);
  for (int a = 0; a < soil.dimension; ++a) {
    if (o.position_mm[a] > soil.box_from_mm[a] && o.position_mm[a] < soil.box_to_mm[a]) continue;
    origins.fail(element + ".position_mm", fmt::format("'{}' lies outside the soil's box in {}", o.name, axis_name[a]),
                 fmt::format("{}", o.position_mm[a]), fmt::format("{} to {}", soil.box_from_mm[a], soil.box_to_mm[a]),
                 "move it, or make the box larger");
  }
  const RootSection& root = scene.root;
  if (o.shape == SoilShape::gap || !root.is_lattice() || root.curvature_per_mm != 0.0)
    return;  // the engine looks again
  constexpr int points = 200;
  for (int k = 0; k <= points; ++k) {
    const double x = (root.length_mm - root.radius_mm) * k / points;
    if (distance_mm(o, {x, 0, 0}, soil.dimension) >= root.radius_mm) continue;
    origins.fail(element + ".position_mm", fmt::format("the root overlaps '{}' at the start", o.name),
                 fmt::format("at x = {:.3g} mm", x), "an obstacle that the root does not touch at the start",
                 "move the obstacle, or make the root shorter");
  }
}

/// Balls that begin inside another body would burst out of it, or hold it with a force that means nothing.
void check_apart(const std::vector<SoilObstacle>& obstacles, int dimension, const Origins& origins) {
  constexpr double rounding_mm = 1e-9;
  for (std::size_t i = 0; i < obstacles.size(); ++i) {
    for (std::size_t k = 0; k < obstacles.size(); ++k) {
      const SoilObstacle &ball = obstacles[i], &other = obstacles[k];
      if (i == k || !is_ball(ball) || other.shape == SoilShape::gap) continue;
      if (!is_ball(other) && !ball.movable) continue;  // a fixed stone may be let into a fixed box
      const double depth_mm = ball.radius_mm - distance_mm(other, ball.position_mm, dimension);
      if (depth_mm <= rounding_mm) continue;
      origins.fail(fmt::format("soil.obstacle[{}].position_mm", std::max(i, k) + 1),
                   fmt::format("'{}' and '{}' overlap", obstacles[std::min(i, k)].name, obstacles[std::max(i, k)].name),
                   fmt::format("'{}' reaches {:.4g} mm into '{}'", ball.name, depth_mm, other.name),
                   "obstacles that at most touch; only fixed boxes and plates may overlap what is fixed",
                   "move them apart, or make one smaller; a body of several balls is a clump");
    }
  }
}

void check_room_for_root(const Scene& scene) {
  const Origins& origins = scene.origins;
  const SoilSection& soil = *scene.find<SoilSection>();
  const RootSection& root = scene.root;
  if (!root.is_lattice()) return;  // the engine looks when it places the root
  constexpr double grains_beside = 2.0;
  const double needed = root.radius_mm + grains_beside * soil.d_max_mm;
  for (int a = 1; a < soil.dimension; ++a) {
    if (soil.box_from_mm[a] <= -needed && soil.box_to_mm[a] >= needed) continue;
    origins.fail(soil.box_from_mm[a] <= -needed ? "soil.box_to_mm" : "soil.box_from_mm",
                 fmt::format("there is no room for the root, whose axis is {} = 0, and {} grains on either side",
                             axis_name[a], grains_beside),
                 fmt::format("{} from {} to {} mm", axis_name[a], soil.box_from_mm[a], soil.box_to_mm[a]),
                 fmt::format("from at most {:.6g} to at least {:.6g} mm", -needed, needed), "make the box wider");
  }
  if (root.length_mm + grains_beside * soil.d_max_mm > soil.box_to_mm[0]) {
    origins.fail("soil.box_to_mm", "there is no room ahead of the root's tip",
                 fmt::format("x to {} mm", soil.box_to_mm[0]),
                 fmt::format("above {:.6g} mm", root.length_mm + grains_beside * soil.d_max_mm),
                 "make the box longer; the root grows towards x = to");
  }
}

void complete_soil(Scene& scene) {
  const Origins& origins = scene.origins;
  SoilSection& soil = *scene.find<SoilSection>();
  const int dimension = scene.scene.dimension;
  if (soil.given_dimension.value_or(dimension) != dimension) {
    origins.fail("soil.dimension", fmt::format("a {}D root can't grow in a {}D soil", dimension, *soil.given_dimension),
                 fmt::format("{}", *soil.given_dimension), fmt::format("{}, as scene.dimension", dimension),
                 "leave it out, or change scene.dimension");
  }
  soil.dimension = dimension;
  for (int a = 0; a < dimension; ++a) {
    if (soil.box_from_mm[a] < soil.box_to_mm[a]) continue;
    origins.fail("soil.box_to_mm", fmt::format("the box is empty in {}", axis_name[a]),
                 fmt::format("{}", soil.box_to_mm[a]), fmt::format("above box_from_mm = {}", soil.box_from_mm[a]),
                 "exchange or move the corners");
  }
  complete_grains(soil, scene);
  check_packing(soil, origins);
  complete_names(soil.obstacles, "soil.obstacle", origins);
  check_apart(soil.obstacles, dimension, origins);
  if (!scene.find<SoilContactSection>()) scene.all<SoilContactSection>().emplace_back();
  if (!scene.has_root) return;
  check_room_for_root(scene);
  for (std::size_t i = 0; i < soil.obstacles.size(); ++i) check_soil_obstacle(soil.obstacles[i], i, scene);
  scene.facts.longest_step_h = scene.find<SoilContactSection>()->interval_h;
}

}  // namespace

void refuse_long_interval(const Scene& scene, double density_N_h2_mm4, double interval_h, const std::string& key) {
  constexpr double most = 1e5;  // shipped soils take some 50 to 500; so many take longer than the process may be silent
  const SoilSection& soil = *scene.find<SoilSection>();
  const double step_h = soil.step_safety * 0.5 * soil.d_min_mm * std::sqrt(density_N_h2_mm4 / soil.E_MPa);
  const double substeps = interval_h / step_h;
  if (!(substeps > most)) return;
  const bool dense = soil.density_N_h2_mm4.has_value();
  scene.origins.fail(
      scene.origins.has("soil.step_safety") ? "soil.step_safety"
      : dense                               ? "soil.density_N_h2_mm4"
                                            : "soil.inertial_number_max",
      fmt::format("the grains would take {:.1e} substeps in an interval", substeps),
      fmt::format("substeps of {:.2g} h (step_safety = {}, density {:.2g} N h^2/mm^4{}) in {} = {:.3g} h", step_h,
                  soil.step_safety, density_N_h2_mm4,
                  dense ? "" : fmt::format(" from inertial_number_max = {}", soil.inertial_number_max), key,
                  interval_h),
      fmt::format("at most {:.0e} substeps; step_safety is usually 0.5", most),
      dense ? "leave density_N_h2_mm4 out: real grains are far too light to follow for hours, and a density from "
              "inertial_number_max is as good while the soil is quasi-static"
            : "raise inertial_number_max: soil is quasi-static up to 0.01");
}

namespace {

void complete_penetrometer(Scene& scene) {
  const Origins& origins = scene.origins;
  PenetrometerSection& probe = *scene.find<PenetrometerSection>();
  if (!scene.find<SoilSection>())
    origins.fail("penetrometer", "there is no soil to push the probe into", {}, {}, "add [soil]");
  const SoilSection& soil = *scene.find<SoilSection>();
  constexpr double grains_ahead = 4.0;
  const double deepest = soil.box_to_mm[0] - soil.box_from_mm[0] - grains_ahead * soil.d_max_mm;
  if (probe.depth_mm > deepest * (1 + 1e-9)) {  // the message's own number is allowed
    origins.fail(
        "penetrometer.depth_mm", "the probe would meet the wall at the other end", fmt::format("{}", probe.depth_mm),
        fmt::format("at most {:.6g} mm: the box less {} grains", deepest, grains_ahead), "make the box longer");
  }
  for (int a = 1; a < soil.dimension; ++a) {
    const double widest = soil.box_to_mm[a] - soil.box_from_mm[a] - grains_ahead * soil.d_max_mm;
    if (probe.diameter_mm <= widest) continue;
    origins.fail("penetrometer.diameter_mm", "the probe leaves no room for grains beside it",
                 fmt::format("{}", probe.diameter_mm),
                 fmt::format("at most {:.6g} mm: the box less {} grains", widest, grains_ahead), "make the box wider");
  }
  if (!probe.average_from_mm) probe.average_from_mm = std::max(probe.depth_mm - 1.0, 0.5 * probe.depth_mm);
  if (*probe.average_from_mm >= probe.depth_mm) {
    origins.fail("penetrometer.average_from_mm", "there is nothing to average",
                 fmt::format("{}", *probe.average_from_mm), fmt::format("below depth_mm = {}", probe.depth_mm),
                 "average over 1 mm or more");
  }
  if (!probe.friction_deg) probe.friction_deg = soil.root_friction_deg;
  if (!probe.interval_h) probe.interval_h = 0.01 * probe.diameter_mm / probe.rate_mm_h;
  refuse_long_interval(scene, expected_density_N_h2_mm4(soil, probe.rate_mm_h, probe.diameter_mm), *probe.interval_h,
                       "penetrometer.interval_h");
  constexpr double most_readings = 1e6;
  const double readings = probe.depth_mm / (probe.rate_mm_h * *probe.interval_h);
  if (!(readings <= most_readings)) {
    origins.fail("penetrometer.interval_h", fmt::format("the probe would be read {:.1e} times", readings),
                 fmt::format("{} h at {} mm/h", *probe.interval_h, probe.rate_mm_h),
                 fmt::format("at most {:.0e} readings in depth_mm = {}", most_readings, probe.depth_mm),
                 "read it less often, or push it faster; is the time in hours?");
  }
}

// clang-format off
SectionSpec soil_section() {
  using namespace sections;
  using So = SoilSection;
  const auto soil_key = [](auto member, auto... rest) { return key(member_of<So>(member), std::move(rest)...); };
  return section<So>("soil", optional, "Granular soil around the root, moved by YADE in a process of its own.", {
    soil_key(&So::given_dimension, "dimension", "-", between(2, 3), "2: one layer of discs; 3: balls. The scene's.",
        "docs/soil.md").defaults_to("scene.dimension").written_when([](const So&) { return false; }),
    soil_key(&So::box_from_mm, "box_from_mm", "mm", place_mm, "Corner of the box; the root enters through x = from.",
        "docs/soil.md").required(),
    soil_key(&So::box_to_mm, "box_to_mm", "mm", place_mm, "Opposite corner; the root grows towards x = to.", "docs/soil.md")
        .required(),
    soil_key(&So::walls, "walls",
        "rigid: all stand still once the root is in; servo: all keep the pressure; mixed: servo, but the one at x = to stands still.",
        "docs/soil.md"),
    soil_key(&So::confining_pressure_MPa, "confining_pressure_MPa", "MPa", at_least(0).up_to(10, pascals),
        "Pressure of packing and of servo walls.", "docs/soil.md").required(),
    soil_key(&So::d_range_mm, "d_range_mm", "mm", above(0).up_to(1e2, microns),
        "Smallest and largest grain diameter, evenly spread; this or d_mean_mm.", "docs/soil.md"),
    soil_key(&So::d_mean_given_mm, "d_mean_mm", "mm", above(0).up_to(1e2, microns), "Mean grain diameter; this or d_range_mm.",
        "docs/soil.md"),
    soil_key(&So::d_spread_given, "d_spread", "-", Limits{.low = 0, .high = 1, .high_open = true},
        "Diameters lie within d_mean (1 - spread) and d_mean (1 + spread).", "docs/soil.md")
        .only_with("d_mean_mm").defaults_to("0.2"),
    soil_key(&So::grains_file, "grains_file", "-", any_text,
        "Grains from a CSV (x_mm, y_mm, z_mm, radius_mm) instead of packing.", "docs/soil.md").names_file(),
    soil_key(&So::contact_law, "contact_law", "Law between bodies that touch.",
        "docs/soil.md"),
    soil_key(&So::E_MPa, "E_MPa", "MPa", modulus, "Stiffness of the grains: 250 times the stress on the tip keeps overlaps small.",
        "docs/soil.md").required(),
    soil_key(&So::poisson, "poisson", "-", Limits{.low = 0, .high = 0.5, .low_open = true},
        "linear, cohesive: tangential over normal stiffness; hertz_mindlin: Poisson's ratio.", "docs/soil.md"),
    soil_key(&So::friction_deg, "friction_deg", "deg", Limits{.low = 0, .high = 80, .above_remedy = "this is an angle, not a coefficient"},
        "Angle of friction between grains.", "docs/soil.md"),
    soil_key(&So::root_friction_deg, "root_friction_deg", "deg",
        Limits{.low = 0, .high = 80, .above_remedy = "this is an angle, not a coefficient"},
        "Between root and grains; the smaller of the two angles holds.", "docs/soil.md"),
    soil_key(&So::rolling, "rolling", "-", between(0, 5), "Rolling resistance: moment over normal force times radius.",
        "docs/soil.md"),
    soil_key(&So::cohesion_MPa, "cohesion_MPa", "MPa", at_least(0).up_to(1e3, pascals),
        "Strength of bonds between grains that touch at the start.", "docs/soil.md").only_where("contact_law", {"cohesive"}),
    soil_key(&So::density_N_h2_mm4, "density_N_h2_mm4", "N h^2/mm^4", between(1e-20, 1e3),
        "Of the grains, numerical; absent: from inertial_number_max and the root's expected speed.", "docs/soil.md")
        .defaults_to("from inertial_number_max"),
    soil_key(&So::inertial_number_max, "inertial_number_max", "-", between(1e-6, 1),
        "Inertial number at the root's expected speed; soil is quasi-static up to 0.01.", "docs/soil.md")
        .only_without("density_N_h2_mm4"),
    soil_key(&So::porosity, "porosity", "-", inside(0, 1), "Wanted; absent: what compaction_friction_deg gives.", "docs/soil.md"),
    soil_key(&So::compaction_friction_deg, "compaction_friction_deg", "deg", between(0, 80),
        "Angle of friction while packing: small packs densely.", "docs/soil.md").only_without("porosity"),
    soil_key(&So::seed, "seed", "-", at_least(1).up_to(2e9, {}), "Of the packing.", "docs/soil.md"),
    soil_key(&So::step_safety, "step_safety", "-", between(1e-3, 1), "Substep over the P-wave step of the smallest grain.",
        "docs/soil.md"),
    soil_key(&So::damping, "damping", "-", between(0, 0.95), "YADE's local damping of the grains.", "docs/soil.md"),
    soil_key(&So::threads, "threads", "-", between(1, 256), "Of YADE; with more than one no two runs are bit-identical.",
        "docs/soil.md"),
  }).completed_by(complete_soil).also_without_root();
}

SectionSpec soil_obstacle_section() {
  using namespace sections;
  using Sb = SoilObstacle;
  return section<Sb>("soil.obstacle", repeated,
                     "A rigid body inside the soil, met by grains and root; a gap is a place without grains.",
                     [](auto& s) {
                       auto* soil = s.template find<SoilSection>();
                       return soil ? &soil->obstacles : nullptr;
                     }, {
    key(&Sb::name, "name", "-", any_text, "For messages; unique.", "-").defaults_to("soil.obstacle_1, ..."),
    key(&Sb::shape, "shape",
        "stone: a ball; clump: three balls that hold together.", "docs/soil.md").required(),
    key(&Sb::position_mm, "position_mm", "mm", place_mm, "Centre.", "-").required(),
    key(&Sb::half_size_mm, "half_size_mm", "mm", above(0).up_to(1e3, microns), "Half the sides.", "-")
        .required().only_where("shape", {"box", "gap"}),
    key(&Sb::length_mm, "length_mm", "mm", above(0).up_to(1e3, microns), "Side of the plate.", "-")
        .required().only_where("shape", {"plate"}),
    key(&Sb::thickness_mm, "thickness_mm", "mm", above(0).up_to(1e3, microns), "Of the plate.", "-")
        .only_where("shape", {"plate"}),
    key(&Sb::angle_deg, "angle_deg", "deg", between(-360, 360), "Turned about z.", "-")
        .only_where("shape", {"box", "plate", "gap", "clump"}),
    key(&Sb::radius_mm, "radius_mm", "mm", above(0).up_to(1e3, microns), "Of the stone, or of the clump as a whole.", "-")
        .required().only_where("shape", {"stone", "clump"}),
    key(&Sb::movable, "movable", "-", any_number, "Pushed aside like a grain.", "-").only_where("shape", {"stone", "clump"}),
  }).also_without_root();
}

SectionSpec soil_contact_section() {
  using namespace sections;
  using Sk = SoilContactSection;
  return section<Sk>("soil.contact", optional, "How root and soil exchange motion and forces.", {
    key(&Sk::interval_h, "interval_h", "h", above(0).up_to(1, seconds),
        "Between two exchanges, in whole windows; without inertia the longest step: the accuracy knob of the coupling.",
        "docs/soil.md"),
    key(&Sk::marker_radius_mm, "marker_radius_mm", "mm", above(0).up_to(10, microns), "Of the balls that are the root's surface.",
        "docs/soil.md").defaults_to("one cell"),
    key(&Sk::marker_spacing, "marker_spacing", "-", Limits{.low = 0.1, .high = 1, .above_remedy = "markers must be closer than their radius"},
        "Between markers, of their radius.", "docs/soil.md"),
    key(&Sk::map_width_cells, "map_width_cells", "-", between(1, 3), "Reach of the weights between cells and markers, half of it.",
        "docs/soil.md"),
    key(&Sk::ramp_h, "ramp_h", "h", at_least(0).up_to(1e3, seconds), "Forces rise from nothing over this time.", "docs/soil.md"),
    key(&Sk::stiffness_predictor, "stiffness_predictor", "-", any_number,
        "Within an interval forces follow the contacts' stiffness, as on rigid walls; else, without inertia, they resist only "
        "what departs from the mean pace.", "docs/soil.md"),
    key(&Sk::under_relaxation, "under_relaxation", "-", any_number, "Aitken's, for a stiff, tightly held root.", "docs/soil.md"),
    key(&Sk::tip_length_mm, "tip_length_mm", "mm", above(0).up_to(1e3, microns), "What counts as tip in tip forces.", "docs/soil.md")
        .defaults_to("a root's diameter"),
  }).also_without_root();
}

SectionSpec penetrometer_section() {
  using namespace sections;
  using Pn = PenetrometerSection;
  return section<Pn>("penetrometer", optional, "A probe pushed into [soil] by rootsoil penetrometer; a run ignores it.", {
    key(&Pn::diameter_mm, "diameter_mm", "mm", above(0).up_to(1e2, microns), "Of the shaft.", "docs/soil.md").required(),
    key(&Pn::cone_angle_deg, "cone_angle_deg", "deg", between(10, 180), "Full angle of the cone; 180: a round tip.",
        "docs/soil.md"),
    key(&Pn::rate_mm_h, "rate_mm_h", "mm/h", above(0).up_to(1e6, {}), "Of penetration; the grains' density follows from it.",
        "docs/soil.md").required(),
    key(&Pn::depth_mm, "depth_mm", "mm", above(0).up_to(1e3, microns), "At the end, from the wall x = from.", "docs/soil.md")
        .required(),
    key(&Pn::average_from_mm, "average_from_mm", "mm", at_least(0).up_to(1e3, microns), "Depth from which Q is averaged.",
        "docs/soil.md").defaults_to("depth_mm - 1 mm"),
    key(&Pn::friction_deg, "friction_deg", "deg", between(0, 80), "Between probe and grains.", "docs/soil.md")
        .defaults_to("soil.root_friction_deg"),
    key(&Pn::seeds, "seeds", "-", between(1, 100), "Samples, with seeds from soil.seed upwards.", "docs/soil.md"),
    key(&Pn::interval_h, "interval_h", "h", above(0).up_to(1e3, seconds), "Between two readings of Q.", "docs/soil.md")
        .defaults_to("0.01 diameter/rate"),
    key(&Pn::turgor_MPa, "turgor_MPa", "MPa", above(0).up_to(10, pascals), "For the paper's p = turgor - Q/4.", "paper 2.1"),
  }).completed_by(complete_penetrometer).also_without_root();
}
// clang-format on

}  // namespace

std::vector<SectionSpec> soil_sections() {
  return {soil_section(), soil_obstacle_section(), soil_contact_section(), penetrometer_section()};
}

}  // namespace rootsoil
