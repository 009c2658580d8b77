// SPDX-License-Identifier: MIT
#include "soil_coupling/protocol.hpp"

#include <fmt/format.h>

#include <stdexcept>

#include "root_sph/core/errors.hpp"

namespace rootsoil {
namespace {

struct Transition {
  SoilState from;
  Kind request;
  SoilState to;
};

using enum SoilState;
constexpr Transition transitions[] = {
    {created, Kind::hello, greeted}, {greeted, Kind::pack, greeted}, {greeted, Kind::build, ready},
    {greeted, Kind::load, ready},    {ready, Kind::load, ready},     {ready, Kind::advance, ready},
    {ready, Kind::snapshot, ready},  {ready, Kind::save, ready},     {created, Kind::stop, stopped},
    {greeted, Kind::stop, stopped},  {ready, Kind::stop, stopped},
};

const Transition* find(SoilState from, Kind request) {
  for (const Transition& t : transitions) {
    if (t.from == from && t.request == request) return &t;
  }
  return nullptr;
}

}  // namespace

std::string_view name_of(SoilState state) {
  constexpr std::string_view names[] = {"created", "greeted", "ready", "waiting", "stopped", "failed"};
  return names[static_cast<int>(state)];
}

std::string_view name_of(Kind kind) {
  switch (kind) {
    case Kind::hello:
      return "hello";
    case Kind::pack:
      return "pack";
    case Kind::build:
      return "build";
    case Kind::advance:
      return "advance";
    case Kind::snapshot:
      return "snapshot";
    case Kind::save:
      return "save";
    case Kind::load:
      return "load";
    case Kind::stop:
      return "stop";
    case Kind::done:
      return "done";
    case Kind::progress:
      return "progress";
    case Kind::failed:
      return "failed";
    case Kind::refused:
      return "refused";
  }
  return "unknown";
}

bool Protocol::allows(Kind request) const { return find(state_, request) != nullptr; }

Packet Protocol::begin(Kind request) {
  const Transition* transition = find(state_, request);
  if (!transition) {
    throw std::logic_error(
        fmt::format("internal error: request '{}' to a soil that is {}", name_of(request), name_of(state_)));
  }
  Packet packet;
  packet.kind = request;
  packet.sequence = ++sequence_;
  after_ = transition->to;
  state_ = request == Kind::stop ? stopped : waiting;
  return packet;
}

bool Protocol::accept(const Packet& answer) {
  const auto broken = [&](const std::string& what) {
    state_ = failed;
    throw SoilError("the soil process broke the protocol: " + what);
  };
  if (state_ != waiting) broken(fmt::format("'{}' came although nothing was asked", name_of(answer.kind)));
  if (answer.magic != packet_magic) broken(fmt::format("a packet begins with {:#x}", answer.magic));
  if (answer.version != protocol_version) {
    broken(fmt::format("it speaks version {}, this program version {}; both must come from the same installation",
                       answer.version, protocol_version));
  }
  if (answer.sequence != sequence_) {
    broken(fmt::format("an answer to message {} came while message {} was open", answer.sequence, sequence_));
  }
  if (answer.text_bytes > text_room) broken(fmt::format("a text of {} bytes", answer.text_bytes));
  switch (answer.kind) {
    case Kind::progress:
      return false;
    case Kind::done:
      state_ = after_;
      return true;
    case Kind::failed:
    case Kind::refused:
      state_ = failed;
      return true;
    default:
      broken(fmt::format("'{}' is no answer", name_of(answer.kind)));
  }
  return false;
}

}  // namespace rootsoil
