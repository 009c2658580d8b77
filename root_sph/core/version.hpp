// SPDX-License-Identifier: MIT
// Which program this is.
#pragma once

namespace rootsoil {

/// "0.1.0+c8ef50d123": the version, and the commit that the program was built from (cmake/version.cmake).
extern const char* const program_version;

}  // namespace rootsoil
