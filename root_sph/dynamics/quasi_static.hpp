// SPDX-License-Identifier: MIT
// Growth without inertia: the displacement of a step at which every cell is in balance.
#pragma once

#include <functional>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include "root_sph/dynamics/preconditioner.hpp"

namespace rootsoil {

/// How an equilibrium was found, or was not.
struct Balance {
  bool found = false;
  int iterations = 0;
  double imbalance = 0.0;      ///< rms over free cells of |f|/(p x its face); the tissue's stress for p if more
  std::size_t worst_cell = 0;  ///< the one with the largest
  double worst_imbalance = 0.0;
  bool stable = true;   ///< a small push does not end it
  double thrust = 0.0;  ///< on the held base, against the root's growth, over p times the held cells' faces
};

/// Solves f(d) = 0 by a quasi-Newton iteration: d += M^-1 f, M from the stiffness at the predictor, improved by
/// Anderson's mixing of the last iterations in the norm of M^-1 (f is not quite the gradient of an energy: friction is
/// none).
template <int Dim>
class QuasiStatic {
 public:
  using Displacements = std::vector<Vec<Dim>>;
  /// Sets tissue.force to the forces after these displacements.
  using Evaluate = std::function<void(const Displacements&)>;
  /// Stiffness of contacts as they are now, a block for each cell, N/mm; empty where nothing can touch.
  using ContactStiffness = std::function<std::vector<Mat<Dim>>()>;

  struct Problem {
    const Tissue<Dim>& tissue;
    const PairTerms<Dim>& terms;
    double dt_h;
    double tolerance;  ///< on Balance::imbalance, and on how far cells still want to move over their size
    Evaluate evaluate;
    ContactStiffness contact;
    /// What the forces are bounded by (friction) follows those of a balance; true: they are others now.
    std::function<bool()> adapt = [] { return false; };
    bool downhill = false;  ///< a balance that iterations do not find is looked for downhill, which takes long
  };

  /// \param displacement first guess in, solution out; zero on held cells
  Balance solve(const Problem& problem, Displacements& displacement);

  /// What is kept.
  void save(std::map<std::string, std::vector<double>>& reals,
            std::map<std::string, std::vector<std::int64_t>>& integers) const;
  void restore(const std::map<std::string, std::vector<double>>& reals,
               const std::map<std::string, std::vector<std::int64_t>>& integers);

  /// A preconditioner, and of which earlier, short step its matrix is: it serves as long as the same cells are free.
  struct Method {
    std::unique_ptr<Preconditioner<Dim>> preconditioner;
    std::vector<std::int64_t> id{};   ///< of the cell of each place; empty: there is no matrix
    std::vector<Mat<Dim>> contact{};  ///< stiffness of what is touched, of each place; empty: nothing can be
    std::int64_t iterations = 0;      ///< that the step needed for which it was made
    double dt_h = 0.0;
    void forget() { id.clear(); }
  };
  /// What the softest mode was found to be when it was looked at last, the thrust on the base then, N, and since when.
  struct Stability {
    double stiffness = 1.0, thrust = 0.0;
    std::int64_t steps = 0;
  };

 private:
  Balance search_with(Method& method, const Problem& problem, Displacements& displacement);

  Method band_{make_band_preconditioner<Dim>()}, layers_{make_layer_preconditioner<Dim>()};
  Stability stability_;
};

extern template class QuasiStatic<2>;
extern template class QuasiStatic<3>;

}  // namespace rootsoil
