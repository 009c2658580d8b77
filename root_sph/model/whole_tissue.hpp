// SPDX-License-Identifier: MIT
// Whether the cells at time 0 are one tissue that a scene's effects can work on. Each function throws InputError or
// does nothing.
#pragma once

#include <span>
#include <string>

#include "root_sph/dynamics/tissue.hpp"
#include "root_sph/io/cell_file.hpp"
#include "root_sph/scene/scene.hpp"

namespace rootsoil {

/// Cells of a file that lie far apart from the others, or in one place. Before anything is computed with them.
void refuse_piles(const std::string& file, std::span<const MeasuredCell> cells);

/// Cells of a file that are not joined to the others.
void refuse_parts(const std::string& file, std::span<const MeasuredCell> cells);

/// Ellipsoids of a file that would have to shrink much to fill the tissue once.
void refuse_overlap(const std::string& file, double volume_scale);

/// A lattice that jitter, unequal cells or curvature have torn, or whose cells they have put in one place.
template <int Dim>
void refuse_torn_lattice(const Scene& scene, const Tissue<Dim>& tissue);

/// A root so slender that the bins along it, a fraction of its diameter each, are too many.
template <int Dim>
void refuse_thread(const Scene& scene, const Tissue<Dim>& tissue);

/// Cells whose kernels reach too few others for a gradient: nothing would hold them together.
/// \param kernel_metrics of all cells
template <int Dim>
void refuse_lonely_cells(const Scene& scene, const Tissue<Dim>& tissue, std::span<const Mat<Dim>> kernel_metrics);

/// A division threshold that the cells at the start exceed many times.
template <int Dim>
void refuse_hasty_division(const Scene& scene, const Tissue<Dim>& tissue);

}  // namespace rootsoil
