// SPDX-License-Identifier: MIT
// Whatever the text: a scene that can be written and read again, or an InputError.
#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <string>
#include <string_view>

#include "root_sph/core/errors.hpp"
#include "root_sph/effects/table.hpp"
#include "root_sph/scene/write_scene.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  try {
    const rootsoil::Scene scene = rootsoil::parse_scene({reinterpret_cast<const char*>(data), size}, "fuzz.toml");
    const std::string resolved = rootsoil::resolved_toml(rootsoil::language(), scene);
    if (rootsoil::resolved_toml(rootsoil::language(), rootsoil::parse_scene(resolved, "fuzz.toml")) != resolved)
      std::abort();
  } catch (const rootsoil::InputError&) {
  }
  return 0;
}
