// SPDX-License-Identifier: MIT
// The scene file's language as a table: every section, every key. Reading, the search for misspelt keys, `rootsoil
// describe` and the resolved scene file all follow from it; a new key is one line where its section is defined.
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <limits>
#include <optional>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include "root_sph/scene/scene.hpp"

namespace rootsoil {

using Numbers = std::vector<double>;
using Texts = std::vector<std::string>;
using Rows = std::vector<std::array<double, 2>>;

/// What a key can hold.
using Value = std::variant<bool, std::int64_t, double, std::string, Numbers, Texts, Rows>;

/// A pair is two numbers; a vector has as many as the scene has dimensions; rows are [[h, value], ...].
enum class ValueType { boolean, integer, number, text, pair, vector, texts, rows };

/// Allowed range of a number, or of each number of a list (of rows: of the second number).
struct Limits {
  double low = -std::numeric_limits<double>::infinity();
  double high = std::numeric_limits<double>::infinity();
  bool low_open = false;
  bool high_open = false;
  std::string above_remedy = {};  ///< what a far too large value hints at: mostly a wrong unit

  bool contains(double number) const;
  bool bounded() const;
  std::string text() const;
  Limits up_to(double highest, std::string remedy = {}) const;
};

/// A key only means something where another key of its section has a value (one of `values`, or any).
struct Condition {
  std::string key;
  std::vector<std::string> values;
  bool absent = false;  ///< the reverse: only where the other key has none
};

struct KeySpec {
  std::string name = {};
  ValueType type = ValueType::number;
  std::string unit = {};
  Limits limits = {};
  std::vector<std::string> choices = {};
  std::string meaning = {};
  std::string source = {};
  bool required = false;
  std::string default_text = {};
  std::optional<Condition> condition = {};
  bool names_file = false;  ///< results depend on what the file holds, not on where it lies
  bool responds = false;  ///< can follow the pressure differential: a pair in [response.*] supplies it instead (Eq. 7)
  std::function<void(Scene&, std::size_t, const Value&)> set = {};
  /// The value in use, nothing where there is none.
  std::function<std::optional<Value>(const Scene&, std::size_t)> get = {};
  /// Read before the other keys of its section, whose values it stands for: fills them in.
  std::function<void(Scene&)> stands_for = {};
};

enum class SectionKind {
  required,   ///< missing is an error
  defaulted,  ///< always in effect, every key has a default
  optional,   ///< absent = the effect is absent
  repeated,   ///< [[name]]
};

struct SectionSpec {
  std::string name = {};  ///< dotted, e.g. "tissue.anisotropy"
  SectionKind kind = SectionKind::optional;
  std::string meaning = {};
  std::vector<KeySpec> keys = {};
  std::function<std::size_t(const Scene&)> count = {};  ///< 0 = absent; otherwise how many
  std::function<void(Scene&)> add = {};                 ///< makes it present, or appends one
  /// Checks what concerns several keys or other sections, and fills in what is left out. Once, with everything read.
  std::function<void(Scene&)> complete = {};
  bool without_root = false;  ///< means something where there is no root too (rootsoil penetrometer)

  const KeySpec* find(std::string_view key) const;
  SectionSpec completed_by(std::function<void(Scene&)> check) &&;
  SectionSpec also_without_root() &&;
};

/// "root.radius_mm", "obstacle[2].radius_mm"; without key the element itself. Users count from 1.
std::string key_path(const SectionSpec& section, std::size_t index, std::string_view key = {});

/// "[root]", "[[obstacle]]"
std::string section_header(const SectionSpec& section);

/// As TOML writes it; numbers with every digit that matters.
std::string toml_text(const Value& value);

/// "a number above 0", "one of a, b"
std::string allowed_text(const KeySpec& key, int dimension);

/// The candidate with the smallest edit distance (letters inserted, dropped, changed or swapped).
std::string nearest(std::string_view word, const std::vector<std::string>& candidates);

/// Every section that a scene file can have: those of every scene, those of effects, and [response.*] for sections with
/// keys that respond.
class Language {
 public:
  /// \param of_effects in the order in which they are read, completed and written; one comes after the one it lies in
  explicit Language(std::vector<SectionSpec> of_effects);

  const std::vector<SectionSpec>& sections() const { return sections_; }
  const SectionSpec* find(std::string_view name) const;

  /// Does the key's condition hold in element `index` of the section?
  bool applies(const SectionSpec& section, const KeySpec& key, const Scene& scene, std::size_t index) const;
  /// Is the key supplied by [response.*], which then replaces it?
  bool supplied_by_response(const SectionSpec& section, const KeySpec& key, const Scene& scene) const;

  /// What `describe` says about one section, or about all.
  std::string describe(const std::optional<std::string>& section) const;

 private:
  std::vector<SectionSpec> sections_;
};

}  // namespace rootsoil
