// SPDX-License-Identifier: MIT
// What a run tells: frames of cells, rows of history.
#pragma once

#include <string>
#include <vector>

#include "root_sph/io/frame.hpp"
#include "root_sph/model/model.hpp"

namespace rootsoil {

/// All columns of the cells at this time, or those of output.fields (and position and cell_id), what effects add, and
/// the closed form.
template <int Dim>
Frame make_frame(const Model<Dim>& model, const Scene& scene);

/// InputError when output.fields names a column that does not exist in this scene.
template <int Dim>
void refuse_unknown_fields(const Model<Dim>& model, const Scene& scene);

/// What every run has, then what its effects add.
/// \param error_name of the column for what the stepping in time leaves unbalanced
template <int Dim>
std::vector<std::string> history_columns(const Model<Dim>& model, const std::string& error_name);

/// A row of history.csv, in the order of history_columns(), and what else the summary wants.
struct HistoryRow {
  std::vector<double> values;
  double length_mm = 0.0;
  double momentum_residual = 0.0;
};

/// What the tip speed of a row is measured against.
struct LengthMark {
  double time_h = 0.0, length_mm = 0.0;
};

/// \param error of the stepping in time since the row before (Unbalanced)
template <int Dim>
HistoryRow make_history_row(const Model<Dim>& model, const LengthMark& before, std::int64_t divisions, double error);

}  // namespace rootsoil
