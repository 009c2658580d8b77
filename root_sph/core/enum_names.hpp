// SPDX-License-Identifier: MIT
// The words for an option's values: one table beside the enum, which reading, writing and listing follow.
#pragma once

#include <array>
#include <cstddef>
#include <iterator>
#include <optional>
#include <string>
#include <string_view>
#include <type_traits>
#include <vector>

namespace rootsoil {

template <class E>
struct EnumName {
  E value;
  const char* name;
};

/// Specialised beside an enum: `template <> inline constexpr EnumName<Base> enum_names<Base>[] = {{Base::free, "free"},
/// ...}`.
template <class E>
inline constexpr EnumName<E> enum_names[1] = {{E{}, ""}};

template <class E>
constexpr const char* name_of(E value) {
  static_assert(std::is_enum_v<E>);
  for (const EnumName<E>& entry : enum_names<E>) {
    if (entry.value == value) return entry.name;
  }
  return "";
}

template <class E>
constexpr std::optional<E> from_name(std::string_view name) {
  for (const EnumName<E>& entry : enum_names<E>) {
    if (name == entry.name) return entry.value;
  }
  return std::nullopt;
}

template <class E>
std::vector<std::string> names_of() {
  std::vector<std::string> names;
  names.reserve(std::size(enum_names<E>));
  for (const EnumName<E>& entry : enum_names<E>) names.emplace_back(entry.name);
  return names;
}

}  // namespace rootsoil
