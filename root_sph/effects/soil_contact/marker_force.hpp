// SPDX-License-Identifier: MIT
// What exchange and prediction tell each other of a marker.
#pragma once

#include "root_sph/exchange/spin.hpp"

namespace rootsoil {

/// Of the soil on a marker, mean over the interval before.
template <int Dim>
struct MarkerForce {
  Vec<Dim> force_N = Vec<Dim>::Zero();
  Spin<Dim> torque_Nmm = Spin<Dim>::Zero();
  double stiffness_N_mm = 0.0;              ///< of the marker's contacts
  Vec<Dim> moved_mm = Vec<Dim>::Zero();     ///< since the middle of the interval to which the mean belongs, until now
  Vec<Dim> expected_mm = Vec<Dim>::Zero();  ///< the same at its mean pace
  Vec<Dim> pace_mm = Vec<Dim>::Zero();      ///< and in a whole window
};

/// How a marker moves through a window.
template <int Dim>
struct MarkerMotion {
  Vec<Dim> moved_mm = Vec<Dim>::Zero();
  Spin<Dim> turned = Spin<Dim>::Zero();
};

}  // namespace rootsoil
