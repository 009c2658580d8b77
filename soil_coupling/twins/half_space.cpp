// SPDX-License-Identifier: MIT
#include "soil_coupling/twins/half_space.hpp"

#include <algorithm>
#include <functional>

#include "soil_coupling/twins/twin_state.hpp"
#include "soil_coupling/twins/vectors.hpp"

namespace rootsoil::twins {
namespace {

void add(Vec3& sum, const Eigen::Vector3d& v) {
  for (int a = 0; a < 3; ++a) sum[static_cast<std::size_t>(a)] += v[a];
}

}  // namespace

double balanced_retreat(std::vector<double> depths_mm, double stiffness_N_mm, double backing_N_mm) {
  if (backing_N_mm <= 0.0) return 0.0;
  // with the n deepest in contact, X = k sum_n depth/(K + n k); right for the n at which X lies below the n-th depth
  std::sort(depths_mm.begin(), depths_mm.end(), std::greater<>());
  double sum = 0.0, retreat = 0.0;
  for (std::size_t n = 0; n < depths_mm.size() && depths_mm[n] > retreat; ++n) {
    sum += depths_mm[n];
    retreat = stiffness_N_mm * sum / (backing_N_mm + static_cast<double>(n + 1) * stiffness_N_mm);
  }
  return retreat;
}

SurfaceForces HalfSpace::advance(const SurfaceMotion& motion) {
  const std::size_t n = motion.id.size();
  SurfaceForces forces;
  forces.mean_N.assign(n, Vec3{});
  forces.mean_torque_Nmm.assign(n, Vec3{});
  forces.contact_stiffness_N_mm.assign(n, 0.0);
  const double share = 1.0 / parameters_.substeps, k = parameters_.stiffness_N_mm;
  const Eigen::Vector3d normal = parameters_.outward;
  std::map<std::int64_t, Eigen::Vector3d> slips;
  std::vector<double> depth(n);
  double deepest = 0.0;
  for (int step = 0; step < parameters_.substeps; ++step) {
    const double at = (step + 0.5) * share;
    for (std::size_t m = 0; m < n; ++m) {
      const Eigen::Vector3d x = eigen(motion.start_mm[m]) + at * (eigen(motion.end_mm[m]) - eigen(motion.start_mm[m]));
      depth[m] = motion.radius_mm[m] - (x - parameters_.point_mm).dot(normal);
    }
    retreat_mm_ = balanced_retreat(depth, k, parameters_.backing_N_mm);
    for (std::size_t m = 0; m < n; ++m) {
      const double overlap = depth[m] - retreat_mm_;
      Eigen::Vector3d& slip = slip_mm_.try_emplace(motion.id[m], Eigen::Vector3d::Zero()).first->second;
      if (overlap <= 0.0) {
        slip.setZero();
        continue;
      }
      const Eigen::Vector3d arm = -motion.radius_mm[m] * normal;
      Eigen::Vector3d moved = share * (eigen(motion.end_mm[m]) - eigen(motion.start_mm[m]));
      if (!motion.spin_per_h.empty()) moved += share * motion.duration_h * eigen(motion.spin_per_h[m]).cross(arm);
      slip += moved - moved.dot(normal) * normal;
      const double limit = parameters_.friction * overlap;
      if (slip.norm() > limit) slip *= limit / slip.norm();
      const Eigen::Vector3d force = k * (overlap * normal - slip);
      add(forces.mean_N[m], share * force);
      add(forces.mean_torque_Nmm[m], share * arm.cross(force));
      if (step + 1 == parameters_.substeps) forces.contact_stiffness_N_mm[m] = k;
      deepest = std::max(deepest, overlap);
    }
  }
  for (const std::int64_t id : motion.id) slips[id] = slip_mm_.at(id);  // those that are gone are forgotten
  slip_mm_.swap(slips);
  forces.numbers = {{"soil_retreat_mm", retreat_mm_}, {"soil_overlap_mm", deepest}};
  return forces;
}

void HalfSpace::save(const std::filesystem::path& file) {
  State state{{"retreat_mm", {retreat_mm_}}, {"id", {}}, {"slip_mm", {}}};
  for (const auto& [id, slip] : slip_mm_) {
    state["id"].push_back(static_cast<double>(id));
    state["slip_mm"].insert(state["slip_mm"].end(), slip.data(), slip.data() + 3);
  }
  write_state(file, "half-space", state);
}

void HalfSpace::load(const std::filesystem::path& file) {
  const State state = read_state(file, "half-space");
  retreat_mm_ = state.at("retreat_mm").at(0);
  slip_mm_.clear();
  for (std::size_t k = 0; k < state.at("id").size(); ++k) {
    const double* slip = state.at("slip_mm").data() + 3 * k;
    slip_mm_[static_cast<std::int64_t>(state.at("id")[k])] = {slip[0], slip[1], slip[2]};
  }
}

}  // namespace rootsoil::twins
