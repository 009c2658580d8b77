// SPDX-License-Identifier: MIT
// Generated clouds of cells, the same on every platform for one seed.
#pragma once

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <random>
#include <string>
#include <type_traits>
#include <vector>

#include "root_sph/core/types.hpp"

namespace rootsoil::test {

/// For typed tests that run in both dimensions.
using BothDimensions = testing::Types<std::integral_constant<int, 2>, std::integral_constant<int, 3>>;

struct DimensionName {
  template <class Dimension>
  static std::string GetName(int) {
    return std::to_string(Dimension::value) + "D";
  }
};

class Random {
 public:
  explicit Random(std::uint64_t seed) : engine_(seed) {}

  double uniform(double low, double high) {
    return low + (high - low) * (static_cast<double>(engine_() >> 11) * 0x1p-53);
  }
  std::size_t index(std::size_t count) { return static_cast<std::size_t>(engine_() % count); }

  /// Entries uniform in [-1, 1].
  template <class Matrix>
  Matrix matrix() {
    Matrix m;
    for (Eigen::Index k = 0; k < m.size(); ++k) m.data()[k] = uniform(-1.0, 1.0);
    return m;
  }

  template <int Dim>
  Mat<Dim> rotation() {
    // Gram-Schmidt on a random matrix, twice, because the first leaves an angle where two columns are nearly parallel
    Mat<Dim> r = matrix<Mat<Dim>>();
    for ([[maybe_unused]] const int pass : {1, 2}) {
      for (int a = 0; a < Dim; ++a) {
        for (int b = 0; b < a; ++b) r.col(a) -= r.col(b).dot(r.col(a)) * r.col(b);
        r.col(a).normalize();
      }
    }
    // right-handed
    if (r.determinant() < 0.0) r.col(0) = -r.col(0);
    return r;
  }

  std::vector<std::int64_t> permutation(std::size_t count) {
    std::vector<std::int64_t> order(count);
    for (std::size_t k = 0; k < count; ++k) {
      const std::size_t other = index(k + 1);
      order[k] = order[other];
      order[other] = static_cast<std::int64_t>(k);
    }
    return order;
  }

 private:
  std::mt19937_64 engine_;
};

/// Rotation by an angle in the plane of axes a and b.
template <int Dim>
Mat<Dim> plane_rotation(double angle, int a = 0, int b = 1) {
  Mat<Dim> r = Mat<Dim>::Identity();
  r(a, a) = r(b, b) = std::cos(angle);
  r(b, a) = std::sin(angle);
  r(a, b) = -r(b, a);
  return r;
}

/// Q of a cell with the given full axis lengths along the columns of `axes`.
template <int Dim>
Mat<Dim> ellipsoid(const Vec<Dim>& lengths, const Mat<Dim>& axes) {
  const Mat<Dim> q = axes * (4.0 * lengths.cwiseProduct(lengths).cwiseInverse()).asDiagonal() * axes.transpose();
  return 0.5 * (q + q.transpose());
}

template <int Dim>
struct Cloud {
  std::vector<Vec<Dim>> position;
  std::vector<Mat<Dim>> shape;
  std::vector<double> volume;

  std::size_t size() const { return position.size(); }
  void add(const Vec<Dim>& x, const Vec<Dim>& lengths, const Mat<Dim>& axes) {
    position.push_back(x);
    shape.push_back(ellipsoid<Dim>(lengths, axes));
    volume.push_back(lengths.prod());
  }
};

/// Round cells on a lattice, moved by up to jitter spacings, their lengths varying by up to size_variation; centred
/// on the origin.
template <int Dim>
Cloud<Dim> lattice(const std::array<int, Dim>& counts, double spacing, Random& random, double jitter = 0.0,
                   double size_variation = 0.0) {
  Cloud<Dim> cloud;
  int total = 1;
  for (const int count : counts) total *= count;
  for (int k = 0; k < total; ++k) {
    Vec<Dim> x;
    int rest = k;
    for (int a = 0; a < Dim; ++a) {
      x[a] = (rest % counts[a] - 0.5 * (counts[a] - 1) + jitter * random.uniform(-1.0, 1.0)) * spacing;
      rest /= counts[a];
    }
    const double length = spacing * (1.0 + size_variation * random.uniform(-1.0, 1.0));
    cloud.add(x, Vec<Dim>::Constant(length), Mat<Dim>::Identity());
  }
  return cloud;
}

}  // namespace rootsoil::test
