// SPDX-License-Identifier: MIT
// The soil's process: starts the driver, asks and waits, and says in plain words what went wrong. Nothing here knows
// what is asked for; yade_soil.hpp does.
#pragma once

#include <filesystem>
#include <functional>
#include <string>
#include <string_view>
#include <vector>

#include "soil_coupling/child_process.hpp"
#include "soil_coupling/protocol.hpp"

namespace rootsoil {

/// How long the soil's process may be silent before it is given up. The system's clock, not the simulation's.
struct Patience {
  double start_s = 120.0;
  double long_task_s = 600.0;  ///< between two signs of progress of packing, building, saving, loading
  double step_at_least_s = 30.0;
  double step_medians = 50.0;  ///< a step may take this many times the median of those before
  double stop_s = 5.0;         ///< to end by itself, before it is killed
};

struct SoilProcessOptions {
  std::filesystem::path python = "/usr/bin/python3";  ///< Debian's: another one on the PATH lacks YADE and numpy
  std::filesystem::path driver;                       ///< empty: yade_side/driver.py
  std::filesystem::path log;                          ///< what the process writes; empty: kept in memory
  std::int64_t threads = 1;
  Patience patience;
  std::function<void(const std::string&)> progress;
};

class SoilProcess {
 public:
  /// Starts the process and shakes hands. SoilError where there is no YADE, or another version.
  explicit SoilProcess(const SoilProcessOptions& options);
  /// Asks it to stop, waits a little, and ends it otherwise.
  ~SoilProcess();

  SharedBlock& block() { return block_; }
  const Protocol& protocol() const { return protocol_; }
  pid_t pid() const { return child_.pid(); }
  const std::string& engine_version() const { return engine_version_; }

  struct Request {
    Kind kind;
    std::string_view text = {};
    std::size_t rows = 0;
    std::int64_t interval = 0;
    double time_h = 0.0, duration_h = 0.0;
  };
  /// Sends, waits for the answer and returns it; columns are in the block already. SoilError: the process died, is
  /// silent, broke the protocol or reported an error; InputError: it refuses what the user asked for.
  Packet ask(const Request& request);

  std::string_view text_of(const Packet& answer) const { return block_.text(answer.text_bytes); }

 private:
  struct Received {
    Packet packet;
    std::string passing_text;  ///< of `progress`
  };
  Received receive(double patience_s, const std::string& doing);
  double patience_s(Kind kind) const;
  [[noreturn]] void give_up(const std::string& what);
  std::string last_words() const;

  SoilProcessOptions options_;
  Protocol protocol_;
  SharedBlock block_;
  Descriptor log_;
  Descriptor socket_;
  Descriptor other_end_;
  ChildProcess child_;
  std::string engine_version_;
  std::vector<double> step_s_;  ///< of the last steps
  std::size_t steps_ = 0;
  std::int64_t intervals_ = 0;  ///< asked for
};

}  // namespace rootsoil
