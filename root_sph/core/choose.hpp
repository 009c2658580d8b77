// SPDX-License-Identifier: MIT
// Choices that are made once and not in every turn of a loop.
#pragma once

#include <type_traits>
#include <utility>

namespace rootsoil {

/// f(std::true_type) or f(std::false_type): a choice becomes a constant of the loop's instance.
template <class F>
auto choose(bool choice, F&& f) {
  return choice ? f(std::true_type()) : f(std::false_type());
}

}  // namespace rootsoil
