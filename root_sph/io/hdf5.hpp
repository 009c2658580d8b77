// SPDX-License-Identifier: MIT
// The little of HDF5 that is needed here, with handles that close themselves. The C interface is used because
// HDF5's own C++ one has neither external links nor files in memory, and prints from its destructors.
//
// Files are put together in memory and written by our own code (write_text_atomically): HDF5 cannot close a file
// after the disk ran full, and crashes when it tries to.
#pragma once

#include <hdf5.h>

#include <cstdint>
#include <filesystem>
#include <span>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

namespace rootsoil::hdf5 {

class Handle {
 public:
  using Close = herr_t (*)(hid_t);
  /// FileError "cannot <action>: HDF5's reason" when id is negative.
  Handle(hid_t id, Close close, std::string_view action);
  Handle(Handle&& other) noexcept : id_(other.id_), close_(other.close_) { other.id_ = H5I_INVALID_HID; }
  Handle& operator=(Handle&&) = delete;
  ~Handle() {
    if (id_ >= 0) close_(id_);
  }
  operator hid_t() const { return id_; }

 private:
  hid_t id_;
  Close close_;
};

/// FileError when status is negative.
void check(herr_t status, std::string_view action);

Handle create_in_memory();
/// The file's bytes, after room for a head.
std::string image(const Handle& file, std::size_t room_before = 0);
/// For what may be too large for memory; the file is there and room for it is set aside (start_temporary).
Handle open_to_extend(const std::filesystem::path& path);
void flush(const Handle& file);
Handle open_image(std::string_view bytes);
/// What to do about a damaged file.
inline constexpr const char* whole_copy =
    "put a whole copy of the file back; a run that goes on by --resume without the file begins a new one";
Handle open_for_reading(const std::filesystem::path& path);

Handle create_group(hid_t parent, const std::string& name);
void create_external_link(hid_t parent, const std::string& name, const std::filesystem::path& file,
                          const std::string& object);
bool is_external_link(hid_t parent, const std::string& name);
/// An object and all below it, under the same name.
void copy(hid_t from, hid_t to, const std::string& name);
Handle open_group(hid_t parent, const std::string& name);
bool is_group(hid_t parent, const std::string& name);
/// In the order in which they were created.
std::vector<std::string> member_names(hid_t group);

void write_attribute(hid_t object, const char* name, double value);
void write_attribute(hid_t object, const char* name, std::int64_t value);
void write_attribute(hid_t object, const char* name, const std::string& value);
double read_real_attribute(hid_t object, const char* name);
std::int64_t read_integer_attribute(hid_t object, const char* name);
std::string read_text_attribute(hid_t object, const char* name);
std::vector<std::string> attribute_names(hid_t object);

using Values = std::variant<std::vector<double>, std::vector<std::int64_t>>;

struct Shape {
  std::int64_t rows = 0;
  int components = 1;
  bool is_integer = false;
};

/// (rows) or (rows, components); groups on the way are created, larger ones are compressed.
Handle create_dataset(hid_t parent, const std::string& name, std::span<const double> values, int components);
Handle create_dataset(hid_t parent, const std::string& name, std::span<const std::int64_t> values, int components);
Handle open_dataset(hid_t parent, const std::string& name);
Shape shape(hid_t dataset);
Values read_values(hid_t dataset);

}  // namespace rootsoil::hdf5
