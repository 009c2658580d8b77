// SPDX-License-Identifier: MIT
#include "root_sph/scene/read_scene.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <toml++/toml.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <fstream>
#include <sstream>
#include <utility>

#include "root_sph/core/errors.hpp"
#include "root_sph/scene/response.hpp"
#include "root_sph/scene/schema_keys.hpp"

namespace rootsoil {
namespace {

std::string join_path(const std::string& path, std::string_view key) {
  return path.empty() ? std::string(key) : fmt::format("{}.{}", path, key);
}

/// The value as the user wrote it, nearly.
std::string text_of(const toml::node& node) {
  constexpr std::size_t longest = 60;
  std::ostringstream out;
  node.visit([&](const auto& n) { out << n; });
  std::string text = out.str();
  if (text.size() > longest) text.replace(longest, std::string::npos, "...");
  return text;
}

// ---- overrides ------------------------------------------------------------------------------------

/// Puts `from` over `into`, key by key. Elements of a list of sections are addressed by number, from 1.
/// Nodes are moved, because that (unlike copying) keeps where they were read.
void lay_over(toml::table& into, toml::table&& from, const std::string& source, const std::string& path) {
  for (auto&& [name, node] : from) {
    const std::string_view key = name.str();
    const std::string here = join_path(path, key);
    toml::node* old = into.get(key);
    toml::table* table = node.as_table();
    if (table && old && old->is_table()) {
      lay_over(*old->as_table(), std::move(*table), source, here);
    } else if (table && old && old->is_array_of_tables()) {
      toml::array& list = *old->as_array();
      for (auto&& [number, element] : *table) {
        const std::string_view digits = number.str();
        std::size_t index = 0;
        const auto [end, error] = std::from_chars(digits.data(), digits.data() + digits.size(), index);
        if (error != std::errc{} || end != digits.data() + digits.size() || index < 1 || index > list.size() ||
            !element.is_table()) {
          throw InputError({.file = source,
                            .line = 0,
                            .key = join_path(here, digits),
                            .what = fmt::format("[[{}]] is a list of sections, addressed by number", key),
                            .given = std::string(digits),
                            .allowed = fmt::format("1 to {}", list.size()),
                            .remedy = fmt::format("write {}.1.key=value", key)});
        }
        lay_over(*list[index - 1].as_table(), std::move(*element.as_table()), source, join_path(here, digits));
      }
    } else {
      node.visit([&](auto& n) { into.insert_or_assign(key, std::move(n)); });
    }
  }
}

void apply_override(toml::table& scene, std::string_view text, const std::string& source) {
  const std::size_t equals = text.find('=');
  const auto wrong = [&](const std::string& what) {
    throw InputError({.file = source,
                      .line = 0,
                      .key = {},
                      .what = what,
                      .given = std::string(text),
                      .allowed = "section.key=value",
                      .remedy = "for example --set growth.c_g=-1"});
  };
  if (equals == std::string_view::npos || equals == 0) wrong("this is not a key and a value");
  const std::string key(text.substr(0, equals));
  const std::string value(text.substr(equals + 1));
  // a line break would let one override smuggle in whole sections, with line numbers that mean nothing
  if (text.find('\n') != std::string_view::npos) wrong("an override is one line");
  toml::table parsed;
  try {
    parsed = toml::parse(fmt::format("{}={}", key, value), std::string_view(source));
  } catch (const toml::parse_error&) {
    try {
      parsed = toml::parse(fmt::format("{}={}", key, toml_text(Value(value))), std::string_view(source));
    } catch (const toml::parse_error& e) {
      wrong(std::string(e.description()));
    }
  }
  if (parsed.empty()) wrong("this is not a key and a value");  // a comment
  lay_over(scene, std::move(parsed), source, {});
}

// ---- reading --------------------------------------------------------------------------------------

class Reader {
 public:
  Reader(const Language& language, const toml::table& table, std::string file)
      : language_(language), table_(table), file_(std::move(file)) {
    scene_.file = file_;
    scene_.origins.add("", {file_, 0});
    for (const SectionSpec& section : language_.sections()) {
      for (const KeySpec& key : section.keys) {
        if (key.stands_for) key.stands_for(scene_);
      }
    }
  }

