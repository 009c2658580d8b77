// SPDX-License-Identifier: MIT
// Elasticity of a transversely isotropic tissue, in the material frame (axis 1 = root axis). Pure functions.
// Source: the paper's Eq. 4 (its shear entries are compliances 1/G; it prints G). 2D is the paper's plane form,
// the 2x2 normal block.
#pragma once

#include "root_sph/core/types.hpp"

namespace rootsoil {

struct ElasticConstants {
  double E_axial_MPa;
  double E_radial_MPa;
  double nu_axial;
  double nu_radial;  ///< 3D only
  double G_MPa;      ///< axial shear
};

/// Compliance S (1/MPa), acting on a stress vector, giving engineering strains.
template <int Dim>
VoigtMat<Dim> compliance(const ElasticConstants& c) {
  VoigtMat<Dim> s = VoigtMat<Dim>::Zero();
  const double axial = 1.0 / c.E_axial_MPa;
  const double cross = -c.nu_axial / c.E_axial_MPa;
  const double radial = 1.0 / c.E_radial_MPa;
  s(0, 0) = axial;
  for (int a = 1; a < Dim; ++a) {
    s(0, a) = s(a, 0) = cross;
    s(a, a) = radial;
  }
  if constexpr (Dim == 2) {
    s(2, 2) = 1.0 / c.G_MPa;
  } else {
    s(1, 2) = s(2, 1) = -c.nu_radial * radial;
    s(3, 3) = 2.0 * (1.0 + c.nu_radial) * radial;
    s(4, 4) = s(5, 5) = 1.0 / c.G_MPa;
  }
  return s;
}

/// The independent entries of C = S^-1, and of the trace of S:sigma, as a column of numbers.
/// Scene-wide where the tissue is uniform, one a cell where it varies along the root.
template <int Dim>
using Stiffness = Eigen::Matrix<double, Dim == 2 ? 6 : 8, 1>;

namespace stiffness_entry {
enum : int { c11 = 0, c12, c22, g, axial_trace, radial_trace, c23, g23 };
}

template <int Dim>
Stiffness<Dim> stiffness(const ElasticConstants& constants) {
  using namespace stiffness_entry;
  const VoigtMat<Dim> s = compliance<Dim>(constants);
  const Mat<Dim> c = s.template topLeftCorner<Dim, Dim>().inverse();
  Stiffness<Dim> k;
  k[c11] = c(0, 0);
  k[c12] = c(0, 1);
  k[c22] = c(1, 1);
  k[g] = constants.G_MPa;
  k[axial_trace] = s.template topLeftCorner<Dim, Dim>().col(0).sum();
  k[radial_trace] = s.template topLeftCorner<Dim, Dim>().col(1).sum();
  if constexpr (Dim == 3) {
    k[c23] = c(1, 2);
    k[g23] = 1.0 / s(3, 3);
  }
  return k;
}

/// C : strain (engineering shear), MPa.
template <int Dim>
Voigt<Dim> elastic_stress(const Stiffness<Dim>& k, const Voigt<Dim>& strain) {
  using namespace stiffness_entry;
  Voigt<Dim> s;
  if constexpr (Dim == 2) {
    s << k[c11] * strain[0] + k[c12] * strain[1], k[c12] * strain[0] + k[c22] * strain[1], k[g] * strain[2];
  } else {
    s << k[c11] * strain[0] + k[c12] * (strain[1] + strain[2]),
        k[c12] * strain[0] + k[c22] * strain[1] + k[c23] * strain[2],
        k[c12] * strain[0] + k[c23] * strain[1] + k[c22] * strain[2],  //
        k[g23] * strain[3], k[g] * strain[4], k[g] * strain[5];
  }
  return s;
}

/// C as a matrix, column by column.
template <int Dim>
VoigtMat<Dim> elastic_tangent(const Stiffness<Dim>& k) {
  VoigtMat<Dim> c;
  for (int column = 0; column < voigt_size<Dim>; ++column) {
    c.col(column) = elastic_stress<Dim>(k, Voigt<Dim>(Voigt<Dim>::Unit(column)));
  }
  return c;
}

/// S : stress, engineering shear: the strain of which the stress is C : strain.
template <int Dim>
Voigt<Dim> elastic_strain(const Stiffness<Dim>& k, const Voigt<Dim>& stress) {
  using namespace stiffness_entry;
  // Of the radial strains, the sum goes with the axial one and the difference is by itself.
  const double lateral = Dim == 2 ? k[c22] : k[c22] + k[Dim == 2 ? c22 : c23];
  const double lateral_stress = Dim == 2 ? stress[1] : stress[1] + stress[Dim - 1];
  const double det = k[c11] * lateral - (Dim - 1) * k[c12] * k[c12];
  const double axial = (lateral * stress[0] - k[c12] * lateral_stress) / det;
  const double radial = (k[c11] * lateral_stress - (Dim - 1) * k[c12] * stress[0]) / det;  // the sum
  Voigt<Dim> strain;
  if constexpr (Dim == 2) {
    strain << axial, radial, stress[2] / k[g];
  } else {
    const double difference = (stress[1] - stress[2]) / (k[c22] - k[c23]);
    strain << axial, 0.5 * (radial + difference), 0.5 * (radial - difference),  //
        stress[3] / k[g23], stress[4] / k[g], stress[5] / k[g];
  }
  return strain;
}

/// tr(S : sigma): the elastic volume strain, rho0/rho - 1.
template <int Dim>
double volume_strain(const Stiffness<Dim>& k, const Voigt<Dim>& stress) {
  using namespace stiffness_entry;
  double lateral = stress[1];
  if constexpr (Dim == 3) lateral += stress[2];
  return k[axial_trace] * stress[0] + k[radial_trace] * lateral;
}

/// K of Eq. 3: 1/(sum of the normal block of S).
template <int Dim>
double bulk_modulus(const Stiffness<Dim>& k) {
  using namespace stiffness_entry;
  return 1.0 / (k[axial_trace] + (Dim - 1) * k[radial_trace]);
}

/// value 1.
template <int Dim>
Voigt<Dim> isotropic(double value) {
  Voigt<Dim> s = Voigt<Dim>::Zero();
  s.template head<Dim>().setConstant(value);
  return s;
}

/// Strains or strain rates along the root and across it.
struct AxialRadial {
  double axial, radial;
};

/// S : p 1, Eq. 8 with p: axial p (1 - nu_A)/E_A, radial p (1/E_R - nu_A/E_A); 3D: (1 - 2 nu_A), (1 - nu_R)/E_R.
template <int Dim>
AxialRadial pressure_strain(const Stiffness<Dim>& k, double p_MPa) {
  return {p_MPa * k[stiffness_entry::axial_trace], p_MPa * k[stiffness_entry::radial_trace]};
}

/// Takes the isotropic part away (2D: half the trace, the paper's plane form; 3D: a third).
template <int Dim>
Voigt<Dim> deviator(Voigt<Dim> s) {
  const double mean = s.template head<Dim>().mean();
  s.template head<Dim>().array() -= mean;
  return s;
}

}  // namespace rootsoil
