// SPDX-License-Identifier: MIT
// A small root that grows onto something; shared by the tests of soil contact.
#pragma once

#include <memory>
#include <string>
#include <utility>

#include "root_sph/effects/soil_contact/soil_start.hpp"
#include "soil_coupling/twins/half_space.hpp"
#include "tests/physics/harness.hpp"

namespace rootsoil::soil_test {

/// 330 cells, 8 across, tip speed 0.17 mm/h, arrested by p (1 - nu_A) W = 0.226 N/mm.
inline const std::string scene_text = R"(
[scene]
name = "contact"
duration_h = 20
[root]
length_mm = 1.2
radius_mm = 0.12
cell_size_mm = 0.03
[tissue]
E_axial_MPa = 1020
[tissue.anisotropy]
E_radial_max_MPa = 15000
x_e_mm = 0.1
s_e_per_mm = 20
c_e = 0.2
[pressure]
differential_MPa = 1
[growth]
lambda0_ug_mm3_h = 4.34e5
x_g_mm = 0.05
s_g_mm = 0.25
c_g = -0.95
mature_at_mm = 0.8
mature_width_mm = 0.2
[division]
l0_mm = 0.045
c_d = 1.0
s_d_per_mm2 = 10.0
x_d_mm = 0.2
constant_beyond_mm = 0.7
[non_affine_control]
[numerics]
stepper = "quasi_static"
step_h = 1e-3
[output]
every_h = 1
)";

/// The same with inertia. The tip moves 3e-4 cells in a step: with more, inertia shows as force when the root meets a
/// plate.
inline const std::string text_with_inertia = [] {
  std::string text = scene_text;
  const std::size_t at = text.find("[numerics]");
  return text.replace(at, text.find("[output]") - at,
                      "[numerics]\nstepper = \"symplectic\"\nstep_h = 5e-5\nmidline_damping_per_h = 0\n");
}();

/// No ramp: these roots start out of contact, and one that meets a plate while forces still rise presses too deep (17 %
/// too hard).
inline SoilContactParameters predicting() {
  SoilContactParameters parameters;
  parameters.stiffness_predictor = true;
  parameters.ramp_h = 0.0;
  return parameters;
}

/// The half-space beyond the tip at a gap, square to the root.
inline twins::HalfSpaceParameters plate(const Scene& scene, double stiffness_N_mm, double gap_mm = 0.01) {
  twins::HalfSpaceParameters p;
  p.point_mm = {scene.root.length_mm + gap_mm, 0.0, 0.0};
  p.outward = {-1.0, 0.0, 0.0};
  p.stiffness_N_mm = stiffness_N_mm;
  return p;
}

/// Force that arrests the root: p (1 - nu_A) times its width over the part that pushes.
inline double arrest_N(const physics::SceneRun<2>& run) {
  return pressure_MPa(run.scene, 0.0) * (1.0 - run.scene.tissue.nu_axial) * 2.0 *
         physics::radius_mm<2>(run.tissue, 0.2, 0.6);
}

/// A scene in progress with a soil in this process.
template <int Dim>
class SoilRun : public physics::SceneRun<Dim> {
 public:
  template <class Make>
  SoilRun(const std::vector<std::string>& overrides, SoilContactParameters parameters, Make&& make,
          const std::string& text = scene_text)
      : physics::SceneRun<Dim>(text, overrides), contact(add_contact(std::move(parameters), make(this->scene))) {}

  /// Axial force of whatever touches the root, compression positive.
  double axial_force_N() const {
    double sum = 0.0;
    for (const auto& effect : this->model->effects) sum -= effect->contact_force_N()[0];
    return sum;
  }
  SoilContactEffect<Dim>& contact;

 private:
  SoilContactEffect<Dim>& add_contact(SoilContactParameters parameters, std::unique_ptr<SoilPort> port) {
    parameters.free_growth = free_growth<Dim>(this->scene);
    this->model->effects.push_back(
        std::make_unique<SoilContactEffect<Dim>>(this->solver, std::move(parameters), std::move(port)));
    for (const auto& effect : this->model->effects) effect->prepare();  // sleep hears of it
    return static_cast<SoilContactEffect<Dim>&>(*this->model->effects.back());
  }
};

}  // namespace rootsoil::soil_test
