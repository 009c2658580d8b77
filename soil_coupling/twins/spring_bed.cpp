// SPDX-License-Identifier: MIT
#include "soil_coupling/twins/spring_bed.hpp"

#include <algorithm>

#include "soil_coupling/twins/twin_state.hpp"
#include "soil_coupling/twins/vectors.hpp"

namespace rootsoil::twins {

SurfaceForces SpringBed::advance(const SurfaceMotion& motion) {
  const std::size_t n = motion.id.size();
  SurfaceForces forces;
  forces.mean_N.assign(n, Vec3{});
  forces.contact_stiffness_N_mm.assign(n, 0.0);
  const double share = 1.0 / parameters_.substeps;
  const Eigen::Vector3d axis = parameters_.axis;
  std::map<std::int64_t, Spring> kept;
  double broken = 0.0, tied = 0.0;
  for (std::size_t m = 0; m < n; ++m) {
    const Eigen::Vector3d start = eigen(motion.start_mm[m]), path = eigen(motion.end_mm[m]) - start;
    auto spring = springs_.find(motion.id[m]);
    for (int step = 0; step < parameters_.substeps; ++step) {
      const Eigen::Vector3d x = start + (step + 0.5) * share * path;
      if (spring == springs_.end()) {
        if ((x - parameters_.point_mm).dot(axis) < 0.0) continue;
        spring = springs_.emplace(motion.id[m], Spring{x}).first;
      }
      const Eigen::Vector3d stretch = x - spring->second.anchor_mm;
      if (parameters_.breaks_at_mm > 0.0 && stretch.norm() > parameters_.breaks_at_mm) spring->second.broken = true;
      if (spring->second.broken) break;
      const Eigen::Vector3d along = stretch.dot(axis) * axis;
      const Eigen::Vector3d force = -parameters_.axial_N_mm * along - parameters_.lateral_N_mm * (stretch - along);
      for (int a = 0; a < 3; ++a) forces.mean_N[m][static_cast<std::size_t>(a)] += share * force[a];
    }
    if (spring == springs_.end()) continue;
    kept.insert(*spring);
    (spring->second.broken ? broken : tied) += 1.0;
    if (!spring->second.broken) {
      forces.contact_stiffness_N_mm[m] = std::max(parameters_.axial_N_mm, parameters_.lateral_N_mm);
    }
  }
  springs_.swap(kept);  // the springs of markers that are gone go with them
  forces.numbers = {{"soil_broken", broken}, {"soil_tied", tied}};
  return forces;
}

void SpringBed::save(const std::filesystem::path& file) {
  State state{{"id", {}}, {"anchor_mm", {}}, {"broken", {}}};
  for (const auto& [id, spring] : springs_) {
    state["id"].push_back(static_cast<double>(id));
    state["anchor_mm"].insert(state["anchor_mm"].end(), spring.anchor_mm.data(), spring.anchor_mm.data() + 3);
    state["broken"].push_back(spring.broken ? 1.0 : 0.0);
  }
  write_state(file, "spring bed", state);
}

void SpringBed::load(const std::filesystem::path& file) {
  const State state = read_state(file, "spring bed");
  springs_.clear();
  for (std::size_t k = 0; k < state.at("id").size(); ++k) {
    const double* anchor = state.at("anchor_mm").data() + 3 * k;
    springs_[static_cast<std::int64_t>(state.at("id")[k])] = {{anchor[0], anchor[1], anchor[2]},
                                                              state.at("broken")[k] != 0.0};
  }
}

}  // namespace rootsoil::twins