  /// \param soil_alone only what means something without a root; the other sections are left alone
  Scene read(bool soil_alone) {
    scene_.has_root = !soil_alone;
    check_names(table_, {}, {});
    if (!soil_alone) refuse_soil_alone();
    for (const SectionSpec& section : language_.sections()) {
      if (!soil_alone || section.without_root) {
        read_section(section);
      } else if (section.name == "scene" && table_.contains("scene")) {
        read_keys(section, 0, *table_.get_as<toml::table>("scene"), false);
      }
    }
    if (!soil_alone) check_response_duplicates();
    for (const SectionSpec& section : language_.sections()) {
      const bool always = section.name == "scene";
      if (section.complete && (always || ((!soil_alone || section.without_root) && section.count(scene_) > 0)))
        section.complete(scene_);
    }
    return std::move(scene_);
  }

 private:
  Location location(const toml::node& node) const {
    const toml::source_region& region = node.source();
    if (region.path && *region.path != file_) return {*region.path, 0};
    return {file_, static_cast<int>(region.begin.line)};
  }

  [[noreturn]] void fail(const toml::node& node, const std::string& path, const std::string& what,
                         const std::string& given, const std::string& allowed, const std::string& remedy) const {
    const Location place = location(node);
    throw InputError({place.file, place.line, path, what, given, allowed, remedy});
  }

  /// Finds every name that does not belong, before anything is read: a misspelt key is then called
  /// misspelt, and not missing.
  void check_names(const toml::table& table, const std::string& name, const std::string& path) const {
    const SectionSpec* section = language_.find(name);
    for (const auto& [key, node] : table) {
      const std::string inner_name = join_path(name, key.str());
      const std::string inner_path = join_path(path, key.str());
      if (const SectionSpec* inner = language_.find(inner_name)) {
        check_section(*inner, node, inner_path);
      } else if (!section || !section->find(key.str())) {
        fail_unknown(node, section, name, inner_path, std::string(key.str()));
      }
    }
  }

  void check_section(const SectionSpec& section, const toml::node& node, const std::string& path) const {
    if (section.kind == SectionKind::repeated) {
      const toml::array* list = node.as_array();
      if (!list || !node.is_array_of_tables()) {
        fail(node, path, "this section can appear several times", node.is_table() ? "" : text_of(node),
             section_header(section), fmt::format("write {} with two brackets", section_header(section)));
      }
      for (std::size_t i = 0; i < list->size(); ++i) {
        check_names(*(*list)[i].as_table(), section.name, key_path(section, i));
      }
    } else if (const toml::table* table = node.as_table()) {
      check_names(*table, section.name, path);
    } else {
      fail(node, path, "this is the name of a section", text_of(node), fmt::format("[{}]", section.name),
           fmt::format("write [{}] once, on a line of its own, and its keys below", section.name));
    }
  }

  [[noreturn]] void fail_unknown(const toml::node& node, const SectionSpec* section, const std::string& name,
                                 const std::string& path, const std::string& key) const {
    std::vector<std::string> known;
    if (section) {
      for (const KeySpec& k : section->keys) known.push_back(k.name);
    }
    const std::string prefix = name.empty() ? "" : name + ".";
    for (const SectionSpec& s : language_.sections()) {
      // a key that is right but in the wrong section
      if (s.find(key)) {
        fail(node, path, "unknown key", {}, {}, fmt::format("{} is a key of [{}]: move it there", key, s.name));
      }
      if (s.name.starts_with(prefix)) known.push_back(s.name.substr(prefix.size()));
    }
    const bool is_section = node.is_table() || node.is_array_of_tables() || !section;
    const std::string best = nearest(key, known);
    fail(node, path, is_section ? "unknown section" : "unknown key", {}, {},
         fmt::format("did you mean {}? (rootsoil describe{} lists what there is)", best,
                     section ? " " + section->name : ""));
  }

  /// A file for rootsoil penetrometer lacks much of what a scene needs, but nothing is wrong with it.
  void refuse_soil_alone() const {
    const auto is_there = [&](const SectionSpec& s) { return s.without_root && table_.at_path(s.name).node(); };
    if (table_.contains("root") || std::none_of(language_.sections().begin(), language_.sections().end(), is_there)) {
      return;
    }
    scene_.origins.fail("", "section [root] is missing: the file describes a soil alone", {}, {},
                        "rootsoil penetrometer takes such a file; for a run add [root] and what it needs");
  }

  void read_section(const SectionSpec& section) {
    const toml::node* node = table_.at_path(section.name).node();
    const toml::array* list = section.kind == SectionKind::repeated && node ? node->as_array() : nullptr;
    const std::size_t count = list ? list->size() : node ? 1 : 0;
    if (count == 0 && section.kind == SectionKind::required) {
      scene_.origins.fail("", fmt::format("section [{}] is missing", section.name), {}, {},
                          fmt::format("add it; rootsoil describe {} lists its keys", section.name));
    }
    for (std::size_t i = 0; i < count; ++i) {
      section.add(scene_);
      const toml::table& table = *(list ? (*list)[i] : *node).as_table();
      scene_.origins.add(key_path(section, i), location(table));
      read_keys(section, i, table);
    }
  }

