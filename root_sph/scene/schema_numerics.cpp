// SPDX-License-Identifier: MIT
// How it is computed, watched and written.
#include "root_sph/scene/presets.hpp"
#include "root_sph/scene/schema_keys.hpp"
#include "root_sph/scene/schema_sections.hpp"

namespace rootsoil::sections {

// clang-format off
SectionSpec numerics_section() {
  using Nu = NumericsSection;
  return section<Nu>("numerics", defaulted, "How it is computed. Keys that are left out follow from accuracy.",
                     [](auto& s) { return &s.numerics; }, {
    key(&Nu::accuracy, "accuracy", "-", one_of(preset_names()), "Preset for the keys that are left out.", "-"),
    key(&Nu::step_h, "step_h", "h", above(0).up_to(1, seconds), "Time step.", "docs/physics.md 5.5")
        .defaults_to("from accuracy"),
    key(&Nu::window_steps, "window_steps", "-", between(1, 1000),
        "Steps for which neighbours and gradients stay frozen.", "docs/physics.md 5.6").defaults_to("from accuracy"),
    key(&Nu::kernel, "kernel", "-", one_of({"cell", "isotropic"}),
        "cell: in the metric of each cell; isotropic: the paper's.", "docs/physics.md 5.1, paper 4.4"),
    key(&Nu::eta, "eta", "-", between(0.5, 5), "Kernel size over cell size (cell kernel).", "docs/physics.md 5.1")
        .defaults_to("from accuracy"),
    key(&Nu::H_bar, "H_bar", "-", above(0).up_to(20, {}), "Kernel size over cell size (isotropic kernel).",
        "Table 1: 2 to 8"),
    key(&Nu::gradient, "gradient", "-", one_of({"plain", "linear", "quadratic", "quadratic_at_surface"}),
        "Order to which the gradient is exact.", "docs/physics.md 5.2, 5.8").defaults_to("from accuracy"),
    key(&Nu::stepper, "stepper", "-", one_of({"symplectic", "predictor_corrector"}), "Time stepping.", "paper 4.4"),
    key(&Nu::inertia, "inertia", "-", one_of({"tensor", "scalar"}), "Inertia from the stability bound.", "docs/physics.md 5.5"),
    key(&Nu::inertia_compensation, "inertia_compensation", "-", any_number,
        "Cancel the leading inertia error of steady growth.", "docs/physics.md 5.9"),
    key(&Nu::mass_damping_per_h, "mass_damping_per_h", "1/h", at_least(0),
        "Damping that settles a root without growth.", "docs/physics.md 5.11").defaults_to("growth: 0, else 2 omega"),
    key(&Nu::midline_damping_per_h, "midline_damping_per_h", "1/h", at_least(0),
        "Damping of the midline's lateral motion, against hose flutter.", "docs/decisions/0003")
        .defaults_to("growth, no obstacle: 5"),
    key(&Nu::artificial_viscosity, "artificial_viscosity", "-", at_least(0), "Bulk pair viscosity.", "docs/physics.md 6"),
    key(&Nu::start, "start", "-", one_of({"equilibrium", "rest"}),
        "equilibrium: stress p and the closed form's velocity; rest: the paper's.", "docs/physics.md 5.9, paper 4.4"),
  });
}

SectionSpec non_affine_control_section() {
  using Nc = NonAffineControlSection;
  return section<Nc>("non_affine_control", optional,
                     "Damps and resists pair motions that no velocity gradient can see.",
                     [](auto& s) { return &s.non_affine_control; }, {
    key(&Nc::damping, "damping", "-", at_least(0), "Damping alpha.", "docs/physics.md 5.4"),
    key(&Nc::stiffness, "stiffness", "-", at_least(0), "Elastic penalty, times E_A.", "docs/decisions/0009"),
  });
}

SectionSpec sleep_section() {
  using Sl = SleepSection;
  return section<Sl>("sleep", optional,
                     "Mature tissue that does not move is left out of the computation until something moves it.",
                     [](auto& s) { return &s.sleep; }, {
    key(&Sl::strain_rate_per_h, "strain_rate_per_h", "1/h", above(0),
        "Tissue that strains no faster, from the base on, falls asleep.", "docs/effects.md")
        .defaults_to("1e-4; with [soil] 5e-3"),
    key(&Sl::mean_over_h, "mean_over_h", "h", above(0),
        "Time over which that is averaged: grains push to and fro.", "docs/effects.md")
        .defaults_to("ten windows; with [soil] 0.1"),
    key(&Sl::stress_change, "stress_change", "-", above(0),
        "Change of axial stress beside the sleeping tissue, or of the soil's force on a cell's face, that wakes it, over "
        "the pressure differential.", "docs/effects.md")
        .defaults_to("0.05; with [soil] 0.3"),
  });
}

SectionSpec probe_section() {
  using Pb = ProbeSection;
  return section<Pb>("probe", repeated, "The tissue followed over time: at a cell, or in a bin along the root.",
                     [](auto& s) { return &s.probes; }, {
    key(&Pb::name, "name", "-", any_text, "For outputs; unique.", "-").defaults_to("probe_1, ..."),
    key(&Pb::position_mm, "position_mm", "mm", place_mm, "The cell nearest to it at the start; this or the bin.", "-"),
    key(&Pb::distance_to_tip_mm, "distance_to_tip_mm", "mm", at_least(0).up_to(1e3, microns),
        "Bin [from, to] along the root; this or the position.", "-"),
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
  });
}
// clang-format on

}  // namespace rootsoil::sections
