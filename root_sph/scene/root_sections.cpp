// SPDX-License-Identifier: MIT
// The scene, the root at the start, its tissue.
#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <cmath>
#include <filesystem>
#include <numbers>

#include "root_sph/core/cell_columns.hpp"
#include "root_sph/scene/checks.hpp"
#include "root_sph/scene/schema_keys.hpp"
#include "root_sph/scene/schema_sections.hpp"

namespace rootsoil::sections {

namespace {

std::string name_from_file(const std::string& file) {
  std::string name = std::filesystem::path(file).stem().string();
  std::replace_if(
      name.begin(), name.end(),
      [](char c) { return !(std::isalnum(static_cast<unsigned char>(c)) || c == '_' || c == '-' || c == '.'); }, '_');
  return name.empty() || name.front() == '.' ? "scene" : name;
}

void complete_scene(Scene& scene) {
  if (scene.scene.name.empty()) {
    scene.scene.name = name_from_file(scene.file);
  } else if (scene.has_root) {
    check_name(scene.scene.name, "scene.name", scene.origins);
  }
}

void complete_cells_file(Scene& scene) {
  if (scene.scene.dimension != 3) {
    scene.origins.fail("root.cells_file", "cells from microscopy are ellipsoids in space",
                       toml_text(scene.root.cells_file), {}, "set scene.dimension = 3");
  }
  scene.root.cells_file = existing_file(scene, "root.cells_file", scene.root.cells_file);
}

void check_lattice(const Scene& scene) {
  const Origins& origins = scene.origins;
  const RootSection& root = scene.root;
  const double width_mm = 2 * root.radius_mm;
  constexpr double rounding = 1 + 1e-9;
  if (width_mm * rounding < root.cell_size_mm) {
    origins.fail("root.radius_mm", "the root is thinner than one cell", fmt::format("{}", root.radius_mm),
                 fmt::format("at least {} (half of cell_size_mm)", root.cell_size_mm / 2),
                 "make the radius larger or the cells smaller");
  }
  const double shortest_mm = root.cap ? std::max(root.radius_mm, root.cell_size_mm) : root.cell_size_mm;
  if (root.length_mm * rounding < shortest_mm) {
    origins.fail(
        "root.length_mm",
        root.cap ? "the root is shorter than its round tip, or than one cell" : "the root is shorter than one cell",
        fmt::format("{}", root.length_mm), fmt::format("at least {}", shortest_mm), "make the root longer");
  }
  if (std::abs(root.curvature_per_mm) * root.radius_mm >= 1) {
    origins.fail("root.curvature_per_mm", "the root is bent more sharply than it is thick",
                 fmt::format("{}", root.curvature_per_mm), fmt::format("-{0} to {0}", 1 / root.radius_mm),
                 "lower the curvature");
  }
  if (root.is_clamped() && root.clamp_length_mm.value_or(0.0) >= root.length_mm) {
    origins.fail("root.clamp_length_mm", "the whole root is clamped", fmt::format("{}", *root.clamp_length_mm),
                 fmt::format("below length_mm = {}", root.length_mm), "shorten the clamp");
  }
  constexpr double most_cells = 2e7;
  const double section = scene.scene.dimension == 2 ? width_mm : std::numbers::pi * root.radius_mm * root.radius_mm;
  const double cells = root.length_mm * section / std::pow(root.cell_size_mm, scene.scene.dimension);
  if (cells > most_cells) {
    origins.fail("root.cell_size_mm", fmt::format("the root would have some {:.0e} cells", cells),
                 fmt::format("{}", root.cell_size_mm), fmt::format("at most {:.0e} cells", most_cells),
                 "are all lengths in mm? Otherwise take larger cells or a shorter root");
  }
}

void complete_cell_columns(Scene& scene) {
  const CellColumns& columns = *scene.find<CellColumns>();
  const Origins& origins = scene.origins;
  if (scene.root.is_lattice()) {
    origins.fail("root.columns", "there is no table with these columns", {}, "only together with cells_file",
                 "remove the section, or give root.cells_file");
  }
  const auto check_size = [&](const char* key, const Texts& titles, std::size_t size) {
    if (titles.empty() || titles.size() == size) return;
    origins.fail(fmt::format("root.columns.{}", key), fmt::format("these are not {} titles", size), toml_text(titles),
                 fmt::format("{} titles of columns", size), "name the columns as the file's first line does");
  };
  check_size("position", columns.position, 3);
  check_size("e1", columns.e1, 3);
  check_size("e2", columns.e2, 3);
  check_size("semi_axes", columns.semi_axes, 3);
  check_size("diameters", columns.diameters, 3);
  check_size("inertia_tensor", columns.inertia, 6);
  const auto refuse_both = [&](const char* key, const Texts& titles, const char* other, const Texts& other_titles) {
    if (titles.empty() || other_titles.empty()) return;
    origins.fail(fmt::format("root.columns.{}", key), fmt::format("{} says the same", other), toml_text(titles), {},
                 "give one of the two");
  };
  refuse_both("diameters", columns.diameters, "semi_axes", columns.semi_axes);
  refuse_both("inertia_tensor", columns.inertia, "semi_axes", columns.semi_axes);
  refuse_both("inertia_tensor", columns.inertia, "diameters", columns.diameters);
}

/// Titles in a list, empty where the file's own names hold.
Key<CellColumns> titles_key(Texts CellColumns::*member, const std::string& name, const std::string& meaning,
                            const std::string& usual) {
  Key<CellColumns> k = key(member, name, "-", any_text, meaning, "-");
  k.get = [member](const CellColumns& columns) {
    return (columns.*member).empty() ? std::nullopt : std::optional<Value>(columns.*member);
  };
  return std::move(k).defaults_to(usual);
}

void complete_root(Scene& scene) { scene.root.is_lattice() ? check_lattice(scene) : complete_cells_file(scene); }

std::string law_meanings() {
  std::string text;
  for (const TissueLawEntry& law : tissue_laws) {
    text += fmt::format("{}{}: {}", text.empty() ? "" : "; ", law.name, law.meaning);
  }
  return text + '.';
}

void complete_tissue(Scene& scene) {
  TissueSection& tissue = scene.tissue;
  if (!tissue.G_MPa) tissue.G_MPa = tissue.E_axial_MPa / (2 * (1 + tissue.nu_axial));
  if (!scene.origins.has("tissue.anisotropy")) check_compliance(scene, {tissue.E_axial_MPa});
}

}  // namespace

// clang-format off
SectionSpec scene_section() {
  using Sc = SceneSection;
  return section<Sc>("scene", required, "What is simulated, and for how long.",
                     [](auto& s) { return &s.scene; }, {
    key(&Sc::name, "name", "-", any_text, "Name of the run: letters, digits, _ - and dot.", "-")
        .defaults_to("the file's name"),
    key(&Sc::dimension, "dimension", "-", between(2, 3), "2 (per mm of depth) or 3.", "paper 4.4"),
    key(&Sc::duration_h, "duration_h", "h", above(0).up_to(1e4, seconds), "Simulated time.", "Table 1: T").required(),
    key(&Sc::seed, "seed", "-", at_least(0), "Start of the random numbers (jitter, size_variation).", "-"),
    key(&Sc::allow_unstable, "allow_unstable", "-", any_number,
        "Run even where waves in the tissue grow by themselves.", "docs/physics.md 3"),
  }).completed_by(complete_scene);
}

SectionSpec root_section() {
  using Ro = RootSection;
  return section<Ro>("root", required, "The cells at the start: a capsule filled with a lattice, or a cell file.",
                     [](auto& s) { return &s.root; }, {
    key(&Ro::cells_file, "cells_file", "-", any_text,
        "Cells from microscopy (a table with a row a cell), relative to this file.",
        "MorphoGraphX export, scikit-image regionprops_table").names_file(),
    key(&Ro::tip_axis, "tip_axis",
        "Direction of the tip in the cell file, nearly. auto: the end with the smaller cells. The root is turned: its own "
        "axis onto +x, the cell furthest from it to +y.", "-").only_with("cells_file"),
    key(&Ro::length_mm, "length_mm", "mm", above(0).up_to(1e3, microns), "From the base to the tip.", "paper 4.4")
        .required().only_without("cells_file"),
    key(&Ro::radius_mm, "radius_mm", "mm", above(0).up_to(20, microns), "Radius (2D: half the width).", "paper 4.4")
        .required().only_without("cells_file"),
    key(&Ro::cell_size_mm, "cell_size_mm", "mm", above(0).up_to(1, microns), "Spacing of the lattice, stretched so that whole cells fit.",
        "Table 1: l0")
        .required().only_without("cells_file"),
    key(&Ro::jitter, "jitter", "-", between(0, 0.5), "Random displacement of the centres, fraction of the spacing.",
        "docs/physics.md 6").only_without("cells_file"),
    key(&Ro::size_variation, "size_variation", "-", between(0, 0.95), "Cell volumes vary by a factor 1-v to 1+v.",
        "docs/physics.md 6").only_without("cells_file"),
    key(&Ro::curvature_per_mm, "curvature_per_mm", "1/mm", between(-1e3, 1e3),
        "Initial curvature of the axis, x-y plane.", "docs/physics.md 6").only_without("cells_file"),
    key(&Ro::base_obliquity_deg, "base_obliquity_deg", "deg", between(-80, 80), "Angle of the cut at the base.",
        "docs/physics.md 6").only_without("cells_file"),
    key(&Ro::cap, "cap", "-", any_number, "Round tip; false: cut straight.", "paper 4.4").only_without("cells_file"),
    key(&Ro::base, "base", "How the base is held.", "paper 4.4"),
    key(&Ro::clamp_length_mm, "clamp_length_mm", "mm", above(0).up_to(1e3, microns),
        "Length held at the base.", "docs/physics.md 6").only_where("base", {"clamped"}).defaults_to("three cells"),
  }).completed_by(complete_root);
}

SectionSpec cell_columns_section() {
  using Co = CellColumns;
  return section<Co>("root.columns", optional, "What the columns of cells_file are called; needed where it differs from "
                     "MorphoGraphX exports and regionprops_table, or where no title names the unit.", {
    key(&Co::unit, "unit", "-", one_of(names_of<LengthUnit>()), "Of lengths in the table; areas and volumes are powers of it.",
        "-").defaults_to("what titles say: (mm), (um), (nm)"),
    key(&Co::label, "label", "-", any_text, "A whole number for each cell.", "-").defaults_to("Label"),
    titles_key(&Co::position, "position", "Centre of the cell: three titles.", "pos.X, pos.Y, pos.Z or centroid-0 ..."),
    titles_key(&Co::e1, "e1", "Unit vector of the longest axis: three titles.", "e1.X, e1.Y, e1.Z"),
    titles_key(&Co::e2, "e2", "Unit vector of the middle axis: three titles.", "e2.X, e2.Y, e2.Z"),
    titles_key(&Co::semi_axes, "semi_axes", "Semi-axes in descending order: three titles.", "r1, r2, r3"),
    titles_key(&Co::diameters, "diameters", "Whole axes in descending order, in place of semi_axes.", "none"),
    titles_key(&Co::inertia, "inertia_tensor", "Inertia of unit mass, in place of axes: six titles, xx, xy, xz, yy, yz, zz.",
               "those of regionprops_table, if there"),
    key(&Co::volume, "volume", "-", any_text, "Volume; where it is all there is, cells are balls.", "-")
        .defaults_to("area if there; else of the ellipsoid"),
  }).completed_by(complete_cell_columns);
}

SectionSpec tissue_section() {
  using Ti = TissueSection;
  return section<Ti>("tissue", required, "Elastic law of the tissue.", [](auto& s) { return &s.tissue; }, {
    key(&Ti::law, "law", law_meanings(), "paper Eq. 1-4, docs/physics.md 3"),
    key(&Ti::E_axial_MPa, "E_axial_MPa", "MPa", modulus, "Axial Young modulus E_A.", "Table 1: 1020").required(),
    key(&Ti::nu_axial, "nu_axial", "-", inside(-1, 1), "Axial Poisson ratio nu_A.", "Table 1: 0.06"),
    key(&Ti::nu_radial, "nu_radial", "-", inside(-1, 1), "Radial Poisson ratio nu_R (3D).", "Table 1: 0.3"),
    key(&Ti::G_MPa, "G_MPa", "MPa", modulus, "Shear modulus between axis and radius.", "paper Eq. 4, docs/physics.md 3")
        .defaults_to("E_A/(2(1+nu_A))"),
    key(&Ti::rho0_ug_mm3, "rho0_ug_mm3", "ug/mm^3", above(0).up_to(1e6, {}), "Equilibrium density.", "Table 1: 1000"),
  }).completed_by(complete_tissue);
}
// clang-format on

}  // namespace rootsoil::sections
