// SPDX-License-Identifier: MIT
#include "root_sph/effects/obstacle/obstacle.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>

#include "root_sph/core/vec3.hpp"
#include "root_sph/dynamics/cell_axes.hpp"
#include "root_sph/dynamics/nearest_cell.hpp"
#include "root_sph/exchange/tissue_shape.hpp"
#include "root_sph/scene/checks.hpp"
#include "root_sph/scene/schema_keys.hpp"

namespace rootsoil {
namespace {

/// N/mm: pressure E_c depth/(2h) on the section V/(2h).
double contact_stiffness(double contact_modulus_MPa, double volume, double half_extent_mm) {
  return contact_modulus_MPa * volume / (4.0 * half_extent_mm * half_extent_mm);
}

void complete_obstacle(ObstacleSection& obstacle, std::size_t index, const Scene& scene) {
  const Origins& origins = scene.origins;
  const std::string element = fmt::format("obstacle[{}]", index + 1);
  const int shape_dimension = obstacle.shape == ObstacleShape::disc     ? 2
                              : obstacle.shape == ObstacleShape::sphere ? 3
                                                                        : scene.scene.dimension;
  if (shape_dimension != scene.scene.dimension) {
    origins.fail(element + ".shape",
                 fmt::format("there is no {} in {} dimensions", name_of(obstacle.shape), scene.scene.dimension),
                 toml_text(std::string(name_of(obstacle.shape))),
                 scene.scene.dimension == 2 ? "plane, box, disc" : "plane, box, sphere",
                 fmt::format("use a {}", scene.scene.dimension == 2 ? "disc" : "sphere"));
  }
  if (obstacle.shape == ObstacleShape::plane) {
    check_one_of(element, "normal", "angle_deg", origins);
    if (origins.has(element + ".angle_deg")) {
      const double angle = obstacle.angle_deg * std::numbers::pi / 180;
      obstacle.normal = {-std::sin(angle), std::cos(angle), 0.0};
      obstacle.angle_deg = 0.0;
    }
    std::array<double, 3>& n = obstacle.normal;
    const double length = std::hypot(n[0], n[1], n[2]);
    constexpr double shortest = 1e-12;
    if (!(length > shortest) || !std::isfinite(length)) {
      origins.fail(element + ".normal", "the normal is too short or too long to tell its direction",
                   toml_text(Numbers(n.begin(), n.begin() + scene.scene.dimension)),
                   fmt::format("a vector longer than {}", shortest),
                   "give the direction from the plane towards the root, of any handy length: [-1, 0]");
    }
    // a unit vector is left alone, so that a resolved scene reads back bit for bit
    if (std::abs(length - 1) > 1e-14) {
      for (double& component : n) component /= length;
    }
  }
  if (!obstacle.contact_modulus_MPa) obstacle.contact_modulus_MPa = scene.tissue.E_axial_MPa;
}

void complete_obstacles(Scene& scene) {
  auto& obstacles = scene.all<ObstacleSection>();
  complete_names(obstacles, "obstacle", scene.origins);
  for (std::size_t i = 0; i < obstacles.size(); ++i) complete_obstacle(obstacles[i], i, scene);
}

// clang-format off
SectionSpec obstacle_section() {
  using namespace sections;
  using Ob = ObstacleSection;
  return section<Ob>("obstacle", repeated, "A rigid obstacle: penalty contact with Coulomb friction.", {
    key(&Ob::name, "name", "-", any_text, "For messages and outputs; unique.", "-").defaults_to("obstacle_1, ..."),
    key(&Ob::shape, "shape", "disc in 2D only, sphere in 3D only.",
        "paper S4").required(),
    key(&Ob::position_mm, "position_mm", "mm", place_mm, "A point of the plane, or the centre.", "-").required(),
    key(&Ob::normal, "normal", "-", any_number, "Direction out of the plane, towards the root; this or angle_deg.", "-")
        .only_where("shape", {"plane"}).defaults_to("none"),
    key(&Ob::angle_deg, "angle_deg", "deg", between(-360, 360),
        "Turned about z. Plane: angle between plane and x axis; 90 faces the root, normal = (-sin, cos).", "-")
        .only_where("shape", {"plane", "box"}).defaults_to("box: 0.0")
        .written_when([](const Ob& o) { return o.shape != ObstacleShape::plane; }),  // a plane's angle has become its normal
    key(&Ob::half_size_mm, "half_size_mm", "mm", above(0).up_to(1e3, microns), "Half the box's sides.", "-")
        .required().only_where("shape", {"box"}),
    key(&Ob::radius_mm, "radius_mm", "mm", above(0).up_to(1e3, microns), "Radius.", "-")
        .required().only_where("shape", {"disc", "sphere"}),
    key(&Ob::friction, "friction", "-", at_least(0), "Coulomb coefficient.", "-"),
    key(&Ob::contact_modulus_MPa, "contact_modulus_MPa", "MPa", modulus, "Stiffness of the penalty.", "-")
        .defaults_to("E_axial_MPa"),
  }).completed_by(complete_obstacles);
}
// clang-format on

template <int Dim>
RigidShape<Dim> rigid_shape(const ObstacleSection& o) {
  if (o.shape == ObstacleShape::plane) return Plane<Dim>{shortened<Dim>(o.position_mm), shortened<Dim>(o.normal)};
  if (o.shape == ObstacleShape::box) {
    const double angle = o.angle_deg * std::numbers::pi / 180.0;
    Mat<Dim> axes = Mat<Dim>::Identity();
    axes(0, 0) = axes(1, 1) = std::cos(angle);
    axes(1, 0) = std::sin(angle);
    axes(0, 1) = -axes(1, 0);
    return Box<Dim>{shortened<Dim>(o.position_mm), shortened<Dim>(o.half_size_mm), axes};
  }
  return Ball<Dim>{shortened<Dim>(o.position_mm), o.radius_mm};
}

std::string overlaps(const ObstacleSection& obstacle) {
  return fmt::format("the obstacle \"{}\" ({}) overlaps the root at the start", obstacle.name, name_of(obstacle.shape));
}

/// The penalty would push a root that begins inside an obstacle apart, or hold the obstacle in the tissue for ever.
template <int Dim>
void refuse_overlap(const Scene& scene, const Tissue<Dim>& tissue, const ObstacleSection& obstacle, std::size_t index) {
  constexpr double deepest = 0.2;  // of a cell; contact that carries a root's thrust is some 0.01 to 0.05 deep
  const auto& cells = tissue.cells;
  const RigidShape<Dim> shape = rigid_shape<Dim>(obstacle);
  std::size_t inside = 0, worst = 0;
  double worst_share = deepest, worst_mm = 0.0;
  for (std::size_t i = 0; i < cells.size(); ++i) {
    const SurfacePoint<Dim> surface = nearest_surface<Dim>(shape, cells.position[i]);
    const double h = half_extent<Dim>(cells.shape[i], surface.normal);
    const double share = (h - surface.distance_mm) / (2.0 * h);
    if (share > deepest) ++inside;
    if (share <= worst_share) continue;
    worst = i;
    worst_share = share;
    worst_mm = h - surface.distance_mm;
  }
  if (inside == 0) return;
  const Vec<Dim>& x = cells.position[worst];
  scene.origins.fail(
      fmt::format("obstacle[{}].position_mm", index + 1), overlaps(obstacle),
      fmt::format("{} of {} cells reach into it; the deepest, at ({:.4g}) mm, {:.3g} mm, {:.2g} of its width", inside,
                  cells.size(), fmt::join(x.data(), x.data() + Dim, ", "), worst_mm, worst_share),
      fmt::format("a root that touches it: no cell deeper than {} of its width", deepest),
      "move the obstacle out of the root, turn it or make it smaller; is its position in mm, and a plane's normal "
      "towards the root?");
}

/// Cells feel an obstacle where their surfaces reach it: one that fits between them is passed without a force.
template <int Dim>
void refuse_small(const Scene& scene, const Tissue<Dim>& tissue, const ObstacleSection& obstacle, std::size_t index) {
  if (obstacle.shape == ObstacleShape::plane) return;
  const bool box = obstacle.shape == ObstacleShape::box;
  const double half_mm =
      box ? *std::min_element(obstacle.half_size_mm.begin(), obstacle.half_size_mm.begin() + Dim) : obstacle.radius_mm;
  const double cell_mm = median_cell_size_mm<Dim>(tissue.cells.volume.values());
  constexpr double rounding = 1 + 1e-9;
  if (2.0 * half_mm * rounding >= cell_mm) return;
  scene.origins.fail(fmt::format("obstacle[{}].{}", index + 1, box ? "half_size_mm" : "radius_mm"),
                     fmt::format("the obstacle \"{}\" ({}) is smaller than a cell: it would slip through between them",
                                 obstacle.name, name_of(obstacle.shape)),
                     fmt::format("{} mm; cells are {:.3g} mm large", half_mm, cell_mm),
                     fmt::format("at least half a cell, {:.3g} mm", 0.5 * cell_mm),
                     "make it larger, or take smaller cells; is it in mm?");
}

/// No cell need reach deep into an obstacle whose centre lies between cells.
template <int Dim>
void refuse_inside(const Scene& scene, const Tissue<Dim>& tissue, const ObstacleSection& obstacle, std::size_t index) {
  if (obstacle.shape == ObstacleShape::plane) return;
  const Vec<Dim> centre = shortened<Dim>(obstacle.position_mm);
  const double nearest = nearest_cell<Dim>(tissue, centre).cell_lengths;
  const double inside = 0.5 * std::sqrt(static_cast<double>(Dim));  // where the corners of four (3D: eight) cells meet
  if (nearest >= inside) return;
  scene.origins.fail(fmt::format("obstacle[{}].position_mm", index + 1), overlaps(obstacle),
                     fmt::format("its centre ({:.4g}) mm lies in the tissue, {:.2g} cell lengths from a cell",
                                 fmt::join(centre.data(), centre.data() + Dim, ", "), nearest),
                     "an obstacle whose centre lies outside the root",
                     "move the obstacle out of the root; is its position in mm?");
}

}  // namespace

template <int Dim>
Vec<Dim> contact_force(const SurfacePoint<Dim>& surface, double half_extent_mm, double volume, double friction,
                       double contact_modulus_MPa, Vec<Dim>& slip_mm, std::optional<double> sliding_N) {
  const double depth = half_extent_mm - surface.distance_mm;
  if (depth <= 0.0) {
    slip_mm.setZero();
    return Vec<Dim>::Zero();
  }
  const double k = contact_stiffness(contact_modulus_MPa, volume, half_extent_mm);
  const double normal = k * depth;
  slip_mm -= slip_mm.dot(surface.normal) * surface.normal;
  const double tangential = k * slip_mm.norm(), most = sliding_N.value_or(friction * normal);
  if (tangential > most) slip_mm *= most / tangential;
  return normal * surface.normal - k * slip_mm;
}

template <int Dim>
ObstacleEffect<Dim>::ObstacleEffect(Solver<Dim>& solver, ObstacleParameters<Dim> parameters)
    : parameters_(std::move(parameters)),
      solver_(solver),
      slip_(solver.tissue().cells.template declare<Vec<Dim>>(
          {"slip " + parameters_.name, "mm", "tangential displacement since contact began"},
          on_division::copy<Dim, Vec<Dim>>)),
      force_(solver.tissue().cells.template declare<Vec<Dim>>(
          {"contact " + parameters_.name, "N", "force of the obstacle on the cell", Storage::scratch},
          on_division::halve<Dim, Vec<Dim>>)),
      sliding_(solver.tissue().inertia ? nullptr
                                       : &solver.tissue().cells.template declare<double>(
                                             {"sliding " + parameters_.name, "N", "what friction can carry"},
                                             on_division::halve<Dim, double>)) {
  const std::string name = "obstacle " + parameters_.name;
  solver.hooks().operators.emplace_back(name, [this](Tissue<Dim>& t) { find_near_cells(t); });
  solver.hooks().stiffness.emplace_back(name,
                                        [this](Tissue<Dim>& t, std::vector<Vec<Dim>>& k) { bound_stiffness(t, k); });
  solver.hooks().contact_stiffness.emplace_back(
      name, [this](Tissue<Dim>& t, std::vector<Mat<Dim>>& k) { add_stiffness(t, k); });
  solver.hooks().forces.emplace_back(name, [this](Tissue<Dim>& t, SlipAdvance advance) { add_forces(t, advance); });
  if (sliding_ && parameters_.friction > 0.0) {
    solver.hooks().friction.emplace_back(name, [this](Tissue<Dim>& t, bool& matters) { adapt_friction(t, matters); });
  }
}

template <int Dim>
void ObstacleEffect<Dim>::find_near_cells(Tissue<Dim>& tissue) {
  auto& cells = tissue.cells;
  near_.clear();
  for (std::size_t i = 0; i < cells.size(); ++i) {
    force_[i].setZero();
    const SurfacePoint<Dim> surface = nearest_surface<Dim>(parameters_.shape, cells.position[i]);
    const double h = half_extent<Dim>(cells.shape[i], surface.normal);
    // twice what the cell moves in the window at its present speed, and half a cell
    const double margin = 2.0 * solver_.window_h() * cells.velocity[i].norm() + h;
    if (surface.distance_mm > h + margin) {
      slip_[i].setZero();
      if (sliding_) (*sliding_)[i] = 0.0;
      continue;
    }
    near_.push_back(i);
  }
}

template <int Dim>
void ObstacleEffect<Dim>::bound_stiffness(const Tissue<Dim>& tissue, std::vector<Vec<Dim>>& stiffness) const {
  const auto& cells = tissue.cells;
  for (const std::size_t i : near_) {
    const SurfacePoint<Dim> surface = nearest_surface<Dim>(parameters_.shape, cells.position[i]);
    const double h = half_extent<Dim>(cells.shape[i], surface.normal);
    stiffness[i].array() += contact_stiffness(parameters_.contact_modulus_MPa, cells.volume[i], h);
  }
}

/// Of the cells that touch now: along the normal, and along the surface where friction holds.
template <int Dim>
void ObstacleEffect<Dim>::add_stiffness(const Tissue<Dim>& tissue, std::vector<Mat<Dim>>& stiffness) const {
  const auto& cells = tissue.cells;
  for (const std::size_t i : near_) {
    if (force_[i].isZero(0.0)) continue;
    const SurfacePoint<Dim> surface = nearest_surface<Dim>(parameters_.shape, cells.position[i]);
    const double h = half_extent<Dim>(cells.shape[i], surface.normal);
    const double k = contact_stiffness(parameters_.contact_modulus_MPa, cells.volume[i], h);
    const Mat<Dim> along_normal = surface.normal * surface.normal.transpose();
    stiffness[i] += k * along_normal;
    const double tangential = (force_[i] - along_normal * force_[i]).norm();
    if (tangential < (1.0 - 1e-9) * (*sliding_)[i]) stiffness[i] += k * (Mat<Dim>::Identity() - along_normal);
  }
}

template <int Dim>
void ObstacleEffect<Dim>::add_forces(Tissue<Dim>& tissue, SlipAdvance advance) {
  auto& cells = tissue.cells;
  for (const std::size_t i : near_) {
    const SurfacePoint<Dim> surface = nearest_surface<Dim>(parameters_.shape, cells.position[i]);
    const double h = half_extent<Dim>(cells.shape[i], surface.normal);
    Vec<Dim> slip = slip_[i] + advance.used_h * cells.velocity[i];
    const std::optional<double> sliding_N = sliding_ ? std::optional<double>((*sliding_)[i]) : std::nullopt;
    force_[i] = contact_force<Dim>(surface, h, cells.volume[i], parameters_.friction, parameters_.contact_modulus_MPa,
                                   slip, sliding_N);
    if (advance.kept_h > 0.0) {
      slip_[i] = slip;
      if (sliding_) (*sliding_)[i] = parameters_.friction * std::max(0.0, force_[i].dot(surface.normal));
    }
    tissue.force[i] += force_[i];
  }
}

/// What friction can carry now; it matters by more than a part of itself, and of the largest.
template <int Dim>
void ObstacleEffect<Dim>::adapt_friction(const Tissue<Dim>& tissue, bool& matters) {
  constexpr double share = 1e-3;
  double largest = 0.0;
  std::vector<double> sliding(near_.size());
  for (std::size_t k = 0; k < near_.size(); ++k) {
    const Vec<Dim> normal = nearest_surface<Dim>(parameters_.shape, tissue.cells.position[near_[k]]).normal;
    sliding[k] = parameters_.friction * std::max(0.0, force_[near_[k]].dot(normal));
    largest = std::max(largest, sliding[k]);
  }
  for (std::size_t k = 0; k < near_.size(); ++k) {
    double& before = (*sliding_)[near_[k]];
    matters |= std::abs(sliding[k] - before) > share * (sliding[k] + largest);
    before = sliding[k];
  }
}

template <int Dim>
void ObstacleEffect<Dim>::add_columns(const Tissue<Dim>&, std::vector<FrameColumn>& columns) const {
  add_contact_force<Dim>(near_, force_, columns);
}

template <int Dim>
void ObstacleEffect<Dim>::keep_awake(std::vector<char>& busy) const {
  for (const std::size_t i : near_) busy[i] = 1;
}

template <int Dim>
Vec<Dim> ObstacleEffect<Dim>::contact_force_N() const {
  Vec<Dim> sum = Vec<Dim>::Zero();
  for (const std::size_t i : near_) sum += force_[i];
  return sum;
}

template <int Dim>
Vec<Dim> ObstacleEffect<Dim>::tip_force_N(double within_mm) const {
  Vec<Dim> sum = Vec<Dim>::Zero();
  for (const std::size_t i : near_) {
    if (solver_.tissue().cells.distance_to_tip[i] <= within_mm) sum += force_[i];
  }
  return sum;
}

EffectSpec obstacle_effect() {
  return {.name = "obstacle",
          .called_by = "[[obstacle]]",
          .what = "rigid plane, box, disc or sphere: penalty contact with friction",
          .exact = "force that arrests a root, p (1 - nu_A) W; Coulomb's cone",
          .push = Push::arrest,
          .sections = {obstacle_section()},
          .called_for = [](const Scene& scene) { return scene.find<ObstacleSection>() != nullptr; },
          .build =
              [](auto assembly) {
                constexpr int Dim = assembly.dimension;
                for (const ObstacleSection& o : assembly.scene.template all<ObstacleSection>()) {
                  assembly.template add<ObstacleEffect<Dim>>(
                      ObstacleParameters<Dim>{o.name, rigid_shape<Dim>(o), o.friction, *o.contact_modulus_MPa});
                }
              },
          .check_start =
              [](const Scene& scene, const auto& tissue, const FreeGrowth&) {
                const auto& obstacles = scene.all<ObstacleSection>();
                for (std::size_t i = 0; i < obstacles.size(); ++i) {
                  refuse_small(scene, tissue, obstacles[i], i);
                  refuse_overlap(scene, tissue, obstacles[i], i);
                  refuse_inside(scene, tissue, obstacles[i], i);
                }
              }};
}

template Vec<2> contact_force<2>(const SurfacePoint<2>&, double, double, double, double, Vec<2>&,
                                 std::optional<double>);
template Vec<3> contact_force<3>(const SurfacePoint<3>&, double, double, double, double, Vec<3>&,
                                 std::optional<double>);
template class ObstacleEffect<2>;
template class ObstacleEffect<3>;

}  // namespace rootsoil
