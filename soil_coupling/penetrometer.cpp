// SPDX-License-Identifier: MIT
#include "soil_coupling/penetrometer.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cerrno>
#include <chrono>
#include <cmath>
#include <fstream>
#include <nlohmann/json.hpp>
#include <numbers>
#include <numeric>

#include "root_sph/core/errors.hpp"
#include "root_sph/core/interruption.hpp"
#include "root_sph/core/progress_line.hpp"
#include "soil_coupling/yade_soil.hpp"

namespace rootsoil {
namespace {

constexpr double smallest_ball = 0.1;  ///< of the rod's radius
constexpr double spacing = 0.05;       ///< of the rod's radius, along the shaft
constexpr double cone_spacing = 0.2;   ///< of a ball's own radius, along the cone

double mean(const std::vector<double>& x) {
  return x.empty() ? 0.0 : std::accumulate(x.begin(), x.end(), 0.0) / static_cast<double>(x.size());
}

double deviation(const std::vector<double>& x) {
  if (x.size() < 2) return 0.0;
  const double m = mean(x);
  double sum = 0.0;
  for (const double v : x) sum += (v - m) * (v - m);
  return std::sqrt(sum / static_cast<double>(x.size() - 1));
}

double section(const Penetrometer& probe, int dimension) {
  const double d = probe.diameter_mm;
  return dimension == 2 ? d : std::numbers::pi * d * d / 4;
}

SurfaceMotion motion_of(const Rod& rod, double front_mm, double step_mm) {
  SurfaceMotion motion;
  for (std::size_t k = 0; k < rod.radius_mm.size(); ++k) {
    const double x = front_mm - rod.behind_mm[k];
    motion.id.push_back(static_cast<std::int64_t>(k));
    motion.start_mm.push_back({x, 0, 0});
    motion.end_mm.push_back({x + step_mm, 0, 0});
  }
  motion.radius_mm = rod.radius_mm;
  return motion;
}

void write_csv(const PenetrometerResult& result, const std::filesystem::path& path) {
  std::ofstream file(path);
  file << "seed,depth_mm,Q_MPa,shaft_force_N,inertial_number,overlap_max\n";
  for (const PenetrometerReading& r : result.readings) {
    file << fmt::format("{},{},{},{},{},{}\n", r.seed, r.depth_mm, r.Q_MPa, r.shaft_force_N, r.inertial_number,
                        r.overlap_max);
  }
  if (!file.flush()) throw FileError(fmt::format("{}: can't be written", path.string()), file_remedy(errno));
}

}  // namespace

Rod make_rod(const Penetrometer& probe, double length_mm) {
  const double radius = 0.5 * probe.diameter_mm;
  const double sine = std::sin(0.5 * probe.cone_angle_deg * std::numbers::pi / 180.0);
  Rod rod;
  const bool round = probe.cone_angle_deg >= 180.0;
  const double first = round ? radius : smallest_ball * radius;
  const double front = first / sine - first;  // of the first ball, behind the cone's apex
  double r = first;
  while (r < radius) {
    rod.behind_mm.push_back(r / sine - front);
    rod.radius_mm.push_back(r);
    r += std::min(spacing * radius, cone_spacing * r * sine);
  }
  const double shoulder = radius / sine - front;
  rod.tip = rod.radius_mm.size() + 1;
  for (double at = shoulder; at < length_mm + shoulder; at += spacing * radius) {
    rod.behind_mm.push_back(at);
    rod.radius_mm.push_back(radius);
  }
  return rod;
}

PenetrometerResult penetrate(const SoilRecipe& recipe, const Penetrometer& probe, const SoilPortFactory& make_soil,
                             const std::function<void(const std::string&)>& progress) {
  using Clock = std::chrono::steady_clock;
  PenetrometerResult result;
  const Rod rod = make_rod(probe, probe.depth_mm);
  const double area = section(probe, recipe.dimension);
  const auto intervals =
      std::max<std::int64_t>(1, std::llround(std::ceil(probe.depth_mm / (probe.rate_mm_h * *probe.interval_h) - 1e-9)));
  const double step_mm = probe.depth_mm / static_cast<double>(intervals);
  std::vector<double> fluctuations, inertial_numbers;
  const auto push = [&](std::int64_t k) {
    SoilRecipe own = recipe;
    own.seed = recipe.seed + k;
    if (probe.friction_deg) own.root_friction_deg = *probe.friction_deg;
    SoilStart start;
    start.root_speed_mm_h = probe.rate_mm_h;
    start.root_diameter_mm = probe.diameter_mm;
    start.progress = progress;
    const std::unique_ptr<SoilPort> soil = make_soil(own, start);
    std::vector<double> averaged;
    const Clock::time_point began = Clock::now();
    for (std::int64_t i = 0; i < intervals; ++i) {
      const double depth_mm = step_mm * static_cast<double>(i);
      SurfaceMotion motion = motion_of(rod, recipe.box_from_mm[0] + depth_mm, step_mm);
      motion.interval = i;
      motion.duration_h = step_mm / probe.rate_mm_h;
      motion.time_h = static_cast<double>(i) * motion.duration_h;
      const SurfaceForces forces = soil->advance(motion);
      PenetrometerReading reading;
      reading.seed = own.seed;
      reading.depth_mm = depth_mm + 0.5 * step_mm;
      for (std::size_t m = 0; m < forces.mean_N.size(); ++m) {
        (m < rod.tip ? reading.Q_MPa : reading.shaft_force_N) -= forces.mean_N[m][0];
      }
      reading.Q_MPa /= area;
      reading.inertial_number = forces.numbers.at("soil_inertial_number");
      reading.overlap_max = forces.numbers.at("soil_overlap_max");
      result.readings.push_back(reading);
      if (reading.depth_mm >= *probe.average_from_mm) averaged.push_back(reading.Q_MPa);
      inertial_numbers.push_back(reading.inertial_number);
      if (progress) {
        const double spent_s = std::chrono::duration<double>(Clock::now() - began).count();
        const double left_s = spent_s * static_cast<double>(intervals - i - 1) / static_cast<double>(i + 1);
        progress(fmt::format("seed {} of {}: depth {:.3f} of {:g} mm, Q {:.3f} MPa, {} left", k + 1, probe.seeds,
                             reading.depth_mm, probe.depth_mm, reading.Q_MPa, clock_text(left_s)));
      }
    }
    result.Q_of_seed_MPa.push_back(mean(averaged));
    fluctuations.push_back(deviation(averaged));
  };
  try {
    for (std::int64_t k = 0; k < probe.seeds; ++k) push(k);
  } catch (const Interrupted&) {
    result.interrupted = true;
  }
  result.Q_MPa = mean(result.Q_of_seed_MPa);
  result.Q_deviation_MPa = deviation(result.Q_of_seed_MPa);
  result.Q_fluctuation_MPa = mean(fluctuations);
  result.inertial_number = mean(inertial_numbers);
  return result;
}

int run_penetrometer(const SoilRecipe& recipe, const Penetrometer& probe, const std::filesystem::path& folder,
                     bool quiet) {
  const std::filesystem::path csv = folder / "penetrometer.csv", json = folder / "penetrometer.json";
  if (std::filesystem::exists(csv) || std::filesystem::exists(json)) {
    throw InputError({.file = {},
                      .line = 0,
                      .key = "--out",
                      .what = "the folder holds results of a penetrometer",
                      .given = folder.string(),
                      .allowed = {},
                      .remedy = "give another folder, or remove these files"});
  }
  std::error_code error;
  std::filesystem::create_directories(folder, error);
  if (error) throw FileError(fmt::format("{}: {}", folder.string(), error.message()), file_remedy(error.value()));
  const Interruption interruption;
  ProgressLine line(quiet);
  const PenetrometerResult result = penetrate(recipe, probe, make_yade_soil, [&](const std::string& text) {
    if (interruption.requested()) throw Interrupted();
    line.show(text);
  });
  line.end();
  write_csv(result, csv);
  if (result.interrupted) {
    fmt::print("interrupted after {} of {} seeds; {} holds what was read so far\n", result.Q_of_seed_MPa.size(),
               probe.seeds, csv.string());
    return static_cast<int>(ExitStatus::interrupted);
  }
  const double P = recipe.confining_pressure_MPa;
  nlohmann::ordered_json summary{{"Q_MPa", result.Q_MPa},
                                 {"Q_deviation_MPa", result.Q_deviation_MPa},
                                 {"Q_fluctuation_MPa", result.Q_fluctuation_MPa},
                                 {"Q_of_seed_MPa", result.Q_of_seed_MPa},
                                 {"Q_over_P", P > 0.0 ? result.Q_MPa / P : 0.0},
                                 {"confining_pressure_MPa", P},
                                 {"inertial_number", result.inertial_number},
                                 {"diameter_mm", probe.diameter_mm},
                                 {"cone_angle_deg", probe.cone_angle_deg},
                                 {"rate_mm_h", probe.rate_mm_h},
                                 {"averaged_mm", {*probe.average_from_mm, probe.depth_mm}}};
  fmt::print("Q = {:.4g} MPa, +- {:.2g} between {} seeds, +- {:.2g} along the way ({:.3g} to {:.3g} mm)\n",
             result.Q_MPa, result.Q_deviation_MPa, probe.seeds, result.Q_fluctuation_MPa, *probe.average_from_mm,
             probe.depth_mm);
  fmt::print("Q/P = {:.3g} at P = {:.3g} MPa, inertial number {:.2g}\n", P > 0.0 ? result.Q_MPa / P : 0.0, P,
             result.inertial_number);
  if (probe.turgor_MPa) {
    const double p = *probe.turgor_MPa - 0.25 * result.Q_MPa;
    summary["turgor_MPa"] = *probe.turgor_MPa;
    summary["differential_MPa"] = p;
    fmt::print(
        "the paper's pressure differential p = turgor - Q/4 = {:.4g} MPa; a root may meet less friction, or more of Q: "
        "compare with a run in [soil]\n",
        p);
  }
  std::ofstream file(json);
  file << summary.dump(2) << '\n';
  if (!file.flush()) throw FileError(fmt::format("{}: can't be written", json.string()), file_remedy(errno));
  fmt::print("wrote {}\n", csv.string());
  return 0;
}

}  // namespace rootsoil
