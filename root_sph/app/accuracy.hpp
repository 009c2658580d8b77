// SPDX-License-Identifier: MIT
// Whether a run keeps the accuracy that its scene states.
#pragma once

#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <string>
#include <vector>

#include "root_sph/effects/effect.hpp"

namespace rootsoil {

/// Follows the measures of a run over its output times.
class AccuracyWatch {
 public:
  /// A row of history.csv. The measures come in the same order every time.
  void judge(double time_h, const std::vector<AccuracyMeasure>& measures);
  /// Whether any measure was beyond its limit so far.
  bool is_outside() const;
  /// What was beyond its limit, when, by how much and what to do, a line for each; empty: nothing.
  std::vector<std::string> complaints() const;
  /// For summary.json: a member for each measure, with its limit, the worst value and where it was beyond.
  nlohmann::ordered_json summary() const;

  std::vector<double> save() const;
  /// \param measures as they will be judged
  void restore(const std::vector<double>& saved, std::vector<AccuracyMeasure> measures);

 private:
  struct Judged {
    double worst = 0.0, at_h = 0.0, rows = 0.0, rows_beyond = 0.0;
  };
  std::vector<AccuracyMeasure> latest_;
  std::vector<Judged> judged_;  ///< of the same measures
};

}  // namespace rootsoil
