// SPDX-License-Identifier: MIT
// Whatever the text: cells with finite shapes and axes that are rotations, or an InputError.
#include <cstddef>
#include <cstdint>
#include <cstdlib>

#include "root_sph/core/errors.hpp"
#include "root_sph/io/cell_file.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  try {
    for (const auto& cell : rootsoil::parse_cell_file({reinterpret_cast<const char*>(data), size}, "fuzz.csv")) {
      const bool good = cell.position_mm.allFinite() && rootsoil::shape_matrix(cell).allFinite() &&
                        cell.axes.isUnitary(1e-10) && rootsoil::volume_mm3(cell) > 0.0;
      if (!good) std::abort();
    }
  } catch (const rootsoil::InputError&) {
  }
  return 0;
}
