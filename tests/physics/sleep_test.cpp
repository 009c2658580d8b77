// SPDX-License-Identifier: MIT
// Mature tissue that sleeps: the root that moves does not notice, and wakes when it must.
#include "harness.hpp"

namespace rootsoil::physics {
namespace {

/// Two thirds of it are mature from the start.
const std::string mature_case = R"(
[scene]
name = "mature"
duration_h = 5
[root]
length_mm = 0.9
radius_mm = 0.03
cell_size_mm = 0.01
[tissue]
E_axial_MPa = 1020
[growth]
lambda0_ug_mm3_h = 4.3e5
x_g_mm = -0.05
s_g_mm = 0.1
c_g = -1
mature_at_mm = 0.15
mature_width_mm = 0.05
[division]
l0_mm = 0.012
c_d = 1
s_d_per_mm2 = 45
x_d_mm = 0.12
constant_beyond_mm = 0.5
[non_affine_control]
[numerics]
step_h = 2e-4
[output]
every_h = 1
)";
const std::string steady = "[pressure]\ndifferential_MPa = 1\n";

template <int Dim>
class Sleeping : public SceneRun<Dim> {
 public:
  explicit Sleeping(const std::string& more, const std::vector<std::string>& overrides = {})
      : SceneRun<Dim>(mature_case + more, overrides) {}

  std::size_t at_rest() const { return this->tissue.cells.total() - this->tissue.cells.size(); }
};

const std::string sleep = "[sleep]\n";

/// From a cell of the one to the nearest of the other: ids depend on the order in which cells divide.
template <int Dim>
double largest_distance_mm(const Sleeping<Dim>& a, const Sleeping<Dim>& b) {
  EXPECT_EQ(a.tissue.cells.total(), b.tissue.cells.total());
  double largest = 0.0;
  for (const Vec<Dim>& x : a.tissue.cells.position.values()) {
    double nearest = std::numeric_limits<double>::infinity();
    for (const Vec<Dim>& y : b.tissue.cells.position.values()) nearest = std::min(nearest, (x - y).norm());
    largest = std::max(largest, nearest);
  }
  return largest;
}

template <int Dim>
void expect_the_same_growth(const std::vector<std::string>& overrides, double hours) {
  Sleeping<Dim> awake(steady, overrides), asleep(steady + sleep, overrides);
  awake.advance_to(hours);
  asleep.advance_to(hours);
  const double share = static_cast<double>(asleep.at_rest()) / static_cast<double>(asleep.tissue.cells.total());
  const double cell_mm = awake.scene.root.cell_size_mm;
  double of_distance_mm = 0.0;  // distances of cells at rest go on as well
  for (std::size_t i = 0; i < asleep.tissue.cells.total(); ++i) {
    const double s = asleep.solver.axis().tip_mm()[0] - asleep.tissue.cells.position[i][0];
    of_distance_mm = std::max(of_distance_mm, std::abs(asleep.tissue.cells.distance_to_tip[i] - s));
  }
  record("cells at rest/all", share);
  EXPECT_GT(share, 0.3);
  expect_within_record("largest difference of a cell's place (cells)", largest_distance_mm(awake, asleep) / cell_mm);
  expect_within_record("difference of length (cells)",
                       (asleep.solver.axis().length_mm() - awake.solver.axis().length_mm()) / cell_mm);
  expect_within_record("largest error of a distance from the tip (cells)", of_distance_mm / cell_mm);
}

/// What the tolerance allows: 1e-4 /h over an hour and the 50 cells that sleep.
TEST(Sleep, TheRootGrowsAndDividesAsIfAllWereAwake) { expect_the_same_growth<2>({}, 1.0); }

/// A step is long: cells fall asleep in several batches, and distances of those at rest must not lag behind.
TEST(Sleep, WithoutInertia) {
  expect_the_same_growth<2>({"numerics.stepper=quasi_static", "numerics.step_h=0.05"}, 2.0);
}

/// The start rings more in 3D, in the mature part as well, until it sleeps.
TEST(Sleep, In3D) {
  expect_the_same_growth<3>({"scene.dimension=3", "root.cell_size_mm=0.015", "root.length_mm=1.2", "numerics.eta=1.3"},
                            0.3);
}

/// A change of the pressure differential wakes all cells, and they take up the new stress.
TEST(Sleep, AChangeOfPressureWakesIt) {
  Sleeping<2> run("[pressure]\ntable = [[0, 1], [0.3, 1], [0.8, 0.5]]\n" + sleep);
  std::size_t most = 0;
  bool woke = false;
  run.advance_to(0.3, [&] { most = std::max(most, run.at_rest()); });
  ASSERT_GT(most, 300u);
  run.advance_to(0.4, [&] { woke = woke || run.at_rest() == 0; });
  EXPECT_TRUE(woke);
  run.advance_to(2.0);
  EXPECT_GT(run.at_rest(), 300u);  // and it sleeps again
  double sum = 0.0, n = 0.0;
  for (std::size_t i = 0; i < run.tissue.cells.total(); ++i) {
    if (run.tissue.is_base(i) || run.tissue.cells.distance_to_tip[i] > 0.8) continue;
    sum += run.tissue.cells.stress[i][0];
    n += 1.0;
  }
  expect_within_record("axial stress/pressure - 1", sum / n / 0.5 - 1.0);
}

/// A plate in the tip's way: thrust goes through the whole root, which must wake to carry it.
TEST(Sleep, ThrustWakesIt) {
  const std::string plate = steady + R"(
[[obstacle]]
name = "plate"
shape = "plane"
position_mm = [0.91, 0.0]
normal = [-1.0, 0.0]
friction = 0.5
)";
  Sleeping<2> awake(plate), asleep(plate + sleep);
  std::size_t most = 0;
  bool woke = false;
  asleep.advance_to(0.6, [&] {
    most = std::max(most, asleep.at_rest());
    woke = woke || (most > 0 && asleep.at_rest() == 0);
  });
  awake.advance_to(0.6);
  const auto force = [](const Sleeping<2>& run) {
    double sum = 0.0;
    for (const auto& effect : run.model->effects) sum -= effect->contact_force_N()[0];
    return sum;
  };
  record("force awake (N/mm)", force(awake));
  EXPECT_GT(most, 300u);
  EXPECT_TRUE(woke);
  ASSERT_GT(force(awake), 0.01);
  expect_within_record("force asleep/awake - 1", force(asleep) / force(awake) - 1.0);
}

}  // namespace
}  // namespace rootsoil::physics
