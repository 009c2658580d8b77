// SPDX-License-Identifier: MIT
#include "root_sph/app/picture.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

extern char** environ;

namespace rootsoil {

Picture draw_picture(const std::filesystem::path& run, bool quiet) {
  // the system's Python: another one may come first on PATH and lack the packages
  const std::string python = "/usr/bin/python3", script = ROOTSOIL_TOOLS_DIR "/overview.py", folder = run.string();
  const char* const arguments[] = {python.c_str(), script.c_str(), folder.c_str(), nullptr};
  posix_spawn_file_actions_t actions;
  posix_spawn_file_actions_init(&actions);
  if (quiet) posix_spawn_file_actions_addopen(&actions, STDOUT_FILENO, "/dev/null", O_WRONLY, 0);
  pid_t child = 0;
  int status = 0;
  const bool drawn =
      posix_spawn(&child, python.c_str(), &actions, nullptr, const_cast<char* const*>(arguments), environ) == 0 &&
      waitpid(child, &status, 0) == child && WIFEXITED(status) && WEXITSTATUS(status) == 0;
  posix_spawn_file_actions_destroy(&actions);
  return {drawn, drawn ? fmt::format("picture: {}", (run / "overview.png").string())
                       : fmt::format("no picture: {} {} {} failed", python, script, folder)};
}

}  // namespace rootsoil
