// SPDX-License-Identifier: MIT
#include "root_sph/app/recorder.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <set>

#include "root_sph/app/closed_form.hpp"
#include "root_sph/dynamics/cell_axes.hpp"

namespace rootsoil {
namespace {

/// Collects a column of reals, three or six numbers a cell where `per_cell` returns a vector or a matrix.
template <int Dim>
class ColumnMaker {
 public:
  ColumnMaker(const Tissue<Dim>& tissue, std::vector<FrameColumn>& columns) : tissue_(tissue), columns_(columns) {}

  template <class PerCell>
  void scalar(const char* name, const char* unit, const char* meaning, PerCell&& per_cell) {
    std::vector<double> values(tissue_.cells.total());
    for (std::size_t i = 0; i < values.size(); ++i) values[i] = per_cell(i);
    columns_.push_back({name, unit, meaning, 1, std::move(values)});
  }
  void integers(const char* name, const char* meaning, std::vector<std::int64_t> values) {
    columns_.push_back({name, "1", meaning, 1, std::move(values)});
  }
  template <class PerCell>
  void vector(const char* name, const char* unit, const char* meaning, PerCell&& per_cell) {
    std::vector<double> values(3 * tissue_.cells.total(), 0.0);
    for (std::size_t i = 0; i < tissue_.cells.total(); ++i) {
      const Vec<Dim> v = per_cell(i);
      std::copy(v.data(), v.data() + Dim, values.begin() + static_cast<std::ptrdiff_t>(3 * i));
    }
    columns_.push_back({name, unit, meaning, 3, std::move(values)});
  }
  /// xx yy zz xy yz xz
  template <class PerCell>
  void tensor(const char* name, const char* unit, const char* meaning, PerCell&& per_cell) {
    std::vector<double> values(6 * tissue_.cells.total(), 0.0);
    for (std::size_t i = 0; i < tissue_.cells.total(); ++i) {
      const Mat<Dim> m = per_cell(i);
      double* out = values.data() + 6 * i;
      for (int a = 0; a < Dim; ++a) out[a] = m(a, a);
      out[3] = m(0, 1);
      if constexpr (Dim == 3) {
        out[4] = m(1, 2);
        out[5] = m(0, 2);
      }
    }
    columns_.push_back({name, unit, meaning, 6, std::move(values)});
  }

