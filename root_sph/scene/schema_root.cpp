// SPDX-License-Identifier: MIT
// The scene, the root at the start, its tissue and its pressure.
#include "root_sph/scene/schema_keys.hpp"
#include "root_sph/scene/schema_sections.hpp"

namespace rootsoil::sections {

namespace {

/// [pressure] has one table and two ways to write it.
Key<PressureSection> constant_pressure(Limits limits) {
  Key<PressureSection> k;
  k.spec = {.name = "differential_MPa",
            .type = ValueType::number,
            .unit = "MPa",
            .limits = std::move(limits),
            .choices = {},
            .meaning = "Constant pressure differential: turgor less what the soil takes; this or table.",
            .source = "paper Eq. 5, Table 1",
            .default_text = "none",
            .condition = {},
            .response_section = {},
            .set = {},
            .get = {}};
  k.set = [](PressureSection& s, const Value& value) { s.table = {{0.0, std::get<double>(value)}}; };
  k.get = [](const PressureSection& s) {
    return s.table.size() == 1 ? std::optional<Value>(s.table.front()[1]) : std::nullopt;
  };
  return k;
}

Key<PressureSection> pressure_table(Limits limits) {
  Key<PressureSection> k;
  k.spec = {.name = "table",
            .type = ValueType::rows,
            .unit = "h, MPa",
            .limits = std::move(limits),
            .choices = {},
            .meaning = "[[time, pressure], ...]: linear in between, constant before the first and after the last.",
            .source = "docs/physics.md 3",
            .default_text = "none",
            .condition = {},
            .response_section = {},
            .set = {},
            .get = {}};
  k.set = [](PressureSection& s, const Value& value) { s.table = std::get<Rows>(value); };
  k.get = [](const PressureSection& s) { return s.table.size() > 1 ? std::optional<Value>(s.table) : std::nullopt; };
  return k;
}

}  // namespace

// clang-format off
SectionSpec scene_section() {
  using Sc = SceneSection;
  return section<Sc>("scene", required, "What is simulated, and for how long.", [](auto& s) { return &s.scene; }, {
    key(&Sc::name, "name", "-", any_text, "Name of the run: letters, digits, _ - and dot.", "-")
        .defaults_to("the file's name"),
    key(&Sc::dimension, "dimension", "-", between(2, 3), "2 (per mm of depth) or 3.", "paper 4.4"),
    key(&Sc::duration_h, "duration_h", "h", above(0).up_to(1e4, seconds), "Simulated time.", "Table 1: T").required(),
    key(&Sc::seed, "seed", "-", at_least(0), "Start of the random numbers (jitter, size_variation).", "-"),
    key(&Sc::allow_unstable, "allow_unstable", "-", any_number,
        "Run even where waves in the tissue grow by themselves.", "docs/physics.md 3"),
  });
}

SectionSpec root_section() {
  using Ro = RootSection;
  return section<Ro>("root", required, "The cells at the start: a capsule filled with a lattice, or a cell file.",
                     [](auto& s) { return &s.root; }, {
    key(&Ro::cells_file, "cells_file", "-", any_text, "Cells from microscopy (CSV in microns), relative to this file.",
        "MorphoGraphX export"),
    key(&Ro::tip_axis, "tip_axis", "-", one_of({"+x", "-x", "+y", "-y", "+z", "-z"}),
        "Direction of the tip in the cell file.", "-").only_with("cells_file"),
    key(&Ro::length_mm, "length_mm", "mm", above(0).up_to(1e3, microns), "From the base to the tip.", "paper 4.4")
        .required().only_without("cells_file"),
    key(&Ro::radius_mm, "radius_mm", "mm", above(0).up_to(20, microns), "Radius (2D: half the width).", "paper 4.4")
        .required().only_without("cells_file"),
    key(&Ro::cell_size_mm, "cell_size_mm", "mm", above(0).up_to(1, microns), "Spacing of the lattice.", "Table 1: l0")
        .required().only_without("cells_file"),
    key(&Ro::jitter, "jitter", "-", between(0, 0.5), "Random displacement of the centres, fraction of the spacing.",
        "docs/physics.md 5").only_without("cells_file"),
    key(&Ro::size_variation, "size_variation", "-", between(0, 0.95), "Cell volumes vary by a factor 1-v to 1+v.",
        "docs/physics.md 7").only_without("cells_file"),
    key(&Ro::curvature_per_mm, "curvature_per_mm", "1/mm", between(-1e3, 1e3),
        "Initial curvature of the axis, x-y plane.", "docs/physics.md 7").only_without("cells_file"),
    key(&Ro::base_obliquity_deg, "base_obliquity_deg", "deg", between(-80, 80), "Angle of the cut at the base.",
        "docs/physics.md 7").only_without("cells_file"),
    key(&Ro::cap, "cap", "-", any_number, "Round tip; false: cut straight.", "paper 4.4").only_without("cells_file"),
    key(&Ro::base, "base", "-", one_of({"clamped", "free"}), "How the base is held.", "paper 4.4"),
    key(&Ro::clamp_length_mm, "clamp_length_mm", "mm", at_least(0).up_to(1e3, microns),
        "Length held at the base; 0 = three cells.", "docs/physics.md 5").only_where("base", {"clamped"}),
  });
}

SectionSpec tissue_section() {
  using Ti = TissueSection;
  return section<Ti>("tissue", required, "Elastic law of the tissue.", [](auto& s) { return &s.tissue; }, {
    key(&Ti::law, "law", "-", one_of({"elastic_growth", "pressure_deviator"}),
        "elastic_growth: full stress, growth along the elastic strain; pressure_deviator: Eq. 1-4 to the letter.",
        "paper Eq. 1-4, docs/physics.md 3"),
    key(&Ti::E_axial_MPa, "E_axial_MPa", "MPa", modulus, "Axial Young modulus E_A.", "Table 1: 1020").required(),
    key(&Ti::nu_axial, "nu_axial", "-", inside(-1, 1), "Axial Poisson ratio nu_A.", "Table 1: 0.06"),
    key(&Ti::nu_radial, "nu_radial", "-", inside(-1, 1), "Radial Poisson ratio nu_R (3D).", "Table 1: 0.3"),
    key(&Ti::G_MPa, "G_MPa", "MPa", modulus, "Shear modulus between axis and radius.", "paper Eq. 4, docs/physics.md 3")
        .defaults_to("E_A/(2(1+nu_A))"),
    key(&Ti::rho0_ug_mm3, "rho0_ug_mm3", "ug/mm^3", above(0).up_to(1e6, {}), "Equilibrium density.", "Table 1: 1000"),
  });
}

SectionSpec anisotropy_section() {
  using An = AnisotropySection;
  return section<An>("tissue.anisotropy", optional,
                     "Radial modulus along the root: E_R = E_A + (E_H - E_A)(c_e + (1 - c_e)/"
                     "(1 + exp(-s_e (s - x_e)))); absent: E_R = E_A.",
                     [](auto& s) { return &s.tissue.anisotropy; }, {
    key(&An::E_radial_max_MPa, "E_radial_max_MPa", "MPa", modulus, "Largest radial modulus E_H.", "Table 1: 15000")
        .required().or_from_response(response_anisotropy),
    key(&An::x_e_mm, "x_e_mm", "mm", place_mm, "Distance from the tip of the transition.", "Eq. 6, Table 1")
        .required().or_from_response(response_anisotropy),
    key(&An::s_e_per_mm, "s_e_per_mm", "1/mm", at_least(0), "Slope of the transition.", "Eq. 6, Table 1")
        .required().or_from_response(response_anisotropy),
    key(&An::c_e, "c_e", "-", fraction, "Scale at the tip.", "Eq. 6, Table 1")
        .required().or_from_response(response_anisotropy),
  });
}

SectionSpec pressure_section() {
  using Pr = PressureSection;
  return section<Pr>("pressure", optional, "Pressure differential, uniform over the root.",
                     [](auto& s) { return &s.pressure; },
                     {constant_pressure(pressure), pressure_table(pressure)});
}
// clang-format on

}  // namespace rootsoil::sections
