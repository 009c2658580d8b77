// SPDX-License-Identifier: MIT
// Cells measured by microscopy: a table with a row for each, as MorphoGraphX users and scikit-image write them.
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include "root_sph/core/cell_columns.hpp"
#include "root_sph/core/types.hpp"

namespace rootsoil {

/// An ellipsoid.
struct MeasuredCell {
  std::int64_t label = 0;
  int line = 0;  ///< of the file
  Vec<3> position_mm = Vec<3>::Zero();
  Mat<3> axes = Mat<3>::Identity();      ///< a rotation; columns e1, e2, e3 = e1 x e2
  Vec<3> semi_axes_mm = Vec<3>::Ones();  ///< r1 >= r2 >= r3 > 0
  double volume_mm3 = 0.0;               ///< of the ellipsoid, where the file gives no other
};

/// Every row is a cell and every cell is kept. InputError names the file, the line and the column.
std::vector<MeasuredCell> read_cell_file(const std::filesystem::path& path, const CellColumns& columns = {});

/// The same for a text that is already in memory; `name` stands for the file in messages.
std::vector<MeasuredCell> parse_cell_file(std::string_view text, const std::string& name,
                                          const CellColumns& columns = {});

/// Q = R diag(1/r^2) R^T, 1/mm^2: the shape the solver works with.
Mat<3> shape_matrix(const MeasuredCell& cell);

/// Second moments of a body of unit volume about its centre, R diag(r^2/5) R^T, mm^2.
Mat<3> covariance(const MeasuredCell& cell);

/// Gives the cell axes and semi-axes from second moments; those must be positive definite.
void set_covariance(MeasuredCell& cell, const Mat<3>& covariance);

/// Of the ellipsoid, mm^3.
double ellipsoid_volume_mm3(const MeasuredCell& cell);

}  // namespace rootsoil
