// SPDX-License-Identifier: MIT
// What every tissue law says of itself, against its own step.
#include <gtest/gtest.h>

#include <cmath>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "root_sph/tissue/hyperbolicity.hpp"
#include "root_sph/tissue/laws/laws.hpp"
#include "tests/support/clouds.hpp"

namespace rootsoil {
namespace {

using test::Random;

ElasticConstants with_ratio(double E_radial_over_axial) {
  return {1020.0, 1020.0 * E_radial_over_axial, 0.06, 0.3, 481.0};
}

constexpr double rho0 = 1000.0, volume = 1e-4;
constexpr double pressures_MPa[] = {0.1, 0.7, 2.0, -0.7};

template <class... Laws>
testing::Types<Laws...> types_of(std::tuple<Laws...>);
using EveryLaw = decltype(types_of(std::tuple_cat(TissueLaws<2>(), TissueLaws<3>())));

struct LawName {
  template <class Law>
  static std::string GetName(int) {
    return std::string(Law::name) + "_" + std::to_string(Law::dimension) + "D";
  }
};

/// One cell of a law, that is strained step by step.
template <class Law>
struct Cell {
  static constexpr int dim = Law::dimension;
  Stiffness<dim> k;
  double V = volume;
  typename Law::State state{Voigt<dim>::Zero(), rho0* volume};

  explicit Cell(double ratio) : k(stiffness<dim>(with_ratio(ratio))) {}

  /// At rest under sigma = p 1.
  Cell(double ratio, double p_MPa) : Cell(ratio) {
    state.stress = isotropic<dim>(p_MPa);
    state.mass *= Law::density_ratio(k, p_MPa);
  }

