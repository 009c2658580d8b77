// SPDX-License-Identifier: MIT
// The cells (one particle = one cell) as named columns.
//
// The store is the only place that resizes, reorders and divides cells. A
// column is a Field; whoever needs one declares it with a rule for division,
// and there is no way to declare one without: cell division cannot forget a
// field. An effect that is absent from the scene declares nothing.
//
// Cells at rest lie at the end of every column, beyond size(): whoever loops over the cells passes them by
// (effects/sleep/sleep.hpp).
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <type_traits>
#include <utility>
#include <vector>

#include "root_sph/core/errors.hpp"
#include "root_sph/core/types.hpp"

namespace rootsoil {

/// One division, as the rules of the fields see it.
template <int Dim>
struct Division {
  Vec<Dim> axis;          ///< unit vector along the mother's longest axis
  double length_mm;       ///< the mother's axis length, 2/sqrt(zeta_1)
  double offset_mm;       ///< daughters lie at +offset and -offset along axis (half the semi-axis)
  double along_root_mm;   ///< offset projected on the mother's root axis (towards the tip > 0)
  std::int64_t first_id;  ///< ids of the two daughters
  std::int64_t second_id;
};

/// What becomes of a value when its cell divides. Both arguments hold the mother's value on entry;
/// first belongs to the daughter at +offset.
template <int Dim, class T>
using DivisionRule = void (*)(T& first, T& second, const Division<Dim>& division);

/// The common rules.
namespace on_division {
template <int Dim, class T>
void copy(T&, T&, const Division<Dim>&) {}

template <int Dim, class T>
void halve(T& first, T& second, const Division<Dim>&) {
  first *= 0.5;
  second *= 0.5;
}

/// For scratch that is recomputed before it is read again.
template <int Dim, class T>
void recomputed(T&, T&, const Division<Dim>&) {}
}  // namespace on_division

/// state: evolves, is part of a checkpoint. scratch: recomputed in every window from state.
enum class Storage { state, scratch };

struct FieldInfo {
  std::string name;
  std::string unit;  ///< "1" for a pure number
  std::string meaning;
  Storage storage = Storage::state;
};

/// How a value type is laid out as plain numbers.
template <class T>
struct FieldTraits;
template <>
struct FieldTraits<double> {
  using Scalar = double;
  static constexpr int components = 1;
};
template <>
struct FieldTraits<std::int64_t> {
  using Scalar = std::int64_t;
  static constexpr int components = 1;
};
template <int Rows, int Cols>
struct FieldTraits<Eigen::Matrix<double, Rows, Cols>> {
  using Scalar = double;
  static constexpr int components = Rows * Cols;
};

/// A column without its type: what the store, the checkpoint and the listings need.
template <int Dim>
class FieldBase {
 public:
  explicit FieldBase(FieldInfo info) : info_(std::move(info)) {}
  virtual ~FieldBase() = default;
  FieldBase(const FieldBase&) = delete;
  FieldBase& operator=(const FieldBase&) = delete;

  const FieldInfo& info() const { return info_; }
  virtual int components() const = 0;
  virtual bool is_integer() const = 0;
  virtual std::size_t bytes_per_cell() const = 0;
  /// The column as plain numbers, cell by cell (matrices column-major); one of the two is empty.
  virtual std::span<double> reals() = 0;
  virtual std::span<std::int64_t> integers() = 0;

 private:
  template <int D>
  friend class ParticleStore;
  virtual void resize(std::size_t cells) = 0;
  virtual void permute(const std::vector<std::int64_t>& new_to_old) = 0;
  virtual void divide(std::size_t mother, std::size_t second_at, const Division<Dim>& division) = 0;

  FieldInfo info_;
};

template <int Dim, class T>
class Field final : public FieldBase<Dim> {
 public:
  using Traits = FieldTraits<T>;

  Field(FieldInfo info, DivisionRule<Dim, T> rule) : FieldBase<Dim>(std::move(info)), rule_(rule) {
    ROOTSOIL_ASSERT(rule != nullptr);
  }

  T& operator[](std::size_t cell) { return values_[cell]; }
  const T& operator[](std::size_t cell) const { return values_[cell]; }
  std::vector<T>& values() { return values_; }
  const std::vector<T>& values() const { return values_; }

  int components() const override { return Traits::components; }
  bool is_integer() const override { return std::is_same_v<typename Traits::Scalar, std::int64_t>; }
  std::size_t bytes_per_cell() const override { return sizeof(T); }

