// SPDX-License-Identifier: MIT
#include "root_sph/exchange/shell.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <set>
#include <tuple>

#include "root_sph/core/errors.hpp"

namespace rootsoil {
namespace {

using Triangle = Shell::Triangle;

void replace_corner(Triangle& t, std::int32_t old_corner, std::int32_t new_corner) {
  std::replace(t.begin(), t.end(), old_corner, new_corner);
}

/// Triangles between two rings of markers about the same axis; the second lies nearer to the tip.
void stitch(const std::vector<std::int32_t>& ring, const std::vector<std::int32_t>& next, std::vector<Triangle>& out) {
  const std::size_t n = ring.size(), m = next.size();
  if (m == 1) {
    for (std::size_t i = 0; i < n; ++i) out.push_back({ring[i], ring[(i + 1) % n], next[0]});
    return;
  }
  for (std::size_t i = 0, j = 0; i < n || j < m;) {
    if (j == m || (i < n && (i + 1) * m <= (j + 1) * n)) {
      out.push_back({ring[i % n], ring[(i + 1) % n], next[j % m]});
      ++i;
    } else {
      out.push_back({ring[i % n], next[(j + 1) % m], next[j % m]});
      ++j;
    }
  }
}

}  // namespace

std::int32_t Shell::add(const Vec<3>& x) {
  position_.push_back(x);
  id_.push_back(next_id_++);
  return static_cast<std::int32_t>(position_.size() - 1);
}

Shell::Shell(const TissueView<3>& cells, MarkerSize size) : Markers(size) {
  const TissueShape<3> shape(cells);
  refuse_thin(shape);
  const double cap_mm = std::min(shape.radius_mm(), 0.5 * shape.length_mm());
  const double base_mm = shape.length_mm() - shape.cell_size_mm();
  const double inset_mm = shape.radius_mm() - size.radius_mm;
  constexpr double pi = std::numbers::pi;
  std::vector<std::int32_t> last;
  // a ring of rays at an angle from the axis: pi/2 across it, 0 towards the tip
  const auto add_ring = [&](double s_mm, double angle) {
    const auto axis = shape.axis_at(s_mm);
    const Vec<3> first = (std::abs(axis.tipwards[2]) < 0.9 ? Vec<3>::UnitZ() : Vec<3>::UnitX());
    const Vec<3> side = first.cross(axis.tipwards).normalized(), other = axis.tipwards.cross(side);
    const auto rays =
        angle < 1e-9
            ? 1
            : std::max(6, static_cast<int>(std::ceil(2.0 * pi * inset_mm * std::sin(angle) / size.spacing_mm)));
    std::vector<std::int32_t> ring;
    for (int k = 0; k < rays; ++k) {
      const double turn = 2.0 * pi * k / rays;
      const Vec<3> across = std::cos(turn) * side + std::sin(turn) * other;
      const auto surface =
          shape.surface_along(axis.position_mm, std::cos(angle) * axis.tipwards + std::sin(angle) * across);
      if (!surface) {
        throw InputError({"", 0, "root", "the tissue has a hole through which its surface can't be seen from its axis",
                          fmt::format("{:.4g} mm from the tip", s_mm), "tissue round the whole axis",
                          "check the file of cells"});
      }
      ring.push_back(add(surface->position_mm - size.radius_mm * surface->outward));
    }
    if (!last.empty()) stitch(last, ring, triangle_);
    last = ring;
  };
  const auto along = static_cast<int>(std::ceil((base_mm - cap_mm) / size.spacing_mm));
  for (int k = 0; k < along; ++k) add_ring(base_mm - (base_mm - cap_mm) * k / along, 0.5 * pi);
  const auto round = static_cast<int>(std::ceil(0.5 * pi * inset_mm / size.spacing_mm));
  for (int k = 0; k <= round; ++k) add_ring(cap_mm, 0.5 * pi * (round - k) / round);
  refine();
}

std::vector<Shell::Edge> Shell::edges() const {
  struct Side {
    std::int32_t a, b, triangle, opposite;
  };
  std::vector<Side> sides;
  sides.reserve(3 * triangle_.size());
  for (std::size_t t = 0; t < triangle_.size(); ++t) {
    for (std::size_t k = 0; k < 3; ++k) {
      const std::int32_t a = triangle_[t][k], b = triangle_[t][(k + 1) % 3];
      sides.push_back({std::min(a, b), std::max(a, b), static_cast<std::int32_t>(t), triangle_[t][(k + 2) % 3]});
    }
  }
  std::sort(sides.begin(), sides.end(), [](const Side& p, const Side& q) {
    return std::tie(p.a, p.b, p.triangle) < std::tie(q.a, q.b, q.triangle);
  });
  std::vector<Edge> edges;
  for (const Side& s : sides) {
    const bool second = !edges.empty() && edges.back().a == s.a && edges.back().b == s.b;
    if (!second) edges.push_back({s.a, s.b});
    ROOTSOIL_ASSERT(edges.back().triangle[1] < 0);  // a third triangle would make it no surface
    edges.back().triangle[second] = s.triangle;
    edges.back().opposite[second] = s.opposite;
  }
  return edges;
}

std::vector<Vec<3>> Shell::normals() const {
  std::vector<Vec<3>> normals(position_.size(), Vec<3>::Zero());
  for (const Triangle& t : triangle_) {
    for (const std::int32_t corner : t) normals[static_cast<std::size_t>(corner)] += area_normal(t);
  }
  for (Vec<3>& n : normals) n.normalize();
  return normals;
}

bool Shell::split_long_edges() {
  std::vector<Edge> all = edges();
  std::erase_if(all, [&](const Edge& e) { return length(e) <= largest_gap * size_.spacing_mm; });
  if (all.empty()) return false;
  std::stable_sort(all.begin(), all.end(), [&](const Edge& p, const Edge& q) { return length(p) > length(q); });
  const std::vector<Vec<3>> normal = normals();
  std::vector<char> touched(triangle_.size(), 0);
  for (const Edge& e : all) {
    const auto is_touched = [&](std::int32_t t) { return t >= 0 && touched[static_cast<std::size_t>(t)]; };
    if (is_touched(e.triangle[0]) || is_touched(e.triangle[1])) continue;
    // the middle of a curved PN edge (Vlachos et al. 2001): the chord's, raised by what the normals say
    const Vec<3> chord = at(e.b) - at(e.a);
    const Vec<3>&na = normal[static_cast<std::size_t>(e.a)], &nb = normal[static_cast<std::size_t>(e.b)];
    const std::int32_t middle = add(0.5 * (at(e.a) + at(e.b)) + 0.125 * (chord.dot(nb) * nb - chord.dot(na) * na));
    for (const std::int32_t t : e.triangle) {
      if (t < 0) continue;
      touched[static_cast<std::size_t>(t)] = 1;
      Triangle half = triangle_[static_cast<std::size_t>(t)];
      replace_corner(half, e.a, middle);
      replace_corner(triangle_[static_cast<std::size_t>(t)], e.b, middle);
      triangle_.push_back(half);
    }
  }
  return true;
}

bool Shell::turn_edges() {
  bool turned = false;
  std::vector<char> touched(triangle_.size(), 0);
  const std::vector<Edge> all = edges();
  std::set<std::pair<std::int32_t, std::int32_t>> known;
  for (const Edge& e : all) known.emplace(e.a, e.b);
  for (const Edge& e : all) {
    if (e.triangle[1] < 0) continue;
    Triangle& first = triangle_[static_cast<std::size_t>(e.triangle[0])];
    Triangle& second = triangle_[static_cast<std::size_t>(e.triangle[1])];
    if (touched[static_cast<std::size_t>(e.triangle[0])] || touched[static_cast<std::size_t>(e.triangle[1])]) continue;
    const auto [c, d] = e.opposite;
    const auto angle_at = [&](std::int32_t corner) {
      const Vec<3> u = at(e.a) - at(corner), v = at(e.b) - at(corner);
      return std::atan2(u.cross(v).norm(), u.dot(v));
    };
    if (angle_at(c) + angle_at(d) < std::numbers::pi + 1e-3) continue;
    if (known.contains({std::min(c, d), std::max(c, d)})) continue;
    Triangle one = first, two = second;  // c keeps one end, d the other
    replace_corner(one, e.b, d);
    replace_corner(two, e.a, c);
    const Vec<3> old_normal = (area_normal(first) + area_normal(second)).normalized();
    if (area_normal(one).dot(old_normal) <= 0.0 || area_normal(two).dot(old_normal) <= 0.0) continue;
    first = one;
    second = two;
    touched[static_cast<std::size_t>(e.triangle[0])] = touched[static_cast<std::size_t>(e.triangle[1])] = 1;
    known.erase({e.a, e.b});
    known.emplace(std::min(c, d), std::max(c, d));
    turned = true;
  }
  return turned;
}

bool Shell::join_close_markers() {
  constexpr double too_close = 0.5;
  const std::vector<Edge> all = edges();
  std::vector<std::vector<std::int32_t>> neighbours(position_.size()), around(position_.size());
  std::vector<char> rim(position_.size(), 0), touched(position_.size(), 0);
  for (const Edge& e : all) {
    neighbours[static_cast<std::size_t>(e.a)].push_back(e.b);
    neighbours[static_cast<std::size_t>(e.b)].push_back(e.a);
    if (e.triangle[1] < 0) rim[static_cast<std::size_t>(e.a)] = rim[static_cast<std::size_t>(e.b)] = 1;
  }
  for (std::size_t t = 0; t < triangle_.size(); ++t) {
    for (const std::int32_t c : triangle_[t])
      around[static_cast<std::size_t>(c)].push_back(static_cast<std::int32_t>(t));
  }
  std::set<std::int32_t> gone;
  for (const Edge& e : all) {
    if (length(e) >= too_close * size_.spacing_mm || e.triangle[1] < 0) continue;
    // the younger marker goes, but none of the rim
    const auto keep_first = rim[static_cast<std::size_t>(e.b)] == 0;
    const std::int32_t keep = keep_first ? e.a : e.b, out = keep_first ? e.b : e.a;
    const auto& near = neighbours[static_cast<std::size_t>(out)];
    if (rim[static_cast<std::size_t>(out)] || touched[static_cast<std::size_t>(keep)]) continue;
    if (std::any_of(near.begin(), near.end(),
                    [&](std::int32_t n) { return touched[static_cast<std::size_t>(n)] != 0; }))
      continue;
    const auto& kept_near = neighbours[static_cast<std::size_t>(keep)];
    const auto common = std::count_if(near.begin(), near.end(), [&](std::int32_t n) {
      return std::find(kept_near.begin(), kept_near.end(), n) != kept_near.end();
    });
    bool good = common == 2;
    for (const std::int32_t n : near) {
      good = good && (n == keep || (at(n) - at(keep)).norm() < largest_gap * size_.spacing_mm);
    }
    for (const std::int32_t t : around[static_cast<std::size_t>(out)]) {
      Triangle moved = triangle_[static_cast<std::size_t>(t)];
      if (std::find(moved.begin(), moved.end(), keep) != moved.end()) continue;
      const Vec<3> before = area_normal(moved);
      replace_corner(moved, out, keep);
      good = good && area_normal(moved).dot(before) > 0.0;
    }
    if (!good) continue;
    for (const std::int32_t t : around[static_cast<std::size_t>(out)]) {
      replace_corner(triangle_[static_cast<std::size_t>(t)], out, keep);
    }
    for (const std::int32_t n : near) touched[static_cast<std::size_t>(n)] = 1;
    touched[static_cast<std::size_t>(out)] = 1;
    gone.insert(out);
  }
  if (gone.empty()) return false;
  std::erase_if(triangle_, [](const Triangle& t) { return t[0] == t[1] || t[1] == t[2] || t[2] == t[0]; });
  std::vector<std::int32_t> now(position_.size(), -1);
  std::int32_t kept = 0;
  for (std::size_t i = 0; i < position_.size(); ++i) {
    if (gone.contains(static_cast<std::int32_t>(i))) continue;
    now[i] = kept;
    position_[static_cast<std::size_t>(kept)] = position_[i];
    id_[static_cast<std::size_t>(kept++)] = id_[i];
  }
  position_.resize(static_cast<std::size_t>(kept));
  id_.resize(static_cast<std::size_t>(kept));
  for (Triangle& t : triangle_) {
    for (std::int32_t& corner : t) corner = now[static_cast<std::size_t>(corner)];
  }
  return true;
}

void Shell::refine() {
  constexpr int most_passes = 20;  // turning could go on for ever among four markers on a circle
  const auto turn = [&] {
    for (int pass = 0; pass < most_passes && turn_edges(); ++pass) continue;
  };
  turn();
  if (join_close_markers()) turn();
  // turning may lengthen an edge: the last word is that of splitting
  for (int pass = 0; pass < most_passes && split_long_edges(); ++pass) turn();
  while (split_long_edges()) continue;
}

void Shell::save(const std::string& prefix, std::map<std::string, std::vector<double>>& reals) const {
  Markers::save(prefix, reals);
  std::vector<double>& corners = reals[prefix + "triangles"];
  for (const Triangle& t : triangle_) corners.insert(corners.end(), t.begin(), t.end());
}

void Shell::restore(const std::string& prefix, const std::map<std::string, std::vector<double>>& reals) {
  Markers::restore(prefix, reals);
  const std::vector<double>& corners = reals.at(prefix + "triangles");
  ROOTSOIL_ASSERT(corners.size() % 3 == 0);
  triangle_.resize(corners.size() / 3);
  for (std::size_t k = 0; k < corners.size(); ++k) triangle_[k / 3][k % 3] = static_cast<std::int32_t>(corners[k]);
}

}  // namespace rootsoil
