// SPDX-License-Identifier: MIT
#include "root_sph/app/accuracy.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>
#include <utility>

#include "root_sph/core/errors.hpp"

namespace rootsoil {

void AccuracyWatch::judge(double time_h, const std::vector<AccuracyMeasure>& measures) {
  latest_ = measures;
  judged_.resize(measures.size());
  for (std::size_t k = 0; k < measures.size(); ++k) {
    const auto& [name, value, limit, remedy] = measures[k];
    if (std::isnan(value)) continue;
    Judged& judged = judged_[k];
    if (value > judged.worst) {
      judged.worst = value;
      judged.at_h = time_h;
    }
    judged.rows += 1.0;
    judged.rows_beyond += value > limit ? 1.0 : 0.0;
  }
}

bool AccuracyWatch::is_outside() const {
  return std::any_of(judged_.begin(), judged_.end(), [](const Judged& j) { return j.rows_beyond > 0.0; });
}

std::vector<std::string> AccuracyWatch::complaints() const {
  std::vector<std::string> lines;
  for (std::size_t k = 0; k < latest_.size(); ++k) {
    const Judged& judged = judged_[k];
    if (judged.rows_beyond == 0.0) continue;
    lines.push_back(fmt::format("{} was {:.3g} at {:.4g} h and beyond its limit of {:.3g} in {:g} of {:g} rows: {}",
                                latest_[k].name, judged.worst, judged.at_h, latest_[k].limit, judged.rows_beyond,
                                judged.rows, latest_[k].remedy));
  }
  return lines;
}

nlohmann::ordered_json AccuracyWatch::summary() const {
  nlohmann::ordered_json measures = nlohmann::ordered_json::object();
  for (std::size_t k = 0; k < latest_.size(); ++k) {
    const auto& [worst, at_h, rows, rows_beyond] = judged_[k];
    measures[latest_[k].name] = {
        {"limit", latest_[k].limit}, {"worst", worst}, {"at_h", at_h}, {"rows", rows}, {"rows_beyond", rows_beyond}};
  }
  return measures;
}

std::vector<double> AccuracyWatch::save() const {
  std::vector<double> saved;
  for (const auto& [worst, at_h, rows, rows_beyond] : judged_) {
    saved.insert(saved.end(), {worst, at_h, rows, rows_beyond});
  }
  return saved;
}

void AccuracyWatch::restore(const std::vector<double>& saved, std::vector<AccuracyMeasure> measures) {
  if (saved.empty()) return;  // before the first row
  latest_ = std::move(measures);
  ROOTSOIL_ASSERT(saved.size() == 4 * latest_.size());
  judged_.resize(latest_.size());
  for (std::size_t k = 0; k < judged_.size(); ++k) {
    judged_[k] = {saved[4 * k], saved[4 * k + 1], saved[4 * k + 2], saved[4 * k + 3]};
  }
}

}  // namespace rootsoil
