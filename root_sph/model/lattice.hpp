// SPDX-License-Identifier: MIT
// The lattice that fills a capsule: whole numbers of cells, and the asked width and length all the same.
#pragma once

#include <map>
#include <string>

#include "root_sph/scene/scene.hpp"

namespace rootsoil {

/// Spacing is cell_size_mm times a stretch along the root and another across it, so that a whole number of cells fits;
/// cells then are not square. Stretches are exactly 1 where cell_size_mm fits anyway (fit_lattice).
struct Lattice {
  int layers = 0, across = 0;
  double stretch_along = 1.0, stretch_across = 1.0;
  double mean_stretch = 1.0;               ///< of volume^(1/dimension)
  double along_mm = 0.0, across_mm = 0.0;  ///< spacing
  double outer_mm = 0.0;                   ///< centres of cells lie within this distance from the axis
  double length_mm = 0.0, width_mm = 0.0;  ///< that result; width in 3D: of the circle with the section's area
};

Lattice fit_lattice(const RootSection& root, int dimension);

/// Of a capsule (root.cap) or a rectangle or cylinder, mm^dimension.
double asked_volume(const RootSection& root, int dimension);

/// The same numbers for summary.json and `check --json`.
std::map<std::string, double> lattice_numbers(const Lattice& lattice, const RootSection& root, double volume,
                                              int dimension);

/// "13 layers of 3 cells, ...": what was asked and what results.
std::string describe_lattice(const Lattice& lattice, const RootSection& root, double volume, int dimension);

/// Whether what results is not what was asked: cells of another shape, or a length, width or volume further off than
/// rounding to whole cells makes them.
bool differs_from_asked(const Lattice& lattice, const RootSection& root, double volume, int dimension);

}  // namespace rootsoil
