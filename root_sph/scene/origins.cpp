// SPDX-License-Identifier: MIT
#include "root_sph/scene/origins.hpp"

#include "root_sph/core/errors.hpp"

namespace rootsoil {

Location Origins::of(std::string path) const {
  while (true) {
    const auto found = locations_.find(path);
    if (found != locations_.end()) return found->second;
    if (path.empty()) return {};
    const std::size_t dot = path.rfind('.');
    path.resize(dot == std::string::npos ? 0 : dot);
  }
}

void Origins::fail(const std::string& path, const std::string& what, const std::string& given,
                   const std::string& allowed, const std::string& remedy) const {
  const Location place = of(path);
  throw InputError({place.file, place.line, path, what, given, allowed, remedy});
}

}  // namespace rootsoil
