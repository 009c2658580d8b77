// SPDX-License-Identifier: MIT
// The scene file's language as text: values as TOML, `rootsoil describe`, what a misspelt name may have meant.
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <utility>

#include "root_sph/core/errors.hpp"
#include "root_sph/scene/response.hpp"

namespace rootsoil {
namespace {

std::string number_text(double number) {
  std::string text = fmt::format("{}", number);  // the shortest that reads back as the same number
  if (text.find_first_not_of("-0123456789") == std::string::npos) text += ".0";
  return text;
}

std::string toml_quoted(std::string_view text) {
  std::string out = "\"";
  for (const char c : text) {
    if (c == '"' || c == '\\') {
      out += {'\\', c};
    } else if (static_cast<unsigned char>(c) < 0x20 || c == 0x7f) {
      out += fmt::format("\\u{:04x}", static_cast<unsigned>(c));
    } else {
      out += c;
    }
  }
  return out + '"';
}

template <class Range, class ToText>
std::string list_text(const Range& range, ToText to_text) {
  std::string out;
  for (const auto& element : range) {
    if (!out.empty()) out += ", ";
    out += to_text(element);
  }
  return "[" + out + "]";
}

std::string type_text(ValueType type, int dimension) {
  switch (type) {
    case ValueType::boolean:
      return "true or false";
    case ValueType::integer:
      return "a whole number";
    case ValueType::number:
      return "a number";
    case ValueType::text:
      return "a text";
    case ValueType::pair:
      return "two numbers";
    case ValueType::vector:
      return dimension == 0 ? "a number per dimension" : fmt::format("{} numbers", dimension);
    case ValueType::texts:
      return "a list of texts";
    case ValueType::rows:
      return "a list of pairs of numbers";
  }
  return {};
}

std::string condition_text(const Condition& condition) {
  if (condition.absent) return "only without " + condition.key;
  if (condition.values.empty()) return "only with " + condition.key;
  return fmt::format("only where {} is {}", condition.key, fmt::join(condition.values, " or "));
}

std::string wrapped(std::string_view text, std::size_t indent) {
  constexpr std::size_t columns = 100;
  std::string out;
  std::size_t column = 0;
  for (std::size_t begin = 0; begin < text.size();) {
    std::size_t end = std::min(text.find(' ', begin), text.size());
    const std::string_view word = text.substr(begin, end - begin);
    if (column == 0 || column + 1 + word.size() > columns) {
      if (!out.empty()) out += '\n';
      out.append(indent, ' ');
      column = indent;
    } else {
      out += ' ';
      ++column;
    }
    out += word;
    column += word.size();
    begin = end + 1;
  }
  return out + "\n";
}

std::string kind_text(SectionKind kind) {
  switch (kind) {
    case SectionKind::required:
      return "required";
    case SectionKind::defaulted:
      return "every key has a default";
    case SectionKind::optional:
      return "absent: the effect is absent";
    case SectionKind::repeated:
      return "as many as wanted";
  }
  return {};
}

std::string describe_section(const SectionSpec& s) {
  std::string out = fmt::format("{}  ({})\n", section_header(s), kind_text(s.kind));
  out += wrapped(s.meaning, 2);
  std::size_t name_width = 0, type_width = 0, unit_width = 0;
  for (const KeySpec& k : s.keys) {
    name_width = std::max(name_width, k.name.size());
    type_width = std::max(type_width, type_text(k.type, 0).size());
    unit_width = std::max(unit_width, k.unit.size());
  }
  for (const KeySpec& k : s.keys) {
    out += fmt::format("\n  {:{}}  {:{}}  {:{}}  {}\n", k.name, name_width, type_text(k.type, 0), type_width, k.unit,
                       unit_width, k.required ? "required" : "default: " + k.default_text);
    const std::string condition = k.condition ? condition_text(*k.condition) : std::string();
    if (k.limits.bounded() || !k.choices.empty()) {
      const std::string allowed = k.choices.empty() ? k.limits.text() : fmt::format("{}", fmt::join(k.choices, ", "));
      out += wrapped(fmt::format("allowed: {}{}{}", allowed, condition.empty() ? "" : "; ", condition), 6);
    } else if (!condition.empty()) {
      out += wrapped(condition, 6);
    }
    if (k.responds) out += wrapped(fmt::format("here or in [{}]", response_section_name(s.name)), 6);
    out += wrapped(k.source == "-" ? k.meaning : fmt::format("{} ({})", k.meaning, k.source), 6);
  }
  return out;
}

}  // namespace

std::string toml_text(const Value& value) {
  struct {
    std::string operator()(bool v) const { return v ? "true" : "false"; }
    std::string operator()(std::int64_t v) const { return fmt::format("{}", v); }
    std::string operator()(double v) const { return number_text(v); }
    std::string operator()(const std::string& v) const { return toml_quoted(v); }
    std::string operator()(const Numbers& v) const { return list_text(v, number_text); }
    std::string operator()(const Texts& v) const { return list_text(v, toml_quoted); }
    std::string operator()(const Rows& v) const {
      return list_text(v, [](const std::array<double, 2>& row) { return list_text(row, number_text); });
    }
  } to_text;
  return std::visit(to_text, value);
}

std::string allowed_text(const KeySpec& key, int dimension) {
  if (!key.choices.empty()) return fmt::format("one of {}", fmt::join(key.choices, ", "));
  std::string text = type_text(key.type, dimension);
  const bool single = key.type == ValueType::number || key.type == ValueType::integer;
  if (key.limits.bounded()) text += (single ? " " : ", each ") + key.limits.text();
  return text;
}

std::string Language::describe(const std::optional<std::string>& section) const {
  if (section) {
    if (const SectionSpec* found = find(*section)) return describe_section(*found);
    std::vector<std::string> names;
    for (const SectionSpec& s : sections_) names.push_back(s.name);
    throw InputError({.file = {},
                      .line = 0,
                      .key = {},
                      .what = "there is no such section",
                      .given = *section,
                      .allowed = fmt::format("{}", fmt::join(names, ", ")),
                      .remedy = fmt::format("did you mean {}?", nearest(*section, names))});
  }
  std::string out;
  for (const SectionSpec& s : sections_) {
    if (!out.empty()) out += '\n';
    out += describe_section(s);
  }
  return out;
}

std::string nearest(std::string_view word, const std::vector<std::string>& candidates) {
  // optimal string alignment; the word is cut because no key is that long and the cost is quadratic
  const auto distance = [](std::string_view a, std::string_view b) {
    std::vector<std::size_t> before(b.size() + 1), last(b.size() + 1), now(b.size() + 1);
    for (std::size_t j = 0; j <= b.size(); ++j) last[j] = j;
    for (std::size_t i = 1; i <= a.size(); ++i) {
      now[0] = i;
      for (std::size_t j = 1; j <= b.size(); ++j) {
        const std::size_t changed = last[j - 1] + (a[i - 1] == b[j - 1] ? 0 : 1);
        now[j] = std::min({changed, last[j] + 1, now[j - 1] + 1});
        const bool swapped = i > 1 && j > 1 && a[i - 1] == b[j - 2] && a[i - 2] == b[j - 1];
        if (swapped) now[j] = std::min(now[j], before[j - 2] + 1);
      }
      std::swap(before, last);
      std::swap(last, now);
    }
    return last[b.size()];
  };
  std::string best;
  std::size_t best_distance = std::numeric_limits<std::size_t>::max();
  for (const std::string& candidate : candidates) {
    const std::size_t d = distance(word.substr(0, 64), candidate);
    if (d < best_distance) {
      best_distance = d;
      best = candidate;
    }
  }
  return best;
}

}  // namespace rootsoil
