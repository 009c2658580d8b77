// SPDX-License-Identifier: MIT
#include "root_sph/app/resume.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <charconv>
#include <map>
#include <variant>

#include "root_sph/core/digest.hpp"
#include "root_sph/core/errors.hpp"
#include "root_sph/core/version.hpp"
#include "root_sph/effects/table.hpp"
#include "root_sph/io/files.hpp"

namespace rootsoil {
namespace fs = std::filesystem;
namespace {

/// Windows end at output times, so output.every_h is not one of them.
bool may_change(const std::string& path) {
  return path == "scene.duration_h" || path == "output.picture" || path == "output.checkpoint_every_h" ||
         path == "numerics.inertia_error_max" || path == "numerics.beyond_accuracy";
}

/// The key's line in the language; path as of key_path.
const KeySpec* key_of(const std::string& path) {
  const std::size_t dot = path.rfind('.');
  const SectionSpec* section = language().find(path.substr(0, std::min(path.find('['), dot)));
  return section ? section->find(path.substr(dot + 1)) : nullptr;
}

bool names_file(const std::string& path) {
  const KeySpec* key = key_of(path);
  return key && key->names_file;
}

/// The key's value as the digest sees it: of a file that the run reads, what it holds.
std::string content(const Scene& scene, const std::string& path, const std::string& text) {
  if (!names_file(path)) return text;
  return read_whole_file(std::get<std::string>(*key_of(path)->get(scene, 0)));
}

}  // namespace

std::string scene_digest(const Scene& scene) {
  std::string all;
  for (const SectionSpec& section : language().sections()) {
    if (section.count(scene) > 0) all += section_header(section);  // some have no keys
  }
  for (const auto& [path, text] : resolved_values(language(), scene)) {
    if (may_change(path)) continue;
    all += fmt::format("\n{} = {}", path, content(scene, path, text));
  }
  return fmt::format("{:016x}", fnv1a(all));
}

std::vector<std::string> differences(const ResolvedValues& now, const ResolvedValues& was) {
  std::map<std::string, std::string> old;
  for (const auto& [path, text] : was) {
    if (!may_change(path)) old.emplace(path, text);
  }
  std::vector<std::string> found;
  for (const auto& [path, text] : now) {
    if (may_change(path)) continue;
    const auto same_key = old.find(path);
    if (same_key == old.end()) {
      found.push_back(fmt::format("{} = {} (was absent)", path, text));
    } else {
      const bool same = same_key->second == text || names_file(path);
      if (!same) found.push_back(fmt::format("{} = {} (was {})", path, text, same_key->second));
      old.erase(same_key);
    }
  }
  for (const auto& [path, text] : old) found.push_back(fmt::format("{} is absent (was {})", path, text));
  return found;
}

std::optional<ResolvedValues> earlier_values(const fs::path& folder) {
  const fs::path file = folder / "scene.toml";
  if (!fs::exists(file)) return std::nullopt;  // the run was ended right after its first checkpoint
  return values_of_resolved_toml(read_whole_file(file));
}

std::optional<double> earlier_step_h(const fs::path& folder) {
  const std::optional<ResolvedValues> was = earlier_values(folder);
  if (!was) return std::nullopt;
  const auto step = std::find_if(was->begin(), was->end(), [](const auto& v) { return v.first == "numerics.step_h"; });
  double step_h = 0.0;
  if (step == was->end()) return std::nullopt;
  const std::string& text = step->second;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), step_h);
  return error == std::errc{} ? std::optional<double>(step_h) : std::nullopt;
}

void refuse_foreign_checkpoint(const Scene& scene, const Checkpoint& checkpoint, const fs::path& folder) {
  const std::string path = (folder / "checkpoint.h5").string();
  if (checkpoint.program_version != program_version) {
    throw InputError({path, 0, "--resume", "the checkpoint was written by another version of the program",
                      checkpoint.program_version, program_version,
                      "build that version (after the + stands its commit), or start anew in another --out"});
  }
  if (checkpoint.scene_digest != scene_digest(scene)) {
    const ResolvedValues now = resolved_values(language(), scene);
    const std::optional<ResolvedValues> was = earlier_values(folder);
    std::vector<std::string> keys = was ? differences(now, *was) : std::vector<std::string>{};
    if (was && keys.empty()) {
      for (const auto& [key, file] : now) {
        if (names_file(key)) keys.push_back(fmt::format("{} = {} (held something else)", key, file));
      }
    }
    constexpr std::size_t most = 12;
    if (keys.size() > most) {
      keys[most] = fmt::format("and {} more", keys.size() - most);
      keys.resize(most + 1);
    }
    throw InputError({scene.file, 0, "--resume", "the checkpoint in this folder belongs to another scene",
                      keys.empty() ? path : fmt::format("{}", fmt::join(keys, ", ")),
                      "the scene that began this run, with its --accuracy and --set; only scene.duration_h, "
                      "output.checkpoint_every_h, output.picture and where its files lie may differ",
                      "take " + (folder / "scene.toml").string() + ", or another --out"});
  }
  if (scene.scene.duration_h < checkpoint.time_h) {
    scene.origins.fail("scene.duration_h", "the run in this folder is already beyond this time",
                       fmt::format("{}", scene.scene.duration_h), fmt::format("at least {}", checkpoint.time_h),
                       "give a longer duration, or start anew in another --out");
  }
}

}  // namespace rootsoil
