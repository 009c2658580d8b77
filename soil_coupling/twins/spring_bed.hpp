// SPDX-License-Identifier: MIT
// A bed of springs (Winkler's foundation): a marker that comes into the bed is tied to where it came in, by one spring
// along the bed's axis and softer or harder ones across it. A spring that is stretched beyond its limit breaks for
// good.
#pragma once

#include <Eigen/Dense>

#include "root_sph/exchange/soil_port.hpp"

namespace rootsoil::twins {

struct SpringBedParameters {
  Eigen::Vector3d point_mm = Eigen::Vector3d::Zero();  ///< of the bed's face
  Eigen::Vector3d axis = Eigen::Vector3d::UnitX();     ///< unit vector into the bed
  double axial_N_mm = 0.0, lateral_N_mm = 0.0;         ///< stiffness of each marker's springs
  double breaks_at_mm = 0.0;                           ///< length at which they break; 0: never
  int substeps = 10;
};

class SpringBed final : public SoilPort {
 public:
  explicit SpringBed(const SpringBedParameters& parameters) : parameters_(parameters) {}
  SurfaceForces advance(const SurfaceMotion& motion) override;
  std::vector<std::string> number_names() const override { return {"soil_broken", "soil_tied"}; }
  void save(const std::filesystem::path& file) override;
  void load(const std::filesystem::path& file) override;

 private:
  struct Spring {
    Eigen::Vector3d anchor_mm;
    bool broken = false;
  };
  SpringBedParameters parameters_;
  std::map<std::int64_t, Spring> springs_;  ///< by marker
};

}  // namespace rootsoil::twins
