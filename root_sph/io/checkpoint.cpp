// SPDX-License-Identifier: MIT
#include "root_sph/io/checkpoint.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <set>
#include <string_view>
#include <utility>

#include "root_sph/core/digest.hpp"
#include "root_sph/core/errors.hpp"
#include "root_sph/io/files.hpp"
#include "root_sph/io/hdf5.hpp"

namespace rootsoil {
namespace fs = std::filesystem;
namespace {

constexpr std::size_t block_bytes = 512;  // the smallest that HDF5 looks behind
constexpr std::string_view signature = "rootsoil checkpoint 1\n";
constexpr std::string_view cells_prefix = "cells/";

std::string block_for(std::string_view content) {
  std::string block = fmt::format("{}checksum {:016x}\nbytes {}\n", signature, fnv1a(content), content.size());
  block.resize(block_bytes, '\0');
  return block;
}

template <class T>
void write_values(hid_t file, std::map<std::string, std::vector<T>>& columns) {
  for (; !columns.empty(); columns.erase(columns.begin())) {
    const auto& [name, values] = *columns.begin();
    hdf5::create_dataset(file, name, std::span(values), 1);
  }
}

std::string image_after_block(Checkpoint& checkpoint) {
  const hdf5::Handle file = hdf5::create_in_memory();
  hdf5::write_attribute(file, "time_h", checkpoint.time_h);
  hdf5::write_attribute(file, "step", checkpoint.step);
  hdf5::write_attribute(file, "scene_digest", checkpoint.scene_digest);
  hdf5::write_attribute(file, "program_version", checkpoint.program_version);
  hdf5::write_attribute(file, "dimension", static_cast<std::int64_t>(checkpoint.dimension));
  write_values(file, checkpoint.reals);
  write_values(file, checkpoint.integers);
  return hdf5::image(file, block_bytes);
}

void read_values(hid_t group, const std::string& prefix, Checkpoint& checkpoint) {
  for (const std::string& name : hdf5::member_names(group)) {
    if (hdf5::is_group(group, name)) {
      read_values(hdf5::open_group(group, name), prefix + name + "/", checkpoint);
      continue;
    }
    hdf5::Values values = hdf5::read_values(hdf5::open_dataset(group, name));
    if (auto* reals = std::get_if<std::vector<double>>(&values)) {
      checkpoint.reals[prefix + name] = std::move(*reals);
    } else {
      checkpoint.integers[prefix + name] = std::move(std::get<std::vector<std::int64_t>>(values));
    }
  }
}

template <int Dim>
bool is_state(const FieldBase<Dim>& field) {
  return field.info().storage == Storage::state;
}

// Copies one column back; the first one decides how many cells there are.
template <int Dim, class T>
void restore_column(const std::map<std::string, std::vector<T>>& columns, FieldBase<Dim>& field, std::span<T> values) {
  const auto found = columns.find(std::string(cells_prefix) + field.info().name);
  if (found == columns.end()) {
    throw FileError(fmt::format("the checkpoint lacks the field '{}' of this scene's cells", field.info().name));
  }
  if (found->second.size() != values.size()) {
    throw FileError(fmt::format("the checkpoint's field '{}' has {} values, {} are needed", field.info().name,
                                found->second.size(), values.size()));
  }
  std::copy(found->second.begin(), found->second.end(), values.begin());
}

template <class T>
void refuse_extra_fields(const std::map<std::string, std::vector<T>>& columns, const std::set<std::string>& known) {
  for (const auto& [name, values] : columns) {
    if (name.starts_with(cells_prefix) && !known.contains(name.substr(cells_prefix.size()))) {
      throw FileError(fmt::format("the checkpoint has a field '{}' that this scene's cells lack",
                                  name.substr(cells_prefix.size())));
    }
  }
}

constexpr const char* start_anew =
    "put a whole copy of the file back if there is one, or start anew in another --out; frames and history stay "
    "readable";

}  // namespace

void write_checkpoint(const fs::path& path, Checkpoint checkpoint) {
  std::string bytes = image_after_block(checkpoint);
  bytes.replace(0, block_bytes, block_for(std::string_view(bytes).substr(block_bytes)));
  write_text_atomically(path, bytes);
}

Checkpoint read_checkpoint(const fs::path& path) {
  const std::string bytes = read_whole_file(path);
  if (!bytes.starts_with(signature)) {
    throw FileError(fmt::format("{}: not a checkpoint of this program, or damaged at its start", path.string()),
                    start_anew);
  }
  const std::string_view content = std::string_view(bytes).substr(std::min(block_bytes, bytes.size()));
  if (bytes.compare(0, block_bytes, block_for(content)) != 0) {
    throw FileError(fmt::format("{}: the checkpoint is damaged (its checksum does not fit its {} bytes)", path.string(),
                                bytes.size()),
                    start_anew);
  }
  try {
    const hdf5::Handle file = hdf5::open_image(content);
    Checkpoint checkpoint;
    checkpoint.time_h = hdf5::read_real_attribute(file, "time_h");
    checkpoint.step = hdf5::read_integer_attribute(file, "step");
    checkpoint.scene_digest = hdf5::read_text_attribute(file, "scene_digest");
    checkpoint.program_version = hdf5::read_text_attribute(file, "program_version");
    checkpoint.dimension = static_cast<int>(hdf5::read_integer_attribute(file, "dimension"));
    read_values(hdf5::open_group(file, "/"), "", checkpoint);
    return checkpoint;
  } catch (const FileError& error) {
    throw FileError(fmt::format("{}: not a checkpoint of this version: {}", path.string(), error.problem()),
                    start_anew);
  }
}

template <int Dim>
void store_cells(const ParticleStore<Dim>& store, Checkpoint& checkpoint) {
  for (const auto& field : store.fields()) {
    if (!is_state(*field)) continue;
    const std::string name = std::string(cells_prefix) + field->info().name;
    if (field->is_integer()) {
      checkpoint.integers[name].assign(field->integers().begin(), field->integers().end());
    } else {
      checkpoint.reals[name].assign(field->reals().begin(), field->reals().end());
    }
  }
}

template <int Dim>
void restore_cells(const Checkpoint& checkpoint, ParticleStore<Dim>& store) {
  std::set<std::string> known;
  for (const auto& field : store.fields()) {
    if (is_state(*field)) known.insert(field->info().name);
  }
  refuse_extra_fields(checkpoint.reals, known);
  refuse_extra_fields(checkpoint.integers, known);

  const auto ids = checkpoint.integers.find(std::string(cells_prefix) + store.cell_id.info().name);
  store.resize(ids == checkpoint.integers.end() ? 0 : ids->second.size());
  for (const auto& field : store.fields()) {
    if (!is_state(*field)) continue;
    if (field->is_integer()) {
      restore_column(checkpoint.integers, *field, field->integers());
    } else {
      restore_column(checkpoint.reals, *field, field->reals());
    }
  }
}

template void store_cells<2>(const ParticleStore<2>&, Checkpoint&);
template void store_cells<3>(const ParticleStore<3>&, Checkpoint&);
template void restore_cells<2>(const Checkpoint&, ParticleStore<2>&);
template void restore_cells<3>(const Checkpoint&, ParticleStore<3>&);

}  // namespace rootsoil
