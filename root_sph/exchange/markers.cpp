// SPDX-License-Identifier: MIT
#include "root_sph/exchange/markers.hpp"

#include <fmt/format.h>

#include "root_sph/core/errors.hpp"

namespace rootsoil {

template <int Dim>
void Markers<Dim>::refuse_thin(const TissueShape<Dim>& shape) const {
  if (size_.radius_mm < 0.8 * shape.radius_mm()) return;
  throw InputError({"", 0, "soil marker radius", "the root is too thin for surface markers of this size",
                    fmt::format("{:.4g} mm", size_.radius_mm),
                    fmt::format("less than {:.4g} mm, 0.8 of the root's radius", 0.8 * shape.radius_mm()),
                    "use smaller markers, or more cells across the root"});
}

template <int Dim>
void Markers<Dim>::save(const std::string& prefix, std::map<std::string, std::vector<double>>& reals) const {
  std::vector<double>& position = reals[prefix + "position_mm"];
  for (const Vec<Dim>& x : position_) position.insert(position.end(), x.data(), x.data() + Dim);
  reals[prefix + "id"].assign(id_.begin(), id_.end());
  reals[prefix + "next_id"] = {static_cast<double>(next_id_)};
}

template <int Dim>
void Markers<Dim>::restore(const std::string& prefix, const std::map<std::string, std::vector<double>>& reals) {
  const std::vector<double>& position = reals.at(prefix + "position_mm");
  const std::vector<double>& id = reals.at(prefix + "id");
  ROOTSOIL_ASSERT(position.size() == Dim * id.size());
  position_.clear();
  for (std::size_t i = 0; i < id.size(); ++i)
    position_.push_back(Eigen::Map<const Vec<Dim>>(position.data() + Dim * i));
  id_.assign(id.begin(), id.end());
  next_id_ = static_cast<std::int64_t>(reals.at(prefix + "next_id").at(0));
}

template class Markers<2>;
template class Markers<3>;

}  // namespace rootsoil
