// SPDX-License-Identifier: MIT
// What the root meets: obstacles, soil; and the penetrometer in the soil.
#include "root_sph/scene/schema_keys.hpp"
#include "root_sph/scene/schema_sections.hpp"

namespace rootsoil::sections {

// clang-format off
SectionSpec obstacle_section() {
  using Ob = ObstacleSection;
  return section<Ob>("obstacle", repeated, "A rigid obstacle: penalty contact with Coulomb friction.",
                     [](auto& s) { return &s.obstacles; }, {
    key(&Ob::name, "name", "-", any_text, "For messages and outputs; unique.", "-").defaults_to("obstacle_1, ..."),
    key(&Ob::shape, "shape", "-", one_of({"plane", "box", "disc", "sphere"}), "disc in 2D only, sphere in 3D only.",
        "paper S4").required(),
    key(&Ob::position_mm, "position_mm", "mm", place_mm, "A point of the plane, or the centre.", "-").required(),
    key(&Ob::normal, "normal", "-", any_number, "Direction out of the plane, towards the root; this or angle_deg.", "-")
        .only_where("shape", {"plane"}).defaults_to("none"),
    key(&Ob::angle_deg, "angle_deg", "deg", between(-360, 360),
        "Turned about z. Plane: angle between plane and x axis; 90 faces the root, normal = (-sin, cos).", "-")
        .only_where("shape", {"plane", "box"}).defaults_to("box: 0.0")
        .written_when([](const Ob& o) { return o.shape != "plane"; }),  // a plane's angle has become its normal
    key(&Ob::half_size_mm, "half_size_mm", "mm", above(0).up_to(1e3, microns), "Half the box's sides.", "-")
        .required().only_where("shape", {"box"}),
    key(&Ob::radius_mm, "radius_mm", "mm", above(0).up_to(1e3, microns), "Radius.", "-")
        .required().only_where("shape", {"disc", "sphere"}),
    key(&Ob::friction, "friction", "-", at_least(0), "Coulomb coefficient.", "-"),
    key(&Ob::contact_modulus_MPa, "contact_modulus_MPa", "MPa", modulus, "Stiffness of the penalty.", "-")
        .defaults_to("E_axial_MPa"),
  });
}

SectionSpec soil_section() {
  using So = SoilSection;
  const auto soil_key = [](auto member, auto... rest) { return key(member_of<So>(member), std::move(rest)...); };
  return section<So>("soil", optional, "Granular soil around the root, moved by YADE in a process of its own.",
                     [](auto& s) { return &s.soil; }, {
    soil_key(&So::soil_dimension, "dimension", "-", between(2, 3), "2: one layer of discs; 3: balls. The scene's.",
        "docs/soil.md").defaults_to("scene.dimension").written_when([](const So&) { return false; }),
    soil_key(&So::box_from_mm, "box_from_mm", "mm", place_mm, "Corner of the box; the root enters through x = from.",
        "docs/soil.md").required(),
    soil_key(&So::box_to_mm, "box_to_mm", "mm", place_mm, "Opposite corner; the root grows towards x = to.", "docs/soil.md")
        .required(),
    soil_key(&So::walls, "walls", "-", one_of({"rigid", "servo", "mixed"}),
        "rigid: all stand still once the root is in; servo: all keep the pressure; mixed: servo, but the one at x = to stands still.",
        "docs/soil.md"),
    soil_key(&So::confining_pressure_MPa, "confining_pressure_MPa", "MPa", at_least(0).up_to(10, pascals),
        "Pressure of packing and of servo walls.", "docs/soil.md").required(),
    soil_key(&So::d_range_mm, "d_range_mm", "mm", above(0).up_to(1e2, microns),
        "Smallest and largest grain diameter, evenly spread; this or d_mean_mm.", "docs/soil.md"),
    soil_key(&So::d_mean_given_mm, "d_mean_mm", "mm", above(0).up_to(1e2, microns), "Mean grain diameter; this or d_range_mm.",
        "docs/soil.md"),
    soil_key(&So::d_spread_given, "d_spread", "-", Limits{.low = 0, .high = 1, .high_open = true, .above_remedy = {}},
        "Diameters lie within d_mean (1 - spread) and d_mean (1 + spread).", "docs/soil.md")
        .only_with("d_mean_mm").defaults_to("0.2"),
    soil_key(&So::grains_file, "grains_file", "-", any_text,
        "Grains from a CSV (x_mm, y_mm, z_mm, radius_mm) instead of packing.", "docs/soil.md"),
    soil_key(&So::contact_law, "contact_law", "-", one_of({"linear", "hertz_mindlin", "cohesive"}), "Law between bodies that touch.",
        "docs/soil.md"),
    soil_key(&So::E_MPa, "E_MPa", "MPa", modulus, "Stiffness of the grains: 250 times the stress on the tip keeps overlaps small.",
        "docs/soil.md").required(),
    soil_key(&So::poisson, "poisson", "-", Limits{.low = 0, .high = 0.5, .low_open = true, .above_remedy = {}},
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
    soil_key(&So::density_N_h2_mm4, "density_N_h2_mm4", "N h^2/mm^4", above(0),
        "Of the grains, numerical; absent: from inertial_number_max and the root's expected speed.", "docs/soil.md")
        .defaults_to("from inertial_number_max"),
    soil_key(&So::inertial_number_max, "inertial_number_max", "-", above(0).up_to(1, {}),
        "Inertial number at the root's expected speed; soil is quasi-static up to 0.01.", "docs/soil.md")
        .only_without("density_N_h2_mm4"),
    soil_key(&So::porosity, "porosity", "-", inside(0, 1), "Wanted; absent: what compaction_friction_deg gives.", "docs/soil.md"),
    soil_key(&So::compaction_friction_deg, "compaction_friction_deg", "deg", between(0, 80),
        "Angle of friction while packing: small packs densely.", "docs/soil.md").only_without("porosity"),
    soil_key(&So::seed, "seed", "-", at_least(1).up_to(2e9, {}), "Of the packing.", "docs/soil.md"),
    soil_key(&So::step_safety, "step_safety", "-", above(0).up_to(1, {}), "Substep over the P-wave step of the smallest grain.",
        "docs/soil.md"),
    soil_key(&So::damping, "damping", "-", between(0, 0.95), "YADE's local damping of the grains.", "docs/soil.md"),
    soil_key(&So::threads, "threads", "-", between(1, 256), "Of YADE; with more than one no two runs are bit-identical.",
        "docs/soil.md"),
  });
}

SectionSpec soil_obstacle_section() {
  using Sb = SoilObstacle;
  return section<Sb>("soil.obstacle", repeated,
                     "A rigid body inside the soil, met by grains and root; a gap is a place without grains.",
                     [](auto& s) { return s.soil ? &s.soil->obstacles : nullptr; }, {
    key(&Sb::name, "name", "-", any_text, "For messages; unique.", "-").defaults_to("soil.obstacle_1, ..."),
    key(&Sb::shape, "shape", "-", one_of({"box", "plate", "stone", "clump", "gap"}),
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
  });
}

SectionSpec soil_contact_section() {
  using Sk = SoilContactSection;
  return section<Sk>("soil.contact", optional, "How root and soil exchange motion and forces.",
                     [](auto& s) { return s.soil ? &s.soil_contact : nullptr; }, {
    key(&Sk::interval_h, "interval_h", "h", above(0).up_to(1, seconds),
        "Between two exchanges, rounded to whole windows: the accuracy knob of the coupling.", "docs/soil.md"),
    key(&Sk::marker_radius_mm, "marker_radius_mm", "mm", above(0).up_to(10, microns), "Of the balls that are the root's surface.",
        "docs/soil.md").defaults_to("one cell"),
    key(&Sk::marker_spacing, "marker_spacing", "-", Limits{.low = 0.1, .high = 1, .above_remedy = "markers must be closer than their radius"},
        "Between markers, of their radius.", "docs/soil.md"),
    key(&Sk::map_width_cells, "map_width_cells", "-", between(1, 3), "Reach of the weights between cells and markers, half of it.",
        "docs/soil.md"),
    key(&Sk::ramp_h, "ramp_h", "h", at_least(0).up_to(1e3, seconds), "Forces rise from nothing over this time.", "docs/soil.md"),
    key(&Sk::stiffness_predictor, "stiffness_predictor", "-", any_number,
        "Within an interval forces follow the contact stiffness; for rigid walls only.", "docs/soil.md"),
    key(&Sk::under_relaxation, "under_relaxation", "-", any_number, "Aitken's, for a stiff, tightly held root.", "docs/soil.md"),
    key(&Sk::tip_length_mm, "tip_length_mm", "mm", above(0).up_to(1e3, microns), "What counts as tip in tip forces.", "docs/soil.md")
        .defaults_to("a root's diameter"),
  });
}

SectionSpec penetrometer_section() {
  using Pn = PenetrometerSection;
  return section<Pn>("penetrometer", optional, "A probe pushed into [soil] by rootsoil penetrometer; a run ignores it.",
                     [](auto& s) { return &s.penetrometer; }, {
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
        .defaults_to("soil.root_friction_deg").written_when([](const Pn& s) { return s.friction_deg >= 0.0; }),
    key(&Pn::seeds, "seeds", "-", between(1, 100), "Samples, with seeds from soil.seed upwards.", "docs/soil.md"),
    key(&Pn::interval_h, "interval_h", "h", above(0).up_to(1e3, seconds), "Between two readings of Q.", "docs/soil.md")
        .defaults_to("0.01 diameter/rate"),
    key(&Pn::turgor_MPa, "turgor_MPa", "MPa", above(0).up_to(10, pascals), "For the paper's p = turgor - Q/4.", "paper 2.1"),
  });
}
// clang-format on

}  // namespace rootsoil::sections
