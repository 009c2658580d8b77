// SPDX-License-Identifier: MIT
// How a section of the scene file and its keys are written down: limits, the types of members, key() and section().
#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <type_traits>
#include <utility>
#include <vector>

#include "root_sph/scene/schema.hpp"

namespace rootsoil::sections {

using enum SectionKind;

// ---- limits ---------------------------------------------------------------------------------------

inline Limits above(double low) { return {.low = low, .low_open = true}; }
inline Limits at_least(double low) { return {.low = low}; }
inline Limits between(double low, double high) { return {.low = low, .high = high}; }
inline Limits inside(double low, double high) {
  return {.low = low, .high = high, .low_open = true, .high_open = true};
}
inline const Limits any_number;

inline constexpr const char* microns = "are these microns? 10 um are 0.01 mm";
inline constexpr const char* pascals = "are these Pa or kPa? 1 MPa = 1000 kPa = 1e6 Pa";
inline constexpr const char* seconds = "are these seconds? 3600 s are 1 h";

/// What a key accepts: a range, or a list of words.
struct Allowed {
  Limits limits;
  std::vector<std::string> choices;
  Allowed(Limits range) : limits(std::move(range)) {}
  Allowed(std::vector<std::string> words) : choices(std::move(words)) {}
};

inline Allowed one_of(std::vector<std::string> words) { return {std::move(words)}; }

inline const Allowed any_text = one_of({});
inline const Limits modulus = above(0).up_to(1e7, pascals);
inline const Limits pressure = at_least(-10).up_to(10, pascals);
inline const Limits place_mm = between(-1e3, 1e3);
inline const Limits fraction = between(-1, 1);

// ---- struct members as values ---------------------------------------------------------------------

template <class T, ValueType Type, class Stored = T>
struct PlainCodec {
  static constexpr ValueType type = Type;
  static T read(const Value& value) { return static_cast<T>(std::get<Stored>(value)); }
  static std::optional<Value> write(const T& member) { return Value(static_cast<Stored>(member)); }
};

template <class T>
struct Codec;
template <>
struct Codec<bool> : PlainCodec<bool, ValueType::boolean> {};
template <>
struct Codec<int> : PlainCodec<int, ValueType::integer, std::int64_t> {};
template <>
struct Codec<std::int64_t> : PlainCodec<std::int64_t, ValueType::integer> {};
template <>
struct Codec<double> : PlainCodec<double, ValueType::number> {};
template <>
struct Codec<Texts> : PlainCodec<Texts, ValueType::texts> {};
template <>
struct Codec<std::string> : PlainCodec<std::string, ValueType::text> {
  static std::optional<Value> write(const std::string& member) {
    return member.empty() ? std::nullopt : std::optional<Value>(member);
  }
};
template <>
struct Codec<Rows> : PlainCodec<Rows, ValueType::rows> {
  static std::optional<Value> write(const Rows& member) {
    return member.empty() ? std::nullopt : std::optional<Value>(member);
  }
};
/// An option is an enum; its words stand beside it (core/enum_names.hpp). Reading has checked the word.
template <class E>
requires std::is_enum_v<E>
struct Codec<E> {
  static constexpr ValueType type = ValueType::text;
  static E read(const Value& value) { return *from_name<E>(std::get<std::string>(value)); }
  static std::optional<Value> write(E member) { return Value(std::string(name_of(member))); }
};
template <std::size_t N>
struct Codec<std::array<double, N>> {
  static constexpr ValueType type = N == 2 ? ValueType::pair : ValueType::vector;
  static std::array<double, N> read(const Value& value) {
    const Numbers& numbers = std::get<Numbers>(value);
    std::array<double, N> member{};
    std::copy_n(numbers.begin(), std::min(N, numbers.size()), member.begin());
    return member;
  }
  static std::optional<Value> write(const std::array<double, N>& member) {
    return Value(Numbers(member.begin(), member.end()));
  }
};
template <class T>
struct Codec<std::optional<T>> {
  static constexpr ValueType type = Codec<T>::type;
  static std::optional<T> read(const Value& value) { return Codec<T>::read(value); }
  static std::optional<Value> write(const std::optional<T>& member) {
    return member ? Codec<T>::write(*member) : std::nullopt;
  }
};

// ---- keys -----------------------------------------------------------------------------------------

template <class S>
struct Key {
  KeySpec spec;
  std::function<void(S&, const Value&)> set;
  std::function<std::optional<Value>(const S&)> get;

