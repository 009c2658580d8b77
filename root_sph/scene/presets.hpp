// SPDX-License-Identifier: MIT
// What [numerics] accuracy stands for.
#pragma once

#include "root_sph/scene/scene.hpp"

namespace rootsoil {

/// The numerics of a preset; keys that the scene gives replace its values.
NumericsSection preset(Accuracy accuracy);

/// The step of a root that grows.
struct StepRule {
  // Without inertia.
  double growth_per_step = 0.0;         ///< largest axial strain; no cell divides earlier by more
  double contact_cells_per_step = 0.0;  ///< that the tip moves where something can be in its way
  // With inertia.
  double tip_cells_per_step = 0.0;  ///< inertia's share of the stress is of the order of its square
  double longest_step_h = 0.0;
  /// Where something can stop the root, cells in a step over the elastic strain p/E_A: the inertia of the root that
  /// runs into it adds some half of E_A times the cells in a step to the stress, and growth, being one-sided, keeps
  /// what is added (docs/decisions/0020).
  double arrest_cells_per_strain = 0.0;
};

StepRule step_rule(Accuracy accuracy);

/// What tools/accuracy_cost.py measured with a preset: a straight 2D root of regular cells, 8 across, that grows and
/// divides for 3 h. Irregular cells add to it. The numbers with inertia stand in docs/accuracy_cost.csv.
struct PresetRecord {
  double discretisation_error = 0.0;  ///< rms over cells of the axial strain rate, relative, against the closed form
  double error_in_balance = 0.0;      ///< the same in steps that end in balance, with what the step adds
  double inertia_error = 0.0;         ///< mean; every run measures its own
  double ms_per_cell_hour = 0.0;      ///< processor time for one cell over one simulated hour
};

PresetRecord preset_record(Accuracy accuracy);

/// The same error with so many cells across.
double discretisation_error(const NumericsSection& numerics, double cells_across);

/// Whether discretisation_error goes beyond what was measured, 4 to 16 cells across, where it may be far too small.
bool is_coarser_than_measured(double cells_across);
inline constexpr const char* coarser_than_measured =
    "fewer than four cells across were never measured: contact and bending may be off by far more than this (one cell "
    "across bends a hundredth as far as it should)";

}  // namespace rootsoil
