// SPDX-License-Identifier: MIT
// Between vectors of the plane or of space and what files, scenes and soils hold: three components, rows in one column.
#pragma once

#include <algorithm>
#include <array>
#include <vector>

#include "root_sph/core/types.hpp"

namespace rootsoil {

/// In 2D the third component is 0.
template <int Dim>
std::array<double, 3> three(const Vec<Dim>& v) {
  std::array<double, 3> out{};
  std::copy_n(v.data(), Dim, out.begin());
  return out;
}

/// In 2D the third component is dropped.
template <int Dim>
Vec<Dim> shortened(const std::array<double, 3>& v) {
  return Eigen::Map<const Vec<Dim>>(v.data());
}

/// A column of vectors or tensors, row by row.
template <class T, std::size_t N>
std::vector<T> flat(const std::vector<std::array<T, N>>& rows) {
  std::vector<T> numbers;
  numbers.reserve(N * rows.size());
  for (const auto& row : rows) numbers.insert(numbers.end(), row.begin(), row.end());
  return numbers;
}

}  // namespace rootsoil
