// SPDX-License-Identifier: MIT
// What an effect is: an object that, when its section is in the scene, declares columns, adds passes to the solver's
// hooks and perhaps columns to the output. One that is not called for is never constructed.
#pragma once

#include "root_sph/dynamics/solver.hpp"
#include "root_sph/io/frame.hpp"

#include <algorithm>
#include <filesystem>
#include <map>
#include <string>
#include <utility>
#include <vector>

namespace rootsoil {

using NamedReals = std::map<std::string, std::vector<double>>;

template <int Dim>
class Effect {
 public:
  virtual ~Effect() = default;
  /// State beyond columns, for a checkpoint.
  virtual void save(NamedReals&) const {}
  virtual void restore(const NamedReals&) {}
  /// Columns for the frames of run.h5.
  virtual void add_columns(const Tissue<Dim>&, std::vector<FrameColumn>&) const {}
  /// Points beside the cells, for the frames.
  virtual void add_points(std::vector<PointSet>&) const {}
  /// Columns for history.csv: the same names, in the same order, at any time.
  virtual std::vector<std::pair<std::string, double>> history() const { return {}; }
  /// What the user should know now, once; asked for after every window.
  virtual std::vector<std::string> take_notes() { return {}; }
  /// What the user should know when the run has ended; empty: nothing.
  virtual std::string closing_remark() const { return {}; }

  /// State that another process keeps in a file of its own beside the checkpoint. The run writes it before the
  /// checkpoint that goes with it.
  virtual bool has_own_file() const { return false; }
  virtual void save_own_file(const std::filesystem::path&) {}
  virtual void restore_own_file(const std::filesystem::path&) {}

  /// Called at every output time, before the frame is written.
  virtual void record(const Tissue<Dim>&) {}
  /// Force of rigid bodies or soil on the root, N.
  virtual Vec<Dim> contact_force_N() const { return Vec<Dim>::Zero(); }
};

/// Adds to the frames' column "contact_force" (3 components, N), which all kinds of contact share.
template <int Dim>
void add_contact_force(const std::vector<std::size_t>& cells, const Field<Dim, Vec<Dim>>& force_N,
                       std::vector<FrameColumn>& columns) {
  auto column = std::find_if(columns.begin(), columns.end(), [](const auto& c) { return c.name == "contact_force"; });
  if (column == columns.end()) {
    columns.push_back({"contact_force", "N", "force of obstacles and soil on the cell", 3,
                       std::vector<double>(3 * force_N.values().size(), 0.0)});
    column = columns.end() - 1;
  }
  auto& values = std::get<std::vector<double>>(column->values);
  for (const std::size_t i : cells) {
    for (int a = 0; a < Dim; ++a) values[3 * i + static_cast<std::size_t>(a)] += force_N[i][a];
  }
}

}  // namespace rootsoil
