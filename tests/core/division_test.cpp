// SPDX-License-Identifier: MIT
// Division of a tissue that has every field a scene can ask for (the paper's 4.2).
#include "root_sph/effects/division/division.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <memory>
#include <stdexcept>
#include <string>
#include <vector>

#include "root_sph/core/symmetric.hpp"
#include "root_sph/dynamics/cell_axes.hpp"
#include "root_sph/model/model.hpp"
#include "tests/support/block.hpp"
#include "tests/support/every_effect.hpp"

namespace rootsoil {
namespace {

using test::Random;

template <int Dim>
struct FullTissue {
  std::unique_ptr<Model<Dim>> model =
      build_model<Dim>(read_scene(test::every_effect, test::in_dimension(Dim)),
                       {.make_soil = [](const Scene&, const SoilStart&) { return std::make_unique<test::NoSoil>(); }});
  Solver<Dim>& solver = model->solver;

  FullTissue() {
    ParticleStore<Dim>& cells = solver.tissue().cells;
    cells.resize(9);

    Random random(7);
    for (const auto& field : cells.fields()) {
      for (double& x : field->reals()) x = random.uniform(0.5, 2.0);
      for (std::int64_t& x : field->integers()) x = static_cast<std::int64_t>(random.index(1000));
    }
    for (std::size_t i = 0; i < cells.size(); ++i) {
      Vec<Dim> lengths = Vec<Dim>::Constant(0.01);
      lengths[0] = 0.03;
      if constexpr (Dim == 3) lengths[2] = 0.02;
      cells.shape[i] = test::ellipsoid<Dim>(lengths, random.rotation<Dim>());
      cells.frame[i] = random.rotation<Dim>();
    }
  }

