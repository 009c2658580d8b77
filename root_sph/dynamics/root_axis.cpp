// SPDX-License-Identifier: MIT
#include "root_sph/dynamics/root_axis.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "root_sph/core/errors.hpp"
#include "root_sph/dynamics/cell_axes.hpp"

namespace rootsoil {
namespace {

/// Fills bins without cells from their neighbours: an empty bin read as rate 0 costs 12-24 % in tip speed.
void fill_gaps(std::vector<double>& value, const std::vector<double>& weight) {
  std::ptrdiff_t last = -1;
  for (std::ptrdiff_t b = 0; b < std::ssize(value); ++b) {
    if (weight[b] <= 0.0) continue;
    value[b] /= weight[b];
    for (std::ptrdiff_t gap = last + 1; gap < b; ++gap) {
      value[gap] = last < 0 ? value[b] : value[last] + (value[b] - value[last]) * double(gap - last) / double(b - last);
    }
    last = b;
  }
  if (last >= 0) std::fill(value.begin() + last + 1, value.end(), value[last]);
}

/// Memory and time go with this: a root that is a thread of 10^6 diameters has come apart.
std::size_t bins_along(double length_mm, double width_mm) {
  constexpr double most = 4e6;
  if (length_mm <= most * width_mm) return static_cast<std::size_t>(std::max(0.0, length_mm / width_mm));
  throw UnphysicalError(
      fmt::format("the tissue came apart: {:.4g} mm from the tip to the last cell, which is more than "
                  "{:.0e} times the width of a slice, {:.4g} mm",
                  length_mm, most, width_mm));
}

std::size_t bin_of(double s_mm, double width_mm) { return static_cast<std::size_t>(std::max(0.0, s_mm / width_mm)); }

}  // namespace

template <int Dim>
void RootAxis<Dim>::start(Tissue<Dim>& tissue) {
  double volume = 0.0, length = 0.0;
  for (std::size_t i = 0; i < tissue.cells.size(); ++i) {
    volume += tissue.cells.volume[i];
    length = std::max(length, tissue.cells.distance_to_tip[i]);
  }
  bin_mm_ = 0.25 * diameter_of<Dim>(volume / length);
  anchor(tissue);
}

template <int Dim>
void RootAxis<Dim>::anchor(Tissue<Dim>& tissue) {
  auto& cells = tissue.cells;
  double furthest = 0.0;
  for (const double s : cells.active(cells.distance_to_tip)) furthest = std::max(furthest, s);
  // Slices wide enough for many cells of both sides: two of the longest cells, at least a diameter, that of the start
  // and the present mean one. Cells at rest count, so that those awake lie in the same slices with and without them.
  double longest = 0.0, volume = 0.0;
  for (std::size_t i = 0; i < cells.size(); ++i) {
    longest = std::max(longest, 2.0 * half_extent<Dim>(cells.shape[i], cells.frame[i].col(0)));
  }
  for (std::size_t i = 0; i < cells.total(); ++i) {
    if (!tissue.is_base(i)) volume += cells.volume[i];
  }
  double width = std::max(4.0 * bin_mm_, 2.0 * longest);
  if (length_mm_ > 0.0) width = std::max(width, diameter_of<Dim>(volume / length_mm_));

  // the last, partial slice joins the one before it
  const std::size_t slices = std::max<std::size_t>(1, bins_along(furthest, width));
  std::vector<Vec<Dim>> knot(slices, Vec<Dim>::Zero());
  std::vector<double> weight(slices, 0.0);
  const auto slice_of = [&](std::size_t i) { return std::min(slices - 1, bin_of(cells.distance_to_tip[i], width)); };
  // A cell counts for the two slices whose middles it lies between, so that no centroid jumps when it passes from one
  // to the other.
  for (std::size_t i = 0; i < cells.size(); ++i) {
    const double z = std::clamp(cells.distance_to_tip[i] / width - 0.5, 0.0, static_cast<double>(slices - 1));
    const std::size_t b = bin_of(z, 1.0), next = std::min(slices - 1, b + 1);
    const double share = z - static_cast<double>(b);
    knot[b] += (1.0 - share) * cells.volume[i] * cells.position[i];
    weight[b] += (1.0 - share) * cells.volume[i];
    knot[next] += share * cells.volume[i] * cells.position[i];
    weight[next] += share * cells.volume[i];
  }
  std::vector<Vec<Dim>> line;
  std::vector<std::size_t> knot_of_slice(slices, 0);
  for (std::size_t b = 0; b < slices; ++b) {
    if (weight[b] > 0.0) line.push_back(knot[b] / weight[b]);
    knot_of_slice[b] = line.empty() ? 0 : line.size() - 1;
  }
  if (line.size() < 2) {
    // a root shorter than two slices is taken as straight along its mean axis
    Vec<Dim> direction = Vec<Dim>::Zero();
    for (std::size_t i = 0; i < cells.size(); ++i) direction += cells.volume[i] * cells.frame[i].col(0);
    line = {line[0], line[0] - width * direction.normalized()};
    std::fill(knot_of_slice.begin(), knot_of_slice.end(), 0);
  }

  // Arc length of each knot, from the first one; negative beyond it, towards the tip.
  std::vector<double> arc(line.size(), 0.0);
  for (std::size_t k = 1; k < line.size(); ++k) arc[k] = arc[k - 1] + (line[k] - line[k - 1]).norm();
  const auto project = [&](const Vec<Dim>& x, std::size_t near) {
    double best = 1e300, found = 0.0;
    const std::size_t from = near >= 2 ? near - 2 : 0, to = std::min(near + 1, line.size() - 2);
    for (std::size_t k = from; k <= to; ++k) {
      const Vec<Dim> along = line[k + 1] - line[k];
      const double length2 = along.squaredNorm();
      double t = length2 > 0.0 ? (x - line[k]).dot(along) / length2 : 0.0;
      if (k > 0) t = std::max(t, 0.0);  // the ends go on as straight lines
      if (k + 2 < line.size()) t = std::min(t, 1.0);
      const double distance2 = (x - line[k] - t * along).squaredNorm();
      if (distance2 < best) {
        best = distance2;
        found = arc[k] + t * (arc[k + 1] - arc[k]);
      }
    }
    return found;
  };
  const Vec<Dim> tipwards = (line[0] - line[1]).normalized();
  std::vector<double> s(cells.size());
  double first = 1e300;
  for (std::size_t i = 0; i < cells.size(); ++i) {
    const std::size_t near = knot_of_slice[slice_of(i)];
    s[i] = project(cells.position[i], near);
    if (near <= 1) first = std::min(first, s[i] - half_extent<Dim>(cells.shape[i], tipwards));
  }
  length_mm_ = 0.0;
  for (std::size_t i = 0; i < cells.size(); ++i) {
    cells.distance_to_tip[i] = s[i] - first;
    if (!cells.clamped[i]) {
      const double end = cells.distance_to_tip[i] + half_extent<Dim>(cells.shape[i], cells.frame[i].col(0));
      length_mm_ = std::max(length_mm_, end);
    }
  }
  length_mm_ += still_mm_;
  tip_mm_ = line[0] - first * tipwards;
}

template <int Dim>
void RootAxis<Dim>::measure_flow(const Tissue<Dim>& tissue, std::span<const double> distance_mm, double window_h) {
  const auto& cells = tissue.cells;
  const std::size_t bins = bins_along(length_mm_, bin_mm_) + 2;
  std::vector<double> rate(bins, 0.0), weight(bins, 0.0);
  for (std::size_t i = 0; i < cells.size(); ++i) {
    if (cells.clamped[i]) continue;
    const std::size_t b = std::min(bins - 1, bin_of(distance_mm[i], bin_mm_));
    rate[b] += cells.volume[i] * tissue.axial_strain[i] / window_h;
    weight[b] += cells.volume[i];
  }
  fill_gaps(rate, weight);
  std::vector<double> flow(bins + 1, 0.0);
  for (std::size_t b = 0; b < bins; ++b) flow[b + 1] = flow[b] + bin_mm_ * rate[b];

  constexpr double smoothing_h = 0.1;
  const double share = flow_mm_h_.empty() ? 1.0 : std::min(1.0, window_h / smoothing_h);
  flow_mm_h_.resize(flow.size(), flow_mm_h_.empty() ? 0.0 : flow_mm_h_.back());
  for (std::size_t k = 0; k < flow.size(); ++k) flow_mm_h_[k] += share * (flow[k] - flow_mm_h_[k]);
}

template <int Dim>
double RootAxis<Dim>::flow_mm_h(double s_mm) const {
  if (flow_mm_h_.size() < 2 || s_mm <= 0.0) return 0.0;
  const double z = s_mm / bin_mm_;
  const std::size_t k = std::min(static_cast<std::size_t>(z), flow_mm_h_.size() - 2);
  return flow_mm_h_[k] + std::min(1.0, z - double(k)) * (flow_mm_h_[k + 1] - flow_mm_h_[k]);
}

template <int Dim>
double RootAxis<Dim>::strain_rate_per_h(double s_mm) const {
  if (flow_mm_h_.size() < 2) return 0.0;
  // linear between the middles of the bins
  const double z = std::max(0.0, s_mm / bin_mm_ - 0.5);
  const std::size_t last = flow_mm_h_.size() - 2;
  const std::size_t k = std::min(static_cast<std::size_t>(z), last);
  const auto rate = [&](std::size_t b) { return (flow_mm_h_[b + 1] - flow_mm_h_[b]) / bin_mm_; };
  if (k == last) return rate(last);
  return rate(k) + (z - double(k)) * (rate(k + 1) - rate(k));
}

template <int Dim>
double RootAxis<Dim>::steady_acceleration(double s_mm) const {
  return strain_rate_per_h(length_mm_) * flow_mm_h(length_mm_) - strain_rate_per_h(s_mm) * flow_mm_h(s_mm);
}

template <int Dim>
std::vector<double> RootAxis<Dim>::save() const {
  std::vector<double> saved{bin_mm_, length_mm_, still_mm_};
  saved.insert(saved.end(), tip_mm_.data(), tip_mm_.data() + Dim);
  saved.insert(saved.end(), flow_mm_h_.begin(), flow_mm_h_.end());
  return saved;
}

template <int Dim>
void RootAxis<Dim>::restore(const std::vector<double>& saved) {
  ROOTSOIL_ASSERT(saved.size() >= 3 + Dim);
  bin_mm_ = saved[0];
  length_mm_ = saved[1];
  still_mm_ = saved[2];
  tip_mm_ = Eigen::Map<const Vec<Dim>>(saved.data() + 3);
  flow_mm_h_.assign(saved.begin() + 3 + Dim, saved.end());
}

template <int Dim>
double mean_section(const Tissue<Dim>& tissue, const RootAxis<Dim>& axis) {
  const auto& cells = tissue.cells;
  double volume = 0.0;
  for (std::size_t i = 0; i < cells.total(); ++i) {
    if (!tissue.is_base(i)) volume += cells.volume[i];
  }
  return volume / axis.length_mm();
}

template <int Dim>
void InertiaImpulse<Dim>::add_window(const Tissue<Dim>& tissue, const RootAxis<Dim>& axis, double window_h) {
  const auto& cells = tissue.cells;
  const double width = axis.bin_mm();
  const std::size_t bins = bins_along(axis.length_mm(), width) + 1;
  impulse_N_h_.resize(std::max(bins, impulse_N_h_.size()), 0.0);
  for (std::size_t i = 0; i < cells.size(); ++i) {
    if (cells.clamped[i] || !(tissue.inertia->inverse[i][0] > 0.0)) continue;
    Vec<Dim> change = cells.velocity[i] - tissue.inertia->start_velocity[i];
    if (tissue.body_acceleration) change -= window_h * (*tissue.body_acceleration)[i];
    const std::size_t b = std::min(bins - 1, bin_of(cells.distance_to_tip[i], width));
    impulse_N_h_[b] += change.dot(cells.frame[i].col(0)) / tissue.inertia->inverse[i][0];
  }
  duration_h_ += window_h;
}

template <int Dim>
double InertiaImpulse<Dim>::error(const Tissue<Dim>& tissue, const RootAxis<Dim>& axis) const {
  if (tissue.pressure_MPa == 0.0 || duration_h_ <= 0.0) return 0.0;
  const auto& cells = tissue.cells;
  double volume = 0.0;
  for (std::size_t i = 0; i < cells.size(); ++i) {
    if (!cells.clamped[i]) volume += cells.volume[i];
  }
  const double section = volume / axis.moving_length_mm();
  double sum = 0.0, worst = 0.0;
  for (const double impulse : impulse_N_h_) {
    sum += impulse;
    worst = std::max(worst, std::abs(sum));
  }
  return worst / (duration_h_ * std::abs(tissue.pressure_MPa) * section);
}

template <int Dim>
std::vector<double> InertiaImpulse<Dim>::save() const {
  std::vector<double> saved{duration_h_};
  saved.insert(saved.end(), impulse_N_h_.begin(), impulse_N_h_.end());
  return saved;
}

template <int Dim>
void InertiaImpulse<Dim>::restore(const std::vector<double>& saved) {
  duration_h_ = saved.at(0);
  impulse_N_h_.assign(saved.begin() + 1, saved.end());
}

template class RootAxis<2>;
template class RootAxis<3>;
template double mean_section<2>(const Tissue<2>&, const RootAxis<2>&);
template double mean_section<3>(const Tissue<3>&, const RootAxis<3>&);
template class InertiaImpulse<2>;
template class InertiaImpulse<3>;

}  // namespace rootsoil
