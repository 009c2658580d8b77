// SPDX-License-Identifier: MIT
// The tissue laws. The choices of the scene file, the instances of the cell loop, the start, the closed form and the
// search for waves that grow by themselves all follow from this list.
#pragma once

#include <tuple>
#include <utility>

#include "root_sph/core/enum_names.hpp"
#include "root_sph/tissue/laws/elastic_growth.hpp"
#include "root_sph/tissue/laws/pressure_deviator.hpp"

namespace rootsoil {

/// Every law; a new one is its file and its name here.
template <int Dim>
using TissueLaws = std::tuple<ElasticGrowth<Dim>, PressureDeviator<Dim>>;

/// A law by its place in the list.
enum class TissueLaw : std::size_t {};

/// What is said about a law.
struct TissueLawEntry {
  TissueLaw value;
  std::string_view name, meaning, source;
  bool always_hyperbolic;
};

/// In the order of the list.
template <IsTissueLaw... Law>
constexpr auto entries_of(const std::tuple<Law...>&) {
  std::size_t place = 0;
  return std::array{
      TissueLawEntry{TissueLaw{place++}, Law::name, Law::meaning, Law::source, Law::always_hyperbolic}...};
}
inline constexpr auto tissue_laws = entries_of(TissueLaws<2>{});

constexpr const TissueLawEntry& entry_of(TissueLaw law) { return tissue_laws[static_cast<std::size_t>(law)]; }

/// Its words in the scene file.
constexpr auto law_names() {
  std::array<EnumName<TissueLaw>, tissue_laws.size()> names{};
  for (std::size_t k = 0; k < names.size(); ++k) names[k] = {tissue_laws[k].value, tissue_laws[k].name.data()};
  return names;
}
template <>
inline constexpr auto enum_names<TissueLaw> = law_names();

/// law_of<ElasticGrowth>
template <template <int> class Law>
inline constexpr TissueLaw law_of = from_name<TissueLaw>(Law<2>::name).value();

/// f(Law()) for the law: the one place where a value becomes a type.
template <int Dim, std::size_t Place = 0, class F>
auto visit_law(TissueLaw law, F&& f) {
  if constexpr (Place + 1 < tissue_laws.size()) {
    if (law != TissueLaw{Place}) return visit_law<Dim, Place + 1>(law, std::forward<F>(f));
  }
  return f(std::tuple_element_t<Place, TissueLaws<Dim>>());
}

template <int Dim>
VoigtMat<Dim> tangent_of(TissueLaw law, const Stiffness<Dim>& k) {
  return visit_law<Dim>(law, [&k]<class Law>(Law) { return Law::tangent(k); });
}

}  // namespace rootsoil
