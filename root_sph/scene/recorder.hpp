// SPDX-License-Identifier: MIT
// What a run tells: frames of cells, rows of history.
#pragma once

#include "root_sph/io/frame.hpp"
#include "root_sph/scene/effect_table.hpp"

#include <string>
#include <vector>

namespace rootsoil {

/// All columns of the cells at this time; a non-empty `wanted` keeps those (and position and cell_id).
template <int Dim>
Frame make_frame(const Model<Dim>& model, const std::vector<std::string>& wanted);

/// InputError when output.fields names a column that does not exist in this scene.
template <int Dim>
void refuse_unknown_fields(const Model<Dim>& model, const Scene& scene);

/// What every run has, then what its effects add.
template <int Dim>
std::vector<std::string> history_columns(const Model<Dim>& model);

/// A row of history.csv, in the order of history_columns(), and what else the summary wants.
struct HistoryRow {
  std::vector<double> values;
  double length_mm = 0.0;
  double inertia_error = 0.0;
  double momentum_residual = 0.0;
};

/// What the tip speed of a row is measured against.
struct LengthMark {
  double time_h = 0.0, length_mm = 0.0;
};

template <int Dim>
HistoryRow make_history_row(const Model<Dim>& model, const LengthMark& before, std::int64_t divisions);

}  // namespace rootsoil
