// SPDX-License-Identifier: MIT
// What the two surfaces of a root share: markers that move with the tissue, each with an id of its own.
#pragma once

#include <cstdint>
#include <map>
#include <string>
#include <vector>

#include "root_sph/exchange/tissue_shape.hpp"

namespace rootsoil {

/// What markers of a surface are made to.
struct MarkerSize {
  double radius_mm = 0.0;
  double spacing_mm = 0.0;  ///< wanted; gaps stay below 1.5 of it
};

/// Largest gap between neighbours in units of the spacing; beyond it a marker is inserted.
inline constexpr double largest_gap = 1.5;

template <int Dim>
class Markers {
 public:
  const std::vector<Vec<Dim>>& positions() const { return position_; }
  std::vector<Vec<Dim>>& positions() { return position_; }
  const std::vector<std::int64_t>& ids() const { return id_; }
  const MarkerSize& size() const { return size_; }

  /// A new id for a marker that comes back to where the soil is.
  void renew(std::size_t marker) { id_[marker] = next_id_++; }

  /// State for a checkpoint.
  void save(const std::string& prefix, std::map<std::string, std::vector<double>>& reals) const;
  void restore(const std::string& prefix, const std::map<std::string, std::vector<double>>& reals);

 protected:
  explicit Markers(MarkerSize size) : size_(size) {}
  /// InputError where the tissue is too thin for markers of this size.
  void refuse_thin(const TissueShape<Dim>& shape) const;

  MarkerSize size_;
  std::vector<Vec<Dim>> position_;
  std::vector<std::int64_t> id_;
  std::int64_t next_id_ = 0;
};

extern template class Markers<2>;
extern template class Markers<3>;

}  // namespace rootsoil