  Key required() && {
    spec.required = true;
    spec.default_text = "required";
    return std::move(*this);
  }
  Key defaults_to(std::string text) && {
    spec.default_text = std::move(text);
    return std::move(*this);
  }
  Key only_with(std::string key) && { return std::move(*this).when({std::move(key), {}, false}); }
  Key only_without(std::string key) && { return std::move(*this).when({std::move(key), {}, true}); }
  Key only_where(std::string key, std::vector<std::string> values) && {
    return std::move(*this).when({std::move(key), std::move(values), false});
  }
  /// Of a file that the run reads (KeySpec::names_file).
  Key names_file() && {
    spec.names_file = true;
    return std::move(*this);
  }
  /// Can follow the pressure differential instead (Eq. 7).
  Key responds() && {
    spec.responds = true;
    return std::move(*this);
  }
  Key stands_for(std::function<void(Scene&)> fill) && {
    spec.stands_for = std::move(fill);
    return std::move(*this);
  }
  Key written_when(bool (*needed)(const S&)) && {
    get = [needed, get = std::move(get)](const S& s) { return needed(s) ? get(s) : std::nullopt; };
    return std::move(*this);
  }

 private:
  Key when(Condition condition) && {
    spec.condition = std::move(condition);
    return std::move(*this);
  }
};

template <class S, class T>
Key<S> key(T S::*member, const std::string& name, const std::string& unit, const Allowed& allowed,
           const std::string& meaning, const std::string& source) {
  using C = Codec<T>;
  Key<S> k;
  k.spec = {.name = name,
            .type = C::type,
            .unit = unit,
            .limits = allowed.limits,
            .choices = allowed.choices,
            .meaning = meaning,
            .source = source};
  k.set = [member](S& s, const Value& value) { s.*member = C::read(value); };
  k.get = [member](const S& s) { return C::write(s.*member); };
  const std::optional<Value> value_by_default = k.get(S{});
  k.spec.default_text = value_by_default ? toml_text(*value_by_default) : "none";
  return k;
}

/// An option: what is allowed are the words of its enum.
template <class S, class E>
requires std::is_enum_v<E> Key<S> key(E S::*member, const std::string& name, const std::string& meaning,
                                      const std::string& source) {
  return key(member, name, "-", one_of(names_of<E>()), meaning, source);
}

/// A table over time given by one number: beside the key of the rows, for a value that stays.
template <class S>
Key<S> constant_or_table(Rows S::*table, const std::string& name, const std::string& unit, const Limits& limits,
                         const std::string& meaning, const std::string& source) {
  Key<S> k;
  k.spec = {.name = name,
            .type = ValueType::number,
            .unit = unit,
            .limits = limits,
            .meaning = meaning,
            .source = source,
            .default_text = "none"};
  k.set = [table](S& s, const Value& value) { s.*table = {{0.0, std::get<double>(value)}}; };
  k.get = [table](const S& s) {
    return (s.*table).size() == 1 ? std::optional<Value>((s.*table).front()[1]) : std::nullopt;
  };
  return k;
}

/// A member of a base as a member of the section that inherits it.
template <class S, class T, class Base>
T S::*member_of(T Base::*member) {
  return member;
}

// ---- sections -------------------------------------------------------------------------------------

// A section is a member of the scene, or one of a list of structs.
template <class S>
std::size_t count_of(const S&) {
  return 1;
}
template <class S>
std::size_t count_of(const std::vector<S>& section) {
  return section.size();
}

template <class S>
auto& element_of(S& section, std::size_t) {
  return section;
}
template <class S>
S& element_of(std::vector<S>& section, std::size_t index) {
  return section[index];
}
template <class S>
const S& element_of(const std::vector<S>& section, std::size_t index) {
  return section[index];
}

template <class S>
void add_to(S&) {}
template <class S>
void add_to(std::vector<S>& section) {
  section.emplace_back();
}

/// `where` gives the section's place in a scene, nullptr where the section around it is absent.
template <class S, class Where>
SectionSpec section(std::string name, SectionKind kind, std::string meaning, Where where, std::vector<Key<S>> keys) {
  SectionSpec spec{.name = std::move(name), .kind = kind, .meaning = std::move(meaning)};
  spec.count = [where](const Scene& scene) { return where(scene) ? count_of(*where(scene)) : 0; };
  spec.add = [where](Scene& scene) { add_to(*where(scene)); };
  for (Key<S>& k : keys) {
    spec.keys.push_back(std::move(k.spec));
    spec.keys.back().set = [where, set = std::move(k.set)](Scene& scene, std::size_t index, const Value& value) {
      set(element_of(*where(scene), index), value);
    };
    spec.keys.back().get = [where, get = std::move(k.get)](const Scene& scene, std::size_t index) {
      return get(element_of(*where(scene), index));
    };
  }
  return spec;
}

/// A section of an effect, which the scene keeps by its type.
template <class S>
SectionSpec section(std::string name, SectionKind kind, std::string meaning, std::vector<Key<S>> keys) {
  return section<S>(
      std::move(name), kind, std::move(meaning), [](auto& scene) { return &scene.template all<S>(); }, std::move(keys));
}

}  // namespace rootsoil::sections