  ParticleStore<Dim>& cells() { return solver.tissue().cells; }
  LongestAxis<Dim> divide(std::size_t mother) {
    const LongestAxis<Dim> axis = longest_axis<Dim>(cells().shape[mother]);
    cells().divide(mother, axis.direction, axis.length_mm, 5000, 5001);
    return axis;
  }
};

/// The numbers of one cell in every column.
template <int Dim>
std::map<std::string, std::vector<double>> numbers_of(const ParticleStore<Dim>& cells, std::size_t cell) {
  std::map<std::string, std::vector<double>> all;
  for (const auto& field : cells.fields()) {
    std::vector<double>& values = all[field->info().name];
    const auto n = static_cast<std::size_t>(field->components());
    for (std::size_t c = n * cell; c < n * (cell + 1); ++c) {
      values.push_back(field->is_integer() ? static_cast<double>(field->integers()[c]) : field->reals()[c]);
    }
  }
  return all;
}

template <class Dimension>
class CellDivision : public testing::Test {};
TYPED_TEST_SUITE(CellDivision, test::BothDimensions, test::DimensionName);

TYPED_TEST(CellDivision, IsLookedAtWithEveryEffectOfTheTable) {
  const Scene scene = read_scene(test::every_effect, test::in_dimension(TypeParam::value));
  for (const EffectSpec& effect : effect_table()) {
    EXPECT_TRUE(effect.called_for(scene)) << "call for '" << effect.name << "' by " << effect.called_by;
  }
}

/// A column that is missing here fails the test: who adds a column says what division does to it.
TYPED_TEST(CellDivision, EveryFieldFollowsItsRule) {
  constexpr int dim = TypeParam::value;
  FullTissue<dim> full;
  auto& cells = full.cells();
  const auto mother = numbers_of<dim>(cells, 4);
  full.divide(4);
  ASSERT_EQ(cells.size(), 10u);
  const auto first = numbers_of<dim>(cells, 4), second = numbers_of<dim>(cells, 9);

  const std::vector<std::string> copied{"velocity",
                                        "material_stress",
                                        "frame",
                                        "clamped",
                                        "slip wall",
                                        "probe p",
                                        "deviatoric_stress",
                                        "asleep",
                                        "neighbours_at_rest",
                                        "looked_at",
                                        "strain_since_look",
                                        "stress_asleep"};
  const std::vector<std::string> halved{"volume", "mass", "contact wall", "soil force", "soil force asleep"};
  const std::vector<std::string> checked_elsewhere{"position", "shape",     "distance_to_tip", "generation",
                                                   "cell_id",  "parent_id", "window_index"};
  for (const auto& field : cells.fields()) {
    const std::string& name = field->info().name;
    const auto in = [&](const std::vector<std::string>& names) {
      return std::find(names.begin(), names.end(), name) != names.end();
    };
    if (in(copied)) {
      EXPECT_EQ(first.at(name), mother.at(name)) << name;
      EXPECT_EQ(second.at(name), mother.at(name)) << name;
    } else if (in(halved)) {
      for (std::size_t c = 0; c < mother.at(name).size(); ++c) {
        EXPECT_EQ(first.at(name)[c], 0.5 * mother.at(name)[c]) << name;
        EXPECT_EQ(second.at(name)[c], 0.5 * mother.at(name)[c]) << name;
      }
    } else if (!in(checked_elsewhere)) {
      EXPECT_EQ(field->info().storage, Storage::scratch) << "say here what division does to '" << name << "'";
    }
  }
  for (const auto& names : {copied, halved, checked_elsewhere}) {
    for (const std::string& name : names) EXPECT_NE(cells.find(name), nullptr) << name;
  }
}

TYPED_TEST(CellDivision, KeepsMassVolumeMomentumCentroidAndStress) {
  constexpr int dim = TypeParam::value;
  FullTissue<dim> full;
  auto& cells = full.cells();
  struct Sums {
    double mass = 0.0, volume = 0.0;
    Vec<dim> momentum = Vec<dim>::Zero(), centroid = Vec<dim>::Zero(), mass_centre = Vec<dim>::Zero();
    Mat<dim> stress = Mat<dim>::Zero();
  };
  const auto sums = [&] {
    Sums s;
    for (std::size_t i = 0; i < cells.size(); ++i) {
      s.mass += cells.mass[i];
      s.volume += cells.volume[i];
      s.momentum += cells.mass[i] * cells.velocity[i];
      s.centroid += cells.volume[i] * cells.position[i];
      s.mass_centre += cells.mass[i] * cells.position[i];
      s.stress += cells.volume[i] * cells.frame[i] * to_matrix<dim>(cells.stress[i]) * cells.frame[i].transpose();
    }
    return s;
  };
  const Sums before = sums();
  for (const std::size_t mother : {0, 4, 8, 4, 9}) full.divide(mother);
  const Sums after = sums();
  constexpr double rounding = 1e-14;  // relative; sums of about ten numbers
  EXPECT_NEAR(after.mass, before.mass, rounding * before.mass);
  EXPECT_NEAR(after.volume, before.volume, rounding * before.volume);
  EXPECT_LT((after.momentum - before.momentum).norm(), rounding * before.momentum.norm());
  EXPECT_LT((after.centroid - before.centroid).norm(), rounding * before.centroid.norm());
  EXPECT_LT((after.mass_centre - before.mass_centre).norm(), rounding * before.mass_centre.norm());
  EXPECT_LT((after.stress - before.stress).norm(), 3.0 * rounding * before.stress.norm());
}

TYPED_TEST(CellDivision, PutsDaughtersHalfASemiAxisFromTheCentre) {
  constexpr int dim = TypeParam::value;
  FullTissue<dim> full;
  auto& cells = full.cells();
  const Vec<dim> centre = cells.position[4];
  const LongestAxis<dim> axis = full.divide(4);
  EXPECT_NEAR(axis.length_mm, 0.03, 1e-15);
  // half of the semi-axis of 0.015
  EXPECT_LT((cells.position[4] - centre - 0.0075 * axis.direction).norm(), 1e-15);
  EXPECT_LT((cells.position[9] - centre + 0.0075 * axis.direction).norm(), 1e-15);
}

TYPED_TEST(CellDivision, HalvesTheLongestAxisAndKeepsTheOthers) {
  constexpr int dim = TypeParam::value;
  FullTissue<dim> full;
  auto& cells = full.cells();
  const Mat<dim> mother = cells.shape[4];
  const SymmetricEigen<dim> axes = symmetric_eigen<dim>(mother);
  full.divide(4);
  for (const std::size_t daughter : {4, 9}) {
    const Mat<dim> in_mothers_axes = axes.vectors.transpose() * cells.shape[daughter] * axes.vectors;
    Vec<dim> expected = axes.values;
    expected[0] *= 4.0;
    EXPECT_LT((in_mothers_axes - Mat<dim>(expected.asDiagonal())).norm(), 1e-12 * mother.norm());
  }
}

TYPED_TEST(CellDivision, ShiftsDistancesFromTheTipByTheOffsetAlongTheRoot) {
  constexpr int dim = TypeParam::value;
  FullTissue<dim> full;
  auto& cells = full.cells();
  const double before = cells.distance_to_tip[4];
  const Vec<dim> centre = cells.position[4];
  full.divide(4);
  for (const std::size_t daughter : {4, 9}) {
    // the frame's first axis points to the tip
    const double towards_tip = (cells.position[daughter] - centre).dot(cells.frame[daughter].col(0));
    EXPECT_NEAR(cells.distance_to_tip[daughter], before - towards_tip, 1e-15);
    EXPECT_GT(std::abs(towards_tip), 1e-4);
  }
}

TYPED_TEST(CellDivision, CountsGenerationsAndRecordsDescent) {
  constexpr int dim = TypeParam::value;
  FullTissue<dim> full;
  auto& cells = full.cells();
  const std::int64_t mother_id = cells.cell_id[4], generation = cells.generation[4];
  full.divide(4);
  EXPECT_EQ(cells.cell_id[4], 5000);
  EXPECT_EQ(cells.cell_id[9], 5001);
  for (const std::size_t daughter : {4, 9}) {
    EXPECT_EQ(cells.generation[daughter], generation + 1);
    EXPECT_EQ(cells.parent_id[daughter], mother_id);
    EXPECT_EQ(full.solver.tissue().window_index[daughter], -1);
  }
}

TYPED_TEST(CellDivision, LeavesOtherCellsAlone) {
  constexpr int dim = TypeParam::value;
  FullTissue<dim> full;
  std::vector<std::map<std::string, std::vector<double>>> before;
  for (std::size_t i = 0; i < 9; ++i) before.push_back(numbers_of<dim>(full.cells(), i));
  full.divide(4);
  for (std::size_t i = 0; i < 9; ++i) {
    if (i == 4) continue;
    EXPECT_EQ(numbers_of<dim>(full.cells(), i), before[i]);
  }
}

TYPED_TEST(CellDivision, OfACellThatIsNotThereIsRefused) {
  FullTissue<TypeParam::value> full;
  EXPECT_THROW(full.cells().divide(9, Vec<TypeParam::value>::UnitX(), 0.1, 1, 2), std::logic_error);
}

TEST(CellsWhenDivided, HalvesEveryAxisAboveTheThreshold) {
  const auto cells = [](double along, double across, double threshold) {
    Mat<3> shape = 4.0 / (across * across) * Mat<3>::Identity();
    shape(0, 0) = 4.0 / (along * along);
    return cells_when_divided<3>(shape, threshold);
  };
  EXPECT_EQ(cells(0.9, 0.9, 1.0), 1.0);
  EXPECT_EQ(cells(1.1, 0.9, 1.0), 2.0);
  EXPECT_EQ(cells(1.9, 1.9, 1.0), 8.0);
  EXPECT_EQ(cells(7.9, 0.9, 1.0), 8.0);
  EXPECT_EQ(cells(1000.0, 1000.0, 1.0), std::pow(1024.0, 3));
}

}  // namespace
}  // namespace rootsoil
