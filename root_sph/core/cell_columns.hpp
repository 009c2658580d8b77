// SPDX-License-Identifier: MIT
// Which columns of a table hold a measured cell: what a scene says in [root.columns], and the reader of tables follows.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "root_sph/core/enum_names.hpp"

namespace rootsoil {

enum class LengthUnit { mm, um, nm };
template <>
inline constexpr EnumName<LengthUnit> enum_names<LengthUnit>[] = {
    {LengthUnit::mm, "mm"}, {LengthUnit::um, "um"}, {LengthUnit::nm, "nm"}};

/// Titles of columns. What is empty has the title that MorphoGraphX users, or else scikit-image's regionprops_table,
/// give it.
struct CellColumns {
  std::optional<LengthUnit> unit;  ///< of columns whose titles name none
  std::string label;
  std::vector<std::string> position;   ///< three
  std::vector<std::string> e1, e2;     ///< unit axes, three each
  std::vector<std::string> semi_axes;  ///< along e1, e2 and e1 x e2, in descending order
  std::vector<std::string> diameters;  ///< the same, twice as long
  std::vector<std::string> inertia;    ///< xx, xy, xz, yy, yz, zz for unit mass, in place of axes
  std::string volume;                  ///< as counted; alone: the cells are balls
};

}  // namespace rootsoil
