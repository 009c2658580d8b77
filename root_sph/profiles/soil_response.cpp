// SPDX-License-Identifier: MIT
#include "root_sph/profiles/soil_response.hpp"

#include <algorithm>

namespace rootsoil {

double SoilResponse::theta(double p) const {
  const double t = (p - p_MPa[1]) / (p_MPa[0] - p_MPa[1]);
  return extrapolate ? t : std::clamp(t, 0.0, 1.0);
}

}  // namespace rootsoil
