// SPDX-License-Identifier: MIT
#include "root_sph/dynamics/tissue.hpp"

namespace rootsoil {
namespace {

template <int Dim>
void forget_index(std::int64_t& first, std::int64_t& second, const Division<Dim>&) {
  first = second = -1;
}

}  // namespace

template <int Dim>
Tissue<Dim>::Tissue()
    : velocity_gradient(cells.template declare<Mat<Dim>>(
          {"velocity_gradient", "1/h", "with the frozen operators of the window", Storage::scratch},
          on_division::recomputed<Dim, Mat<Dim>>)),
      deformation(cells.template declare<Mat<Dim>>(
          {"deformation", "1", "deformation since the start of the window", Storage::scratch},
          on_division::recomputed<Dim, Mat<Dim>>)),
      nominal_force(cells.template declare<Mat<Dim>>(
          {"nominal_force", Dim == 2 ? "N" : "N mm", "V sigma_total F^-T", Storage::scratch},
          on_division::recomputed<Dim, Mat<Dim>>)),
      force(cells.template declare<Vec<Dim>>({"force", Dim == 2 ? "N/mm" : "N", "sum of all forces", Storage::scratch},
                                             on_division::recomputed<Dim, Vec<Dim>>)),
      axial_strain(
          cells.template declare<double>({"axial_strain", "1", "since the start of the window", Storage::scratch},
                                         on_division::recomputed<Dim, double>)),
      window_index(cells.template declare<std::int64_t>(
          {"window_index", "1", "index in the window before, -1 when divided since", Storage::scratch},
          forget_index<Dim>)) {}

template <int Dim>
void Tissue<Dim>::need_inertia() {
  if (inertia) return;
  auto& inverse = cells.template declare<Vec<Dim>>(
      {"inverse_inertia", "mm/(N h^2)", "along the material axes, 0 where held", Storage::scratch},
      on_division::recomputed<Dim, Vec<Dim>>);
  auto& start_velocity =
      cells.template declare<Vec<Dim>>({"start_velocity", "mm/h", "at the start of the window", Storage::scratch},
                                       on_division::recomputed<Dim, Vec<Dim>>);
  inertia.emplace(Inertia<Dim>{inverse, start_velocity});
}

template <int Dim>
void use_law(Tissue<Dim>& tissue, TissueLaw law) {
  tissue.material.law = law;
  visit_law<Dim>(law, [&]<class Law>(Law) {
    for (const LawColumn& c : Law::columns) {
      tissue.material.law_columns.push_back(&tissue.cells.template declare<Voigt<Dim>>(
          {std::string(c.name), std::string(c.unit), std::string(c.meaning)}, on_division::copy<Dim, Voigt<Dim>>));
    }
  });
}

template <int Dim>
Energies energies(const Tissue<Dim>& tissue) {
  Energies e;
  const auto& cells = tissue.cells;
  for (std::size_t i = 0; i < cells.total(); ++i) {
    if (tissue.inertia) {
      const Vec<Dim> u = cells.frame[i].transpose() * cells.velocity[i];
      const Vec<Dim>& inverse = tissue.inertia->inverse[i];
      for (int a = 0; a < Dim; ++a) {
        if (inverse[a] > 0.0) e.kinetic += 0.5 * u[a] * u[a] / inverse[a];
      }
    }
    // sigma : S : sigma by solving with the normal block of C
    const Stiffness<Dim>& k = tissue.material.stiffness_of(i);
    const Mat<Dim> c = elastic_tangent<Dim>(k).template topLeftCorner<Dim, Dim>();
    const Voigt<Dim>& s = cells.stress[i];
    double density = s.template head<Dim>().dot(c.inverse() * s.template head<Dim>());
    if constexpr (Dim == 2) {
      density += s[2] * s[2] / k[stiffness_entry::g];
    } else {
      density += s[3] * s[3] / k[stiffness_entry::g23] + (s[4] * s[4] + s[5] * s[5]) / k[stiffness_entry::g];
    }
    e.elastic += 0.5 * cells.volume[i] * density;
  }
  return e;
}

template <int Dim>
double relative_momentum_residual(const Tissue<Dim>& tissue, const Vec<Dim>& external_N) {
  Vec<Dim> sum = -external_N;
  for (std::size_t i = 0; i < tissue.cells.total(); ++i) sum += tissue.force[i];
  double magnitudes = 0.0;
  for (std::size_t k = 0; k < tissue.pairs.pairs.size(); ++k) {
    const auto [i, j] = tissue.pairs.pairs[k];
    magnitudes += (tissue.nominal_force[i] * tissue.gradients[k].at_i).norm() +
                  (tissue.nominal_force[j] * tissue.gradients[k].at_j).norm();
  }
  return magnitudes > 0.0 ? sum.norm() / magnitudes : 0.0;
}

template struct Tissue<2>;
template struct Tissue<3>;
template void use_law<2>(Tissue<2>&, TissueLaw);
template void use_law<3>(Tissue<3>&, TissueLaw);
template Energies energies<2>(const Tissue<2>&);
template Energies energies<3>(const Tissue<3>&);
template double relative_momentum_residual<2>(const Tissue<2>&, const Vec<2>&);
template double relative_momentum_residual<3>(const Tissue<3>&, const Vec<3>&);

}  // namespace rootsoil
