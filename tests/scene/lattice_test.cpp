// SPDX-License-Identifier: MIT
// The root that is asked for is the root that results, whatever the size of its cells.
#include "root_sph/model/lattice.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "root_sph/model/initial_cells.hpp"
#include "tests/scene/scene_text.hpp"

namespace rootsoil {
namespace {

using testing::parse;

RootSection capsule(double length_mm, double radius_mm, double cell_size_mm) {
  RootSection root;
  root.length_mm = length_mm;
  root.radius_mm = radius_mm;
  root.cell_size_mm = cell_size_mm;
  return root;
}

TEST(Lattice, ThatFitsIsNotStretched) {
  for (const auto& root : {capsule(2.0, 0.1, 0.01), capsule(1.0, 0.063, 0.007), capsule(8.0, 0.48, 0.08)}) {
    const Lattice lattice = fit_lattice(root, 2);
    EXPECT_EQ(lattice.stretch_along, 1.0);
    EXPECT_EQ(lattice.stretch_across, 1.0);
    EXPECT_EQ(lattice.mean_stretch, 1.0);
    EXPECT_EQ(lattice.along_mm, root.cell_size_mm);
    EXPECT_EQ(lattice.across_mm, root.cell_size_mm);
    EXPECT_EQ(lattice.outer_mm, root.radius_mm);
  }
  // 8 across in 3D: the section of 52 cells is 3.4 % too large, and stays
  const Lattice space = fit_lattice(capsule(0.6, 0.04, 0.01), 3);
  EXPECT_EQ(space.stretch_across, 1.0);
  EXPECT_NEAR(space.width_mm, 0.01 * std::sqrt(4.0 * 52 / std::numbers::pi), 1e-12);
}

TEST(Lattice, ThatDoesNotFitIsStretchedToTheAskedSize) {
  const Lattice lattice = fit_lattice(capsule(1.05, 0.1, 0.08), 2);
  EXPECT_EQ(lattice.layers, 13);
  EXPECT_EQ(lattice.across, 3);
  EXPECT_NEAR(lattice.along_mm, 1.05 / 13, 1e-15);
  EXPECT_NEAR(lattice.across_mm, 0.2 / 3, 1e-15);
  EXPECT_NEAR(lattice.outer_mm, 0.1, 1e-15);
}

/// Volume and section of the cells that can move, relative to what was asked.
template <int Dim>
std::array<double, 2> relative_size(const std::vector<std::string>& root) {
  std::vector<std::string> overrides{"scene.dimension=" + std::to_string(Dim)};
  overrides.insert(overrides.end(), root.begin(), root.end());
  const Scene scene = parse(testing::minimal, overrides);
  Tissue<Dim> tissue;
  const InitialReport report = make_initial_cells<Dim>(scene, tissue, 1.5);
  double layer = 0.0;  // volume of the layer at the base
  const double along = report.lattice->along_mm;
  for (std::size_t i = 0; i < tissue.cells.size(); ++i) {
    const double x = tissue.cells.position[i][0];
    if (x > 0.0 && x < along) layer += tissue.cells.volume[i];
  }
  const double r = scene.root.radius_mm;
  const double section = Dim == 2 ? 2.0 * r : std::numbers::pi * r * r;
  return {report.volume / asked_volume(scene.root, Dim), layer / along / section};
}

TEST(Lattice, FillsTheAskedVolume2D) {
  // from 1.05 to 12 cells across, 13.5 to 40 along
  for (const double size : {0.095, 0.08, 0.066, 0.047, 0.03, 0.0217, 0.0087}) {
    const std::vector<std::string> root{"root.radius_mm=0.05", "root.length_mm=1.29",
                                        "root.cell_size_mm=" + std::to_string(size)};
    const auto [volume, section] = relative_size<2>(root);
    EXPECT_NEAR(section, 1.0, 1e-9) << size;
    EXPECT_NEAR(volume, 1.0, 0.016) << size;  // measured 0.0084, in the round tip
    auto cut = root;
    cut.push_back("root.cap=false");
    EXPECT_NEAR(relative_size<2>(cut)[0], 1.0, 3e-3) << size;  // measured 1.9e-3, a length that is left alone
  }
}

TEST(Lattice, FillsTheAskedVolume3D) {
  for (const double size : {0.095, 0.066, 0.05, 0.034, 0.026, 0.0217, 0.0175}) {
    const std::vector<std::string> root{"root.radius_mm=0.05", "root.length_mm=1.29",
                                        "root.cell_size_mm=" + std::to_string(size)};
    const auto [volume, section] = relative_size<3>(root);
    EXPECT_NEAR(section, 1.0, 0.04) << size;  // twice the misfit of a diameter that is left alone
    EXPECT_NEAR(volume, 1.0, 0.04) << size;   // measured 0.032
  }
}

TEST(Lattice, CellsHaveTheShapeOfTheirPlaces) {
  const Scene scene = parse(testing::minimal, {"root.radius_mm=0.1", "root.length_mm=1.05", "root.cell_size_mm=0.08",
                                               "root.curvature_per_mm=0.5"});
  Tissue<2> tissue;
  const InitialReport report = make_initial_cells<2>(scene, tissue, 1.5);
  for (std::size_t i = 0; i < tissue.cells.size(); ++i) {
    const Mat<2> q = tissue.cells.frame[i].transpose() * tissue.cells.shape[i] * tissue.cells.frame[i];
    EXPECT_NEAR(2.0 / std::sqrt(q(0, 0)), 1.05 / 13, 1e-12);
    EXPECT_NEAR(2.0 / std::sqrt(q(1, 1)), 0.2 / 3, 1e-12);
    EXPECT_NEAR(q(0, 1), 0.0, 1e-9 * q(0, 0));
    EXPECT_NEAR(tissue.cells.volume[i], 1.05 / 13 * 0.2 / 3, 1e-12);
  }
  EXPECT_NEAR(report.cell_size_mm, std::sqrt(1.05 / 13 * 0.2 / 3), 1e-12);
}

TEST(Lattice, SaysWhatResultsWhereItIsNotWhatWasAsked) {
  const auto differs = [](const RootSection& root, int dimension) {
    const double volume = asked_volume(root, dimension);
    return differs_from_asked(fit_lattice(root, dimension), root, volume, dimension);
  };
  EXPECT_FALSE(differs(capsule(2.0, 0.1, 0.01), 2));
  EXPECT_TRUE(differs(capsule(1.05, 0.1, 0.08), 2));
  EXPECT_TRUE(differs(capsule(0.6, 0.04, 0.01), 3));  // the section
  const RootSection root = capsule(1.05, 0.1, 0.08);
  const std::string text = describe_lattice(fit_lattice(root, 2), root, 0.2, 2);
  for (const char* part : {"13 layers of cells, 3 across", "0.08077 mm long and 0.06667 mm wide (asked 0.08)",
                           "1.05 mm long (asked 1.05)", "0.2 mm wide (asked 0.2)"}) {
    EXPECT_NE(text.find(part), std::string::npos) << text;
  }
}

}  // namespace
}  // namespace rootsoil
