// SPDX-License-Identifier: MIT
// Messages of a run: to run.log always, to the terminal unless quiet. Warnings and errors always go to both.
#pragma once

#include <fmt/format.h>
#include <spdlog/sinks/basic_file_sink.h>
#include <spdlog/spdlog.h>

#include <cstdio>
#include <filesystem>
#include <string>
#include <utility>

namespace rootsoil {

class RunLog {
 public:
  RunLog(const std::filesystem::path& file, bool quiet)
      : quiet_(quiet), file_("run", std::make_shared<spdlog::sinks::basic_file_sink_mt>(file.string())) {
    file_.set_pattern("%Y-%m-%d %H:%M:%S %l %v");
    file_.flush_on(spdlog::level::info);
  }

  template <class... Arguments>
  void info(fmt::format_string<Arguments...> text, Arguments&&... arguments) {
    const std::string message = fmt::format(text, std::forward<Arguments>(arguments)...);
    file_.info(message);
    if (!quiet_) fmt::print(stderr, "{}\n", message);
  }
  /// What is not as it should be: to the terminal even when quiet.
  template <class... Arguments>
  void warning(fmt::format_string<Arguments...> text, Arguments&&... arguments) {
    const std::string message = fmt::format(text, std::forward<Arguments>(arguments)...);
    file_.warn(message);
    fmt::print(stderr, "warning: {}\n", message);
  }
  /// To the file only.
  template <class... Arguments>
  void note(fmt::format_string<Arguments...> text, Arguments&&... arguments) {
    file_.warn(fmt::format(text, std::forward<Arguments>(arguments)...));
  }
  /// What ends a run.
  template <class... Arguments>
  void error(fmt::format_string<Arguments...> text, Arguments&&... arguments) {
    const std::string message = fmt::format(text, std::forward<Arguments>(arguments)...);
    file_.error(message);
    fmt::print(stderr, "rootsoil: {}\n", message);
  }

 private:
  bool quiet_;
  spdlog::logger file_;
};

}  // namespace rootsoil
