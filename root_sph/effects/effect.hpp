// SPDX-License-Identifier: MIT
// What an effect is while a scene runs: an object that declares columns, adds passes to the solver's hooks and perhaps
// something to the output. One that is not called for is never constructed.
#pragma once

#include <algorithm>
#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "root_sph/dynamics/solver.hpp"
#include "root_sph/io/frame.hpp"

namespace rootsoil {

using NamedReals = std::map<std::string, std::vector<double>>;

/// A file beside history.csv, a row an output time.
struct SideTable {
  std::string file_name;
  std::vector<std::string> columns;  ///< without the time, which comes first
};

/// A measure of a run's accuracy beside the limit that the scene states for it.
struct AccuracyMeasure {
  std::string name;  ///< of its column of history.csv
  double value = 0.0, limit = 0.0;
  std::string remedy;  ///< what to do where the value is beyond the limit
};

template <int Dim>
class Effect {
 public:
  virtual ~Effect() = default;
  /// When every effect of the scene exists.
  virtual void prepare() {}

  // ---- state
  /// Beyond columns, for a checkpoint.
  virtual void save(NamedReals&) const {}
  virtual void restore(const NamedReals&) {}
  /// Beginning of the name of a file that keeps state of another process beside the checkpoint; empty: there is none.
  /// The run writes it before the checkpoint that goes with it.
  virtual std::string state_file_name() const { return {}; }
  virtual void save_state_file(const std::filesystem::path&) {}
  virtual void restore_state_file(const std::filesystem::path&) {}

  // ---- what acts on the root from outside
  /// Of rigid bodies or soil, N.
  virtual Vec<Dim> contact_force_N() const { return Vec<Dim>::Zero(); }
  /// Of everything outside the root, N: what the forces of all cells sum up to.
  virtual Vec<Dim> external_force_N() const { return contact_force_N(); }
  /// Of bodies outside on the root within a distance of its tip, N.
  virtual Vec<Dim> tip_force_N(double /*within_mm*/) const { return Vec<Dim>::Zero(); }
  /// On each cell, where cells at rest feel it too, N; nullptr: they don't.
  virtual const Field<Dim, Vec<Dim>>* lasting_force() const { return nullptr; }
  /// Marks cells that must not fall asleep now, at a window's end.
  virtual void keep_awake(std::vector<char>&) const {}

  // ---- output
  /// Columns for the frames of run.h5.
  virtual void add_columns(const Tissue<Dim>&, std::vector<FrameColumn>&) const {}
  /// Tables beside the cells, for the frames.
  virtual void add_tables(std::vector<FrameTable>&) const {}
  /// Columns for history.csv: the same names, in the same order, at any time.
  virtual std::vector<std::pair<std::string, double>> history() const { return {}; }
  virtual std::optional<SideTable> side_table() const { return std::nullopt; }
  virtual std::vector<double> side_row() const { return {}; }
  /// Asked for at every output time; a value that is not a number is not known yet.
  virtual std::vector<AccuracyMeasure> accuracy() const { return {}; }
  /// What the user should know now, once; asked for after every window.
  virtual std::vector<std::string> take_notes() { return {}; }
  /// What the user should know when the run has ended; empty: nothing.
  virtual std::string closing_remark() const { return {}; }
};

/// The column of a frame with this name, nullptr where there is none.
inline FrameColumn* find_column(std::vector<FrameColumn>& columns, const std::string& name) {
  const auto found = std::find_if(columns.begin(), columns.end(), [&](const auto& c) { return c.name == name; });
  return found == columns.end() ? nullptr : &*found;
}

/// Adds to the frames' column "contact_force" (3 components, N), which all kinds of contact share.
template <int Dim>
void add_contact_force(const std::vector<std::size_t>& cells, const Field<Dim, Vec<Dim>>& force_N,
                       std::vector<FrameColumn>& columns) {
  FrameColumn* column = find_column(columns, "contact_force");
  if (!column) {
    columns.push_back({"contact_force", "N", "force of obstacles and soil on the cell", 3,
                       std::vector<double>(3 * force_N.values().size(), 0.0)});
    column = &columns.back();
  }
  auto& values = std::get<std::vector<double>>(column->values);
  for (const std::size_t i : cells) {
    for (int a = 0; a < Dim; ++a) values[3 * i + static_cast<std::size_t>(a)] += force_N[i][a];
  }
}

}  // namespace rootsoil
