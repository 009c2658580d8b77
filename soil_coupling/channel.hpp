// SPDX-License-Identifier: MIT
// The two things that both processes hold: a socket for packets and a block of memory. Neither has a name in the file
// system or on the network; both vanish with the last process that holds them.
#pragma once

#include <cstddef>
#include <span>
#include <string>
#include <string_view>
#include <utility>

#include "soil_coupling/message.hpp"

namespace rootsoil {

/// Owns a file descriptor.
class Descriptor {
 public:
  explicit Descriptor(int fd = -1) : fd_(fd) {}
  Descriptor(Descriptor&& other) noexcept : fd_(std::exchange(other.fd_, -1)) {}
  Descriptor& operator=(Descriptor&& other) noexcept {
    std::swap(fd_, other.fd_);
    return *this;
  }
  ~Descriptor() { reset(); }
  int get() const { return fd_; }
  void reset();

 private:
  int fd_;
};

/// A connected pair of sockets that keep packets apart (SOCK_SEQPACKET).
std::pair<Descriptor, Descriptor> packet_socket_pair();

/// Memory without a name (memfd), mapped; grows when asked to, and follows when the other side has made it grow.
class SharedBlock {
 public:
  explicit SharedBlock(std::size_t bytes);
  ~SharedBlock();
  SharedBlock(const SharedBlock&) = delete;
  SharedBlock& operator=(const SharedBlock&) = delete;

  int descriptor() const { return memory_.get(); }
  std::size_t size() const { return size_; }
  /// At least so many bytes. SoilError where the machine has no memory left.
  void grow(std::size_t bytes);
  /// The other side says that it made the block this long. SoilError where that is not so.
  void follow(std::size_t bytes);

  void write_text(std::string_view text);
  std::string_view text(std::size_t bytes) const;

  /// Column `index` of a table with `rows` rows, 8 bytes a number; T is double or std::int64_t.
  template <class T>
  std::span<T> column(std::span<const Column> table, std::size_t index, std::size_t rows,
                      std::size_t begin = text_room) const {
    static_assert(sizeof(T) == 8);
    return {reinterpret_cast<T*>(data_ + column_offset(table, index, rows, begin)), rows * table[index].components};
  }

 private:
  void map(std::size_t bytes);
  Descriptor memory_;
  std::byte* data_ = nullptr;
  std::size_t size_ = 0;
};

}  // namespace rootsoil
