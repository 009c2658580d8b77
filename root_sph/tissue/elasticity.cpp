// SPDX-License-Identifier: MIT
#include "root_sph/tissue/elasticity.hpp"

#include "root_sph/tissue/closed_form.hpp"
#include "root_sph/tissue/laws.hpp"

namespace rootsoil {
// The headers are pure templates; this unit checks that they stand on their own.
template Stiffness<2> stiffness<2>(const ElasticConstants&);
template Stiffness<3> stiffness<3>(const ElasticConstants&);
}  // namespace rootsoil
