// SPDX-License-Identifier: MIT
// From measured cells to a root: specks become part of their neighbours, the axis and the tip are found, the root is
// turned onto +x, and its hull tells how much of the tissue the ellipsoids fill.
#pragma once

#include <span>
#include <string>
#include <vector>

#include "root_sph/io/cell_file.hpp"
#include "root_sph/scene/scene.hpp"

namespace rootsoil {

/// A speck that has become a part of another cell.
struct Merged {
  std::int64_t label = 0;
  int line = 0;
  std::int64_t into = 0;
};

/// What was found in a cell file.
struct MeasuredRootReport {
  std::size_t cells_in_file = 0;
  std::vector<Merged> merged;
  Vec<3> tip_direction = Vec<3>::UnitX();                       ///< of the root's axis, in the file
  std::string tip_axis;                                         ///< asked for or found: "+x"
  std::string tip_found;                                        ///< how
  double lean_deg = 0.0;                                        ///< by which the root was turned onto it
  Vec<3> extent_mm = Vec<3>::Zero();                            ///< along the root and across
  double smallest_mm = 0.0, median_mm = 0.0, largest_mm = 0.0;  ///< sizes of cells, volume^(1/3)
  double most_slender = 1.0;                                    ///< r1/r3
  double cells_mm3 = 0.0, hull_mm3 = 0.0;                       ///< all cells together; the tissue
};

struct MeasuredRoot {
  std::vector<MeasuredCell> cells;  ///< the axis is x, the tip at the largest x
  MeasuredRootReport report;
};

/// Reads scene.root.cells_file. InputError where the cells are not one root.
MeasuredRoot read_measured_root(const Scene& scene);

/// What a user wants to know of it, a sentence a line.
std::vector<std::string> describe(const MeasuredRootReport& report);

// ---- the parts --------------------------------------------------------------------------------------

/// Distance of two cells' centres over the distance at which they would touch.
double touch(const Vec<3>& offset, const Mat<3>& shape_a, const Mat<3>& shape_b);

/// Volume, centroid and second moments of the two together.
MeasuredCell merged(const MeasuredCell& a, const MeasuredCell& b);

/// Cells far smaller than most that they touch become a part of the one they touch most.
std::vector<Merged> merge_specks(std::vector<MeasuredCell>& cells);

/// Unit vector along the root, towards one of its ends; zero where it is hardly longer than wide.
Vec<3> principal_axis(std::span<const MeasuredCell> cells);

/// Turns the root onto +x, which tip_axis or else the cells tell from the other end.
void turn_to_x(std::vector<MeasuredCell>& cells, TipAxis asked, const std::string& file, MeasuredRootReport& report);

/// Of the body that a skin around the cells encloses. Convex hulls of pieces as long as they are wide, so that a bent
/// root is not larger than a straight one.
double hull_volume_mm3(std::span<const MeasuredCell> cells);

}  // namespace rootsoil
