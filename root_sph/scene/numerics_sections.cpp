// SPDX-License-Identifier: MIT
// How it is computed and written.
#include <fmt/format.h>

#include "root_sph/scene/presets.hpp"
#include "root_sph/scene/schema_keys.hpp"
#include "root_sph/scene/schema_sections.hpp"

namespace rootsoil::sections {

namespace {

void complete_output(Scene& scene) {
  OutputSection& output = scene.output;
  if (output.every_h > scene.scene.duration_h) {
    // where one of the two comes from the command line, it is the one to blame
    const auto is_in_file = [&](const char* key) { return scene.origins.of(key).file == scene.file; };
    if (is_in_file("output.every_h") && !is_in_file("scene.duration_h")) {
      scene.origins.fail(
          "scene.duration_h", "the run would end before its first frame", fmt::format("{}", scene.scene.duration_h),
          fmt::format("at least output.every_h = {}", output.every_h),
          fmt::format("run for longer, or write frames more often: --set output.every_h={}", scene.scene.duration_h));
    }
    scene.origins.fail("output.every_h", "the first frame would come after the end", fmt::format("{}", output.every_h),
                       fmt::format("at most duration_h = {}", scene.scene.duration_h), "write frames more often");
  }
  constexpr double most_frames = 1e6;  // of 100 cells: 50 GB
  if (scene.scene.duration_h / output.every_h > most_frames) {
    scene.origins.fail("output.every_h",
                       fmt::format("{:.1e} frames would fill the disk", scene.scene.duration_h / output.every_h),
                       fmt::format("{}", output.every_h),
                       fmt::format("at least {:.4g} h: {:.0e} frames in duration_h = {}",
                                   scene.scene.duration_h / most_frames, most_frames, scene.scene.duration_h),
                       "write frames less often; are both times in hours?");
  }
  if (!output.checkpoint_every_h) output.checkpoint_every_h = output.every_h;
}

}  // namespace

// clang-format off
SectionSpec numerics_section() {
  const std::vector<std::string> with_inertia{"symplectic", "predictor_corrector"};
  using Nu = NumericsSection;
  return section<Nu>("numerics", defaulted, "How it is computed. Keys that are left out follow from accuracy.",
                     [](auto& s) { return &s.numerics; }, {
    key(&Nu::accuracy, "accuracy", "Preset for the keys that are left out.", "-")
        .stands_for([](Scene& s) { s.numerics = preset(s.numerics.accuracy); }),
    key(&Nu::step_h, "step_h", "h", above(0).up_to(1, seconds), "Time step.", "docs/physics.md 5.5")
        .defaults_to("from accuracy"),
    key(&Nu::window_steps, "window_steps", "-", between(1, 1000),
        "Steps for which neighbours and gradients stay frozen.", "docs/physics.md 5.6")
        .only_where("stepper", with_inertia).defaults_to("from accuracy"),
    key(&Nu::kernel, "kernel",
        "cell: in the metric of each cell; isotropic: the paper's.", "docs/physics.md 5.1, paper 4.4"),
    key(&Nu::eta, "eta", "-", between(0.5, 5), "Kernel size over cell size (cell kernel).", "docs/physics.md 5.1")
        .defaults_to("from accuracy"),
    key(&Nu::H_bar, "H_bar", "-", above(0).up_to(20, {}), "Kernel size over cell size (isotropic kernel).",
        "Table 1: 2 to 8"),
    key(&Nu::gradient, "gradient", "Order to which the gradient is exact.", "docs/physics.md 5.2, 5.8").defaults_to("from accuracy"),
    key(&Nu::stepper, "stepper",
        "quasi_static: forces balance at the end of every step; the others move masses: symplectic, or the paper's.",
        "docs/decisions/0021, paper 4.4"),
    key(&Nu::force_tolerance, "force_tolerance", "-", above(0).up_to(0.1, {}),
        "What may be left of the balance: rms force on a cell over the pressure differential times its face.",
        "docs/decisions/0021").only_where("stepper", {"quasi_static"}).defaults_to("from accuracy"),
    key(&Nu::inertia, "inertia", "Inertia from the stability bound.", "docs/physics.md 5.5")
        .only_where("stepper", with_inertia),
    key(&Nu::inertia_compensation, "inertia_compensation", "-", any_number,
        "Cancel the leading inertia error of steady growth.", "docs/physics.md 5.9")
        .only_where("stepper", with_inertia),
    key(&Nu::mass_damping_per_h, "mass_damping_per_h", "1/h", at_least(0),
        "Damping that settles a root without growth.", "docs/physics.md 5.11")
        .only_where("stepper", with_inertia).defaults_to("growth: 0, else 2 omega"),
    key(&Nu::midline_damping_per_h, "midline_damping_per_h", "1/h", at_least(0),
        "Damping of the midline's lateral motion, against hose flutter.", "docs/decisions/0003")
        .only_where("stepper", with_inertia).defaults_to("growth, nothing that pushes: 5"),
    key(&Nu::artificial_viscosity, "artificial_viscosity", "-", at_least(0), "Bulk pair viscosity.", "docs/physics.md 5.14")
        .only_where("stepper", with_inertia),
    key(&Nu::start, "start",
        "equilibrium: stress p and the closed form's velocity; rest: the paper's.", "docs/physics.md 5.9, paper 4.4"),
    key(&Nu::inertia_error_max, "inertia_error_max", "-", above(0),
        "Share of the pressure differential; a run whose inertia error passes it is outside its stated accuracy.",
        "docs/physics.md 5.15").only_where("stepper", with_inertia),
    key(&Nu::beyond_accuracy, "beyond_accuracy",
        "A run outside its stated accuracy: tell: says so and goes on; stop: ends with exit status 3.", "docs/physics.md 5.15"),
  });
}

SectionSpec output_section() {
  using Ou = OutputSection;
  return section<Ou>("output", required, "What is written, and when.", [](auto& s) { return &s.output; }, {
    key(&Ou::every_h, "every_h", "h", above(0).up_to(1e4, seconds), "Time between frames.", "-").required(),
    key(&Ou::checkpoint_every_h, "checkpoint_every_h", "h", above(0).up_to(1e4, seconds),
        "Time between checkpoints.", "-")
        .defaults_to("every_h"),
    key(&Ou::fields, "fields", "-", any_text, "Fields of the frames; empty: all.", "-"),
    key(&Ou::picture, "picture", "-", any_number, "Draw overview.png when the run ends.", "-"),
  }).completed_by(complete_output);
}
// clang-format on

}  // namespace rootsoil::sections
