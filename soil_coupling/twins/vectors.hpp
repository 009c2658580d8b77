// SPDX-License-Identifier: MIT
#pragma once

#include <Eigen/Dense>

#include "root_sph/exchange/soil_port.hpp"

namespace rootsoil::twins {

inline Eigen::Vector3d eigen(const Vec3& v) { return {v[0], v[1], v[2]}; }

}  // namespace rootsoil::twins
