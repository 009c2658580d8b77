// SPDX-License-Identifier: MIT
#include "root_sph/tissue/elasticity.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "tests/support/clouds.hpp"

namespace rootsoil {
namespace {

using test::Random;

const std::vector<ElasticConstants> tissues{{1020.0, 1020.0, 0.06, 0.3, 481.0},
                                            {1020.0, 15000.0, 0.06, 0.3, 481.0},
                                            {1020.0, 51000.0, 0.06, 0.2, 85000.0},
                                            {200.0, 150.0, 0.35, 0.4, 60.0}};

/// Of Gaussian elimination: all pivots of a symmetric matrix are positive where it is positive definite, and only
/// there.
template <class Matrix>
double smallest_pivot(Matrix m) {
  double smallest = m(0, 0);
  for (Eigen::Index k = 0; k < m.rows(); ++k) {
    smallest = std::min(smallest, m(k, k));
    for (Eigen::Index row = k + 1; row < m.rows(); ++row) m.row(row) -= m(row, k) / m(k, k) * m.row(k);
  }
  return smallest;
}

template <class Dimension>
class Elasticity : public testing::Test {};
TYPED_TEST_SUITE(Elasticity, test::BothDimensions, test::DimensionName);

TEST(Compliance2D, HasTheEntriesOfEquation4InItsPlaneForm) {
  const VoigtMat<2> s = compliance<2>({1000.0, 4000.0, 0.06, 0.3, 500.0});
  VoigtMat<2> expected;
  expected << 1.0e-3, -6.0e-5, 0.0,  //
      -6.0e-5, 2.5e-4, 0.0,          //
      0.0, 0.0, 2.0e-3;
  EXPECT_LT((s - expected).norm(), 1e-18);
}

TEST(Compliance3D, HasTheEntriesOfEquation4) {
  const VoigtMat<3> s = compliance<3>({1000.0, 4000.0, 0.06, 0.3, 500.0});
  VoigtMat<3> expected = VoigtMat<3>::Zero();
  expected.topLeftCorner<3, 3>() << 1.0e-3, -6.0e-5, -6.0e-5,  //
      -6.0e-5, 2.5e-4, -7.5e-5,                                //
      -6.0e-5, -7.5e-5, 2.5e-4;
  expected(3, 3) = 2.0 * 1.3 / 4000.0;  // the plane of isotropy: 2 (1 + nu_R)/E_R
  expected(4, 4) = expected(5, 5) = 2.0e-3;
  EXPECT_LT((s - expected).norm(), 1e-18);
}

TYPED_TEST(Elasticity, StiffnessTimesComplianceIsOne) {
  constexpr int dim = TypeParam::value;
  for (const ElasticConstants& constants : tissues) {
    const VoigtMat<dim> product = elastic_tangent<dim>(stiffness<dim>(constants)) * compliance<dim>(constants);
    EXPECT_LT((product - VoigtMat<dim>::Identity()).norm(), 1e-13);
  }
}

TYPED_TEST(Elasticity, VolumeStrainIsTheTraceOfTheElasticStrain) {
  constexpr int dim = TypeParam::value;
  Random random(1);
  for (const ElasticConstants& constants : tissues) {
    const Stiffness<dim> k = stiffness<dim>(constants);
    for (int trial = 0; trial < 10; ++trial) {
      const Voigt<dim> strain = random.matrix<Voigt<dim>>();
      EXPECT_NEAR(volume_strain<dim>(k, elastic_stress<dim>(k, strain)), strain.template head<dim>().sum(), 1e-12);
    }
  }
}

TYPED_TEST(Elasticity, BulkModulusIsOneOverTheSumOfTheNormalBlock) {
  constexpr int dim = TypeParam::value;
  for (const ElasticConstants& constants : tissues) {
    const double sum = compliance<dim>(constants).template topLeftCorner<dim, dim>().sum();
    EXPECT_NEAR(bulk_modulus<dim>(stiffness<dim>(constants)), 1.0 / sum, 1e-12 / sum);
  }
}

TYPED_TEST(Elasticity, IsotropicTissueHasTheUsualBulkModulus) {
  constexpr int dim = TypeParam::value;
  const Stiffness<dim> k = stiffness<dim>({1020.0, 1020.0, 0.3, 0.3, 1020.0 / 2.6});
  // 3D E/(3 (1 - 2 nu)); plane form E/(2 (1 - nu))
  EXPECT_NEAR(bulk_modulus<dim>(k), dim == 2 ? 1020.0 / 1.4 : 1020.0 / 1.2, 1e-10);
}

TYPED_TEST(Elasticity, DeviatorHasNoTraceAndKeepsShear) {
  constexpr int dim = TypeParam::value;
  const Voigt<dim> s = Random(2).matrix<Voigt<dim>>();
  const Voigt<dim> d = deviator<dim>(s);
  EXPECT_NEAR(d.template head<dim>().sum(), 0.0, 1e-15);
  EXPECT_EQ(d.template tail<voigt_size<dim> - dim>(), s.template tail<voigt_size<dim> - dim>());
  // what was taken away is isotropic
  const double taken = s[0] - d[0];
  for (int a = 1; a < dim; ++a) EXPECT_NEAR(s[a] - d[a], taken, 1e-15);
  EXPECT_NEAR(taken, s.template head<dim>().sum() / dim, 1e-15);
}

TYPED_TEST(Elasticity, IsSymmetricAndPositive) {
  constexpr int dim = TypeParam::value;
  for (const ElasticConstants& constants : tissues) {
    const Stiffness<dim> k = stiffness<dim>(constants);
    const VoigtMat<dim> c = elastic_tangent<dim>(k);
    EXPECT_EQ(c, VoigtMat<dim>(c.transpose()));
    EXPECT_GT(smallest_pivot(c), 0.0);
  }
}

TEST(PressureStrain, IsThatOfEquation8) {
  const ElasticConstants constants{1020.0, 5000.0, 0.06, 0.3, 481.0};
  const AxialRadial plane = pressure_strain<2>(stiffness<2>(constants), 0.7);
  EXPECT_NEAR(plane.axial, 0.7 * 0.94 / 1020.0, 1e-17);
  EXPECT_NEAR(plane.radial, 0.7 * (1.0 / 5000.0 - 0.06 / 1020.0), 1e-17);
  const AxialRadial solid = pressure_strain<3>(stiffness<3>(constants), 0.7);
  EXPECT_NEAR(solid.axial, 0.7 * 0.88 / 1020.0, 1e-17);
  EXPECT_NEAR(solid.radial, 0.7 * (0.7 / 5000.0 - 0.06 / 1020.0), 1e-17);
}

TYPED_TEST(Elasticity, RotatedTensorsKeepTheirInvariantsThroughVoigtVectors) {
  constexpr int dim = TypeParam::value;
  Random random(4);
  const Voigt<dim> s = random.matrix<Voigt<dim>>();
  const Mat<dim> m = to_matrix<dim>(s);
  EXPECT_EQ(m, Mat<dim>(m.transpose()));
  EXPECT_EQ(to_voigt<dim>(m), s);
  // work: stress vector . strain vector = sigma : epsilon, with engineering shear in the strain
  const Mat<dim> strain = to_matrix<dim>(random.matrix<Voigt<dim>>());
  EXPECT_NEAR(s.dot(to_strain_voigt<dim>(strain)), m.cwiseProduct(strain).sum(), 1e-14);
}

}  // namespace
}  // namespace rootsoil
