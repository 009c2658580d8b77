// SPDX-License-Identifier: MIT
#include "root_sph/io/series.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <numeric>
#include <set>
#include <span>
#include <stdexcept>
#include <utility>

#include "root_sph/core/errors.hpp"
#include "root_sph/io/files.hpp"
#include "root_sph/io/hdf5.hpp"

namespace rootsoil {
namespace fs = std::filesystem;
namespace {

std::int64_t rows_of(const std::vector<FrameColumn>& columns) {
  if (columns.empty()) return 0;
  const auto rows = [](const FrameColumn& column) {
    const std::size_t values = std::visit([](const auto& list) { return list.size(); }, column.values);
    const std::size_t components = static_cast<std::size_t>(column.components);
    ROOTSOIL_ASSERT(column.components >= 1 && values % components == 0);
    return static_cast<std::int64_t>(values / components);
  };
  const std::int64_t first = rows(columns.front());
  for (const FrameColumn& column : columns) ROOTSOIL_ASSERT(rows(column) == first);
  return first;
}

std::vector<ColumnInfo> describe(const std::vector<FrameColumn>& columns) {
  std::vector<ColumnInfo> infos;
  for (const FrameColumn& column : columns) {
    const bool is_integer = std::holds_alternative<std::vector<std::int64_t>>(column.values);
    infos.push_back({column.name, column.unit, column.meaning, column.components, is_integer});
  }
  return infos;
}

FrameInfo describe(const Frame& frame) {
  FrameInfo info{frame.time_h, frame.step, rows_of(frame.columns), describe(frame.columns), {}};
  for (const FrameTable& table : frame.tables) {
    info.tables.push_back({table.name, rows_of(table.columns), describe(table.columns)});
  }
  return info;
}

void write_columns(hid_t group, const std::vector<FrameColumn>& columns) {
  for (const FrameColumn& column : columns) {
    ROOTSOIL_ASSERT(column.name.find('/') == std::string::npos);
    const auto create = [&](const auto& values) {
      return hdf5::create_dataset(group, column.name, std::span(values), column.components);
    };
    const hdf5::Handle dataset = std::visit(create, column.values);
    hdf5::write_attribute(dataset, "unit", column.unit);
    hdf5::write_attribute(dataset, "meaning", column.meaning);
  }
}

std::string frame_image(const Frame& frame) {
  const hdf5::Handle file = hdf5::create_in_memory();
  hdf5::write_attribute(file, "time_h", frame.time_h);
  hdf5::write_attribute(file, "step", frame.step);
  hdf5::write_attribute(file, "cells", rows_of(frame.columns));
  write_columns(file, frame.columns);
  for (const FrameTable& table : frame.tables) {
    const hdf5::Handle group = hdf5::create_group(file, table.name);
    hdf5::write_attribute(group, "count", rows_of(table.columns));
    write_columns(group, table.columns);
  }
  return hdf5::image(file);
}

hdf5::Handle series_without_frames(const SeriesMetadata& metadata, const std::vector<FrameInfo>& frames) {
  hdf5::Handle file = hdf5::create_in_memory();
  for (const auto& [name, value] : metadata) hdf5::write_attribute(file, name.c_str(), value);
  hdf5::create_group(file, "frames");
  std::vector<std::int64_t> index(static_cast<std::size_t>(most_points(frames)));
  std::iota(index.begin(), index.end(), std::int64_t{0});
  const hdf5::Handle dataset = hdf5::create_dataset(file, "point_index", std::span<const std::int64_t>(index), 1);
  hdf5::write_attribute(dataset, "unit", "1");
  hdf5::write_attribute(dataset, "meaning", "0, 1, 2, ...: run.xmf draws a point for each");
  return file;
}

ColumnInfo read_column_info(hid_t group, const std::string& name, std::int64_t rows) {
  const hdf5::Handle dataset = hdf5::open_dataset(group, name);
  const hdf5::Shape shape = hdf5::shape(dataset);
  if (shape.rows != rows) throw FileError(fmt::format("'{}' has not one row a cell or point", name));
  return {name, hdf5::read_text_attribute(dataset, "unit"), hdf5::read_text_attribute(dataset, "meaning"),
          shape.components, shape.is_integer};
}

TableInfo read_table_info(hid_t group, const std::string& name) {
  TableInfo info{name, hdf5::read_integer_attribute(group, "count"), {}};
  for (const std::string& column : hdf5::member_names(group)) {
    info.columns.push_back(read_column_info(group, column, info.count));
  }
  return info;
}

FrameInfo read_info(hid_t group) {
  FrameInfo info{hdf5::read_real_attribute(group, "time_h"),
                 hdf5::read_integer_attribute(group, "step"),
                 hdf5::read_integer_attribute(group, "cells"),
                 {},
                 {}};
  for (const std::string& name : hdf5::member_names(group)) {
    if (hdf5::is_group(group, name)) {
      info.tables.push_back(read_table_info(hdf5::open_group(group, name), name));
    } else {
      info.columns.push_back(read_column_info(group, name, info.cells));
    }
  }
  return info;
}

std::vector<FrameColumn> read_columns(hid_t group, const std::vector<ColumnInfo>& infos) {
  std::vector<FrameColumn> columns;
  columns.reserve(infos.size());
  for (const ColumnInfo& c : infos) {
    columns.push_back({c.name, c.unit, c.meaning, c.components, hdf5::read_values(hdf5::open_dataset(group, c.name))});
  }
  return columns;
}

// Runs a reader; its errors then say which file they are about.
template <class Read>
auto reading(const fs::path& run_h5, Read read) {
  const hdf5::Handle file = hdf5::open_for_reading(run_h5);
  try {
    return read(file);
  } catch (const FileError& error) {
    throw FileError(fmt::format("{}: damaged, or not a series of frames: {}", run_h5.string(), error.problem()),
                    hdf5::whole_copy);
  }
}

}  // namespace

bool TableInfo::has_positions() const {
  return std::any_of(columns.begin(), columns.end(), [](const ColumnInfo& c) { return c.name == "position"; });
}

std::int64_t most_points(const std::vector<FrameInfo>& frames) {
  std::int64_t most = 0;
  for (const FrameInfo& frame : frames) {
    most = std::max(most, frame.cells);
    for (const TableInfo& table : frame.tables) {
      if (table.has_positions()) most = std::max(most, table.count);
    }
  }
  return most;
}

std::string frame_group(std::size_t index) { return fmt::format("/frames/{:06}", index); }

SeriesWriter::SeriesWriter(fs::path folder, SeriesMetadata metadata, std::optional<double> continue_from_h)
    : folder_(std::move(folder)), metadata_(std::move(metadata)) {
  std::error_code trouble;
  fs::create_directories(folder_ / "frames", trouble);
  if (trouble) {
    fail(fmt::format("{}: {}", (folder_ / "frames").string(), trouble.message()), file_remedy(trouble.value()));
  }
  if (continue_from_h && fs::exists(folder_ / "run.h5")) take_over(*continue_from_h);
  write_index();
  // what the index does not name was never reported as written, or is no longer wanted
  std::set<fs::path> named;
  for (std::size_t i = 0; i < frames_.size(); ++i) named.insert(frame_file(i));
  for (const auto& entry : fs::directory_iterator(folder_ / "frames")) {
    if (!named.contains(entry.path())) fs::remove(entry.path(), trouble);
  }
}

fs::path SeriesWriter::frame_file(std::size_t index) const {
  return folder_ / "frames" / fmt::format("frame_{:06}.h5", index);
}

void SeriesWriter::fail(const std::string& reason, const std::string& remedy) const {
  throw FileError(fmt::format("{}\n  kept:    {} frames{} in {}", reason, frames_.size(),
                              frames_.empty() ? "" : fmt::format(" up to {} h", frames_.back().time_h),
                              (folder_ / "run.h5").string()),
                  remedy);
}

void SeriesWriter::take_over(double last_time_h) {
  const fs::path run_h5 = folder_ / "run.h5";
  frames_ = list_frames(run_h5);
  std::erase_if(frames_, [&](const FrameInfo& frame) { return frame.time_h > last_time_h; });
  // a finished series holds its frames itself; they become files again, so that it can go on
  const bool packed =
      reading(run_h5, [&](hid_t file) { return !frames_.empty() && !hdf5::is_external_link(file, frame_group(0)); });
  if (!packed) return;
  for (std::size_t i = 0; i < frames_.size(); ++i) {
    write_text_atomically(frame_file(i), frame_image(read_frame(run_h5, i)));
  }
}

void SeriesWriter::write_index() const {
  const hdf5::Handle file = series_without_frames(metadata_, frames_);
  for (std::size_t i = 0; i < frames_.size(); ++i) {
    hdf5::create_external_link(file, frame_group(i), "frames" / frame_file(i).filename(), "/");
  }
  write_text_atomically(folder_ / "run.h5", hdf5::image(file));
  write_text_atomically(folder_ / "run.xmf", xdmf_text(frames_));
}

void SeriesWriter::write(const Frame& frame) {
  ROOTSOIL_ASSERT(frames_.empty() || frame.time_h > frames_.back().time_h);
  const FrameInfo info = describe(frame);
  try {
    write_text_atomically(frame_file(frames_.size()), frame_image(frame));
    frames_.push_back(info);
    write_index();
  } catch (const FileError& error) {
    if (!frames_.empty() && frames_.back().time_h == frame.time_h) frames_.pop_back();
    fail(error.problem(), error.remedy());
  }
}

void SeriesWriter::pack() const {
  const fs::path run_h5 = folder_ / "run.h5";
  constexpr std::uintmax_t per_file_bytes = 1 << 20, per_frame_bytes = 1 << 12;  // generous, for HDF5's own tables
  std::uintmax_t room_bytes = per_file_bytes;
  for (std::size_t i = 0; i < frames_.size(); ++i) room_bytes += fs::file_size(frame_file(i)) + per_frame_bytes;
  const fs::path temporary =
      start_temporary(run_h5, hdf5::image(series_without_frames(metadata_, frames_)), room_bytes);
  {
    const hdf5::Handle linked = hdf5::open_for_reading(run_h5);
    const hdf5::Handle packed = hdf5::open_to_extend(temporary);
    for (std::size_t i = 0; i < frames_.size(); ++i) hdf5::copy(linked, packed, frame_group(i));
    hdf5::flush(packed);
  }
  commit_temporary(run_h5);
}

void SeriesWriter::finish() {
  try {
    pack();
  } catch (const FileError& error) {
    discard_temporary(folder_ / "run.h5");
    fail(error.problem(), error.remedy());
  } catch (const std::runtime_error& error) {
    discard_temporary(folder_ / "run.h5");
    fail(error.what(), "has a frame's file gone? The run's other files are whole");
  }
  std::error_code trouble;  // frames that stay behind do no harm
  fs::remove_all(folder_ / "frames", trouble);
}

SeriesMetadata read_metadata(const fs::path& run_h5) {
  return reading(run_h5, [](hid_t file) {
    SeriesMetadata metadata;
    for (const std::string& name : hdf5::attribute_names(file)) {
      metadata[name] = hdf5::read_text_attribute(file, name.c_str());
    }
    return metadata;
  });
}

std::vector<FrameInfo> list_frames(const fs::path& run_h5) {
  return reading(run_h5, [](hid_t file) {
    std::vector<FrameInfo> frames(hdf5::member_names(hdf5::open_group(file, "frames")).size());
    for (std::size_t i = 0; i < frames.size(); ++i) frames[i] = read_info(hdf5::open_group(file, frame_group(i)));
    return frames;
  });
}

Frame read_frame(const fs::path& run_h5, std::size_t index) {
  return reading(run_h5, [&](hid_t file) {
    const hdf5::Handle group = hdf5::open_group(file, frame_group(index));
    const FrameInfo info = read_info(group);
    Frame frame{info.time_h, info.step, read_columns(group, info.columns), {}};
    for (const TableInfo& table : info.tables) {
      frame.tables.push_back({table.name, read_columns(hdf5::open_group(group, table.name), table.columns)});
    }
    return frame;
  });
}

}  // namespace rootsoil