 private:
  const Tissue<Dim>& tissue_;
  std::vector<FrameColumn>& columns_;
};

void keep_wanted(std::vector<FrameColumn>& columns, const std::vector<std::string>& wanted) {
  if (wanted.empty()) return;
  std::erase_if(columns, [&](const FrameColumn& c) {
    return c.name != "position" && c.name != "cell_id" &&
           std::find(wanted.begin(), wanted.end(), c.name) == wanted.end();
  });
}

/// Of cells: what every run has, then what its effects add.
template <int Dim>
std::vector<FrameColumn> cell_columns(const Model<Dim>& model) {
  const Tissue<Dim>& tissue = model.solver.tissue();
  const auto& cells = tissue.cells;
  std::vector<FrameColumn> columns;
  ColumnMaker<Dim> make(tissue, columns);
  make.vector("position", "mm", "centre of the cell", [&](std::size_t i) { return cells.position[i]; });
  make.vector("velocity", "mm/h", "velocity of the centre", [&](std::size_t i) { return cells.velocity[i]; });
  make.scalar("volume", Dim == 2 ? "mm^2" : "mm^3", "volume of the cell (2D: area)",
              [&](std::size_t i) { return cells.volume[i]; });
  make.scalar("density", "ug/mm^3", "biological mass per volume",
              [&](std::size_t i) { return cells.mass[i] / cells.volume[i]; });
  make.tensor("stress", "MPa", "stress of the tissue, tension positive, without the pressure differential",
              [&](std::size_t i) -> Mat<Dim> {
                return cells.frame[i] * to_matrix<Dim>(cells.stress[i]) * cells.frame[i].transpose();
              });
  make.scalar("pressure", "MPa", "isostatic part of the stress, compression positive",
              [&](std::size_t i) { return -cells.stress[i].template head<Dim>().mean(); });
  make.scalar("axial_strain_rate", "1/h", "along the root axis, mean over the latest window",
              [&](std::size_t i) { return model.solver.axial_strain_rate_per_h(i); });
  make.scalar("distance_to_tip", "mm", "from the tip along the root",
              [&](std::size_t i) { return cells.distance_to_tip[i]; });
  make.vector("axis", "1", "unit vector along the root, towards the tip",
              [&](std::size_t i) -> Vec<Dim> { return cells.frame[i].col(0); });
  make.vector("cell_axes", "mm", "lengths of the cell's axes, longest first",
              [&](std::size_t i) { return axis_lengths_mm<Dim>(cells.shape[i]); });
  make.tensor("shape", "1/mm^2", "shape matrix Q, eigenvalues 4/length^2",
              [&](std::size_t i) { return cells.shape[i]; });
  make.integers("generation", "divisions since the start", cells.generation.values());
  make.integers("cell_id", "unique number of the cell", cells.cell_id.values());
  make.integers("parent_id", "cell_id of the mother, -1 at the start", cells.parent_id.values());
  make.integers("clamped", "1 where the cell is held", cells.clamped.values());
  std::vector<std::int64_t> neighbours(tissue.pairs.neighbours.begin(), tissue.pairs.neighbours.end());
  neighbours.resize(cells.total(), 0);
  make.integers("neighbours", "cells that this cell interacts with", std::move(neighbours));
  for (const auto& effect : model.effects) effect->add_columns(tissue, columns);
  return columns;
}

}  // namespace

template <int Dim>
Frame make_frame(const Model<Dim>& model, const Scene& scene) {
  Frame frame{model.solver.tissue().time_h, model.solver.steps(), cell_columns<Dim>(model)};
  keep_wanted(frame.columns, scene.output.fields);
  for (const auto& effect : model.effects) effect->add_tables(frame.tables);
  frame.tables.push_back(closed_form_table<Dim>(scene, model.solver));
  return frame;
}

template <int Dim>
void refuse_unknown_fields(const Model<Dim>& model, const Scene& scene) {
  std::set<std::string> known;
  for (const FrameColumn& c : cell_columns<Dim>(model)) known.insert(c.name);
  for (const std::string& name : scene.output.fields) {
    if (known.contains(name)) continue;
    scene.origins.fail("output.fields", "there is no such field in this scene", name,
                       fmt::format("{}", fmt::join(known, ", ")), "take it out, or leave fields empty to write all");
  }
}

template <int Dim>
std::vector<std::string> history_columns(const Model<Dim>& model, const std::string& error_name) {
  std::vector<std::string> columns{"time_h",
                                   "cells",
                                   "divisions",
                                   "tip_x_mm",
                                   "tip_y_mm",
                                   "tip_z_mm",
                                   "length_mm",
                                   "tip_speed_mm_h",
                                   "max_axial_strain_rate_per_h",
                                   "mean_radius_mm",
                                   "kinetic_over_elastic",
                                   error_name,
                                   "min_neighbours",
                                   "contact_force_x_N",
                                   "contact_force_y_N",
                                   "contact_force_z_N",
                                   "contact_force_N"};
  for (const auto& effect : model.effects) {
    for (const auto& [name, value] : effect->history()) columns.push_back(name);
  }
  return columns;
}

template <int Dim>
HistoryRow make_history_row(const Model<Dim>& model, const LengthMark& before, std::int64_t divisions, double error) {
  const Tissue<Dim>& tissue = model.solver.tissue();
  const RootAxis<Dim>& axis = model.solver.axis();
  const auto& cells = tissue.cells;

  HistoryRow row;
  row.length_mm = axis.length_mm();
  Vec<Dim> contact = Vec<Dim>::Zero(), external = Vec<Dim>::Zero();
  for (const auto& effect : model.effects) {
    contact += effect->contact_force_N();
    external += effect->external_force_N();
  }
  row.momentum_residual = relative_momentum_residual<Dim>(tissue, external);

  const double elapsed_h = tissue.time_h - before.time_h;
  const double tip_speed =
      elapsed_h > 0.0 ? (row.length_mm - before.length_mm) / elapsed_h : axis.flow_mm_h(row.length_mm);
  double fastest = 0.0;
  for (std::size_t k = 1; k < axis.flow().size(); ++k) {
    fastest = std::max(fastest, (axis.flow()[k] - axis.flow()[k - 1]) / axis.bin_mm());
  }
  std::int64_t fewest = tissue.pairs.neighbours.empty() ? 0 : static_cast<std::int64_t>(cells.size());
  for (std::size_t i = 0; i < tissue.pairs.neighbours.size(); ++i) {
    // next to cells at rest, partners are missing from the list only
    if (!tissue.asleep || !(*tissue.asleep)[i]) fewest = std::min<std::int64_t>(fewest, tissue.pairs.neighbours[i]);
  }
  const double section = mean_section<Dim>(tissue, axis);
  const Energies energy = energies<Dim>(tissue);
  const Vec<Dim>& tip = axis.tip_mm();
  row.values = {tissue.time_h,
                static_cast<double>(cells.total()),
                static_cast<double>(divisions),
                tip[0],
                tip[1],
                Dim == 3 ? tip[Dim - 1] : 0.0,
                row.length_mm,
                tip_speed,
                fastest,
                Dim == 2 ? 0.5 * section : std::sqrt(section / std::numbers::pi),
                energy.elastic > 0.0 ? energy.kinetic / energy.elastic : 0.0,
                error,
                static_cast<double>(fewest),
                contact[0],
                contact[1],
                Dim == 3 ? contact[Dim - 1] : 0.0,
                contact.norm()};
  for (const auto& effect : model.effects) {
    for (const auto& [name, value] : effect->history()) row.values.push_back(value);
  }
  return row;
}

template Frame make_frame<2>(const Model<2>&, const Scene&);
template Frame make_frame<3>(const Model<3>&, const Scene&);
template void refuse_unknown_fields<2>(const Model<2>&, const Scene&);
template void refuse_unknown_fields<3>(const Model<3>&, const Scene&);
template std::vector<std::string> history_columns<2>(const Model<2>&, const std::string&);
template std::vector<std::string> history_columns<3>(const Model<3>&, const std::string&);
template HistoryRow make_history_row<2>(const Model<2>&, const LengthMark&, std::int64_t, double);
template HistoryRow make_history_row<3>(const Model<3>&, const LengthMark&, std::int64_t, double);

}  // namespace rootsoil
