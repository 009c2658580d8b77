// SPDX-License-Identifier: MIT
// The closed form of every law against a simulation with it, in isotropic tissue, where every law has waves that
// travel.
#include <gtest/gtest.h>

#include <cmath>
#include <string>

#include "growth.hpp"

namespace rootsoil::physics {
namespace {

class EveryLaw : public testing::TestWithParam<std::string> {
 protected:
  std::string law() const { return "tissue.law=\"" + GetParam() + "\""; }
};

/// Logarithmic strains of a root that is put under pressure; p/E = 1 %, so that the laws differ.
template <int Dim>
void expect_equilibrium_strain(const std::string& law) {
  SceneRun<Dim> run(strain_case, {law, "scene.dimension=" + std::to_string(Dim), "pressure.differential_MPa=10",
                                  "root.length_mm=0.4", "root.radius_mm=0.03"});
  run.advance_to(8.0);
  const AxialRadial found = measured_strain<Dim>(run, 0.1, 0.3);
  const AxialRadial exact = visit_law<Dim>(run.scene.tissue.law, [&]<class Law>(Law) {
    return Law::equilibrium_strain(stiffness<Dim>(elastic_constants(run.scene, 0.2, 10.0)), 10.0);
  });
  expect_within_record("axial strain", std::log1p(found.axial) / exact.axial - 1.0);
  expect_within_record("radial strain", std::log1p(found.radial) / exact.radial - 1.0);
}

TEST_P(EveryLaw, Strain2D) { expect_equilibrium_strain<2>(law()); }
TEST_P(EveryLaw, Strain3D) { expect_equilibrium_strain<3>(law()); }

TEST_P(EveryLaw, Growth2D) {
  expect_closed_form<2>(growth_case, {law(), "root.radius_mm=0.03", "tissue.anisotropy.E_radial_max_MPa=1020"}, 0.3,
                        1.0);
}

INSTANTIATE_TEST_SUITE_P(Laws, EveryLaw, testing::ValuesIn(names_of<TissueLaw>()),
                         [](const auto& law) { return law.param; });

}  // namespace
}  // namespace rootsoil::physics
