// SPDX-License-Identifier: MIT
#include "root_sph/dynamics/assembly.hpp"
#include "root_sph/dynamics/preconditioner.hpp"

namespace rootsoil {

template <int Dim>
FreeCells order_free_cells(const ParticleStore<Dim>& cells) {
  FreeCells free;
  free.place.assign(cells.size(), -1);
  for (const std::int32_t i : order_along_root<Dim>(cells)) {
    if (cells.clamped[i]) continue;
    free.place[i] = static_cast<std::int32_t>(free.cell.size());
    free.cell.push_back(i);
  }
  return free;
}

template FreeCells order_free_cells<2>(const ParticleStore<2>&);
template FreeCells order_free_cells<3>(const ParticleStore<3>&);

}  // namespace rootsoil
