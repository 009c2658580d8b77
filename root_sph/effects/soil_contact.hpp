// SPDX-License-Identifier: MIT
// The root meets a soil: surface markers carry the tissue's motion to a SoilPort and the soil's forces back.
//
// One coupling interval is a whole number of solver windows. In it the cells carry the mean forces of the interval
// before; at its end the soil is told how the markers moved and answers with the next forces (a staggered scheme of
// first order: the interval is an accuracy knob).
#pragma once

#include <functional>
#include <memory>
#include <optional>

#include "root_sph/effects/effect.hpp"
#include "root_sph/exchange/material_surface.hpp"
#include "root_sph/exchange/soil_port.hpp"
#include "root_sph/exchange/surface_mapping.hpp"

namespace rootsoil {

/// The root without soil, for the check that a run prints.
struct FreeGrowth {
  std::function<double(double s_mm)> axial_rate_per_h;  ///< closed form at a distance from the tip
  double arrest_stress_per_pressure = 1.0;              ///< 1 - nu_A in 2D, 1 - 2 nu_A in 3D
};

struct SoilContactParameters {
  std::optional<double> marker_radius_mm;  ///< absent: one cell (median)
  double marker_spacing = 0.6;             ///< of the radius; gaps stay below 1.5 of it
  double map_width_cells = 1.4;            ///< reach of the weights between cells and markers, half of it
  int windows_per_interval = 1;
  double ramp_h = 0.2;  ///< forces rise from nothing over this time from the run's start
  /// In an interval a marker's force follows its contact stiffness, from the middle of the interval before, to which the
  /// mean force belongs. Without lag it is stable on rigid walls, where a held force pumps energy. Where the soil yields
  /// with stiffness k_soil, the root feels too much: as a dashpot of (k - k_soil) times the interval would add.
  bool stiffness_predictor = false;
  bool under_relaxation = false;        ///< Aitken's
  std::optional<double> tip_length_mm;  ///< markers nearer to the tip make up the tip force; absent: a root's diameter
  std::function<bool(const Vec3& position_mm)> near_soil;  ///< empty: everywhere
  FreeGrowth free_growth;
};

/// Force of a contact after its marker moved by this from where the force was measured: its size follows the stiffness
/// along its own line, never pulls, and grows at most fourfold. Pure.
template <int Dim>
Vec<Dim> predicted_force(const Vec<Dim>& force_N, double stiffness_N_mm, const Vec<Dim>& moved_mm);

template <int Dim>
class SoilContactEffect final : public Effect<Dim> {
 public:
  /// The cells must be there, with their distances from the tip.
  SoilContactEffect(Solver<Dim>& solver, SoilContactParameters parameters, std::unique_ptr<SoilPort> port);

  void save(NamedReals& reals) const override;
  void restore(const NamedReals& reals) override;
  bool has_own_file() const override { return true; }
  void save_own_file(const std::filesystem::path& file) override { port_->save(file); }
  void restore_own_file(const std::filesystem::path& file) override { port_->load(file); }
  void add_columns(const Tissue<Dim>& tissue, std::vector<FrameColumn>& columns) const override;
  void add_points(std::vector<PointSet>& points) const override;
  std::vector<std::pair<std::string, double>> history() const override;
  std::vector<std::string> take_notes() override;
  std::string closing_remark() const override;
  Vec<Dim> contact_force_N() const override;

  const MaterialSurface<Dim>& surface() const { return surface_; }
  const SoilPort& port() const { return *port_; }
  /// Of the soil on a marker, as last answered.
  const Vec<Dim>& marker_force_N(std::size_t marker) const { return load_[marker].force_N; }
  double root_work_Nmm() const { return sum_.root_work_Nmm; }  ///< done by the root since the start
  double soil_work_Nmm() const { return sum_.soil_work_Nmm; }  ///< received by the soil, by its own forces

 private:
  /// What a marker carries from interval to interval.
  struct Load {
    Vec<Dim> force_N = Vec<Dim>::Zero();
    Spin<Dim> torque_Nmm = Spin<Dim>::Zero();
    double stiffness_N_mm = 0.0;
    Vec<Dim> residual_N = Vec<Dim>::Zero();  ///< of under-relaxation
    Vec<Dim> start_mm = Vec<Dim>::Zero();    ///< at the interval's start
    Spin<Dim> angle = Spin<Dim>::Zero();     ///< turned since then
    Vec<Dim> path_mm = Vec<Dim>::Zero();     ///< of the interval before
    double in_soil = 0.0;                    ///< 1 where the port knows the marker

    template <class Visit>
    void for_each_number(Visit&& visit);
  };
  /// Sums over the run.
  struct Sums {
    double root_work_Nmm = 0.0, soil_work_Nmm = 0.0;
    double expected_path_mm = 0.0, expected_from_h = -1.0, expected_from_mm = 0.0;
    double relaxation = 1.0;
    template <class Visit>
    void for_each_number(Visit&& visit);
  };

  void begin_interval();
  void begin_window(Tissue<Dim>& tissue, std::vector<Vec<Dim>>& stiffness);
  void add_stiffness(const Tissue<Dim>& tissue, std::vector<Vec<Dim>>& stiffness);
  void spread_forces();
  void add_forces(Tissue<Dim>& tissue);
  void move_markers(const Tissue<Dim>& tissue);
  void exchange(const Tissue<Dim>& tissue);
  void take_answer(const SurfaceMotion& motion, const std::vector<std::size_t>& marker, const SurfaceForces& answer);
  double ramp(double time_h) const;
  double thrust_N(double within_mm) const;
  double expected_tip_speed_mm_h() const;

  Solver<Dim>& solver_;
  SoilContactParameters parameters_;
  std::unique_ptr<SoilPort> port_;
  Field<Dim, Vec<Dim>>& force_;  ///< N, of the soil on each cell
  MaterialSurface<Dim> surface_;
  std::vector<Load> load_;  ///< one a marker
  std::int64_t interval_ = 0;
  int windows_done_ = 0;  ///< of the interval under way
  double interval_start_h_ = 0.0;
  Sums sum_;
  std::map<std::string, double> numbers_;  ///< the port's latest

  // of the window under way
  SurfaceMapping<Dim> mapping_;
  std::vector<Vec<Dim>> anchor_mm_;          ///< sum phi x at the window's start
  std::vector<Vec<Dim>> start_position_mm_;  ///< of the cells
  std::vector<Vec<Dim>> applied_N_;          ///< ramped force on each marker, now
  std::vector<Vec<Dim>> applied_from_mm_;    ///< how far the marker had come in the window when it was set
  std::vector<double> distance_to_tip_mm_;   ///< of each marker
  std::vector<Vec<Dim>> axis_;
  std::vector<std::size_t> loaded_;    ///< cells with a force
  double share_ = 1.0;                 ///< of the ramp
  double worst_interval_ratio_ = 0.0;  ///< interval over its stability limit, the largest that was reported
  std::vector<std::string> notes_;
};

}  // namespace rootsoil
