// SPDX-License-Identifier: MIT
// A soil's grains from a file: each is checked where it is read, and the message names its line.
#include "root_sph/effects/soil_contact/listed_grains.hpp"

#include <gtest/gtest.h>

#include <filesystem>
#include <string>
#include <vector>

#include "root_sph/core/errors.hpp"
#include "root_sph/io/files.hpp"
#include "tests/io/temporary_folder.hpp"

namespace rootsoil {
namespace {

using test::expect_contains;

const std::string header = "x_mm,y_mm,z_mm,radius_mm\n";

class ListedGrains : public testing::Test {
 protected:
  ListedGrains() {
    soil_.box_from_mm = {-1, -1, -1};
    soil_.box_to_mm = {1, 1, 1};
    soil_.d_min_mm = 0.2;
    soil_.d_max_mm = 0.4;
    soil_.grains_file = (folder_ / "grains.csv").string();
  }
  std::vector<SoilGrain> read(const std::string& text) {
    write_text_atomically(soil_.grains_file, text);
    return read_listed_grains(soil_);
  }
  std::string refusal(const std::string& text) {
    return test::message_of<InputError>([&] { read(text); });
  }
  test::TemporaryFolder folder_;
  SoilRecipe soil_;
};

TEST_F(ListedGrains, LayoutDoesNotMatter) {
  const std::string two = "0.5,-0.5,0,0.15\n-0.5,0.25,0,0.1\n";
  for (const std::string& text :
       {header + two, "\xEF\xBB\xBF" + header + two,
        std::string("x_mm,y_mm,z_mm,radius_mm\r\n0.5,-0.5,0,0.15\r\n\r\n-0.5,0.25,0,0.1"),
        std::string("kind, radius_mm, z_mm, y_mm, x_mm\nsand, 0.15, 0, -0.5, 0.5\nsand, 0.1, 0.0, 0.25, -0.5\n")}) {
    const std::vector<SoilGrain> grains = read(text);
    ASSERT_EQ(grains.size(), 2u) << text;
    EXPECT_EQ(grains[0].centre_mm, (Vec3{0.5, -0.5, 0}));
    EXPECT_EQ(grains[0].radius_mm, 0.15);
    EXPECT_EQ(grains[1].centre_mm, (Vec3{-0.5, 0.25, 0}));
  }
}

TEST_F(ListedGrains, GrainsOfAPackedSampleAreAccepted) {
  // into the wall and into each other by half a radius, and 5 % larger or smaller than asked for
  EXPECT_EQ(read(header + "0.9,0,0,0.2\n0.6,0,0,0.2\n0,0,0,0.21\n0,0.5,0,0.095\n").size(), 4u);
}

TEST_F(ListedGrains, WhatIsWrongInARowIsSaidWithItsLine) {
  const std::vector<std::pair<std::string, std::vector<std::string>>> bad_rows = {
      {"0.5,0,0", {"column 'radius_mm'", "the value is missing"}},
      {"0.5,0,0,0.15,7", {"more values than the header has columns"}},
      {"0,5,0,0,0.15", {"more values than the header has columns", "decimal point"}},
      {"0.5,nan,0,0.15", {"column 'y_mm'", "not a finite number"}},
      {"0.5,0,0,inf", {"column 'radius_mm'", "not a finite number"}},
      {"0.5,zero,0,0.15", {"column 'y_mm'", "not a number"}},
      {"0.5,0,0,0", {"column 'radius_mm'", "a radius must be positive"}},
      {"0.5,0,0,-0.15", {"column 'radius_mm'", "a radius must be positive"}},
      {"0.5,0,0,0.3", {"column 'radius_mm'", "not of the size that the scene says", "0.09 to 0.22"}},
      {"0.5,0,0,150", {"column 'radius_mm'", "in millimetres"}},
      {"0.5,0,0.5,0.15", {"column 'z_mm'", "all grains lie in the plane z = 0"}},
      {"0.95,0,0,0.15", {"column 'x_mm'", "not inside the soil's box", "-0.925 to 0.925"}},
      {"0.5,-2,0,0.15", {"column 'y_mm'", "not inside the soil's box"}},
      {"1e300,0,0,0.15", {"column 'x_mm'", "not inside the soil's box"}},
      {"-0.5,0,0,0.15", {"two grains lie in the same place", "the grain of line 2"}},
      {"-0.29,0,0,0.15", {"two grains overlap too far", "60 % of the smaller radius into the grain of line 2"}},
  };
  for (const auto& [row, words] : bad_rows) {
    SCOPED_TRACE(row);
    const std::string message = refusal(header + "-0.5,0,0,0.15\n" + row + "\n");
    expect_contains(message, "grains.csv:3: ");
    expect_contains(message, "to do:");
    for (const std::string& part : words) expect_contains(message, part);
  }
}

TEST_F(ListedGrains, InSpaceTheThirdDimensionCounts) {
  soil_.dimension = 3;
  EXPECT_EQ(read(header + "0,0,-0.5,0.15\n0,0,0,0.15\n0,0,0.25,0.15\n").size(), 3u);
  expect_contains(refusal(header + "0,0,-0.5,0.15\n0,0,-0.6,0.15\n"), "two grains overlap too far");
  expect_contains(refusal(header + "0,0,0.99,0.15\n"), "column 'z_mm': the grain is not inside the soil's box");
}

TEST_F(ListedGrains, AFileWithoutHeaderOrGrainsIsRefused) {
  expect_contains(refusal(""), "the file is empty");
  expect_contains(refusal(header), "the file holds no grains");
  expect_contains(refusal("x,y,z,r\n0,0,0,0.15\n"), "grains.csv:1: columns are missing: x_mm, y_mm, z_mm, radius_mm");
  expect_contains(refusal("X_MM,y_mm,z_mm,radius_mm\n0,0,0,0.15\n"), "columns are missing: x_mm\n");
  expect_contains(refusal("0,0,0,0.15\n"), "columns are missing");
  expect_contains(refusal("x_mm y_mm z_mm radius_mm\n0 0 0 0.15\n"), "separated by commas");
  soil_.grains_file = (folder_ / "none.csv").string();
  expect_contains(test::message_of<InputError>([&] { read_listed_grains(soil_); }), "there is no such file");
}

}  // namespace
}  // namespace rootsoil
