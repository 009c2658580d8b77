// SPDX-License-Identifier: MIT
#include "root_sph/effects/soil_contact/listed_grains.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <string>
#include <unordered_map>

#include "root_sph/io/csv_reader.hpp"

namespace rootsoil {
namespace {

enum Column : std::size_t { x, y, z, radius };

const CsvTable table{.columns = {"x_mm", "y_mm", "z_mm", "radius_mm"},
                     .rows = "grains",
                     .whole_remedy = "list the grains, or leave soil.grains_file out to have them packed",
                     .header_remedy = "give every grain's centre and radius, in millimetres",
                     .row_remedy = "correct this row"};

// A file may hold the grains of a packed sample: they grow to within some per cent of the diameters asked for.
constexpr double size_tolerance = 0.1;
// Of the smaller radius (walls: of the grain's): beyond it contact laws mean nothing, and the engine ends a run.
constexpr double deepest_overlap = 0.5;

class Reader {
 public:
  Reader(const SoilRecipe& soil, const std::string& text)
      : soil_(soil), csv_(text, soil.grains_file, table), bin_mm_((1.0 + size_tolerance) * soil.d_max_mm) {
    for (int a = 0; a < soil.dimension; ++a) {
      bins_[a] = static_cast<std::int64_t>((soil.box_to_mm[a] - soil.box_from_mm[a]) / bin_mm_) + 1;
    }
  }

  std::vector<SoilGrain> read() {
    while (csv_.next_row()) {
      const SoilGrain grain{{csv_.number(x), csv_.number(y), csv_.number(z)}, csv_.number(radius)};
      check_size(grain);
      check_place(grain);
      check_overlap(grain);
      bin_content_[bin_of(coordinates(grain))].push_back(grains_.size());
      grains_.push_back(grain);
      line_.push_back(csv_.line_number());
      if (static_cast<double>(grains_.size()) > most_grains) {
        csv_.fail({}, "the file holds too many grains", "more", fmt::format("at most {:.0e}", most_grains),
                  "take larger grains or a smaller box");
      }
    }
    return grains_;
  }

 private:
  using Bin = std::array<std::int64_t, 3>;

  void check_size(const SoilGrain& grain) const {
    const double smallest = 0.5 * (1.0 - size_tolerance) * soil_.d_min_mm;
    const double largest = 0.5 * (1.0 + size_tolerance) * soil_.d_max_mm;
    if (grain.radius_mm >= smallest && grain.radius_mm <= largest) return;
    csv_.fail_at(
        radius,
        grain.radius_mm > 0.0 ? "the grain is not of the size that the scene says" : "a radius must be positive",
        fmt::format("{}", grain.radius_mm),
        fmt::format("{:.6g} to {:.6g}, half the diameters of d_range_mm or d_mean_mm within {:.0f} %", smallest,
                    largest, 100.0 * size_tolerance),
        "give radii, in millimetres, and the grains' own diameters in the scene");
  }

  void check_place(const SoilGrain& grain) const {
    if (soil_.dimension == 2 && grain.centre_mm[2] != 0.0) {
      csv_.fail_at(z, "in two dimensions all grains lie in the plane z = 0", fmt::format("{}", grain.centre_mm[2]), "0",
                   "set z_mm to 0, or scene.dimension to 3");
    }
    for (int a = 0; a < soil_.dimension; ++a) {
      const double margin = (1.0 - deepest_overlap) * grain.radius_mm;
      const double low = soil_.box_from_mm[a] + margin, high = soil_.box_to_mm[a] - margin;
      if (grain.centre_mm[a] >= low && grain.centre_mm[a] <= high) continue;
      csv_.fail_at(static_cast<std::size_t>(a), "the grain is not inside the soil's box",
                   fmt::format("{}, radius {}", grain.centre_mm[a], grain.radius_mm),
                   fmt::format("{:.6g} to {:.6g}: at most half the radius may reach into a wall", low, high),
                   "move the grain, or make the box larger (soil.box_from_mm, soil.box_to_mm)");
    }
  }

  void check_overlap(const SoilGrain& grain) const {
    const Bin at = coordinates(grain);
    const std::int64_t depth = soil_.dimension == 3 ? 1 : 0;
    for (std::int64_t i = at[0] - 1; i <= at[0] + 1; ++i) {
      for (std::int64_t j = at[1] - 1; j <= at[1] + 1; ++j) {
        for (std::int64_t k = at[2] - depth; k <= at[2] + depth; ++k) check_overlap_in({i, j, k}, grain);
      }
    }
  }

  void check_overlap_in(const Bin& bin, const SoilGrain& grain) const {
    for (int a = 0; a < 3; ++a) {
      if (bin[a] < 0 || bin[a] >= bins_[a]) return;
    }
    const auto content = bin_content_.find(bin_of(bin));
    if (content == bin_content_.end()) return;
    for (const std::size_t other : content->second) {
      const SoilGrain& b = grains_[other];
      const double distance = std::hypot(grain.centre_mm[0] - b.centre_mm[0], grain.centre_mm[1] - b.centre_mm[1],
                                         grain.centre_mm[2] - b.centre_mm[2]);
      const double overlap = (grain.radius_mm + b.radius_mm - distance) / std::min(grain.radius_mm, b.radius_mm);
      if (overlap <= deepest_overlap) continue;
      csv_.fail({}, distance == 0.0 ? "two grains lie in the same place" : "two grains overlap too far",
                fmt::format("({}, {}, {}), {:.0f} % of the smaller radius into the grain of line {}",
                            grain.centre_mm[0], grain.centre_mm[1], grain.centre_mm[2], 100.0 * overlap, line_[other]),
                fmt::format("at most {:.0f} %", 100.0 * deepest_overlap),
                "give every grain once, and beside the others");
    }
  }

  Bin coordinates(const SoilGrain& grain) const {
    Bin bin{};
    for (int a = 0; a < soil_.dimension; ++a) {
      bin[a] = static_cast<std::int64_t>((grain.centre_mm[a] - soil_.box_from_mm[a]) / bin_mm_);
    }
    return bin;
  }

  std::int64_t bin_of(const Bin& bin) const { return (bin[0] * bins_[1] + bin[1]) * bins_[2] + bin[2]; }

  const SoilRecipe& soil_;
  CsvReader csv_;
  double bin_mm_;  ///< no two grains that touch lie farther apart
  Bin bins_{1, 1, 1};
  std::vector<SoilGrain> grains_;
  std::vector<int> line_;
  std::unordered_map<std::int64_t, std::vector<std::size_t>> bin_content_;
};

}  // namespace

std::vector<SoilGrain> read_listed_grains(const SoilRecipe& soil) {
  const std::string text = read_users_file(soil.grains_file, "soil.grains_file", "a CSV file of grains");
  return Reader(soil, text).read();
}

}  // namespace rootsoil
