// SPDX-License-Identifier: MIT
// Everything a run needs to go on as if it had not been interrupted, bit for bit.
//
// The file is HDF5 behind a block of 512 bytes that holds a checksum of all the rest (HDF5 calls it a user block
// and skips it): a damaged file is refused before any of its content is believed.
#pragma once

#include <cstdint>
#include <filesystem>
#include <map>
#include <string>
#include <vector>

#include "root_sph/core/particle_store.hpp"

namespace rootsoil {

struct Checkpoint {
  double time_h = 0.0;
  std::int64_t step = 0;
  std::string scene_digest;  ///< of the resolved scene: a checkpoint fits one scene only
  std::string program_version;
  int dimension = 2;
  std::map<std::string, std::vector<double>> reals;  ///< names may hold '/'
  std::map<std::string, std::vector<std::int64_t>> integers;

  bool operator==(const Checkpoint&) const = default;
};

/// Replaces the file in one step; the previous checkpoint stays until the new one is complete on the disk. What is
/// written is let go on the way: a large root's checkpoint would stand four times in memory.
void write_checkpoint(const std::filesystem::path& path, Checkpoint checkpoint);

/// FileError: missing, damaged, or not a checkpoint.
Checkpoint read_checkpoint(const std::filesystem::path& path);

/// All columns of the store with Storage::state, as "cells/<name>".
template <int Dim>
void store_cells(const ParticleStore<Dim>& store, Checkpoint& checkpoint);

/// The reverse; the store's columns must be declared. FileError names a column that only one side has.
template <int Dim>
void restore_cells(const Checkpoint& checkpoint, ParticleStore<Dim>& store);

extern template void store_cells<2>(const ParticleStore<2>&, Checkpoint&);
extern template void store_cells<3>(const ParticleStore<3>&, Checkpoint&);
extern template void restore_cells<2>(const Checkpoint&, ParticleStore<2>&);
extern template void restore_cells<3>(const Checkpoint&, ParticleStore<3>&);

}  // namespace rootsoil
