// SPDX-License-Identifier: MIT
// Values that a scene gives over time, or along the root: [[h, value], ...], linear in between, constant before the
// first and after the last.
#pragma once

#include <string>

#include "root_sph/scene/schema.hpp"

namespace rootsoil {

/// \param table rows (x, value), x increasing; not empty
double value_at(const Rows& table, double x);

/// InputError where the first numbers of a key's rows do not increase from 0 on.
/// \param name of those numbers: times, distances
void check_increasing(const Rows& table, const std::string& key, const std::string& name, const Origins& origins);

}  // namespace rootsoil
