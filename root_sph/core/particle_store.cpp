// SPDX-License-Identifier: MIT
#include "root_sph/core/particle_store.hpp"

namespace rootsoil {
namespace {

// Rules of the paper's 4.2: two equal daughters at half the semi-axis on each side of the division
// plane, mass and volume shared, the longest axis halved (its eigenvalue of Q times four).
template <int Dim>
void move_apart(Vec<Dim>& first, Vec<Dim>& second, const Division<Dim>& d) {
  first += d.offset_mm * d.axis;
  second -= d.offset_mm * d.axis;
}

template <int Dim>
void halve_longest_axis(Mat<Dim>& first, Mat<Dim>& second, const Division<Dim>& d) {
  const double zeta = 4.0 / (d.length_mm * d.length_mm);
  first += 3.0 * zeta * d.axis * d.axis.transpose();
  second = first;
}

template <int Dim>
void shift_along_root(double& first, double& second, const Division<Dim>& d) {
  first -= d.along_root_mm;  // towards the tip: nearer to it
  second += d.along_root_mm;
}

template <int Dim>
void next_generation(std::int64_t& first, std::int64_t& second, const Division<Dim>&) {
  ++first;
  ++second;
}

template <int Dim>
void new_ids(std::int64_t& first, std::int64_t& second, const Division<Dim>& d) {
  first = d.first_id;
  second = d.second_id;
}

}  // namespace

template <int Dim>
ParticleStore<Dim>::ParticleStore()
    : position(declare<Vec<Dim>>({"position", "mm", "centre of the cell"}, move_apart<Dim>)),
      velocity(declare<Vec<Dim>>({"velocity", "mm/h", "velocity of the centre"}, on_division::copy<Dim, Vec<Dim>>)),
      volume(declare<double>({"volume", Dim == 2 ? "mm^2" : "mm^3", "volume of the cell (2D: area)"},
                             on_division::halve<Dim, double>)),
      mass(declare<double>({"mass", Dim == 2 ? "ug/mm" : "ug", "biological mass (2D: per mm of depth)"},
                           on_division::halve<Dim, double>)),
      stress(declare<Voigt<Dim>>({"material_stress", "MPa", "stress in the material frame, tension positive"},
                                 on_division::copy<Dim, Voigt<Dim>>)),
      frame(declare<Mat<Dim>>({"frame", "1", "material axes as columns, first along the root"},
                              on_division::copy<Dim, Mat<Dim>>)),
      shape(declare<Mat<Dim>>({"shape", "1/mm^2", "shape matrix Q, eigenvalues 4/length^2"}, halve_longest_axis<Dim>)),
      distance_to_tip(
          declare<double>({"distance_to_tip", "mm", "distance from the tip along the root"}, shift_along_root<Dim>)),
      generation(declare<std::int64_t>({"generation", "1", "divisions since the start"}, next_generation<Dim>)),
      cell_id(declare<std::int64_t>({"cell_id", "1", "unique number of the cell"}, new_ids<Dim>)),
      // parent_id is set by divide(), which alone knows the mother's id
      parent_id(declare<std::int64_t>({"parent_id", "1", "cell_id of the mother, -1 at the start"},
                                      on_division::copy<Dim, std::int64_t>)),
      clamped(
          declare<std::int64_t>({"clamped", "1", "1 where the cell is held"}, on_division::copy<Dim, std::int64_t>)) {}

template <int Dim>
FieldBase<Dim>* ParticleStore<Dim>::find(const std::string& name) const {
  for (const auto& field : fields_) {
    if (field->info().name == name) return field.get();
  }
  return nullptr;
}

template <int Dim>
std::size_t ParticleStore<Dim>::bytes_per_cell() const {
  std::size_t bytes = 0;
  for (const auto& field : fields_) bytes += field->bytes_per_cell();
  return bytes;
}

template <int Dim>
void ParticleStore<Dim>::resize(std::size_t cells) {
  for (auto& field : fields_) field->resize(cells);
  size_ = total_ = cells;
}

template <int Dim>
void ParticleStore<Dim>::rest(std::size_t cells) {
  ROOTSOIL_ASSERT(cells <= size_);
  size_ -= cells;
}

template <int Dim>
void ParticleStore<Dim>::permute(const std::vector<std::int64_t>& new_to_old) {
  ROOTSOIL_ASSERT(new_to_old.size() == size_);
  for (auto& field : fields_) field->permute(new_to_old);
}

template <int Dim>
void ParticleStore<Dim>::divide(std::size_t mother, const Vec<Dim>& axis, double length_mm, std::int64_t first_id,
                                std::int64_t second_id) {
  ROOTSOIL_ASSERT(mother < size_);
  const double offset_mm = 0.25 * length_mm;
  const Division<Dim> division{axis,     length_mm, offset_mm, offset_mm * axis.dot(frame[mother].col(0)),
                               first_id, second_id};
  const std::int64_t mother_id = cell_id[mother];
  for (auto& field : fields_) field->divide(mother, size_, division);
  ++size_;
  ++total_;
  parent_id[mother] = mother_id;
  parent_id[size_ - 1] = mother_id;
}

template class ParticleStore<2>;
template class ParticleStore<3>;

}  // namespace rootsoil
