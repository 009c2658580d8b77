// SPDX-License-Identifier: MIT
// The root meets a soil: surface markers carry the tissue's motion to a SoilPort and the soil's forces back.
//
// One coupling interval is a whole number of solver windows. In it the cells carry the mean forces of the interval
// before; at its end the soil is told how the markers moved and answers with the next forces (a staggered scheme of
// first order: the interval is an accuracy knob). A root without inertia would give way to forces that are held as far
// as its own stiffness lets it, and swing: it feels the contacts' stiffness as well (docs/decisions/0021).
//
// Markers, port and answer: exchange.hpp. Forces on cells in a window: prediction.hpp. What is told: bookkeeping.hpp.
#pragma once

#include <functional>
#include <memory>
#include <optional>

#include "root_sph/effects/effect_spec.hpp"
#include "root_sph/effects/soil_contact/bookkeeping.hpp"
#include "root_sph/effects/soil_contact/exchange.hpp"
#include "root_sph/effects/soil_contact/prediction.hpp"

namespace rootsoil {

struct SoilContactParameters {
  std::optional<double> marker_radius_mm;  ///< absent: one cell (median)
  double marker_spacing = 0.6;             ///< of the radius; gaps stay below 1.5 of it
  double map_width_cells = 1.4;            ///< reach of the weights between cells and markers, half of it
  int windows_per_interval = 1;
  double ramp_h = 0.2;  ///< forces rise from nothing over this time from the run's start
  /// In an interval a marker's force follows its contact stiffness, from the middle of the interval before, to which
  /// the mean force belongs. Without lag it is stable on rigid walls, where a held force pumps energy. Where the soil
  /// yields with stiffness k_soil, the root feels too much: as a dashpot of (k - k_soil) times the interval would add.
  /// Where it is false, a root with inertia feels the held force, one without the stiffness against what departs from a
  /// marker's mean pace: the dashpot of what is not steady.
  bool stiffness_predictor = false;
  bool under_relaxation = false;        ///< Aitken's
  std::optional<double> tip_length_mm;  ///< markers nearer to the tip make up the tip force; absent: a root's diameter
  std::function<bool(const Vec3& position_mm)> near_soil;  ///< empty: everywhere
  double inertial_number_max = 0.01;                       ///< stated for the soil
  FreeGrowth free_growth;                                  ///< for the check that a run prints
};

template <int Dim>
class SoilContactEffect final : public Effect<Dim> {
 public:
  /// The cells must be there, with their distances from the tip.
  SoilContactEffect(Solver<Dim>& solver, SoilContactParameters parameters, std::unique_ptr<SoilPort> port);

  void save(NamedReals& reals) const override;
  void restore(const NamedReals& reals) override;
  std::string state_file_name() const override { return "soil"; }
  void save_state_file(const std::filesystem::path& file) override { exchange_.port().save(file); }
  void restore_state_file(const std::filesystem::path& file) override { exchange_.port().load(file); }
  const Field<Dim, Vec<Dim>>* lasting_force() const override { return &force_; }
  void add_columns(const Tissue<Dim>& tissue, std::vector<FrameColumn>& columns) const override;
  void add_tables(std::vector<FrameTable>& tables) const override;
  std::vector<std::pair<std::string, double>> history() const override;
  std::vector<AccuracyMeasure> accuracy() const override;
  std::vector<std::string> take_notes() override;
  std::string closing_remark() const override;
  Vec<Dim> contact_force_N() const override;
  Vec<Dim> tip_force_N(double within_mm) const override;

  const MaterialSurface<Dim>& surface() const { return exchange_.surface(); }
  /// Of the soil on a marker, as last answered.
  const Vec<Dim>& marker_force_N(std::size_t marker) const { return exchange_.force_N(marker); }
  double root_work_Nmm() const { return books_.root_work_Nmm(); }  ///< done by the root since the start
  double soil_work_Nmm() const { return books_.soil_work_Nmm(); }  ///< received by the soil, by its own forces

 private:
  /// Where a marker is along the root.
  struct Place {
    double distance_to_tip_mm;
    Vec<Dim> tipwards;
  };

  void begin_window(Tissue<Dim>& tissue);
  void bound_stiffness(std::vector<Vec<Dim>>& stiffness) const;
  void spread(Tissue<Dim>& tissue);
  void add_forces(Tissue<Dim>& tissue, SlipAdvance advance);
  /// What the window is of a whole one: a step without inertia may be made in parts.
  double part() const;
  void move_markers(const Tissue<Dim>& tissue);
  void root_did(const std::vector<double>& work_Nmm);
  void exchange(const Tissue<Dim>& tissue);
  std::vector<MarkerThrust> thrust() const;
  RootSize root_size() const;
  double expected_speed_mm_h(const std::vector<MarkerThrust>& thrust) const;

  Solver<Dim>& solver_;
  SoilContactParameters parameters_;
  Field<Dim, Vec<Dim>>& force_;  ///< N, of the soil on each cell
  SoilExchange<Dim> exchange_;
  SoilBooks books_;
  EnergyCheck energy_;
  WindowForces<Dim> window_;
  std::vector<Place> place_;         ///< of each marker, at the window's start
  std::vector<std::size_t> loaded_;  ///< cells with a force
  std::vector<std::string> notes_;
};

EffectSpec soil_contact_effect();

}  // namespace rootsoil
