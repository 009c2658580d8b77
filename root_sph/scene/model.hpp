// SPDX-License-Identifier: MIT
// Scene -> model: the solver, its cells at time 0 and the effects that the scene calls for.
#pragma once

#include "root_sph/effects/soil_contact.hpp"
#include "root_sph/scene/effect_table.hpp"
#include "root_sph/scene/initial_cells.hpp"
#include "root_sph/scene/scene.hpp"

#include <memory>

namespace rootsoil {

/// Closed-form flow of a freely growing straight root: tip speed and v(s), mm/h. 0 without growth or pressure.
struct ClosedFormFlow {
  double tip_speed_mm_h = 0.0;
  double peak_rate_per_h = 0.0;
};
template <int Dim>
double closed_form_axial_rate(const Scene& scene, double s_mm);
template <int Dim>
double closed_form_radial_rate(const Scene& scene, double s_mm);
template <int Dim>
ClosedFormFlow closed_form_flow(const Scene& scene, double length_mm);

/// Throws InputError where the law loses hyperbolicity anywhere on the root and the scene does not allow it.
template <int Dim>
void refuse_unstable_law(const Scene& scene);

/// The step, h: numerics.step_h, or chosen for the accuracy wanted (docs/decisions/0004). A divisor of the output
/// interval, so that frames fall on steps.
template <int Dim>
double choose_step_h(const Scene& scene);

template <int Dim>
struct BuiltModel {
  std::unique_ptr<Model<Dim>> model;
  InitialReport initial;
};

template <int Dim>
BuiltModel<Dim> build_model(const Scene& scene);

/// Lets the root of a built model meet a soil. The closed form of the scene is what a run is checked against.
template <int Dim>
SoilContactEffect<Dim>& add_soil_contact(const Scene& scene, Model<Dim>& model, SoilContactParameters parameters,
                                         std::unique_ptr<SoilPort> port);

}  // namespace rootsoil
