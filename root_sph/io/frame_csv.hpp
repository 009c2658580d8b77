// SPDX-License-Identifier: MIT
// A frame as a table for spreadsheets and scripts.
#pragma once

#include <filesystem>

#include "root_sph/io/frame.hpp"

namespace rootsoil {

/// A row a cell. Scalars by field name, three components name_x name_y name_z, six components name_xx name_yy
/// name_zz name_xy name_yz name_xz.
void write_frame_csv(const std::filesystem::path& path, const Frame& frame);

}  // namespace rootsoil
