// SPDX-License-Identifier: MIT
// Does a scene go on with a run that was begun before? docs/decisions/0011
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "root_sph/io/checkpoint.hpp"
#include "root_sph/scene/write_scene.hpp"

namespace rootsoil {

/// Identifies what the results of a scene depend on; what may change on --resume is left out. Of files that the run
/// reads, the content counts, wherever they lie: FileError where one is gone.
std::string scene_digest(const Scene& scene);

/// "growth.c_g = -0.9 (was -1)" for every key that results depend on and that differs. Files are not compared.
std::vector<std::string> differences(const ResolvedValues& now, const ResolvedValues& was);

/// The step of the run in the folder, h; nothing where its scene.toml is missing. The files that the scene names may
/// have moved since.
std::optional<double> earlier_step_h(const std::filesystem::path& folder);

/// InputError, naming the keys that differ, where the checkpoint is not one of this scene (with its step filled in) or
/// of this version of the program.
void refuse_foreign_checkpoint(const Scene& scene, const Checkpoint& checkpoint, const std::filesystem::path& folder);

}  // namespace rootsoil