  void read_keys(const SectionSpec& section, std::size_t index, const toml::table& table, bool complete = true) {
    const auto read_key = [&](const KeySpec& key) {
      const toml::node* node = table.get(key.name);
      if (!node) return;
      const std::string path = key_path(section, index, key.name);
      key.set(scene_, index, read_value(*node, key, path));
      scene_.origins.add(path, location(*node));
    };
    for (const KeySpec& key : section.keys) {
      if (!key.stands_for) continue;
      read_key(key);
      key.stands_for(scene_);
    }
    for (const KeySpec& key : section.keys) read_key(key);
    if (!complete) return;
    for (const KeySpec& key : section.keys) check_presence(section, key, index);
  }

  void check_presence(const SectionSpec& section, const KeySpec& key, std::size_t index) const {
    const std::string path = key_path(section, index, key.name);
    const bool given = scene_.origins.has(path);
    if (given && !language_.applies(section, key, scene_, index)) {
      const Condition& c = *key.condition;
      const std::string other = key_path(section, index, c.key);
      if (c.absent)
        scene_.origins.fail(path, fmt::format("{} and {} exclude each other", key.name, c.key), {}, {},
                            "give one of them");
      scene_.origins.fail(path, "this key means nothing here", {},
                          c.values.empty() ? fmt::format("only together with {}", c.key)
                                           : fmt::format("only where {} is {}", c.key, fmt::join(c.values, " or ")),
                          fmt::format("remove it, or change {}", other));
    }
    if (!given && key.required && !key.responds && language_.applies(section, key, scene_, index))
      fail_missing(section, path, key);
  }

  [[noreturn]] void fail_missing(const SectionSpec& section, const std::string& path, const KeySpec& key) const {
    const std::string or_response =
        key.responds ? fmt::format(", here or as a pair in [{}]", response_section_name(section.name)) : "";
    scene_.origins.fail(path, "this key is missing", {}, allowed_text(key, scene_.scene.dimension),
                        fmt::format("give it{}: {}", or_response, key.meaning));
  }

  /// Can only be told when [response.*], which comes last, has been read.
  void check_response_duplicates() const {
    for (const SectionSpec& section : language_.sections()) {
      if (section.count(scene_) == 0) continue;
      for (const KeySpec& key : section.keys) {
        if (!key.responds) continue;
        const std::string path = key_path(section, 0, key.name);
        const bool given = scene_.origins.has(path);
        const bool supplied = language_.supplied_by_response(section, key, scene_);
        if (!given && !supplied && key.required && language_.applies(section, key, scene_, 0))
          fail_missing(section, path, key);
        if (given && supplied) {
          scene_.origins.fail(fmt::format("{}.{}", response_section_name(section.name), key.name),
                              fmt::format("{} is given in [{}] too", key.name, section.name), {}, {},
                              "give it in one of the two");
        }
      }
    }
  }

