// SPDX-License-Identifier: MIT
#include "root_sph/effects/soil_contact/soil_contact.hpp"

#include <limits>
#include <utility>

#include "root_sph/core/vec3.hpp"

namespace rootsoil {
namespace {

template <int Dim>
TissueView<Dim> view(const ParticleStore<Dim>& cells) {
  return {cells.position.values(), cells.shape.values(), cells.volume.values(), cells.distance_to_tip.values()};
}

template <int Dim>
MarkerSize marker_size(const ParticleStore<Dim>& cells, const SoilContactParameters& p) {
  const double radius = p.marker_radius_mm ? *p.marker_radius_mm : median_cell_size_mm<Dim>(cells.volume.values());
  return {radius, p.marker_spacing * radius};
}

}  // namespace

template <int Dim>
SoilContactEffect<Dim>::SoilContactEffect(Solver<Dim>& solver, SoilContactParameters parameters,
                                          std::unique_ptr<SoilPort> port)
    : solver_(solver),
      parameters_(std::move(parameters)),
      force_(solver.tissue().cells.template declare<Vec<Dim>>(
          {"soil force", "N", "force of the soil on the cell", Storage::scratch}, on_division::halve<Dim, Vec<Dim>>)),
      exchange_({view<Dim>(solver.tissue().cells), marker_size<Dim>(solver.tissue().cells, parameters_)},
                std::move(port),
                {parameters_.windows_per_interval, parameters_.under_relaxation, parameters_.near_soil}) {
  if (!parameters_.tip_length_mm) {
    const TissueShape<Dim> shape(view<Dim>(solver.tissue().cells));
    parameters_.tip_length_mm = 2.0 * shape.radius_mm();
  }
  Hooks<Dim>& hooks = solver.hooks();
  hooks.pair_history.emplace_back("soil contact", [this](Tissue<Dim>& t) { begin_window(t); });
  hooks.coupling.emplace_back("soil contact", [this](Tissue<Dim>&, std::vector<Vec<Dim>>& k) { bound_stiffness(k); });
  hooks.forces.emplace_back("soil contact", [this](Tissue<Dim>& t, SlipAdvance advance) { add_forces(t, advance); });
  hooks.contact_stiffness.emplace_back("soil contact", [this](Tissue<Dim>& t, std::vector<Mat<Dim>>& k) {
    window_.add_stiffness(t.cells.position.values(), part(), k);
  });
  hooks.surface.emplace_back("soil contact", [this](Tissue<Dim>& t) { move_markers(t); });
  hooks.exchange.emplace_back("soil", [this](Tissue<Dim>& t) { exchange(t); });
}

template <int Dim>
double SoilContactEffect<Dim>::part() const {
  return solver_.tissue().inertia ? 1.0 : solver_.window_h() / solver_.options().step_h;
}

template <int Dim>
void SoilContactEffect<Dim>::begin_window(Tissue<Dim>& tissue) {
  const auto& cells = tissue.cells;
  const double start_h = tissue.inertia ? tissue.time_h : tissue.time_h - solver_.window_h();
  if (exchange_.interval_begins()) exchange_.begin_interval(start_h);
  window_ = WindowForces<Dim>(
      {surface().positions(), cells.position.values(), cells.shape.values(), parameters_.map_width_cells},
      exchange_.forces(), ramp(start_h + 0.5 * solver_.window_h(), parameters_.ramp_h), cells.position.values(),
      !parameters_.stiffness_predictor);
  const SurfaceMapping<Dim>& mapping = window_.mapping();
  std::vector<Vec<Dim>> cell_axis(cells.total());
  for (std::size_t i = 0; i < cells.total(); ++i) cell_axis[i] = cells.frame[i].col(0);
  place_.clear();
  for (std::size_t m = 0; m < mapping.markers(); ++m) {
    place_.push_back(
        {mapping.interpolate(m, cells.distance_to_tip.values()), mapping.interpolate(m, cell_axis).normalized()});
  }
  spread(tissue);
}

template <int Dim>
void SoilContactEffect<Dim>::bound_stiffness(std::vector<Vec<Dim>>& stiffness) const {
  for (const auto& [i, k] : window_.stiffness()) {
    if (i < stiffness.size()) stiffness[i].array() += k;  // the others rest
  }
}

template <int Dim>
void SoilContactEffect<Dim>::spread(Tissue<Dim>& tissue) {
  loaded_ = window_.spread(force_.values());
  // cells at rest feel nothing else
  for (std::size_t i = tissue.cells.size(); i < tissue.cells.total(); ++i) tissue.force[i] = force_[i];
}

template <int Dim>
void SoilContactEffect<Dim>::add_forces(Tissue<Dim>& tissue, SlipAdvance advance) {
  if (!tissue.inertia) {
    root_did(window_.balance(tissue.cells.position.values(), part(), advance.kept_h > 0.0));
    spread(tissue);
  } else if (parameters_.stiffness_predictor) {
    root_did(window_.follow(tissue.cells.position.values()));
    spread(tissue);
  }
  for (const std::size_t i : loaded_) {
    if (i < tissue.cells.size()) tissue.force[i] += force_[i];
  }
}

template <int Dim>
void SoilContactEffect<Dim>::move_markers(const Tissue<Dim>& tissue) {
  const std::vector<MarkerMotion<Dim>> motion = window_.motion(tissue.cells.position.values(), tissue.cells.size());
  exchange_.move(motion, part());
  root_did(window_.work_Nmm(motion));
  if (window_.share() < 1.0 || !parameters_.free_growth.axial_rate_per_h) return;
  books_.expect(expected_speed_mm_h(thrust()), solver_.window_h(), tissue.time_h, solver_.axis().length_mm());
}

template <int Dim>
void SoilContactEffect<Dim>::root_did(const std::vector<double>& work_Nmm) {
  books_.root_did(work_Nmm);
  energy_.root_did(work_Nmm);
}

template <int Dim>
void SoilContactEffect<Dim>::exchange(const Tissue<Dim>& tissue) {
  if (!exchange_.interval_ends()) return;
  const std::vector<double> received_Nmm = exchange_.advance(tissue.time_h);
  books_.soil_received(received_Nmm);
  if (parameters_.stiffness_predictor || !parameters_.free_growth.axial_rate_per_h) return;
  const RootSize root = root_size();
  const double free_speed_mm_h = expected_speed_mm_h({});
  if (auto note = energy_.soil_received(received_Nmm, window_.share(),
                                        parameters_.windows_per_interval * solver_.window_h() / part(), tissue.time_h,
                                        root.arrest_N * free_speed_mm_h)) {
    notes_.push_back(std::move(*note));
  }
}

template <int Dim>
RootSize SoilContactEffect<Dim>::root_size() const {
  const RootAxis<Dim>& axis = solver_.axis();
  const double section = mean_section<Dim>(solver_.tissue(), axis);
  return {axis.length_mm(), axis.bin_mm(),
          parameters_.free_growth.arrest_stress_MPa(Pressures(solver_.tissue())) * section};
}

template <int Dim>
std::vector<MarkerThrust> SoilContactEffect<Dim>::thrust() const {
  std::vector<MarkerThrust> thrust;
  for (std::size_t m = 0; m < place_.size(); ++m) {
    thrust.push_back({place_[m].distance_to_tip_mm, -window_.applied_N()[m].dot(place_[m].tipwards)});
  }
  return thrust;
}

template <int Dim>
double SoilContactEffect<Dim>::expected_speed_mm_h(const std::vector<MarkerThrust>& thrust) const {
  const Pressures now(solver_.tissue());
  return expected_tip_speed_mm_h(thrust, root_size(),
                                 [&](double s_mm) { return parameters_.free_growth.axial_rate_per_h(s_mm, now); });
}

template <int Dim>
void SoilContactEffect<Dim>::add_columns(const Tissue<Dim>&, std::vector<FrameColumn>& columns) const {
  add_contact_force<Dim>(loaded_, force_, columns);
}

template <int Dim>
void SoilContactEffect<Dim>::add_tables(std::vector<FrameTable>& tables) const {
  MarkerSnapshot markers;
  markers.id = surface().ids();
  markers.radius_mm = surface().size().radius_mm;
  for (std::size_t m = 0; m < markers.id.size(); ++m) {
    markers.position_mm.push_back(three<Dim>(surface().positions()[m]));
    markers.force_N.push_back(three<Dim>(exchange_.force_N(m)));
    markers.stiffness_N_mm.push_back(exchange_.stiffness_N_mm(m));
  }
  tables.push_back(marker_table(std::move(markers)));
  if (!exchange_.has_met()) return;  // the root has not been put in yet
  for (FrameTable& of_soil : soil_tables(exchange_.port().snapshot())) tables.push_back(std::move(of_soil));
}

template <int Dim>
std::vector<std::pair<std::string, double>> SoilContactEffect<Dim>::history() const {
  const std::vector<MarkerThrust> on_markers = thrust();
  MarkerTotals totals;
  totals.markers = surface().ids().size();
  totals.tip_thrust_N = thrust_within_N(on_markers, *parameters_.tip_length_mm);
  totals.thrust_N = thrust_within_N(on_markers, std::numeric_limits<double>::infinity());
  totals.section = mean_section<Dim>(solver_.tissue(), solver_.axis());
  for (const Vec<Dim>& f : window_.applied_N()) {
    totals.in_touch += f.isZero(0.0) ? 0 : 1;
    totals.load_N += f.norm();
  }
  if (parameters_.free_growth.axial_rate_per_h && !on_markers.empty()) {
    totals.expected_tip_speed_mm_h = expected_speed_mm_h(on_markers);
  }
  return soil_history(totals, books_, exchange_.numbers());
}

template <int Dim>
std::vector<AccuracyMeasure> SoilContactEffect<Dim>::accuracy() const {
  const auto found = exchange_.numbers().find("soil_inertial_number");  // a soil without grains has none
  if (found == exchange_.numbers().end()) return {};
  // the density is chosen for the speed of the tip, and this is the number of an interval's fastest marker
  return {{found->first, found->second, 2.0 * parameters_.inertial_number_max,
           "take a smaller soil.inertial_number_max, or leave soil.density_N_h2_mm4 out"}};
}

template <int Dim>
std::vector<std::string> SoilContactEffect<Dim>::take_notes() {
  return std::exchange(notes_, {});
}

template <int Dim>
std::string SoilContactEffect<Dim>::closing_remark() const {
  return books_.closing_remark(solver_.tissue().time_h, solver_.axis().length_mm());
}

template <int Dim>
Vec<Dim> SoilContactEffect<Dim>::contact_force_N() const {
  Vec<Dim> sum = Vec<Dim>::Zero();
  for (const std::size_t i : loaded_) sum += force_[i];
  return sum;
}

template <int Dim>
Vec<Dim> SoilContactEffect<Dim>::tip_force_N(double within_mm) const {
  Vec<Dim> sum = Vec<Dim>::Zero();
  for (std::size_t m = 0; m < place_.size(); ++m) {
    if (place_[m].distance_to_tip_mm <= within_mm) sum += window_.applied_N()[m];
  }
  return sum;
}

template <int Dim>
void SoilContactEffect<Dim>::save(NamedReals& reals) const {
  exchange_.save(reals);
  books_.save(reals);
  energy_.save(reals);
}

template <int Dim>
void SoilContactEffect<Dim>::restore(const NamedReals& reals) {
  exchange_.restore(reals);
  books_.restore(reals);
  energy_.restore(reals);
}

template class SoilContactEffect<2>;
template class SoilContactEffect<3>;

}  // namespace rootsoil
