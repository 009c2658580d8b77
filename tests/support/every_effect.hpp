// SPDX-License-Identifier: MIT
// A scene with every effect of the table: every_effect.toml.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "root_sph/exchange/soil_port.hpp"

namespace rootsoil::test {

inline const std::filesystem::path every_effect =
    std::filesystem::path(ROOTSOIL_SOURCE_DIR) / "tests" / "support" / "every_effect.toml";

/// What makes it a scene of so many dimensions.
inline std::vector<std::string> in_dimension(int dimension) {
  if (dimension == 2) return {};
  return {"scene.dimension=3",
          "obstacle.1.position_mm=[0.3, 0, 0]",
          "obstacle.1.normal=[-1, 0, 0]",
          "gravity.acceleration_m_s2=[9.81, 0, 0]",
          "probe.1.position_mm=[0.1, 0, 0]",
          "soil.box_from_mm=[0.1, -1, -1]",
          "soil.box_to_mm=[2, 1, 1]"};
}

/// Exerts nothing.
struct NoSoil final : SoilPort {
  SurfaceForces advance(const SurfaceMotion& motion) override {
    return {std::vector<Vec3>(motion.id.size()), std::vector<double>(motion.id.size(), 0.0), {}, {}};
  }
  void save(const std::filesystem::path&) override {}
  void load(const std::filesystem::path&) override {}
};

}  // namespace rootsoil::test
