// SPDX-License-Identifier: MIT
#include "soil_coupling/soil_process.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <poll.h>
#include <sys/mman.h>
#include <sys/socket.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <chrono>
#include <cstring>
#include <nlohmann/json.hpp>
#include <sstream>

#include "root_sph/core/errors.hpp"

namespace rootsoil {
namespace {

using Clock = std::chrono::steady_clock;

double seconds_since(Clock::time_point start) { return std::chrono::duration<double>(Clock::now() - start).count(); }

Descriptor open_log(const std::filesystem::path& path) {
  if (path.empty()) return Descriptor(memfd_create("rootsoil-log", MFD_CLOEXEC));
  Descriptor log(open(path.c_str(), O_RDWR | O_CREAT | O_APPEND | O_CLOEXEC, 0666));
  if (log.get() < 0) {
    const int error = errno;
    throw FileError(fmt::format("{}: {}", path.string(), std::strerror(error)), file_remedy(error));
  }
  return log;
}

ChildCommand command_of(const SoilProcessOptions& options, int socket, int block, int log) {
  const std::filesystem::path driver =
      options.driver.empty() ? std::filesystem::path(ROOTSOIL_YADE_SIDE_DIR) / "driver.py" : options.driver;
  for (const std::filesystem::path& needed : {driver, std::filesystem::path(ROOTSOIL_NO_TEMPORARY_FOLDER)}) {
    if (!std::filesystem::exists(needed)) {
      throw SoilError(fmt::format("the soil process can't be started: {} is missing", needed.string()));
    }
  }
  // YADE takes every core otherwise, and waiting threads would take the root's (both read when it is loaded). Paths are
  // UTF-8 whatever the locale says.
  return {.arguments = {options.python.string(), "-u", "-I", "-X", "utf8", driver.string()},
          .environment = {{"OMP_NUM_THREADS", std::to_string(options.threads)},
                          {"OMP_WAIT_POLICY", "passive"},
                          {"ROOTSOIL_NO_TEMPORARY_FOLDER", ROOTSOIL_NO_TEMPORARY_FOLDER}},
          .descriptors = {socket, block},
          .output = log};
}

std::string describe(Kind kind) {
  switch (kind) {
    case Kind::hello:
      return "while it started";
    case Kind::pack:
      return "while it packed the sample";
    case Kind::build:
      return "while it placed the root in the soil";
    case Kind::save:
      return "while it saved the soil";
    case Kind::load:
      return "while it loaded the soil";
    case Kind::snapshot:
      return "while it listed the grains";
    default:
      return "";
  }
}

/// Without the lists of calls that Python prints before an error, which only say something to its authors; the log has
/// them.
std::string without_tracebacks(const std::string& text) {
  std::string kept;
  bool in_list = false;
  std::istringstream lines(text);
  for (std::string line; std::getline(lines, line);) {
    const bool begins = line.starts_with("Traceback (most recent call last)");
    in_list = begins || (in_list && line.starts_with(' '));
    if (!in_list) kept += line + '\n';
  }
  return kept;
}

constexpr const char* what_is_kept =
    ". Nothing of the interval counts; all frames and the last checkpoint that were written are kept, --resume goes on "
    "from there";

}  // namespace

SoilProcess::SoilProcess(const SoilProcessOptions& options)
    : options_(options), block_(text_room), log_(open_log(options.log)), child_([&] {
        std::tie(socket_, other_end_) = packet_socket_pair();
        return command_of(options_, other_end_.get(), block_.descriptor(), log_.get());
      }()) {
  other_end_.reset();  // so that the socket ends when the process does
  const Packet answer = ask({.kind = Kind::hello});
  const auto greeting = nlohmann::json::parse(text_of(answer), nullptr, false);
  if (!greeting.is_object() || !greeting.contains("engine")) give_up("its greeting can't be read");
  engine_version_ = greeting["engine"].get<std::string>();
}

SoilProcess::~SoilProcess() {
  try {
    if (!child_.how_it_ended() && protocol_.allows(Kind::stop)) {
      Packet packet = protocol_.begin(Kind::stop);
      packet.block_bytes = block_.size();
      if (send(socket_.get(), &packet, sizeof(packet), MSG_NOSIGNAL | MSG_DONTWAIT) == sizeof(packet)) {
        child_.wait(static_cast<int>(1e3 * options_.patience.stop_s));
      }
    }
  } catch (...) {
    // the process is ended by ~ChildProcess in any case
  }
}

std::string SoilProcess::last_words() const {
  constexpr off_t most = 2000;
  struct stat info {};
  if (fstat(log_.get(), &info) != 0 || info.st_size == 0) return {};
  std::string text(static_cast<std::size_t>(std::min(most, info.st_size)), '\0');
  const ssize_t got = pread(log_.get(), text.data(), text.size(), info.st_size - static_cast<off_t>(text.size()));
  text.resize(static_cast<std::size_t>(std::max<ssize_t>(0, got)));
  text = without_tracebacks(text);
  while (!text.empty() && text.back() == '\n') text.pop_back();
  return text.empty() ? text : "\n  it said last:\n" + text;
}

void SoilProcess::give_up(const std::string& what) {
  protocol_.fail();
  child_.kill();
  throw SoilError(fmt::format("the soil process {}{}{}", what, intervals_ > 0 ? what_is_kept : "", last_words()));
}

double SoilProcess::patience_s(Kind kind) const {
  const Patience& p = options_.patience;
  if (kind == Kind::hello) return p.start_s;
  if (kind != Kind::advance) return p.long_task_s;
  if (step_s_.empty()) return std::max(p.step_at_least_s, p.long_task_s);  // the first one also settles the soil
  std::vector<double> sorted = step_s_;
  const auto middle = sorted.begin() + static_cast<std::ptrdiff_t>(sorted.size() / 2);
  std::nth_element(sorted.begin(), middle, sorted.end());
  return std::max(p.step_at_least_s, p.step_medians * *middle);
}

SoilProcess::Received SoilProcess::receive(double patience_s, const std::string& doing) {
  const Clock::time_point start = Clock::now();
  while (true) {
    pollfd watched[2] = {{socket_.get(), POLLIN, 0}, {child_.watch(), POLLIN, 0}};
    const int left_ms = std::max(0, static_cast<int>(1e3 * (patience_s - seconds_since(start))));
    const int ready = poll(watched, 2, left_ms);
    if (ready < 0 && errno == EINTR) continue;
    if (watched[0].revents != 0) {
      std::array<char, sizeof(Packet) + progress_room> message;
      const ssize_t got = recv(socket_.get(), message.data(), message.size(), MSG_DONTWAIT);
      if (got >= static_cast<ssize_t>(sizeof(Packet))) {
        Received received;
        std::memcpy(&received.packet, message.data(), sizeof(Packet));
        received.passing_text.assign(message.data() + sizeof(Packet), static_cast<std::size_t>(got) - sizeof(Packet));
        return received;
      }
      if (got > 0) give_up(fmt::format("broke the protocol: a packet of {} bytes", got));
    }
    if (watched[0].revents != 0 || watched[1].revents != 0) {
      // the socket has ended, or the process has
      if (!child_.wait(2000)) give_up("closed its socket");
      give_up(fmt::format("{} {}", *child_.how_it_ended(), doing));
    }
    if (ready == 0) {
      give_up(fmt::format("gave no answer for {:.3g} s {}{}", patience_s, doing,
                          child_.is_stopped() ? " (it is stopped)" : ""));
    }
  }
}

Packet SoilProcess::ask(const Request& request) {
  const std::string doing = request.kind == Kind::advance
                                ? fmt::format("in interval {}, at {:.6g} h", request.interval, request.time_h)
                                : describe(request.kind);
  const double patience = patience_s(request.kind);
  const Clock::time_point start = Clock::now();
  if (request.kind == Kind::advance) ++intervals_;
  block_.write_text(request.text);
  Packet packet = protocol_.begin(request.kind);
  packet.block_bytes = block_.size();
  packet.text_bytes = request.text.size();
  packet.rows = request.rows;
  packet.interval = request.interval;
  packet.time_h = request.time_h;
  packet.duration_h = request.duration_h;
  if (send(socket_.get(), &packet, sizeof(packet), MSG_NOSIGNAL) != sizeof(packet)) {
    const int error = errno;
    if (child_.wait(2000)) give_up(fmt::format("{} {}", *child_.how_it_ended(), doing));
    give_up(fmt::format("can't be reached ({}) {}", std::strerror(error), doing));
  }
  while (true) {
    const auto [answer, passing_text] = receive(patience, doing);
    bool complete = false;
    try {
      complete = protocol_.accept(answer);
      block_.follow(answer.block_bytes);
    } catch (const SoilError& e) {
      child_.kill();
      protocol_.fail();
      throw SoilError(fmt::format("{} ({}){}", e.what(), doing, intervals_ > 0 ? what_is_kept : ""));
    }
    if (!complete) {
      if (options_.progress) options_.progress(passing_text);
      continue;
    }
    const std::string text(text_of(answer));
    if (answer.kind == Kind::failed) give_up(fmt::format("reported an error {}: {}", doing, text));
    if (answer.kind == Kind::refused) {
      child_.kill();
      const auto problem = nlohmann::json::parse(text, nullptr, false);
      const auto part = [&](const char* name) { return problem.is_object() ? problem.value(name, "") : std::string(); };
      throw InputError({.file = part("file"),
                        .line = 0,
                        .key = part("key"),
                        .what = problem.is_object() ? part("what") : text,
                        .given = part("given"),
                        .allowed = part("allowed"),
                        .remedy = part("remedy")});
    }
    if (request.kind == Kind::advance) {
      constexpr std::size_t remembered = 101;
      if (step_s_.size() < remembered) step_s_.push_back(0.0);
      step_s_[steps_++ % remembered] = seconds_since(start);
    }
    return answer;
  }
}

}  // namespace rootsoil
