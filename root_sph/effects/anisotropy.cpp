// SPDX-License-Identifier: MIT
#include "root_sph/effects/anisotropy.hpp"

#include <utility>

namespace rootsoil {

template <int Dim>
AnisotropyEffect<Dim>::AnisotropyEffect(Solver<Dim>& solver, ElasticConstants constants,
                                        std::function<RadialModulusProfile(double)> profile_at)
    : radial_modulus_(solver.tissue().cells.template declare<double>(
          {"radial_modulus", "MPa", "E_R at the cell, Eq. 6", Storage::scratch},
          on_division::recomputed<Dim, double>)) {
  Tissue<Dim>& tissue = solver.tissue();
  tissue.material.stiffness = &tissue.cells.template declare<Stiffness<Dim>>(
      {"stiffness", "MPa", "entries of C, and of the trace of S (1/MPa)", Storage::scratch},
      on_division::recomputed<Dim, Stiffness<Dim>>);
  solver.hooks().parameters.emplace_back(
      "anisotropy", [this, &solver, constants, profile_at = std::move(profile_at)](Tissue<Dim>& t) {
        const RadialModulusProfile profile = profile_at(t.pressure_MPa);
#pragma omp parallel for schedule(static)
        for (std::size_t i = 0; i < t.cells.size(); ++i) {
          ElasticConstants here = constants;
          here.E_radial_MPa = profile(solver.mid_window_distance(t.cells.distance_to_tip[i]));
          radial_modulus_[i] = here.E_radial_MPa;
          (*t.material.stiffness)[i] = stiffness<Dim>(here);
        }
      });
}

template <int Dim>
void AnisotropyEffect<Dim>::add_columns(const Tissue<Dim>&, std::vector<FrameColumn>& columns) const {
  columns.push_back({"radial_modulus", "MPa", "radial Young modulus of the tissue", 1, radial_modulus_.values()});
}

template class AnisotropyEffect<2>;
template class AnisotropyEffect<3>;

}  // namespace rootsoil
