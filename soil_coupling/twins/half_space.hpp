// SPDX-License-Identifier: MIT
// A rigid half-space behind a plane: every marker that reaches into it is pushed back by a spring, with Coulomb
// friction. The plane can stand on a spring of its own, so that a root's thrust rises slowly as it grows.
#pragma once

#include <Eigen/Dense>

#include "root_sph/exchange/soil_port.hpp"

namespace rootsoil::twins {

struct HalfSpaceParameters {
  Eigen::Vector3d point_mm = Eigen::Vector3d::Zero();  ///< of the plane, at rest
  Eigen::Vector3d outward = Eigen::Vector3d::UnitX();  ///< unit normal, out of the half-space
  double stiffness_N_mm = 0.0;                         ///< of each marker's contact, normal and tangential
  double friction = 0.0;                               ///< tan of the friction angle
  double backing_N_mm = 0.0;  ///< stiffness of the spring behind the plane; 0: the plane is fixed
  int substeps = 10;          ///< per interval; forces are their mean
};

class HalfSpace final : public SoilPort {
 public:
  explicit HalfSpace(const HalfSpaceParameters& parameters) : parameters_(parameters) {}
  SurfaceForces advance(const SurfaceMotion& motion) override;
  std::vector<std::string> number_names() const override { return {"soil_retreat_mm", "soil_overlap_mm"}; }
  void save(const std::filesystem::path& file) override;
  void load(const std::filesystem::path& file) override;

 private:
  HalfSpaceParameters parameters_;
  std::map<std::int64_t, Eigen::Vector3d> slip_mm_;  ///< by marker, tangential, since contact began
  double retreat_mm_ = 0.0;                          ///< how far the plane stands back
};

/// The retreat X at which the spring behind the plane carries the contacts: K X = k sum (depth - X)+. Pure.
double balanced_retreat(std::vector<double> depths_mm, double stiffness_N_mm, double backing_N_mm);

}  // namespace rootsoil::twins
