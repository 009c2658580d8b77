// SPDX-License-Identifier: MIT
// One coupling interval as the soil sees it: which markers there are, how they moved, and what the soil answers.
#pragma once

#include <functional>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include "root_sph/effects/soil_contact/marker_force.hpp"
#include "root_sph/exchange/material_surface.hpp"
#include "root_sph/exchange/soil_port.hpp"

namespace rootsoil {

/// The soil's answer for one marker.
template <int Dim>
struct MarkerAnswer {
  Vec<Dim> force_N;
  Spin<Dim> torque_Nmm;
  double stiffness_N_mm;
};

/// Of an answer, marker by marker. Error where it is not of the motion's length, or holds what is no number. Pure.
template <int Dim>
std::vector<MarkerAnswer<Dim>> checked_answer(const SurfaceMotion& motion, const SurfaceForces& answer);

struct ExchangeParameters {
  int windows_per_interval = 1;
  bool under_relaxation = false;                           ///< Aitken's
  std::function<bool(const Vec3& position_mm)> near_soil;  ///< empty: everywhere
};

/// Markers and port. In the order of a run: begin_interval, then for every window forces and move, then advance.
template <int Dim>
class SoilExchange {
 public:
  SoilExchange(MaterialSurface<Dim> surface, std::unique_ptr<SoilPort> port, ExchangeParameters parameters);

  bool interval_begins() const { return windows_done_ == 0; }
  bool interval_ends() const { return windows_done_ >= parameters_.windows_per_interval; }
  /// The soil has been told of the root.
  bool has_met() const { return interval_ > 0; }

  /// Markers are inserted, removed, in or out of the soil's reach. What they carried stays with them.
  void begin_interval(double time_h);
  /// One a marker.
  std::vector<MarkerForce<Dim>> forces() const;
  /// Markers go with the tissue; a window is over. \param part that it was of a whole one: a step without inertia may
  /// be cut into halves, quarters, ...
  void move(const std::vector<MarkerMotion<Dim>>& motion, double part = 1.0);
  /// Tells the soil how the markers moved until now and takes its forces for the next interval. Returns the work that
  /// the soil received at each of the markers it knows, by its own forces, N mm.
  std::vector<double> advance(double time_h);

  const MaterialSurface<Dim>& surface() const { return surface_; }
  SoilPort& port() const { return *port_; }
  /// As last answered; one a marker.
  const Vec<Dim>& force_N(std::size_t marker) const { return load_[marker].force_N; }
  double stiffness_N_mm(std::size_t marker) const { return load_[marker].stiffness_N_mm; }
  const std::map<std::string, double>& numbers() const { return numbers_; }  ///< the port's latest

  void save(std::map<std::string, std::vector<double>>& reals) const;
  void restore(const std::map<std::string, std::vector<double>>& reals);

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
    Vec<Dim> pace_mm = Vec<Dim>::Zero();     ///< path of an interval, mean over the latest ones
    double intervals = 0.0;                  ///< in that mean
    double in_soil = 0.0;                    ///< 1 where the port knows the marker

    template <class Visit>
    void for_each_number(Visit&& visit);
  };

  std::vector<std::size_t> markers_in_soil() const;
  SurfaceMotion motion(const std::vector<std::size_t>& markers, double time_h) const;
  void take(const std::vector<std::size_t>& markers, const std::vector<MarkerAnswer<Dim>>& answers);

  ExchangeParameters parameters_;
  std::unique_ptr<SoilPort> port_;
  MaterialSurface<Dim> surface_;
  std::vector<Load> load_;  ///< one a marker
  std::int64_t interval_ = 0;
  double windows_done_ = 0.0;  ///< of the interval under way
  double interval_start_h_ = 0.0;
  double relaxation_ = 1.0;
  std::map<std::string, double> numbers_;
};

}  // namespace rootsoil
