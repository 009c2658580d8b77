// SPDX-License-Identifier: MIT
// The surface of a root as markers that move with the tissue: a line of discs in 2D.
#pragma once

#include "root_sph/exchange/outline.hpp"

namespace rootsoil {

template <int Dim>
struct MaterialSurfaceOf;
template <>
struct MaterialSurfaceOf<2> {
  using type = Outline;
};

template <int Dim>
using MaterialSurface = typename MaterialSurfaceOf<Dim>::type;

}  // namespace rootsoil
