// SPDX-License-Identifier: MIT
// The frames of a run: run.h5, and run.xmf, by which ParaView finds its way in run.h5.
//
// While a run goes on, every frame is a file of its own (frames/frame_000012.h5) that is never touched again, and
// run.h5 is a small table of external links to them that is replaced as a whole: no instant exists at which a
// frame that was reported as written can be damaged. finish() makes one self-contained run.h5 of it. Readers see
// the same groups, /frames/000012/<column>, in both states. Tables beside the cells are in
// /frames/000012/<table>/<column>.
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "root_sph/io/frame.hpp"

namespace rootsoil {

/// What is known of a column without reading its values.
struct ColumnInfo {
  std::string name;
  std::string unit;
  std::string meaning;
  int components = 1;
  bool is_integer = false;

  bool operator==(const ColumnInfo&) const = default;
};

/// A table beside the cells.
struct TableInfo {
  std::string name;
  std::int64_t count = 0;  ///< of rows
  std::vector<ColumnInfo> columns;

  /// Whether its rows are points in space.
  bool has_positions() const;
  bool operator==(const TableInfo&) const = default;
};

struct FrameInfo {
  double time_h = 0.0;
  std::int64_t step = 0;
  std::int64_t cells = 0;
  std::vector<ColumnInfo> columns;
  std::vector<TableInfo> tables;

  bool operator==(const FrameInfo&) const = default;
};

/// Attributes of the file as a whole, e.g. program, version, scene, dimension.
using SeriesMetadata = std::map<std::string, std::string>;

class SeriesWriter {
 public:
  /// A new series in this folder; with continue_from_h, the series that is there goes on and its frames later
  /// than that time are dropped.
  SeriesWriter(std::filesystem::path folder, SeriesMetadata metadata, std::optional<double> continue_from_h = {});

  /// On return the frame is on the disk and readable. Times must increase. For a resumed run to miss nothing,
  /// a frame is written before the checkpoint of the same time.
  void write(const Frame& frame);

  /// Packs all frames into run.h5. The last call; if it fails or is never made, the frames stay readable.
  void finish();

  const std::vector<FrameInfo>& frames() const { return frames_; }

 private:
  std::filesystem::path frame_file(std::size_t index) const;
  void write_index() const;
  void pack() const;
  void take_over(double last_time_h);
  [[noreturn]] void fail(const std::string& reason, const std::string& remedy) const;

  std::filesystem::path folder_;
  SeriesMetadata metadata_;
  std::vector<FrameInfo> frames_;
};

/// All three: FileError when the file is missing, damaged or not a series of frames.
SeriesMetadata read_metadata(const std::filesystem::path& run_h5);
std::vector<FrameInfo> list_frames(const std::filesystem::path& run_h5);
Frame read_frame(const std::filesystem::path& run_h5, std::size_t index);

/// The text of run.xmf: temporal collections of points (cells, and every table of points beside them) whose
/// values lie in run.h5.
std::string xdmf_text(const std::vector<FrameInfo>& frames);

/// The largest number of cells, or of points of a table, in any frame.
std::int64_t most_points(const std::vector<FrameInfo>& frames);

/// "/frames/000012"
std::string frame_group(std::size_t index);

}  // namespace rootsoil
