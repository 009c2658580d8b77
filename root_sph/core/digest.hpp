// SPDX-License-Identifier: MIT
// The hash FNV-1a: a number that tells texts apart.
#pragma once

#include <cstdint>
#include <string_view>

namespace rootsoil {

/// Any single changed byte changes the result.
inline std::uint64_t fnv1a(std::string_view bytes) {
  std::uint64_t hash = 0xcbf29ce484222325u;
  for (const char byte : bytes) hash = (hash ^ static_cast<unsigned char>(byte)) * 0x100000001b3u;
  return hash;
}

}  // namespace rootsoil
