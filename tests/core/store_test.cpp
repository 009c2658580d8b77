// SPDX-License-Identifier: MIT
#include <gtest/gtest.h>

#include <algorithm>
#include <stdexcept>
#include <vector>

#include "root_sph/core/particle_store.hpp"
#include "tests/support/clouds.hpp"

namespace rootsoil {
namespace {

using test::Random;

// A column cannot be declared without a rule for division: the call does not compile.
template <class Store>
concept DeclaresWithRule = requires(Store& store, FieldInfo info) {
  store.template declare<double>(info, on_division::halve<2, double>);
};
template <class Store>
concept DeclaresWithoutRule = requires(Store& store, FieldInfo info) {
  store.template declare<double>(info);
};
static_assert(DeclaresWithRule<ParticleStore<2>>);
static_assert(!DeclaresWithoutRule<ParticleStore<2>>);

template <class Dimension>
class Store : public testing::Test {
 protected:
  static constexpr int Dim = Dimension::value;

  /// Every column of every cell gets its own number.
  static void number(ParticleStore<Dim>& store) {
    double next = 1.0;
    for (const auto& field : store.fields()) {
      for (double& x : field->reals()) x = next++;
      for (std::int64_t& x : field->integers()) x = static_cast<std::int64_t>(next++);
    }
  }
};
TYPED_TEST_SUITE(Store, test::BothDimensions, test::DimensionName);

TYPED_TEST(Store, RefusesAFieldWithANullRule) {
  ParticleStore<TypeParam::value> store;
  const std::size_t fields = store.fields().size();
  EXPECT_THROW(store.template declare<double>({"new", "1", ""}, nullptr), std::logic_error);
  EXPECT_EQ(store.fields().size(), fields);
}

TYPED_TEST(Store, RefusesANameTwice) {
  constexpr int dim = TypeParam::value;
  ParticleStore<dim> store;
  EXPECT_THROW(store.template declare<double>({"volume", "1", ""}, on_division::copy<dim, double>), std::logic_error);
}

/// Cells at rest keep every number, whatever is sorted and divided before them, and come back.
TYPED_TEST(Store, CellsAtRestKeepEveryNumber) {
  constexpr int dim = TypeParam::value;
  ParticleStore<dim> store;
  store.resize(5);
  this->number(store);
  for (std::size_t i = 0; i < 5; ++i) {
    store.cell_id[i] = static_cast<std::int64_t>(i);
    store.shape[i].setIdentity();
  }
  const auto volume_of = [&](std::int64_t id) {
    const auto& ids = store.cell_id.values();
    const auto found = std::find(ids.begin(), ids.end(), id);
    return store.volume[static_cast<std::size_t>(found - ids.begin())];
  };
  const double third = volume_of(3), fourth = volume_of(4);
  store.rest(2);
  EXPECT_EQ(store.size(), 3u);
  EXPECT_EQ(store.total(), 5u);
  EXPECT_EQ(store.active(store.volume).size(), 3u);
  store.permute({2, 0, 1});
  EXPECT_EQ(store.cell_id[0], 2);
  store.divide(1, Vec<dim>::UnitX(), 2.0, 10, 11);
  EXPECT_EQ(store.size(), 4u);
  EXPECT_EQ(store.total(), 6u);
  EXPECT_EQ(store.cell_id[1], 10);
  EXPECT_EQ(store.cell_id[3], 11);
  EXPECT_EQ(store.parent_id[3], 0);
  EXPECT_EQ(volume_of(3), third);
  EXPECT_EQ(volume_of(4), fourth);
  store.wake();
  EXPECT_EQ(store.size(), 6u);
  std::vector<std::int64_t> ids = store.cell_id.values();
  std::sort(ids.begin(), ids.end());
  EXPECT_EQ(ids, (std::vector<std::int64_t>{1, 2, 3, 4, 10, 11}));
}

TYPED_TEST(Store, NewCellsAndNewColumnsAreZero) {
  constexpr int dim = TypeParam::value;
  ParticleStore<dim> store;
  store.resize(3);
  store.template declare<Mat<dim>>({"late", "1", ""}, on_division::copy<dim, Mat<dim>>);
  store.resize(5);
  for (const auto& field : store.fields()) {
    const auto reals = field->reals();
    const auto integers = field->integers();
    EXPECT_EQ(reals.size() + integers.size(), 5u * static_cast<std::size_t>(field->components())) << field->info().name;
    EXPECT_TRUE(std::all_of(reals.begin(), reals.end(), [](double x) { return x == 0.0; })) << field->info().name;
    EXPECT_TRUE(std::all_of(integers.begin(), integers.end(), [](auto x) { return x == 0; })) << field->info().name;
  }
}

TYPED_TEST(Store, PermuteMovesWholeCells) {
  constexpr int dim = TypeParam::value;
  constexpr std::size_t cells = 50;
  ParticleStore<dim> store, sorted;
  store.template declare<Vec<dim>>({"extra", "1", ""}, on_division::copy<dim, Vec<dim>>);
  sorted.template declare<Vec<dim>>({"extra", "1", ""}, on_division::copy<dim, Vec<dim>>);
  for (ParticleStore<dim>* s : {&store, &sorted}) {
    s->resize(cells);
    this->number(*s);
  }
  const std::vector<std::int64_t> new_to_old = Random(3).permutation(cells);
  sorted.permute(new_to_old);
  for (std::size_t f = 0; f < store.fields().size(); ++f) {
    FieldBase<dim>& before = *store.fields()[f];
    FieldBase<dim>& after = *sorted.fields()[f];
    const auto components = static_cast<std::size_t>(before.components());
    for (std::size_t k = 0; k < cells; ++k) {
      const auto old = static_cast<std::size_t>(new_to_old[k]);
      for (std::size_t c = 0; c < components; ++c) {
        if (before.is_integer()) {
          EXPECT_EQ(after.integers()[components * k + c], before.integers()[components * old + c]);
        } else {
          EXPECT_EQ(after.reals()[components * k + c], before.reals()[components * old + c]);
        }
      }
    }
  }
}

TYPED_TEST(Store, RefusesAPermutationOfAnotherSize) {
  ParticleStore<TypeParam::value> store;
  store.resize(3);
  EXPECT_THROW(store.permute({0, 1}), std::logic_error);
}

TYPED_TEST(Store, CountsTheBytesOfItsColumns) {
  constexpr int dim = TypeParam::value;
  ParticleStore<dim> store;
  const std::size_t before = store.bytes_per_cell();
  store.template declare<Mat<dim>>({"extra", "1", ""}, on_division::copy<dim, Mat<dim>>);
  EXPECT_EQ(store.bytes_per_cell(), before + 8u * dim * dim);
}

}  // namespace
}  // namespace rootsoil
