// SPDX-License-Identifier: MIT
#include "root_sph/effects/soil_contact.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <unordered_map>
#include <utility>

#include "root_sph/exchange/under_relaxation.hpp"

namespace rootsoil {
namespace {

template <int Dim>
Vec3 three(const Vec<Dim>& v) {
  Vec3 out{};
  std::copy(v.data(), v.data() + Dim, out.begin());
  return out;
}

template <int Dim>
Vec3 axial(const Spin<Dim>& v) {
  if constexpr (Dim == 2) {
    return {0.0, 0.0, v[0]};
  } else {
    return {v[0], v[1], v[2]};
  }
}

template <int Dim>
Vec<Dim> shortened(const Vec3& v) {
  return Eigen::Map<const Vec<Dim>>(v.data());
}

template <int Dim>
Spin<Dim> shortened_spin(const Vec3& v) {
  if constexpr (Dim == 2) {
    return Spin<2>(v[2]);
  } else {
    return Spin<3>(v[0], v[1], v[2]);
  }
}

template <int Dim>
TissueView<Dim> view(const ParticleStore<Dim>& cells) {
  return {cells.position.values(), cells.shape.values(), cells.volume.values(), cells.distance_to_tip.values()};
}

template <int Dim>
MarkerSize marker_size(const ParticleStore<Dim>& cells, const SoilContactParameters& p) {
  const double radius = p.marker_radius_mm ? *p.marker_radius_mm : median_cell_size_mm<Dim>(cells.volume.values());
  return {radius, p.marker_spacing * radius};
}

/// A column of vectors or tensors, row by row.
template <class T, std::size_t N>
std::vector<T> flat(const std::vector<std::array<T, N>>& rows) {
  std::vector<T> numbers;
  numbers.reserve(N * rows.size());
  for (const auto& row : rows) numbers.insert(numbers.end(), row.begin(), row.end());
  return numbers;
}

/// Of the two columns of pairs, the one.
std::vector<std::int64_t> member(const std::vector<std::array<std::int64_t, 2>>& pairs, std::size_t which) {
  std::vector<std::int64_t> ids;
  for (const auto& pair : pairs) ids.push_back(pair[which]);
  return ids;
}

/// Grains and contacts of a soil, for the frames; a soil without grains adds nothing.
void add_soil_points(SoilSnapshot soil, std::vector<PointSet>& points) {
  if (soil.id.empty()) return;
  for (auto& s : soil.stress_MPa) std::rotate(s.begin() + 3, s.end() - 1, s.end());  // frames: xx yy zz xy yz xz
  points.push_back({"grains",
                    {{"position", "mm", "centre of the grain", 3, flat(soil.position_mm)},
                     {"radius", "mm", "radius of the grain", 1, std::move(soil.radius_mm)},
                     {"velocity", "mm/h", "velocity of the grain", 3, flat(soil.velocity_mm_h)},
                     {"contacts", "1", "bodies that the grain touches", 1, std::move(soil.contacts)},
                     {"stress", "MPa", "mean stress in the grain, tension positive", 6, flat(soil.stress_MPa)},
                     {"grain_id", "1", "unique number of the grain", 1, std::move(soil.id)}}});
  constexpr const char* who = "grain_id of the body; -1 root, -2 wall, -3 obstacle";
  points.push_back({"soil_contacts",
                    {{"position", "mm", "where two bodies touch", 3, flat(soil.contact_position_mm)},
                     {"force", "N", "on the first body (2D: per mm of depth)", 3, flat(soil.contact_force_N)},
                     {"first_id", "1", who, 1, member(soil.contact_ids, 0)},
                     {"second_id", "1", who, 1, member(soil.contact_ids, 1)}}});
}

}  // namespace

template <int Dim>
Vec<Dim> predicted_force(const Vec<Dim>& force_N, double stiffness_N_mm, const Vec<Dim>& moved_mm) {
  constexpr double most = 4.0;
  const double size = force_N.norm();
  if (size <= 0.0) return force_N;
  const double grown = size - stiffness_N_mm * moved_mm.dot(force_N) / size;
  return force_N * (std::clamp(grown, 0.0, most * size) / size);
}

template <int Dim>
template <class Visit>
void SoilContactEffect<Dim>::Load::for_each_number(Visit&& visit) {
  const auto all = [&](auto& vector) {
    for (Eigen::Index k = 0; k < vector.size(); ++k) visit(vector[k]);
  };
  all(force_N);
  all(torque_Nmm);
  visit(stiffness_N_mm);
  all(residual_N);
  all(start_mm);
  all(angle);
  all(path_mm);
  visit(in_soil);
}

template <int Dim>
template <class Visit>
void SoilContactEffect<Dim>::Sums::for_each_number(Visit&& visit) {
  for (double* x :
       {&root_work_Nmm, &soil_work_Nmm, &expected_path_mm, &expected_from_h, &expected_from_mm, &relaxation}) {
    visit(*x);
  }
}

template <int Dim>
SoilContactEffect<Dim>::SoilContactEffect(Solver<Dim>& solver, SoilContactParameters parameters,
                                          std::unique_ptr<SoilPort> port)
    : solver_(solver),
      parameters_(std::move(parameters)),
      port_(std::move(port)),
      force_(solver.tissue().cells.template declare<Vec<Dim>>(
          {"soil force", "N", "force of the soil on the cell", Storage::scratch}, on_division::halve<Dim, Vec<Dim>>)),
      surface_(view<Dim>(solver.tissue().cells), marker_size<Dim>(solver.tissue().cells, parameters_)),
      load_(surface_.ids().size()) {
  ROOTSOIL_ASSERT(port_ && parameters_.windows_per_interval >= 1);
  if (!parameters_.tip_length_mm) {
    const TissueShape<Dim> shape(view<Dim>(solver.tissue().cells));
    parameters_.tip_length_mm = 2.0 * shape.radius_mm();
  }
  for (const std::string& name : port_->number_names()) numbers_[name] = std::numeric_limits<double>::quiet_NaN();
  Hooks<Dim>& hooks = solver.hooks();
  if (solver.tissue().neighbours_at_rest) {
    hooks.loads.push_back({&force_, &solver.tissue().cells.template declare<Vec<Dim>>(
                                        {"soil force asleep", "N", "force of the soil when the cell fell asleep"},
                                        on_division::halve<Dim, Vec<Dim>>)});
  }
  hooks.stiffness.emplace_back("soil contact",
                               [this](Tissue<Dim>& t, std::vector<Vec<Dim>>& k) { begin_window(t, k); });
  hooks.forces.emplace_back("soil contact", [this](Tissue<Dim>& t, SlipAdvance) { add_forces(t); });
  // first of all: what else happens at a window's end (the spacing of cells is evened out) is no motion of the tissue
  hooks.window_end.emplace(hooks.window_end.begin(), "soil", [this](Tissue<Dim>& t) { exchange(t); });
  hooks.window_end.emplace(hooks.window_end.begin(), "soil contact", [this](Tissue<Dim>& t) { move_markers(t); });
}

/// Markers for the interval: inserted, removed, in or out of the soil's reach. What they carried stays with them.
template <int Dim>
void SoilContactEffect<Dim>::begin_interval() {
  std::unordered_map<std::int64_t, std::size_t> before;
  for (std::size_t m = 0; m < load_.size(); ++m) before[surface_.ids()[m]] = m;
  surface_.refine();
  std::vector<Load> load(surface_.ids().size());
  for (std::size_t m = 0; m < load.size(); ++m) {
    const auto known = before.find(surface_.ids()[m]);
    if (known != before.end()) load[m] = load_[known->second];
    const Vec<Dim>& x = surface_.positions()[m];
    const bool near = !parameters_.near_soil || parameters_.near_soil(three<Dim>(x));
    if (!near) load[m] = Load{};
    // an id that the soil has seen go does not come back
    if (near && known != before.end() && interval_ > 0 && load[m].in_soil == 0.0) surface_.renew(m);
    load[m].in_soil = near ? 1.0 : 0.0;
    load[m].start_mm = x;
    load[m].angle.setZero();
  }
  load_.swap(load);
  interval_start_h_ = solver_.tissue().time_h;
}

template <int Dim>
double SoilContactEffect<Dim>::ramp(double time_h) const {
  return parameters_.ramp_h > 0.0 ? std::clamp(time_h / parameters_.ramp_h, 0.0, 1.0) : 1.0;
}

template <int Dim>
void SoilContactEffect<Dim>::begin_window(Tissue<Dim>& tissue, std::vector<Vec<Dim>>& stiffness) {
  const auto& cells = tissue.cells;
  if (windows_done_ == 0) begin_interval();
  mapping_ = SurfaceMapping<Dim>(surface_.positions(), cells.position.values(), cells.shape.values(),
                                 parameters_.map_width_cells);
  const std::size_t n = mapping_.markers();
  anchor_mm_.resize(n);
  distance_to_tip_mm_.resize(n);
  axis_.resize(n);
  std::vector<Vec<Dim>> cell_axis(cells.total());
  for (std::size_t i = 0; i < cells.total(); ++i) cell_axis[i] = cells.frame[i].col(0);
  for (std::size_t m = 0; m < n; ++m) {
    anchor_mm_[m] = mapping_.interpolate(m, cells.position.values());
    distance_to_tip_mm_[m] = mapping_.interpolate(m, cells.distance_to_tip.values());
    axis_[m] = mapping_.interpolate(m, cell_axis).normalized();
  }
  start_position_mm_ = cells.position.values();
  share_ = ramp(tissue.time_h + 0.5 * solver_.window_h());
  applied_N_.assign(n, Vec<Dim>::Zero());
  applied_from_mm_.assign(n, Vec<Dim>::Zero());
  for (std::size_t m = 0; m < n; ++m) applied_N_[m] = share_ * load_[m].force_N;
  spread_forces();
  add_stiffness(tissue, stiffness);
}

/// Row sums of the contacts' stiffness, |phi_mi| k_m sum_j |phi_mj|. A force that is held makes the interval the step
/// of the contact's spring, with a limit of its own: K_contact T^2/4 <= M.
template <int Dim>
void SoilContactEffect<Dim>::add_stiffness(const Tissue<Dim>& tissue, std::vector<Vec<Dim>>& stiffness) {
  std::map<std::size_t, double> contact;
  for (std::size_t m = 0; m < load_.size(); ++m) {
    if (load_[m].stiffness_N_mm <= 0.0) continue;
    double sum = 0.0;
    for (const auto& s : mapping_.shares(m)) sum += std::abs(s.weight);
    for (const auto& s : mapping_.shares(m)) {
      contact[static_cast<std::size_t>(s.cell)] += share_ * load_[m].stiffness_N_mm * sum * std::abs(s.weight);
    }
  }
  const double interval_h = parameters_.windows_per_interval * solver_.window_h();
  double limit_h = std::numeric_limits<double>::infinity();
  for (const auto& [i, k] : contact) {
    if (i >= tissue.cells.size()) break;  // the others rest
    stiffness[i].array() += k;
    if (tissue.cells.clamped[i] || k <= 0.0) continue;
    limit_h = std::min(limit_h, tissue.step_h * std::sqrt(stiffness[i].minCoeff() / k));
  }
  // said again only when it got much worse
  if (!parameters_.stiffness_predictor && interval_h > std::max(1.0, 1.5 * worst_interval_ratio_) * limit_h) {
    worst_interval_ratio_ = interval_h / limit_h;
    notes_.push_back(fmt::format(
        "the coupling interval of {:.3g} h is beyond the stability limit of the contacts' stiffness, {:.3g} h, at "
        "{:.4g} h; if the soil's force oscillates, take fewer steps a window or a smaller step",
        interval_h, limit_h, tissue.time_h));
  }
}

template <int Dim>
void SoilContactEffect<Dim>::spread_forces() {
  for (Vec<Dim>& f : force_.values()) f.setZero();
  loaded_.clear();
  for (std::size_t m = 0; m < load_.size(); ++m) {
    const Spin<Dim> torque = share_ * load_[m].torque_Nmm;
    if (applied_N_[m].isZero(0.0) && torque.isZero(0.0)) continue;
    mapping_.spread(m, applied_N_[m], torque, force_.values());
    for (const auto& s : mapping_.shares(m)) loaded_.push_back(static_cast<std::size_t>(s.cell));
  }
  std::sort(loaded_.begin(), loaded_.end());
  loaded_.erase(std::unique(loaded_.begin(), loaded_.end()), loaded_.end());
  Tissue<Dim>& tissue = solver_.tissue();  // cells at rest feel nothing else
  for (std::size_t i = tissue.cells.size(); i < tissue.cells.total(); ++i) tissue.force[i] = force_[i];
}

template <int Dim>
void SoilContactEffect<Dim>::add_forces(Tissue<Dim>& tissue) {
  if (parameters_.stiffness_predictor) {
    for (std::size_t m = 0; m < load_.size(); ++m) {
      if (load_[m].stiffness_N_mm <= 0.0) continue;
      const Vec<Dim> moved = mapping_.interpolate(m, tissue.cells.position.values()) - anchor_mm_[m];
      sum_.root_work_Nmm -= applied_N_[m].dot(moved - applied_from_mm_[m]);
      applied_from_mm_[m] = moved;
      const Vec<Dim> since_measured = 0.5 * load_[m].path_mm + surface_.positions()[m] - load_[m].start_mm + moved;
      applied_N_[m] = share_ * predicted_force<Dim>(load_[m].force_N, load_[m].stiffness_N_mm, since_measured);
    }
    spread_forces();
  }
  for (const std::size_t i : loaded_) {
    if (i < tissue.cells.size()) tissue.force[i] += force_[i];
  }
}

template <int Dim>
void SoilContactEffect<Dim>::move_markers(const Tissue<Dim>& tissue) {
  const auto& cells = tissue.cells;
  std::vector<Vec<Dim>> moved_cells(cells.total(), Vec<Dim>::Zero());
  for (std::size_t i = 0; i < cells.size(); ++i) moved_cells[i] = cells.position[i] - start_position_mm_[i];
  for (std::size_t m = 0; m < load_.size(); ++m) {
    const Vec<Dim> moved = mapping_.interpolate(m, moved_cells);
    const Spin<Dim> turned = mapping_.half_curl(m, moved_cells);
    surface_.positions()[m] += moved;
    load_[m].angle += turned;
    sum_.root_work_Nmm -= applied_N_[m].dot(moved - applied_from_mm_[m]) + share_ * load_[m].torque_Nmm.dot(turned);
  }
  ++windows_done_;
  if (share_ < 1.0 || !parameters_.free_growth.axial_rate_per_h) return;
  if (sum_.expected_from_h < 0.0) {
    sum_.expected_from_h = tissue.time_h;
    sum_.expected_from_mm = solver_.axis().length_mm();
  }
  sum_.expected_path_mm += solver_.window_h() * expected_tip_speed_mm_h();
}

template <int Dim>
void SoilContactEffect<Dim>::exchange(const Tissue<Dim>& tissue) {
  if (windows_done_ < parameters_.windows_per_interval) return;
  windows_done_ = 0;
  SurfaceMotion motion;
  motion.interval = interval_++;
  motion.time_h = interval_start_h_;
  motion.duration_h = tissue.time_h - interval_start_h_;
  std::vector<std::size_t> marker;
  for (std::size_t m = 0; m < load_.size(); ++m) {
    load_[m].path_mm = surface_.positions()[m] - load_[m].start_mm;
    if (load_[m].in_soil == 0.0) continue;
    marker.push_back(m);
    motion.id.push_back(surface_.ids()[m]);
    motion.start_mm.push_back(three<Dim>(load_[m].start_mm));
    motion.end_mm.push_back(three<Dim>(surface_.positions()[m]));
    motion.radius_mm.push_back(surface_.size().radius_mm);
    motion.spin_per_h.push_back(axial<Dim>(load_[m].angle / motion.duration_h));
  }
  take_answer(motion, marker, port_->advance(motion));
}

template <int Dim>
void SoilContactEffect<Dim>::take_answer(const SurfaceMotion& motion, const std::vector<std::size_t>& marker,
                                         const SurfaceForces& answer) {
  const bool torques = !answer.mean_torque_Nmm.empty();
  if (answer.mean_N.size() != marker.size() || answer.contact_stiffness_N_mm.size() != marker.size() ||
      (torques && answer.mean_torque_Nmm.size() != marker.size())) {
    throw Error(ExitStatus::soil_failed, fmt::format("the soil answered for {} of {} surface markers at {:.5g} h",
                                                     answer.mean_N.size(), marker.size(), motion.time_h));
  }
  std::vector<Vec<Dim>> residual(marker.size());
  double before_dot_change = 0.0, change_squared = 0.0, residual_squared = 0.0;
  for (std::size_t k = 0; k < marker.size(); ++k) {
    Load& load = load_[marker[k]];
    const Vec<Dim> force = shortened<Dim>(answer.mean_N[k]);
    const Spin<Dim> torque = torques ? shortened_spin<Dim>(answer.mean_torque_Nmm[k]) : Spin<Dim>(Spin<Dim>::Zero());
    if (!force.allFinite() || !torque.allFinite() || !std::isfinite(answer.contact_stiffness_N_mm[k])) {
      throw Error(
          ExitStatus::soil_failed,
          fmt::format("the soil's force on surface marker {} is not a number at {:.5g} h (position {:.4g}, "
                      "{:.4g}, {:.4g} mm)",
                      motion.id[k], motion.time_h, motion.end_mm[k][0], motion.end_mm[k][1], motion.end_mm[k][2]));
    }
    sum_.soil_work_Nmm -=
        force.dot(shortened<Dim>(motion.end_mm[k]) - shortened<Dim>(motion.start_mm[k])) + torque.dot(load.angle);
    load.stiffness_N_mm = answer.contact_stiffness_N_mm[k];
    load.torque_Nmm = torque;
    residual[k] = force - load.force_N;
    const Vec<Dim> change = residual[k] - load.residual_N;
    before_dot_change += load.residual_N.dot(change);
    change_squared += change.squaredNorm();
    residual_squared += residual[k].squaredNorm();
  }
  if (parameters_.under_relaxation) {
    sum_.relaxation = aitken_factor(sum_.relaxation, before_dot_change, change_squared, residual_squared);
  }
  for (std::size_t k = 0; k < marker.size(); ++k) {
    load_[marker[k]].force_N += sum_.relaxation * residual[k];
    load_[marker[k]].residual_N = residual[k];
  }
  for (auto& [name, value] : numbers_) {
    const auto given = answer.numbers.find(name);
    if (given != answer.numbers.end()) value = given->second;
  }
}

/// Axial thrust of the soil on the part of the root within a distance of the tip, N; compression positive.
template <int Dim>
double SoilContactEffect<Dim>::thrust_N(double within_mm) const {
  double sum = 0.0;
  for (std::size_t m = 0; m < applied_N_.size(); ++m) {
    if (distance_to_tip_mm_[m] <= within_mm) sum -= applied_N_[m].dot(axis_[m]);
  }
  return sum;
}

/// Integral of rate(s) (1 - thrust(s)/(p (1 - nu_A) W)): what the tip speed should be without inertia. With all force
/// at the tip this is V0 (1 - F/(p (1 - nu_A) W)).
template <int Dim>
double SoilContactEffect<Dim>::expected_tip_speed_mm_h() const {
  const RootAxis<Dim>& axis = solver_.axis();
  const double arrest_N = solver_.tissue().pressure_MPa * parameters_.free_growth.arrest_stress_per_pressure *
                          mean_section<Dim>(solver_.tissue(), axis);
  if (!(arrest_N > 0.0)) return 0.0;
  const auto bins = static_cast<std::size_t>(std::ceil(axis.length_mm() / axis.bin_mm()));
  std::vector<double> thrust(bins, 0.0);
  for (std::size_t m = 0; m < applied_N_.size(); ++m) {
    const double s = std::max(0.0, distance_to_tip_mm_[m]);
    thrust[std::min(bins - 1, static_cast<std::size_t>(s / axis.bin_mm()))] -= applied_N_[m].dot(axis_[m]);
  }
  const double width = axis.length_mm() / static_cast<double>(bins);
  double speed = 0.0, sum = 0.0;
  for (std::size_t b = 0; b < bins; ++b) {
    sum += thrust[b];
    const double rate = parameters_.free_growth.axial_rate_per_h((static_cast<double>(b) + 0.5) * width);
    speed += width * rate * std::max(0.0, 1.0 - sum / arrest_N);
  }
  return speed;
}

template <int Dim>
void SoilContactEffect<Dim>::add_columns(const Tissue<Dim>&, std::vector<FrameColumn>& columns) const {
  add_contact_force<Dim>(loaded_, force_, columns);
}

template <int Dim>
void SoilContactEffect<Dim>::add_points(std::vector<PointSet>& points) const {
  std::vector<double> position, force, radius(load_.size(), surface_.size().radius_mm), stiffness;
  for (std::size_t m = 0; m < load_.size(); ++m) {
    const Vec3 x = three<Dim>(surface_.positions()[m]);
    const Vec3 f = three<Dim>(load_[m].force_N);
    position.insert(position.end(), x.begin(), x.end());
    force.insert(force.end(), f.begin(), f.end());
    stiffness.push_back(load_[m].stiffness_N_mm);
  }
  points.push_back({"markers",
                    {{"position", "mm", "centre of the surface marker", 3, position},
                     {"radius", "mm", "radius of the marker; it touches the tissue's surface from within", 1, radius},
                     {"force", "N", "of the soil on the marker, mean over the latest interval", 3, force},
                     {"contact_stiffness", "N/mm", "of the marker's contacts", 1, stiffness},
                     {"marker_id", "1", "unique number of the marker", 1, surface_.ids()}}});
  if (interval_ > 0) add_soil_points(port_->snapshot(), points);  // before, the root has not been put in
}

template <int Dim>
std::vector<std::pair<std::string, double>> SoilContactEffect<Dim>::history() const {
  double contacts = 0.0, load = 0.0;
  for (const Vec<Dim>& f : applied_N_) {
    contacts += f.isZero(0.0) ? 0.0 : 1.0;
    load += f.norm();
  }
  const double tip_N = thrust_N(*parameters_.tip_length_mm);
  const double section = mean_section<Dim>(solver_.tissue(), solver_.axis());
  std::vector<std::pair<std::string, double>> row{
      {"soil_markers", static_cast<double>(load_.size())},
      {"soil_contacts", contacts},
      {"soil_tip_force_N", tip_N},
      {"soil_tip_resistance_MPa", tip_N / section},  // what a penetrometer's Q is for the root
      {"soil_axial_force_N", thrust_N(std::numeric_limits<double>::infinity())},
      {"soil_load_N", load},
      {"soil_root_work_Nmm", sum_.root_work_Nmm},
      {"soil_received_work_Nmm", sum_.soil_work_Nmm},
      {"soil_expected_tip_speed_mm_h",
       parameters_.free_growth.axial_rate_per_h && !applied_N_.empty() ? expected_tip_speed_mm_h() : 0.0}};
  row.insert(row.end(), numbers_.begin(), numbers_.end());
  return row;
}

template <int Dim>
std::vector<std::string> SoilContactEffect<Dim>::take_notes() {
  return std::exchange(notes_, {});
}

template <int Dim>
std::string SoilContactEffect<Dim>::closing_remark() const {
  const double hours = solver_.tissue().time_h - sum_.expected_from_h;
  if (sum_.expected_from_h < 0.0 || hours <= 0.0) return "";
  const double measured = (solver_.axis().length_mm() - sum_.expected_from_mm) / hours;
  return fmt::format(
      "soil: tip speed {:.4f} mm/h; from the soil's forces it should be {:.4f} mm/h, V0 (1 - F/(p (1 - "
      "nu_A) W)) along the root; work of the root {:.4g} N mm, received by the soil {:.4g} N mm",
      measured, sum_.expected_path_mm / hours, sum_.root_work_Nmm, sum_.soil_work_Nmm);
}

template <int Dim>
Vec<Dim> SoilContactEffect<Dim>::contact_force_N() const {
  Vec<Dim> sum = Vec<Dim>::Zero();
  for (const std::size_t i : loaded_) sum += force_[i];
  return sum;
}

template <int Dim>
void SoilContactEffect<Dim>::save(NamedReals& reals) const {
  surface_.save("soil/marker/", reals);
  std::vector<double>& load = reals["soil/marker/load"];
  for (Load l : load_) l.for_each_number([&](double& x) { load.push_back(x); });
  Sums sums = sum_;
  std::vector<double>& all = reals["soil/sums"];
  sums.for_each_number([&](double& x) { all.push_back(x); });
  reals["soil/interval"] = {static_cast<double>(interval_), static_cast<double>(windows_done_), interval_start_h_,
                            worst_interval_ratio_};
  std::vector<double>& numbers = reals["soil/numbers"];
  for (const auto& [name, value] : numbers_) numbers.push_back(value);
}

template <int Dim>
void SoilContactEffect<Dim>::restore(const NamedReals& reals) {
  surface_.restore("soil/marker/", reals);
  const auto take = [](const std::vector<double>& from, std::size_t& at) {
    return [&from, &at](double& x) { x = from.at(at++); };
  };
  std::size_t at = 0;
  load_.assign(surface_.ids().size(), Load{});
  for (Load& l : load_) l.for_each_number(take(reals.at("soil/marker/load"), at));
  at = 0;
  sum_.for_each_number(take(reals.at("soil/sums"), at));
  const std::vector<double>& interval = reals.at("soil/interval");
  interval_ = static_cast<std::int64_t>(interval.at(0));
  windows_done_ = static_cast<int>(interval.at(1));
  interval_start_h_ = interval.at(2);
  worst_interval_ratio_ = interval.at(3);
  at = 0;
  for (auto& [name, value] : numbers_) value = reals.at("soil/numbers").at(at++);
}

template Vec<2> predicted_force<2>(const Vec<2>&, double, const Vec<2>&);
template Vec<3> predicted_force<3>(const Vec<3>&, double, const Vec<3>&);
template class SoilContactEffect<2>;
template class SoilContactEffect<3>;

}  // namespace rootsoil
