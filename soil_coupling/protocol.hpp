// SPDX-License-Identifier: MIT
// Who may say what, and when: the conversation with the soil's process as an explicit state machine. It touches no file
// and no process, so that it is tested alone.
//
//              hello               pack
//   created ---------> greeted  <--------> (waiting)
//                         |
//                         | build, load
//                         v     advance, snapshot, save
//                       ready <------------------------> (waiting)
//
//   stop leads from created, greeted and ready to stopped; whatever goes wrong leads to failed, and nothing leads on
//   from there.
#pragma once

#include <cstdint>
#include <string>

#include "soil_coupling/message.hpp"

namespace rootsoil {

enum class SoilState { created, greeted, ready, waiting, stopped, failed };

std::string_view name_of(SoilState state);
std::string_view name_of(Kind kind);

class Protocol {
 public:
  SoilState state() const { return state_; }

  /// Is the request allowed now?
  bool allows(Kind request) const;

  /// Precondition: allows(request); otherwise a mistake of ours (std::logic_error). Returns the packet to complete and
  /// send: numbered, one higher than the last one.
  Packet begin(Kind request);

  /// Takes an answer. Postcondition: the request is answered and state() is what it leads to; after `progress` it is
  /// still open (false). Anything else - another number, version or kind, `failed`, `refused` - leaves state failed;
  /// SoilError says what was wrong with the packet itself. What `failed` and `refused` say is left to the caller.
  bool accept(const Packet& answer);

  void fail() { state_ = SoilState::failed; }

 private:
  SoilState state_ = SoilState::created;
  SoilState after_ = SoilState::created;  ///< while waiting: where `done` leads
  std::uint64_t sequence_ = 0;
};

}  // namespace rootsoil
