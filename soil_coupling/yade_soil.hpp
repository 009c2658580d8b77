// SPDX-License-Identifier: MIT
// The soil port, by YADE in a process of its own.
#pragma once

#include <filesystem>
#include <memory>
#include <string>

#include "root_sph/exchange/soil_recipe.hpp"
#include "soil_coupling/soil_process.hpp"

namespace rootsoil {

class YadeSoil : public SoilPort {
 public:
  /// Takes the packed sample from the cache or packs it, starts the process, and builds the soil without the root.
  YadeSoil(const SoilRecipe& recipe, const SoilStart& start, const SoilProcessOptions& options);

  SurfaceForces advance(const SurfaceMotion& motion) override;
  /// See yade_side/soil.py for what they mean; docs/soil.md explains them to users.
  std::vector<std::string> number_names() const override;
  void save(const std::filesystem::path& file) override;
  void load(const std::filesystem::path& file) override;
  SoilSnapshot snapshot() override;

  double density_N_h2_mm4() const { return density_N_h2_mm4_; }
  SoilProcess& process() { return *process_; }

 private:
  SoilRecipe recipe_;
  double density_N_h2_mm4_;
  std::string start_text_;  ///< JSON
  std::unique_ptr<SoilProcess> process_;
};

/// Density that the recipe gives or that follows from the root; InputError where neither does.
double grain_density_N_h2_mm4(const SoilRecipe& recipe, const SoilStart& start);

/// The SoilPortFactory of a program that has YADE: makes a YadeSoil.
std::unique_ptr<SoilPort> make_yade_soil(const SoilRecipe& recipe, const SoilStart& start);

}  // namespace rootsoil