  std::span<double> reals() override {
    if constexpr (std::is_same_v<typename Traits::Scalar, double>) {
      return {reinterpret_cast<double*>(values_.data()), values_.size() * Traits::components};
    }
    return {};
  }
  std::span<std::int64_t> integers() override {
    if constexpr (std::is_same_v<typename Traits::Scalar, std::int64_t>) return {values_.data(), values_.size()};
    return {};
  }

 private:
  static_assert(sizeof(T) == Traits::components * sizeof(typename Traits::Scalar), "columns must be dense");

  static T zero() {
    if constexpr (std::is_arithmetic_v<T>) {
      return T{0};
    } else {
      return T::Zero();
    }
  }
  void resize(std::size_t cells) override { values_.resize(cells, zero()); }
  void permute(const std::vector<std::int64_t>& new_to_old) override {
    std::vector<T> sorted;
    sorted.reserve(values_.size());
    for (const std::int64_t old : new_to_old) sorted.push_back(values_[static_cast<std::size_t>(old)]);
    if (sorted.size() == values_.size()) {
      values_.swap(sorted);
    } else {
      std::copy(sorted.begin(), sorted.end(), values_.begin());  // what rests stays where it is
    }
  }
  void divide(std::size_t mother, std::size_t second_at, const Division<Dim>& division) override {
    T first = values_[mother];
    T second = first;
    rule_(first, second, division);
    values_[mother] = first;
    values_.push_back(second);
    std::swap(values_[second_at], values_.back());
  }

  DivisionRule<Dim, T> rule_;
  std::vector<T> values_;
};

template <int Dim>
class ParticleStore {
 public:
  ParticleStore();

  std::size_t size() const { return size_; }    ///< cells that take part
  std::size_t total() const { return total_; }  ///< and those at rest

  /// Adds a column (all zero). The name must be new. The reference stays valid for the store's life.
  template <class T>
  Field<Dim, T>& declare(FieldInfo info, DivisionRule<Dim, T> rule) {
    ROOTSOIL_ASSERT(find(info.name) == nullptr);
    auto field = std::make_unique<Field<Dim, T>>(std::move(info), rule);
    Field<Dim, T>& reference = *field;
    static_cast<FieldBase<Dim>&>(reference).resize(total_);
    fields_.push_back(std::move(field));
    return reference;
  }

  const std::vector<std::unique_ptr<FieldBase<Dim>>>& fields() const { return fields_; }
  /// nullptr when there is no such column.
  FieldBase<Dim>* find(const std::string& name) const;
  std::size_t bytes_per_cell() const;

  void resize(std::size_t cells);
  /// The values of the cells that take part.
  template <class T>
  std::span<const T> active(const Field<Dim, T>& field) const {
    return {field.values().data(), size_};
  }
  /// The last so many of the cells that take part go to rest.
  void rest(std::size_t cells);
  /// All take part again.
  void wake() { size_ = total_; }
  /// Of the cells that take part: new_to_old[k] = index, before the call, of the cell that becomes cell k.
  void permute(const std::vector<std::int64_t>& new_to_old);
  /// Divides a cell: the daughter at +offset stays at this index, the other becomes the last that takes part.
  /// Every field follows its own rule. Paper 4.2.
  void divide(std::size_t mother, const Vec<Dim>& axis, double length_mm, std::int64_t first_id,
              std::int64_t second_id);

 private:
  std::vector<std::unique_ptr<FieldBase<Dim>>> fields_;
  std::size_t size_ = 0, total_ = 0;

 public:
  // What every scene has. Stress and frame: stress lives in the material frame, whose axes are the
  // columns of `frame` (first: the root axis, pointing to the tip).
  Field<Dim, Vec<Dim>>& position;       ///< mm
  Field<Dim, Vec<Dim>>& velocity;       ///< mm/h
  Field<Dim, double>& volume;           ///< mm^Dim
  Field<Dim, double>& mass;             ///< ug: biological mass
  Field<Dim, Voigt<Dim>>& stress;       ///< MPa, tension positive, material frame, without the pressure p
  Field<Dim, Mat<Dim>>& frame;          ///< rotation
  Field<Dim, Mat<Dim>>& shape;          ///< Q of the paper, 1/mm^2: eigenvalues 4/length^2
  Field<Dim, double>& distance_to_tip;  ///< mm, along the root
  Field<Dim, std::int64_t>& generation;
  Field<Dim, std::int64_t>& cell_id;
  Field<Dim, std::int64_t>& parent_id;  ///< -1: there from the start
  Field<Dim, std::int64_t>& clamped;    ///< 1 where the cell is held
};

extern template class ParticleStore<2>;
extern template class ParticleStore<3>;

}  // namespace rootsoil