  void step(const Voigt<dim>& strain, double dt_h = 0.0, double lambda = 0.0, double yield_MPa = 0.0) {
    V *= std::exp(strain.template head<dim>().sum());
    Law::step({k, strain, V, dt_h, lambda, rho0, yield_MPa}, state);
  }
};

template <int Dim>
Voigt<Dim> as_strain(const AxialRadial& e) {
  Voigt<Dim> strain = isotropic<Dim>(e.radial);
  strain[0] = e.axial;
  return strain;
}

template <class Law>
class TheLaw : public testing::Test {};
TYPED_TEST_SUITE(TheLaw, EveryLaw, LawName);

TYPED_TEST(TheLaw, HasAsTangentTheDerivativeOfItsStep) {
  constexpr int dim = TypeParam::dimension;
  constexpr double h = 1e-5;
  for (const double ratio : {1.0, 5.0, 15.0}) {
    const Cell<TypeParam> rest(ratio);
    const VoigtMat<dim> tangent = TypeParam::tangent(rest.k);
    for (int column = 0; column < voigt_size<dim>; ++column) {
      Cell<TypeParam> more = rest, less = rest;
      more.step(h * Voigt<dim>::Unit(column));
      less.step(-h * Voigt<dim>::Unit(column));
      const Voigt<dim> derivative = (more.state.stress - less.state.stress) / (2.0 * h);
      const double error = (derivative - tangent.col(column)).norm() / tangent.norm();
      // 3.3e-12: the density's curvature leaves h^2/6, the 1 in rho/rho0 rounding
      EXPECT_LT(error, 6e-12);
    }
  }
}

TYPED_TEST(TheLaw, RestsUnderPressureAtItsDensity) {
  constexpr int dim = TypeParam::dimension;
  for (const double p : pressures_MPa) {
    Cell<TypeParam> cell(15.0, p);
    const double mass = cell.state.mass;
    for (int step = 0; step < 10; ++step) cell.step(Voigt<dim>::Zero());
    EXPECT_LT((cell.state.stress - isotropic<dim>(p)).norm(), 6e-13);  // 3.0e-13
    EXPECT_EQ(cell.state.mass, mass);
  }
}

TYPED_TEST(TheLaw, IsStretchedToPressureAndDensityByItsEquilibriumStrain) {
  constexpr int dim = TypeParam::dimension;
  constexpr int steps = 7;
  for (const double p : pressures_MPa) {
    Cell<TypeParam> cell(15.0);
    const Voigt<dim> strain = as_strain<dim>(TypeParam::equilibrium_strain(cell.k, p));
    for (int step = 0; step < steps; ++step) cell.step(strain / steps);
    EXPECT_LT((cell.state.stress - isotropic<dim>(p)).norm(), 2.5e-12);  // 1.4e-12
    // elastic_growth takes the density from the small strain: half its square apart
    const double density = cell.state.mass / (rho0 * cell.V), trace = strain.template head<dim>().sum();
    EXPECT_NEAR(density / TypeParam::density_ratio(cell.k, p), 1.0, 0.51 * trace * trace + 1e-15);
  }
}

/// The strain that leaves the stress as it is, found with the tangent, against the closed form.
TYPED_TEST(TheLaw, GrowsUnderConstantPressureAtTheRateOfTheClosedForm) {
  constexpr int dim = TypeParam::dimension;
  constexpr double dt_h = 1e-7, lambda_over_rho0 = 400.0;
  std::vector<std::pair<double, double>> pressures_and_yields{{0.7, 0.3}, {2.0, 1.9}, {0.3, 0.7}};
  for (const double p : pressures_MPa) pressures_and_yields.emplace_back(p, 0.0);
  for (const auto& [p, yield] : pressures_and_yields) {
    Cell<TypeParam> cell(15.0, p);
    const VoigtMat<dim> softness = TypeParam::tangent(cell.k).inverse();
    Voigt<dim> rate;
    for (int step = 0; step < 5; ++step) {
      Voigt<dim> strain = Voigt<dim>::Zero();
      Cell<TypeParam> after = cell;
      for (int iteration = 0; iteration < 20; ++iteration) {
        after = cell;
        after.step(strain, dt_h, lambda_over_rho0 * rho0, yield);
        strain += softness * (isotropic<dim>(p) - after.state.stress);
      }
      cell = after;
      rate = strain / dt_h;
    }
    const Voigt<dim> closed_form = as_strain<dim>(TypeParam::growth_rate(cell.k, p, lambda_over_rho0, yield));
    // the mass source of a step is explicit in pressure_deviator, which leaves dt lambda/rho0 = 4.0e-5; without growth
    // the rounding of a stress, over E and dt, leaves 2.1e-9 /h
    EXPECT_LT((rate - closed_form).norm(), 4.2e-5 * closed_form.norm() + 4e-9);
  }
}

TYPED_TEST(TheLaw, IsHyperbolicInTheTissuesInWhichItSaysSo) {
  constexpr int dim = TypeParam::dimension;
  const auto hyperbolic = [](double ratio) {
    return scan_acoustic_tensor<dim>(TypeParam::tangent(stiffness<dim>(with_ratio(ratio)))).hyperbolic;
  };
  bool everywhere = true;
  for (double ratio = 1.0; ratio <= 50.0; ratio *= 1.01) everywhere = everywhere && hyperbolic(ratio);
  EXPECT_TRUE(hyperbolic(1.0));
  EXPECT_EQ(everywhere, TypeParam::always_hyperbolic);
}

TEST(TissueLaws, AreKnownByTheirNames) {
  std::set<std::string_view> names;
  for (const TissueLawEntry& law : tissue_laws) {
    EXPECT_TRUE(names.insert(law.name).second) << "two laws are called " << law.name;
    EXPECT_EQ(from_name<TissueLaw>(law.name), law.value);
    EXPECT_EQ(entry_of(law.value).name, law.name);
    EXPECT_FALSE(law.meaning.empty() || law.source.empty());
    EXPECT_EQ(visit_law<2>(law.value, []<class Law>(Law) { return Law::name; }), law.name);
    EXPECT_EQ(visit_law<3>(law.value, []<class Law>(Law) { return Law::name; }), law.name);
  }
  EXPECT_EQ(from_name<TissueLaw>("no_law"), std::nullopt);
}

}  // namespace
}  // namespace rootsoil
