// SPDX-License-Identifier: MIT
// `rootsoil run` and `version` with a soil of this process in the place of YADE, for hard cases: a stiff, rough plate
// 0.01 mm beyond the tip, which can let go.
#include <CLI/CLI.hpp>
#include <iostream>
#include <limits>
#include <memory>

#include "root_sph/app/commands.hpp"
#include "root_sph/core/errors.hpp"
#include "root_sph/core/version.hpp"
#include "root_sph/effects/soil_contact/soil_section.hpp"
#include "root_sph/effects/table.hpp"
#include "soil_coupling/twins/half_space.hpp"

namespace rootsoil {
namespace {

constexpr double gap_mm = 0.01, stiffness_N_mm = 100.0, friction = 0.5;

/// A plate that is gone from one time on.
class ReleasingPlate final : public SoilPort {
 public:
  ReleasingPlate(const twins::HalfSpaceParameters& parameters, double gone_at_h)
      : plate_(parameters), gone_at_h_(gone_at_h) {}
  SurfaceForces advance(const SurfaceMotion& motion) override {
    SurfaceForces forces = plate_.advance(motion);
    if (motion.time_h < gone_at_h_) return forces;
    forces.mean_N.assign(forces.mean_N.size(), Vec3{});
    forces.mean_torque_Nmm.assign(forces.mean_torque_Nmm.size(), Vec3{});
    forces.contact_stiffness_N_mm.assign(forces.contact_stiffness_N_mm.size(), 0.0);
    return forces;
  }
  std::vector<std::string> number_names() const override { return plate_.number_names(); }
  void save(const std::filesystem::path& file) override { plate_.save(file); }
  void load(const std::filesystem::path& file) override { plate_.load(file); }

 private:
  twins::HalfSpace plate_;
  double gone_at_h_;
};

int command_line(int argc, char** argv) {
  CLI::App app{"rootsoil run with a plate of this process"};
  app.require_subcommand(1);
  app.add_subcommand("version", "Print the version");
  std::filesystem::path scene_file;
  RunOptions options;
  double gone_at_h = std::numeric_limits<double>::infinity();
  CLI::App* run = app.add_subcommand("run", "Run a scene");
  run->add_option("SCENE", scene_file)->required();
  run->add_option("--out", options.out)->required();
  run->add_option("--threads", options.threads);
  run->add_flag("--resume", options.resume);
  run->add_option("--until", options.until_h);
  run->add_flag("--quiet", options.quiet);
  run->add_option("--gone-at", gone_at_h, "Hours, when the plate lets go");
  CLI11_PARSE(app, argc, argv);
  if (!run->parsed()) {
    std::cout << "rootsoil " << program_version << '\n';
    return 0;
  }
  Scene scene = read_scene(scene_file);
  SoilContactSection contact;
  contact.interval_h = scene.numerics.step_h.value_or(contact.interval_h);  // a window an interval
  contact.ramp_h = 0.0;                                                     // the root starts out of contact
  scene.facts.longest_step_h = contact.interval_h;
  contact.stiffness_predictor = true;
  scene.all<SoilContactSection>().push_back(contact);
  return run_scene(scene, options, [gone_at_h](const Scene& read, const SoilStart&) {
    twins::HalfSpaceParameters plate;
    plate.point_mm = {read.root.length_mm + gap_mm, 0.0, 0.0};
    plate.outward = {-1.0, 0.0, 0.0};
    plate.stiffness_N_mm = stiffness_N_mm;
    plate.friction = friction;
    return std::make_unique<ReleasingPlate>(plate, gone_at_h);
  });
}

}  // namespace
}  // namespace rootsoil

int main(int argc, char** argv) {
  try {
    return rootsoil::command_line(argc, argv);
  } catch (const rootsoil::Error& error) {
    std::cerr << error.what() << '\n';
    return static_cast<int>(error.status());
  }
}
