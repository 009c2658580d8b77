// SPDX-License-Identifier: MIT
#include "root_sph/scene/resume.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cstdint>
#include <map>

#include "root_sph/core/errors.hpp"
#include "root_sph/scene/read_scene.hpp"
#include "root_sph/scene/write_scene.hpp"

namespace rootsoil {
namespace fs = std::filesystem;
namespace {

/// The scene without what may change on --resume. Windows end at output times, so output.every_h may not.
Scene what_results_depend_on(Scene scene) {
  scene.scene.duration_h = 1.0;
  scene.output.picture = false;
  scene.output.checkpoint_every_h = 1.0;
  scene.root.cells_file = fs::path(scene.root.cells_file).filename().string();  // the file may have moved
  return scene;
}

}  // namespace

std::string scene_digest(const Scene& scene) {
  std::uint64_t hash = 0xcbf29ce484222325ULL;  // FNV-1a
  for (const unsigned char c : resolved_toml(what_results_depend_on(scene))) hash = (hash ^ c) * 0x100000001b3ULL;
  return fmt::format("{:016x}", hash);
}

std::vector<std::string> differences(const Scene& scene, const Scene& was) {
  const ResolvedValues now = resolved_values(what_results_depend_on(scene));
  const ResolvedValues before = resolved_values(what_results_depend_on(was));
  std::map<std::string, std::string> old(before.begin(), before.end());
  std::vector<std::string> found;
  for (const auto& [path, text] : now) {
    const auto same_key = old.find(path);
    if (same_key == old.end()) {
      found.push_back(fmt::format("{} = {} (was absent)", path, text));
    } else {
      if (same_key->second != text) found.push_back(fmt::format("{} = {} (was {})", path, text, same_key->second));
      old.erase(same_key);
    }
  }
  for (const auto& [path, text] : old) found.push_back(fmt::format("{} is absent (was {})", path, text));
  return found;
}

std::optional<Scene> earlier_scene(const fs::path& folder) {
  const fs::path file = folder / "scene.toml";
  if (!fs::exists(file)) return std::nullopt;  // the run was ended right after its first checkpoint
  return read_scene(file);
}

void refuse_foreign_checkpoint(const Scene& scene, const Checkpoint& checkpoint, const fs::path& folder) {
  const std::string path = (folder / "checkpoint.h5").string();
  if (checkpoint.program_version != ROOTSOIL_VERSION) {
    throw InputError({path, 0, "--resume", "the checkpoint was written by another version of the program",
                      checkpoint.program_version, ROOTSOIL_VERSION, "use that version, or start anew in another --out"});
  }
  if (checkpoint.scene_digest != scene_digest(scene)) {
    const std::optional<Scene> was = earlier_scene(folder);
    std::vector<std::string> keys = was ? differences(scene, *was) : std::vector<std::string>{};
    constexpr std::size_t most = 12;
    if (keys.size() > most) {
      keys[most] = fmt::format("and {} more", keys.size() - most);
      keys.resize(most + 1);
    }
    throw InputError({scene.file, 0, "--resume", "the checkpoint in this folder belongs to another scene",
                      keys.empty() ? path : fmt::format("{}", fmt::join(keys, ", ")),
                      "the scene that began this run, with its --accuracy and --set; only scene.duration_h, "
                      "output.checkpoint_every_h and output.picture may differ",
                      "take " + (folder / "scene.toml").string() + ", or another --out"});
  }
  if (scene.scene.duration_h < checkpoint.time_h) {
    scene.origins.fail("scene.duration_h", "the run in this folder is already beyond this time",
                       fmt::format("{}", scene.scene.duration_h), fmt::format("at least {}", checkpoint.time_h),
                       "give a longer duration, or start anew in another --out");
  }
}

}  // namespace rootsoil
