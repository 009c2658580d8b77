// SPDX-License-Identifier: MIT
// The closed form along the root, for the frames: what the measured profiles are to be compared with.
#pragma once

#include "root_sph/dynamics/solver.hpp"
#include "root_sph/io/frame.hpp"
#include "root_sph/scene/scene.hpp"

namespace rootsoil {

/// The table "closed_form": a straight root of the present length in steady growth at the present pressure
/// differential, with nothing in its way, a row for each of some distances from the tip. It holds the columns of what
/// the scene has.
template <int Dim>
FrameTable closed_form_table(const Scene& scene, const Solver<Dim>& solver);

}  // namespace rootsoil