  Value read_value(const toml::node& node, const KeySpec& key, const std::string& path) const {
    const auto wrong = [&](const toml::node& at, const std::string& what, const std::string& remedy = {}) {
      fail(at, path, what, text_of(at), allowed_text(key, scene_.scene.dimension), remedy);
    };
    const auto number = [&](const toml::node& n) {
      const bool is_number = n.is_integer() || n.is_floating_point();
      if (!is_number)
        wrong(n, "this is not a number",
              n.is_string() ? "write it without quotes, with a digit on both sides of the point" : "");
      const double value = *n.value<double>();
      return value;
    };
    const auto in_range = [&](const toml::node& n, double value) {
      if (!std::isfinite(value)) wrong(n, "this is not a finite number");
      if (!key.limits.contains(value)) {
        wrong(n, "the value is outside its range", value >= key.limits.high ? key.limits.above_remedy : "");
      }
      constexpr double smallest = 1e-300;  // below, a number loses digits, and its inverse may be infinite
      if (key.limits.low == 0 && key.limits.low_open && value < smallest) {
        wrong(n, "the value is too small to compute with", fmt::format("give at least {}", smallest));
      }
      return value;
    };
    const auto text = [&](const toml::node& n) {
      if (!n.is_string()) wrong(n, "this is not a text", "write it in quotes");
      std::string value = n.ref<std::string>();
      if (!key.choices.empty() && std::find(key.choices.begin(), key.choices.end(), value) == key.choices.end()) {
        wrong(n, "this is not one of the choices", fmt::format("did you mean {}?", nearest(value, key.choices)));
      }
      if (value.empty() && key.type == ValueType::text) wrong(n, "this text is empty");
      return value;
    };
    const auto list = [&](const toml::node& n, std::size_t size, const char* what) -> const toml::array& {
      const toml::array* values = n.as_array();
      if (!values || (size > 0 && values->size() != size)) wrong(n, what);
      return *values;
    };
    const auto numbers = [&](std::size_t size) {
      Numbers values;
      for (const toml::node& n :
           list(node, size, size == 2 ? "this is not a list of two numbers" : "this is not a list of three numbers")) {
        values.push_back(in_range(n, number(n)));
      }
      return values;
    };

    switch (key.type) {
      case ValueType::boolean:
        if (!node.is_boolean()) wrong(node, "this is neither true nor false");
        return node.ref<bool>();
      case ValueType::integer:
        if (!node.is_integer()) wrong(node, "this is not a whole number");
        in_range(node, static_cast<double>(node.ref<std::int64_t>()));
        return node.ref<std::int64_t>();
      case ValueType::number:
        return in_range(node, number(node));
      case ValueType::text:
        return text(node);
      case ValueType::pair:
        return numbers(2);
      case ValueType::vector:
        return numbers(static_cast<std::size_t>(scene_.scene.dimension));
      case ValueType::texts: {
        Texts values;
        for (const toml::node& n : list(node, 0, "this is not a list of texts")) values.push_back(text(n));
        return values;
      }
      case ValueType::rows: {
        Rows rows;
        for (const toml::node& n : list(node, 0, "this is not a list of [time, value] pairs")) {
          const toml::array& row = list(n, 2, "this is not a [time, value] pair");
          const double time = number(row[0]);
          if (!std::isfinite(time)) wrong(row[0], "this is not a finite number");
          constexpr double farthest_h = 1e6;  // a hundred times the longest run
          if (std::abs(time) > farthest_h) {
            fail(row[0], path, "the time is outside its range", text_of(row[0]),
                 fmt::format("times from -{0:.0e} to {0:.0e} h", farthest_h), sections::seconds);
          }
          rows.push_back({time, in_range(row[1], number(row[1]))});
        }
        if (rows.empty()) wrong(node, "the list is empty");
        return rows;
      }
    }
    ROOTSOIL_ASSERT(false && "unknown value type");
    return {};
  }

  const Language& language_;
  const toml::table& table_;
  std::string file_;
  Scene scene_;
};

}  // namespace

namespace {

toml::table parse_table(std::string_view text, const std::string& file_name,
                        const std::vector<std::string>& set_overrides) {
  toml::table table;
  try {
    table = toml::parse(text, std::string_view(file_name));
  } catch (const toml::parse_error& e) {
    throw InputError({.file = file_name,
                      .line = static_cast<int>(e.source().begin.line),
                      .key = {},
                      .what = "this is not TOML: " + std::string(e.description()),
                      .given = {},
                      .allowed = {},
                      .remedy = "correct the line; https://toml.io describes the format"});
  }
  for (const std::string& entry : set_overrides) apply_override(table, entry, "from --set");
  return table;
}

std::string text_of_file(const std::filesystem::path& path) {
  const auto wrong = [&](const std::string& what, const std::string& remedy) {
    throw InputError(
        {.file = path.string(), .line = 0, .key = {}, .what = what, .given = {}, .allowed = {}, .remedy = remedy});
  };
  std::error_code error;
  if (!std::filesystem::exists(path, error))
    wrong("there is no such scene file", "check the path; scenarios/ holds examples");
  if (std::filesystem::is_directory(path, error))
    wrong("this is a folder, not a scene file", "give the .toml file in it");
  std::ifstream stream(path, std::ios::binary);
  std::ostringstream text;
  if (stream) text << stream.rdbuf();
  if (!stream || stream.bad()) {
    throw FileError(fmt::format("{}: cannot be read", path.string()), "check its permissions");
  }
  return text.str();
}

}  // namespace

Scene parse_scene(const Language& language, std::string_view text, std::string file_name, const ReadOptions& options) {
  toml::table table = parse_table(text, file_name, options.overrides);
  if (options.accuracy)
    apply_override(table, "numerics.accuracy=" + toml_text(Value(*options.accuracy)), "from --accuracy");
  return Reader(language, table, std::move(file_name)).read(options.soil_alone);
}

Scene read_scene(const Language& language, const std::filesystem::path& path, const ReadOptions& options) {
  return parse_scene(language, text_of_file(path), path.string(), options);
}

}  // namespace rootsoil
