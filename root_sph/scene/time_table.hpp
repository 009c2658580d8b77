// SPDX-License-Identifier: MIT
// Values that a scene gives over time, or along the root: [[h, value], ...], linear in between, constant before the
// first and after the last.
#pragma once

#include <string>

#include "root_sph/scene/schema.hpp"

namespace rootsoil {

/// \param table rows (time_h, value), times increasing; not empty
double value_at(const Rows& table, double time_h);

/// InputError where the times of a key's rows do not increase, or what else is first in a row.
void check_times(const Rows& table, const std::string& key, const Origins& origins, const std::string& what = "time");

}  // namespace rootsoil
