// SPDX-License-Identifier: MIT
// Response of the tissue to soil strength, the paper's Eq. 7, for any key that declares that it responds: a pair in
// [response.NAME] then stands in the place of the key in the section NAME.
#pragma once

#include <array>
#include <optional>
#include <string>

#include "root_sph/core/enum_names.hpp"
#include "root_sph/scene/schema.hpp"

namespace rootsoil {

/// perceived: the pressure differential less what bodies outside exert on the root's tip.
enum class Follows { pressure, perceived };
template <>
inline constexpr EnumName<Follows> enum_names<Follows>[] = {{Follows::pressure, "pressure"},
                                                            {Follows::perceived, "perceived"}};

struct ResponseSection {
  bool extrapolate = true;  ///< false: theta is kept within [0, 1]
  Follows follows = Follows::pressure;
  double over_h = 1.0;                  ///< time constant of what is perceived; 0: at once
  std::optional<double> tip_length_mm;  ///< what acts nearer to the tip is perceived; absent: a root's diameter
};

/// Whether what responds follows what the root perceives.
bool responds_to_perceived(const Scene& scene);

/// Lowest and highest pressure that what responds can follow, MPa: those of the pressure differential over the run.
/// A root that perceives a push as large as its pressure follows 0.
std::array<double, 2> responding_range_MPa(const Scene& scene);

/// Eq. 7: xi(p) = theta xi_1 + (1 - theta) xi_2 with theta linear, theta(p_1) = 1, theta(p_2) = 0.
double responded(const std::array<double, 2>& pair, const std::array<double, 2>& p_MPa, double p, bool extrapolate);

/// "response.growth" for "growth", "response.anisotropy" for "tissue.anisotropy".
std::string response_section_name(const std::string& target);

/// What responds in a section, nullptr where nothing does.
const Response* response_of(const Scene& scene, const std::string& target);

/// [response.NAME] for a section with keys that respond.
SectionSpec response_section(const SectionSpec& target);

/// A section at a pressure differential: as the scene gives it, with the keys that respond at their value there.
template <class S>
S at_pressure(const Scene& scene, const SectionSpec& spec, double p_MPa) {
  const Response* response = response_of(scene, spec.name);
  if (!response) return *scene.find<S>();
  const ResponseSection* all = scene.find<ResponseSection>();
  Scene bare;
  bare.all<S>() = {*scene.find<S>()};
  for (const auto& [key, pair] : response->pairs) {
    spec.find(key)->set(bare, 0, responded(pair, response->p_MPa, p_MPa, !all || all->extrapolate));
  }
  return bare.all<S>().front();
}

}  // namespace rootsoil
