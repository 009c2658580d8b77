// SPDX-License-Identifier: MIT
// Soils and markers for tests.
#pragma once

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <string>

#include "root_sph/core/errors.hpp"
#include "soil_coupling/yade_soil.hpp"

namespace rootsoil::test {

/// A folder that goes with the object; soil samples are kept in it.
class Folder {
 public:
  Folder() {
    std::string name = (std::filesystem::temp_directory_path() / "rootsoil_soil_XXXXXX").string();
    path_ = mkdtemp(name.data());
    setenv("ROOTSOIL_CACHE", (path_ / "cache").c_str(), 1);
  }
  ~Folder() { std::filesystem::remove_all(path_); }
  std::filesystem::path operator/(const std::string& name) const { return path_ / name; }

 private:
  std::filesystem::path path_;
};

inline std::string write(const std::filesystem::path& path, const std::string& text) {
  std::ofstream(path) << text;
  return path.string();
}

/// A rigid box of 4 mm x 4 mm with these grains; nothing presses on it.
inline SoilRecipe listed_grains(std::vector<SoilGrain> grains) {
  SoilRecipe r;
  r.box_from_mm = {-2, -2, 0};
  r.box_to_mm = {2, 2, 0};
  r.walls = SoilWalls::rigid;
  r.d_mean_mm = 0.3;
  r.d_min_mm = 0.25;
  r.d_max_mm = 0.35;
  r.d_spread = 1.0 / 6;
  r.grains = std::move(grains);
  r.E_MPa = 300.0;
  r.density_N_h2_mm4 = 1e-4;
  return r;
}

/// Some hundred grains in a box of 5 mm x 4 mm under pressure; the root comes from the left.
inline SoilRecipe packed_grains() {
  SoilRecipe r;
  r.box_from_mm = {0, -2, 0};
  r.box_to_mm = {5, 2, 0};
  r.confining_pressure_MPa = 0.1;
  r.d_mean_mm = 0.25;
  r.d_min_mm = 0.2;
  r.d_max_mm = 0.3;
  r.d_spread = 0.2;
  r.E_MPa = 300.0;
  return r;
}

inline SoilStart start_of_root() {
  SoilStart s;
  s.root_speed_mm_h = 0.5;
  s.root_diameter_mm = 0.8;
  return s;
}

/// `markers` in a row that moves from x to x + dx.
inline SurfaceMotion row_of_markers(std::int64_t interval, int markers, double x, double dx) {
  SurfaceMotion m;
  m.interval = interval;
  m.duration_h = 1e-3;
  m.time_h = static_cast<double>(interval) * m.duration_h;
  for (int k = 0; k < markers; ++k) {
    const double y = 0.05 * k;
    m.id.push_back(k);
    m.start_mm.push_back({x, y, 0});
    m.end_mm.push_back({x + dx, y, 0});
    m.radius_mm.push_back(0.1);
  }
  return m;
}

inline Vec3 total(const std::vector<Vec3>& vectors) {
  Vec3 sum{};
  for (const Vec3& v : vectors) {
    for (int a = 0; a < 3; ++a) sum[a] += v[a];
  }
  return sum;
}

/// Does the process exist (and is no zombie)?
inline bool runs(pid_t pid) {
  std::ifstream stat("/proc/" + std::to_string(pid) + "/stat");
  std::string text;
  return std::getline(stat, text) && text.find(") Z ") == std::string::npos;
}

template <class Exception, class Action>
std::string message_of(Action action) {
  try {
    action();
  } catch (const Exception& e) {
    return e.what();
  }
  ADD_FAILURE() << "nothing was thrown";
  return {};
}

}  // namespace rootsoil::test
