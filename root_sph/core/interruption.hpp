// SPDX-License-Identifier: MIT
// Ctrl-C and kill ask a long task to stop at the next good place.
#pragma once

#include <csignal>

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

}  // namespace rootsoil
