// SPDX-License-Identifier: MIT
// Ctrl-C and kill ask a long task to stop at the next good place.
#pragma once

#include <unistd.h>

#include <csignal>
#include <string_view>

#include "root_sph/core/errors.hpp"

namespace rootsoil {

/// While it lives, SIGINT and SIGTERM only leave a mark. Restores the old handlers. One at a time.
class Interruption {
 public:
  Interruption() {
    mark_ = 0;
    old_interrupt_ = std::signal(SIGINT, [](int) { mark_ = 1; });
    old_terminate_ = std::signal(SIGTERM, [](int) { mark_ = 1; });
  }
  Interruption(const Interruption&) = delete;
  Interruption& operator=(const Interruption&) = delete;
  ~Interruption() {
    std::signal(SIGINT, old_interrupt_);
    std::signal(SIGTERM, old_terminate_);
  }
  bool requested() const { return mark_ != 0; }

 private:
  static inline volatile std::sig_atomic_t mark_ = 0;
  void (*old_interrupt_)(int);
  void (*old_terminate_)(int);
};

/// While there is nothing to keep, SIGINT and SIGTERM end the program at once, with the exit status of an interrupted
/// run.
inline void end_at_once_when_interrupted() {
  for (const int signal : {SIGINT, SIGTERM}) {
    std::signal(signal, [](int) {
      constexpr std::string_view text = "rootsoil: interrupted before anything was done\n";
      static_cast<void>(!write(STDERR_FILENO, text.data(), text.size()));  // a handler may call this, and little else
      _exit(static_cast<int>(ExitStatus::interrupted));
    });
  }
}

}  // namespace rootsoil
