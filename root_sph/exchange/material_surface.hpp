// SPDX-License-Identifier: MIT
// The surface of a root as markers that move with the tissue: a line of discs in 2D, a shell of spheres in 3D.
#pragma once

#include <type_traits>

#include "root_sph/exchange/outline.hpp"
#include "root_sph/exchange/shell.hpp"

namespace rootsoil {

template <int Dim>
using MaterialSurface = std::conditional_t<Dim == 2, Outline, Shell>;

}  // namespace rootsoil
