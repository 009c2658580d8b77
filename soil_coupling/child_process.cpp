// SPDX-License-Identifier: MIT
#include "soil_coupling/child_process.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <poll.h>
#include <sys/prctl.h>
#include <sys/syscall.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <csignal>
#include <cstring>
#include <fstream>

#include "root_sph/core/errors.hpp"

extern char** environ;

namespace rootsoil {
namespace {

constexpr int first_inherited = 3;
constexpr std::size_t most_inherited = 8;
constexpr int out_of_the_way = first_inherited + static_cast<int>(most_inherited);

std::vector<std::string> environment_of(const ChildCommand& command) {
  std::vector<std::string> result;
  for (char** entry = environ; *entry; ++entry) {
    const std::string text = *entry;
    if (!command.environment.contains(text.substr(0, text.find('=')))) result.push_back(text);
  }
  for (const auto& [name, value] : command.environment) result.push_back(fmt::format("{}={}", name, value));
  return result;
}

std::vector<char*> pointers(std::vector<std::string>& texts) {
  std::vector<char*> result;
  result.reserve(texts.size() + 1);
  for (std::string& text : texts) result.push_back(text.data());
  result.push_back(nullptr);
  return result;
}

/// Between fork and exec only system calls are allowed: this process has threads, and one may have held a lock.
[[noreturn]] void become(const ChildCommand& command, char** arguments, char** environment, pid_t parent) {
  prctl(PR_SET_PDEATHSIG, SIGKILL);
  if (getppid() != parent) _exit(0);  // it died before the line above
  signal(SIGINT, SIG_IGN);            // Ctrl-C goes to both; this process decides when the other one stops
  signal(SIGPIPE, SIG_DFL);
  signal(SIGXFSZ, SIG_DFL);
  // first out of the way, then into place: source and target numbers may overlap, also with the standard streams',
  // which the program's caller may have closed
  const int nothing = fcntl(open("/dev/null", O_RDWR), F_DUPFD, out_of_the_way);
  const int output = command.output >= 0 ? fcntl(command.output, F_DUPFD, out_of_the_way) : nothing;
  std::array<int, most_inherited> moved;
  std::transform(command.descriptors.begin(), command.descriptors.end(), moved.begin(),
                 [](int fd) { return fcntl(fd, F_DUPFD, out_of_the_way); });
  dup2(nothing, STDIN_FILENO);
  dup2(output, STDOUT_FILENO);
  dup2(output, STDERR_FILENO);
  int target = first_inherited;
  for (std::size_t k = 0; k < command.descriptors.size(); ++k) dup2(moved[k], target++);
  close_range(static_cast<unsigned>(target), ~0U, 0);
  execve(arguments[0], arguments, environment);
  _exit(127);
}

std::string describe_end(int status) {
  if (WIFSIGNALED(status)) {
    const int number = WTERMSIG(status);
    return fmt::format("was killed by signal {} ({})", number, strsignal(number));
  }
  return fmt::format("ended with status {}", WEXITSTATUS(status));
}

}  // namespace

ChildProcess::ChildProcess(const ChildCommand& command) {
  ROOTSOIL_ASSERT(command.descriptors.size() <= most_inherited);
  const std::string& program = command.arguments.at(0);
  if (access(program.c_str(), X_OK) != 0) {
    throw SoilError(fmt::format("the soil process can't be started: {}: {}", program, std::strerror(errno)));
  }
  std::vector<std::string> arguments = command.arguments, environment = environment_of(command);
  std::vector<char*> argument_pointers = pointers(arguments), environment_pointers = pointers(environment);
  const pid_t parent = getpid();
  pid_ = fork();
  if (pid_ < 0) throw SoilError(fmt::format("the soil process can't be started: {}", std::strerror(errno)));
  if (pid_ == 0) become(command, argument_pointers.data(), environment_pointers.data(), parent);
  watch_ = Descriptor(static_cast<int>(syscall(SYS_pidfd_open, pid_, 0)));
  if (watch_.get() < 0) {
    const int error = errno;
    kill();
    throw SoilError(fmt::format("the soil process can't be watched: {}", std::strerror(error)));
  }
}

bool ChildProcess::wait(int milliseconds) {
  if (ended_) return true;
  pollfd watched{watch_.get(), POLLIN, 0};
  while (poll(&watched, 1, milliseconds) < 0 && errno == EINTR) {
  }
  int status = 0;
  if (waitpid(pid_, &status, WNOHANG) != pid_) return false;
  ended_ = describe_end(status);
  return true;
}

bool ChildProcess::is_stopped() const {
  std::ifstream file(fmt::format("/proc/{}/stat", pid_));
  std::string text;
  std::getline(file, text);
  const std::size_t name_end = text.rfind(')');
  return name_end != std::string::npos && name_end + 2 < text.size() &&
         (text[name_end + 2] == 'T' || text[name_end + 2] == 't');
}

void ChildProcess::kill() {
  if (ended_ || pid_ < 0) return;
  ::kill(pid_, SIGKILL);
  int status = 0;
  while (waitpid(pid_, &status, 0) < 0 && errno == EINTR) {
  }
  ended_ = describe_end(status);
}

}  // namespace rootsoil
