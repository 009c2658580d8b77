// SPDX-License-Identifier: MIT
#include "root_sph/io/cell_file.hpp"

#include <fmt/format.h>

#include <cmath>
#include <numbers>

#include "root_sph/core/errors.hpp"
#include "root_sph/io/files.hpp"
#include "tests/io/temporary_folder.hpp"

namespace rootsoil {
namespace {

using test::expect_contains;

const std::string header =
    "Label, pos.X (um), pos.Y (um), pos.Z (um), e1.X, e1.Y, e1.Z, e2.X, e2.Y, e2.Z, r1 (um), r2 (um), r3 (um)\n";
const std::string row = "7, 1000, -20.5, 3e1, 1, 0, 0, 0, 1, 0, 20, 10, 5\n";

std::vector<MeasuredCell> parse(const std::string& text) { return parse_cell_file(text, "cells.csv"); }
std::string refusal(const std::string& text) {
  return test::message_of<InputError>([&] { parse(text); });
}
std::string replaced(std::string text, const std::string& from, const std::string& to) {
  for (std::size_t at = 0; (at = text.find(from, at)) != std::string::npos; at += to.size()) {
    text.replace(at, from.size(), to);
  }
  return text;
}

void expect_the_cell(const std::vector<MeasuredCell>& cells) {
  ASSERT_EQ(cells.size(), 1u);
  EXPECT_EQ(cells[0].label, 7);
  EXPECT_TRUE(cells[0].position_mm.isApprox(Vec<3>(1.0, -0.0205, 0.03), 1e-15));
  EXPECT_TRUE(cells[0].semi_axes_mm.isApprox(Vec<3>(0.02, 0.01, 0.005), 1e-15));
  EXPECT_TRUE(cells[0].axes.isApprox(Mat<3>::Identity(), 1e-15));
}
void expect_the_cell(const std::string& text) {
  SCOPED_TRACE(text);
  expect_the_cell(parse(text));
}

TEST(CellFile, ReadsMicrometresAsMillimetres) { expect_the_cell(header + row); }

TEST(CellFile, TheMicroSignMayArriveInAnyEncoding) {
  // UTF-8 micro, UTF-8 mu, Latin-1, replacement character, UTF-8 read as Latin-1, question mark, control byte
  for (const char* sign :
       {"\xC2\xB5", "\xCE\xBC", "\xB5", "\xEF\xBF\xBD", "\xC3\x82\xC2\xB5", "?", "\x1A", "\xFF\xFE"}) {
    expect_the_cell(replaced(header, "(um)", fmt::format("({}m)", sign)) + row);
  }
}

TEST(CellFile, LayoutDoesNotMatter) {
  expect_the_cell("\xEF\xBB\xBF" + replaced(header + row, "\n", "\r\n"));
  expect_the_cell(replaced(header + row, " ", ""));
  expect_the_cell(replaced(header + row, ",", " ,\t"));
  expect_the_cell("\n" + header + "\n  \n" + row + "\n\n");
  expect_the_cell(header + row.substr(0, row.size() - 1));
  expect_the_cell(replaced(header, "\n", ",\n") + replaced(row, "\n", ",\n"));
  expect_the_cell("\"Label\",\"pos.X (um)\"" + header.substr(header.find(", pos.Y")) + replaced(row, "7,", "\"7\","));
  expect_the_cell(header + replaced(row, "1000", "+1000.0"));
}

TEST(CellFile, ColumnsMayComeInAnyOrderWithOthersBetween) {
  expect_the_cell(
      "type, r3 (um), Label, pos.Z (um), pos.Y (um), pos.X (um), e2.X, e2.Y, e2.Z, e1.X, e1.Y, e1.Z, r1 (um), r2 (um)\n"
      "\"cortex, outer\", 5, 7, 30, -20.5, 1000, 0, 1, 0, 1, 0, 0, 20, 10\n");
}

TEST(CellFile, SemicolonsOrTabsMayStandBetweenValues) {
  for (const char* separator : {";", "\t", " ; "}) expect_the_cell(replaced(header + row, ", ", separator));
}

TEST(CellFile, DecimalsMayHaveACommaButNoSignForThousands) {
  const std::string semicolons = replaced(header + row, ", ", ";");
  expect_the_cell(replaced(replaced(semicolons, "-20.5", "-20,5"), ";20;", ";20,0;"));
  expect_the_cell(header + replaced(row, "-20.5", "\"-20,5\""));
  expect_contains(refusal(replaced(semicolons, "1000", "1,000.0")), "points and commas are mixed");
  expect_contains(refusal(replaced(semicolons, "1000", "1,000")), "column 'pos.Y (um)': points and commas are mixed");
}

TEST(CellFile, TitlesNameTheUnit) {
  expect_the_cell(replaced(header, "(um)", "(mm)") + "7, 1, -0.0205, 0.03, 1, 0, 0, 0, 1, 0, 0.02, 0.01, 0.005\n");
  expect_the_cell(replaced(header, "r1 (um)", "r1 (nm)") + replaced(row, "20, 10, 5", "20000, 10, 5"));
  const std::string bare = replaced(header, " (um)", "");
  const std::string message = refusal(bare + row);
  expect_contains(message, "cells.csv:1: column 'pos.X': the unit of this column is not known");
  expect_contains(message, "[root.columns] with unit = ");
  CellColumns columns;
  columns.unit = LengthUnit::um;
  expect_the_cell(parse_cell_file(bare + row, "cells.csv", columns));
  columns.unit = LengthUnit::mm;
  expect_contains(test::message_of<InputError>([&] { parse_cell_file(header + row, "cells.csv", columns); }),
                  "the title names another unit than root.columns.unit");
}

TEST(CellFile, ColumnsMayHaveOtherNames) {
  CellColumns columns;
  columns.label = "id";
  columns.position = {"x (um)", "y (um)", "z (um)"};
  columns.e1 = {"a", "b", "c"};
  columns.diameters = {"L1 (um)", "L2 (um)", "L3 (um)"};
  columns.volume = "V";
  columns.unit = LengthUnit::um;
  const auto cells = parse_cell_file(
      "id,x (um),y (um),z (um),a,b,c,e2.X,e2.Y,e2.Z,L1 (um),L2 (um),L3 (um),V\n7,1000,-20.5,30,1,0,0,0,1,0,40,20,10,"
      "5000\n",
      "cells.csv", columns);
  expect_the_cell(cells);
  EXPECT_NEAR(cells[0].volume_mm3, 5e-6, 1e-18);
}

TEST(CellFile, RegionpropsTablesHaveInertiaInPlaceOfAxes) {
  // skimage.measure.regionprops_table: the inertia of unit mass, tr(C) 1 - C with C = r^2/5 along the axes
  const double a = 400.0 / 5.0, b = 100.0 / 5.0, c = 25.0 / 5.0;
  const std::string table =
      ",label,area,centroid-0,centroid-1,centroid-2,inertia_tensor-0-0,inertia_tensor-0-1,inertia_tensor-0-2,"
      "inertia_tensor-1-1,inertia_tensor-1-2,inertia_tensor-2-2\n" +
      fmt::format("0,7,4000,1000,-20.5,30,{},0,0,{},0,{}\n", b + c, a + c, a + b);
  CellColumns columns;
  columns.unit = LengthUnit::um;
  const MeasuredCell cell = parse_cell_file(table, "cells.csv", columns).at(0);
  EXPECT_EQ(cell.label, 7);
  EXPECT_TRUE(cell.position_mm.isApprox(Vec<3>(1.0, -0.0205, 0.03), 1e-15));
  EXPECT_TRUE(cell.semi_axes_mm.isApprox(Vec<3>(0.02, 0.01, 0.005), 1e-12));
  EXPECT_NEAR(cell.axes.determinant(), 1.0, 1e-12);
  EXPECT_NEAR(std::abs(cell.axes(0, 0)), 1.0, 1e-12);
  EXPECT_NEAR(cell.volume_mm3, 4e-6, 1e-18);
  EXPECT_TRUE(covariance(cell).isApprox(1e-6 * Vec<3>(a, b, c).asDiagonal().toDenseMatrix(), 1e-12));
  expect_contains(refusal(table), "the unit of this column is not known");
  const std::string flat = replaced(table, fmt::format("{},0,{}", a + c, a + b), "1,0,1");
  expect_contains(test::message_of<InputError>([&] { parse_cell_file(flat, "cells.csv", columns); }),
                  "cells.csv:2: column 'inertia_tensor-0-0': no body has this inertia");
}

TEST(CellFile, VolumesAloneMakeBalls) {
  CellColumns columns;
  columns.position = {"x (um)", "y (um)", "z (um)"};
  columns.volume = "V";
  columns.unit = LengthUnit::um;
  const auto cell =
      parse_cell_file("label,x (um),y (um),z (um),V\n1,0,0,0,4188.790204786391\n", "c.csv", columns).at(0);
  EXPECT_TRUE(cell.semi_axes_mm.isApprox(Vec<3>::Constant(0.01), 1e-12));
}

TEST(CellFile, EveryCellIsKept) {
  std::string text = header;
  for (int i = 0; i < 3000; ++i) text += std::to_string(i).append(row.substr(1));
  const std::vector<MeasuredCell> cells = parse(text);
  ASSERT_EQ(cells.size(), 3000u);
  for (int i = 0; i < 3000; ++i) EXPECT_EQ(cells[static_cast<std::size_t>(i)].label, i);
}

TEST(CellFile, NearlyOrthonormalAxesBecomeARotation) {
  const MeasuredCell cell = parse(header + "1, 0, 0, 0, 0.995, 0.003, 0.001, -0.004, 0, 1.006, 20, 10, 5\n").at(0);
  EXPECT_TRUE((cell.axes.transpose() * cell.axes).isApprox(Mat<3>::Identity(), 1e-14));
  EXPECT_NEAR(cell.axes.determinant(), 1.0, 1e-14);
  EXPECT_TRUE(cell.axes.col(0).isApprox(Vec<3>(0.995, 0.003, 0.001).normalized(), 1e-14));
  EXPECT_TRUE(cell.axes.col(2).isApprox(Vec<3>(0, -1, 0), 2e-2));
}

TEST(CellFile, ShapeMatrixIsTheEllipsoid) {
  const MeasuredCell cell = parse(header + "1, 0, 0, 0, 0.6, 0.8, 0, 0, 0, 1, 20, 10, 5\n").at(0);
  const Mat<3> q = shape_matrix(cell);
  EXPECT_TRUE(q.isApprox(q.transpose(), 1e-15));
  for (int i = 0; i < 3; ++i) {
    const Vec<3> end = cell.semi_axes_mm[i] * cell.axes.col(i);
    EXPECT_NEAR(end.dot(q * end), 1.0, 1e-13);
  }
  EXPECT_NEAR(ellipsoid_volume_mm3(cell), 4.0 / 3.0 * std::numbers::pi * 1e-6, 1e-18);
}

TEST(CellFile, AMissingFileIsNamed) {
  const std::string message = test::message_of<InputError>([] { read_cell_file("no/cells.csv"); });
  expect_contains(message, "no/cells.csv");
  expect_contains(message, "there is no such file");
}

TEST(CellFile, IsReadFromTheDisk) {
  const test::TemporaryFolder folder;
  write_text_atomically(folder / "cells.csv", header + row);
  EXPECT_EQ(read_cell_file(folder / "cells.csv").size(), 1u);
}

TEST(CellFile, EmptyFilesAndFilesWithoutCellsAreRefused) {
  for (const char* nothing : {"", "\n \r\n", "\xEF\xBB\xBF"}) expect_contains(refusal(nothing), "the file is empty");
  expect_contains(refusal(header), "cells.csv: the file holds no cells");
}

TEST(CellFile, AllMissingColumnsAreListed) {
  const std::string message = refusal(replaced(replaced(header, "e1.Y", "f1.Y"), "r3 (um)", "r3 (m)") + row);
  expect_contains(message, "cells.csv:1: columns are missing: e1.Y, r3 (um)\n");
  expect_contains(message, "[root.columns]");
  expect_contains(refusal("a b c\n1 2 3\n"), "Label, pos.X (um)");
  expect_contains(refusal("\xB5\x1B[31m\n"), "given:   ??[31m\n");
  expect_contains(refusal(replaced(header, "e1.Y", "e1.X") + row), "column 'e1.X': the column is there twice");
}

struct BadRow {
  std::string from, to;
  std::vector<std::string> said;
};

TEST(CellFile, WhatIsWrongInARowIsSaidWithItsLineAndColumn) {
  const std::vector<BadRow> bad_rows = {
      {"1000", "1o00", {"column 'pos.X (um)'", "not a number", "1o00"}},
      {"1000", "", {"column 'pos.X (um)'", "the value is missing"}},
      {"1000", "nan", {"column 'pos.X (um)'", "not a finite number", "nan"}},
      {"1000", "-inf", {"column 'pos.X (um)'", "not a finite number"}},
      {"1000", "1e999", {"column 'pos.X (um)'", "not a finite number"}},
      {"1000", "1e9", {"column 'pos.X (um)'", "out of range", "micrometres"}},
      {"8,", "8.5,", {"column 'Label'", "not a whole number", "8.5"}},
      {"8,", "1e300,", {"column 'Label'", "not a whole number"}},
      {"8,", "7,", {"column 'Label'", "two cells have the same label", "7, also in line 2"}},
      {"1, 0, 0, 0, 1, 0", "0, 0, 0, 0, 1, 0", {"column 'e1.X'", "the axis is zero"}},
      {"1, 0, 0, 0, 1, 0", "1, 0, 0, 0, 0, 0", {"column 'e2.X'", "the axis is zero"}},
      {"1, 0, 0, 0, 1, 0", "1e200, 1e200, 0, 0, 1, 0", {"column 'e1.X'", "not a unit vector"}},
      {"1, 0, 0, 0, 1, 0", "1, 0, 0, 0.1, 0.995, 0", {"column 'e2.X'", "not orthogonal", "e1.e2 = 0.0999"}},
      {"20, 10, 5", "20, 10, 0", {"column 'r3 (um)'", "must be positive"}},
      {"20, 10, 5", "20, -10, 5", {"column 'r2 (um)'", "must be positive", "-10"}},
      {"20, 10, 5", "20, 10, 1e-9", {"column 'r3 (um)'", "out of range"}},
      {"20, 10, 5", "20, 5, 10", {"column 'r3 (um)'", "not in descending order", "r1 = 20, r2 = 5, r3 = 10"}},
      {"20, 10, 5", "20, 10", {"column 'r3 (um)'", "the value is missing", "a row of 12 values"}},
      {"20, 10, 5", "20, 10, 5, 4", {"more values than the header has columns", "14 values"}},
  };
  for (const BadRow& bad : bad_rows) {
    const std::string changed = replaced(replaced(row, "7,", "8,"), bad.from, bad.to);
    const std::string message = refusal(header + row + changed);
    expect_contains(message, "cells.csv:3: ");
    for (const std::string& part : bad.said) expect_contains(message, part);
    expect_contains(message, "to do:");
  }
}

TEST(CellFile, KnowsTheLineOfEveryCell) {
  const std::vector<MeasuredCell> cells = parse(header + row + "\n" + replaced(row, "7, 1000", "8, 1020"));
  ASSERT_EQ(cells.size(), 2u);
  EXPECT_EQ(cells[0].line, 2);
  EXPECT_EQ(cells[1].line, 4);
}

TEST(CellFile, CellsOutOfProportionAreRefused) {
  const std::string others = replaced(row, "7,", "1,") + replaced(row, "7,", "2,");
  const auto with = [&](const std::string& semi_axes) {
    return header + others + replaced(row, "20, 10, 5", semi_axes);
  };
  EXPECT_NO_THROW(parse(with("0.2, 0.2, 0.1")));
  for (const char* part :
       {"cells.csv:4", "cell 7 is out of proportion", "3.22e-05 mm large", "median cell 0.0161 mm"}) {
    expect_contains(refusal(with("0.02, 0.02, 0.02")), part);
  }
  expect_contains(refusal(with("2000, 2000, 2000")), "cell 7 is out of proportion");
  for (const char* part : {"cells.csv:4", "r3 (um)", "r1 = 200, r3 = 1", "at most 100 times r3"}) {
    expect_contains(refusal(with("200, 100, 1")), part);
  }
}

}  // namespace
}  // namespace rootsoil
