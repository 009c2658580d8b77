// SPDX-License-Identifier: MIT
// What goes between this program and the soil's process: the one place that says how it is laid out. It is mirrored in
// yade_side/message.py; tests/soil_coupling checks that both agree. Whoever changes anything here raises the version.
//
// A packet of 64 bytes (little endian) goes over a socket for every message. What it refers to lies in a block of
// memory that both sides share:
//
//   byte 0       text, UTF-8: JSON, or what an error says                              text_bytes of at most text_room
//   byte 65536   columns of the message's table, one after the other, each of `rows` rows and begun on a multiple of 64
//
// Whoever needs more room makes the block longer before it sends; the other side sees block_bytes and maps it anew.
// Only the text of `progress` follows its packet over the socket: nobody waits until it has been read, so that the
// block may already hold the next one.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <string>

namespace rootsoil {

inline constexpr std::uint32_t packet_magic = 0x4C494F53;  // "SOIL"
inline constexpr std::uint16_t protocol_version = 2;
inline constexpr std::size_t text_room = 65536;
inline constexpr std::size_t column_alignment = 64;
inline constexpr std::size_t progress_room = 512;

enum class Kind : std::uint16_t {
  // requests
  hello = 1,     ///< who are you? Answer: text with versions
  pack = 2,      ///< text: recipe. Makes a sample file
  build = 3,     ///< text: recipe and start; columns: body, then listed grains in the same way. Makes room for the root
  advance = 4,   ///< columns: motion. Answer: columns forces, text with numbers
  snapshot = 5,  ///< Answer: columns grains, then contacts; text with their numbers
  save = 6,      ///< text: file
  load = 7,      ///< text: recipe and file; instead of build
  stop = 8,      ///< no answer: the process ends
  // answers, with the sequence number of the request
  done = 100,
  progress = 101,  ///< text: how far it is; the answer is still to come
  failed = 102,    ///< text: what went wrong in the soil's process
  refused = 103,   ///< text: what is wrong with what the user asked for
};

struct Packet {
  std::uint32_t magic = packet_magic;
  std::uint16_t version = protocol_version;
  Kind kind = Kind::hello;
  std::uint64_t sequence = 0;
  std::uint64_t block_bytes = 0;
  std::uint64_t text_bytes = 0;
  std::uint64_t rows = 0;
  std::int64_t interval = 0;
  double time_h = 0.0;
  double duration_h = 0.0;
};
static_assert(sizeof(Packet) == 64);

/// A column: `components` numbers of 8 bytes a row.
struct Column {
  const char* name;
  const char* type;  ///< "f8" or "i8", as numpy calls them
  std::size_t components;
};

inline constexpr std::array body_table{Column{"position_mm", "f8", 3}, Column{"radius_mm", "f8", 1}};
inline constexpr std::array motion_table{Column{"id", "i8", 1}, Column{"start_mm", "f8", 3}, Column{"end_mm", "f8", 3},
                                         Column{"spin_per_h", "f8", 3}, Column{"radius_mm", "f8", 1}};
inline constexpr std::array forces_table{Column{"mean_N", "f8", 3}, Column{"mean_torque_Nmm", "f8", 3},
                                         Column{"contact_stiffness_N_mm", "f8", 1}};
inline constexpr std::array grains_table{
    Column{"id", "i8", 1},        Column{"position_mm", "f8", 3}, Column{"velocity_mm_h", "f8", 3},
    Column{"radius_mm", "f8", 1}, Column{"contacts", "i8", 1},    Column{"stress_MPa", "f8", 6}};
inline constexpr std::array contacts_table{Column{"ids", "i8", 2}, Column{"position_mm", "f8", 3},
                                           Column{"force_N", "f8", 3}};

/// First byte of column `index` of a table with `rows` rows that begins at byte `begin`; index = the number of columns
/// gives the table's end.
constexpr std::size_t column_offset(std::span<const Column> table, std::size_t index, std::size_t rows,
                                    std::size_t begin = text_room) {
  std::size_t offset = begin;
  for (std::size_t k = 0; k < index; ++k) {
    const std::size_t bytes = 8 * table[k].components * rows;
    offset += (bytes + column_alignment - 1) / column_alignment * column_alignment;
  }
  return offset;
}

/// The whole layout as JSON, for the test that compares it with yade_side/message.py.
std::string describe_layout();

}  // namespace rootsoil
