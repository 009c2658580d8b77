// SPDX-License-Identifier: MIT
#include "soil_coupling/channel.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/mman.h>
#include <sys/socket.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstring>

#include "root_sph/core/errors.hpp"

namespace rootsoil {
namespace {

[[noreturn]] void system_trouble(const char* what) {
  throw SoilError(fmt::format("{} the soil process: {}", what, std::strerror(errno)));
}

}  // namespace

void Descriptor::reset() {
  if (fd_ >= 0) close(fd_);
  fd_ = -1;
}

std::pair<Descriptor, Descriptor> packet_socket_pair() {
  int ends[2];
  if (socketpair(AF_UNIX, SOCK_SEQPACKET | SOCK_CLOEXEC, 0, ends) != 0) system_trouble("no socket for");
  return {Descriptor(ends[0]), Descriptor(ends[1])};
}

SharedBlock::SharedBlock(std::size_t bytes) : memory_(memfd_create("rootsoil", MFD_CLOEXEC)) {
  if (memory_.get() < 0) system_trouble("no shared memory for");
  grow(std::max(bytes, text_room));
}

SharedBlock::~SharedBlock() {
  if (data_) munmap(data_, size_);
}

void SharedBlock::map(std::size_t bytes) {
  void* mapped = data_ ? mremap(data_, size_, bytes, MREMAP_MAYMOVE)
                       : mmap(nullptr, bytes, PROT_READ | PROT_WRITE, MAP_SHARED, memory_.get(), 0);
  if (mapped == MAP_FAILED) system_trouble("shared memory can't be mapped for");
  data_ = static_cast<std::byte*>(mapped);
  size_ = bytes;
}

void SharedBlock::grow(std::size_t bytes) {
  if (bytes <= size_) return;
  const std::size_t wanted = std::max(bytes, size_ + size_ / 2);
  // fallocate and not ftruncate: without memory left this fails here, and not as a SIGBUS at the first write
  const int error = posix_fallocate(memory_.get(), 0, static_cast<off_t>(wanted));
  if (error != 0) {
    errno = error;
    system_trouble("not enough shared memory for");
  }
  map(wanted);
}

void SharedBlock::follow(std::size_t bytes) {
  if (bytes == size_) return;
  struct stat info {};
  if (fstat(memory_.get(), &info) != 0 || bytes < size_ || static_cast<std::size_t>(info.st_size) < bytes) {
    throw SoilError(
        fmt::format("the soil process broke the protocol: it speaks of {} bytes of shared memory, there are {}", bytes,
                    info.st_size));
  }
  map(bytes);
}

void SharedBlock::write_text(std::string_view text) {
  if (text.size() > text_room)
    throw SoilError(fmt::format("a message of {} bytes is too long for the soil process", text.size()));
  std::memcpy(data_, text.data(), text.size());
}

std::string_view SharedBlock::text(std::size_t bytes) const {
  return {reinterpret_cast<const char*>(data_), std::min(bytes, text_room)};
}

}  // namespace rootsoil
