// SPDX-License-Identifier: MIT
// What an effect is: an object that, when its section is in the scene, declares columns, adds passes to the solver's
// hooks and perhaps columns to the output. One that is not called for is never constructed.
#pragma once

#include "root_sph/dynamics/solver.hpp"
#include "root_sph/io/frame.hpp"

#include <map>
#include <string>
#include <vector>

namespace rootsoil {

using NamedReals = std::map<std::string, std::vector<double>>;

template <int Dim>
class Effect {
 public:
  virtual ~Effect() = default;
  /// State beyond columns, for a checkpoint.
  virtual void save(NamedReals&) const {}
  virtual void restore(const NamedReals&) {}
  /// Columns for the frames of run.h5.
  virtual void add_columns(const Tissue<Dim>&, std::vector<FrameColumn>&) const {}
  /// Called at every output time, before the frame is written.
  virtual void record(const Tissue<Dim>&) {}
  /// Force of rigid bodies or soil on the root, N.
  virtual Vec<Dim> contact_force_N() const { return Vec<Dim>::Zero(); }
};

}  // namespace rootsoil
