// SPDX-License-Identifier: MIT
// A process that this one starts, watches and outlives. It can't be left behind: it is killed when the object goes, and
// by the system when this process dies in whatever way.
#pragma once

#include <sys/types.h>

#include <map>
#include <optional>
#include <string>
#include <vector>

#include "soil_coupling/channel.hpp"

namespace rootsoil {

struct ChildCommand {
  std::vector<std::string> arguments;              ///< the first is the program's path
  std::map<std::string, std::string> environment;  ///< set on top of this process's own
  std::vector<int> descriptors;                    ///< become 3, 4, ... there; nothing else is inherited
  int output = -1;                                 ///< where its standard output and error go
};

class ChildProcess {
 public:
  /// SoilError where the process can't be started.
  explicit ChildProcess(const ChildCommand& command);
  ~ChildProcess() { kill(); }
  ChildProcess(const ChildProcess&) = delete;
  ChildProcess& operator=(const ChildProcess&) = delete;

  pid_t pid() const { return pid_; }
  /// Becomes readable when the process has ended.
  int watch() const { return watch_.get(); }
  /// Has it ended within this time? Then it is reaped, and how_it_ended() has a text.
  bool wait(int milliseconds);
  /// "was killed by signal 9 (Killed)", "ended with status 1"; nothing while it runs.
  const std::optional<std::string>& how_it_ended() const { return ended_; }
  /// Is it stopped (SIGSTOP, or a debugger)?
  bool is_stopped() const;
  void kill();

 private:
  pid_t pid_ = -1;
  Descriptor watch_;
  std::optional<std::string> ended_;
};

}  // namespace rootsoil
