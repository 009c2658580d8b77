// SPDX-License-Identifier: MIT
#include "root_sph/io/hdf5.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>

#include "root_sph/core/errors.hpp"

namespace rootsoil::hdf5 {
namespace {

// Errors reach the user as our own messages, once.
void silence() { H5Eset_auto2(H5E_DEFAULT, nullptr, nullptr); }

// HDF5 keeps a stack of what failed; the innermost entry says why.
std::string reason() {
  std::string text = "unknown reason";
  const auto keep_innermost = [](unsigned depth, const H5E_error2_t* entry, void* out) -> herr_t {
    if (depth == 0 && entry->desc != nullptr) *static_cast<std::string*>(out) = entry->desc;
    return 0;
  };
  H5Ewalk2(H5E_DEFAULT, H5E_WALK_UPWARD, keep_innermost, &text);
  return text;
}

Handle property_list(hid_t kind) { return {H5Pcreate(kind), H5Pclose, "create a property list"}; }

Handle memory_access() {
  silence();
  constexpr std::size_t growth_bytes = 1 << 20;
  Handle access = property_list(H5P_FILE_ACCESS);
  check(H5Pset_fapl_core(access, growth_bytes, false), "choose a file in memory");
  return access;
}

Handle text_type() {
  Handle type(H5Tcopy(H5T_C_S1), H5Tclose, "describe a text");
  check(H5Tset_size(type, H5T_VARIABLE), "describe a text");
  check(H5Tset_cset(type, H5T_CSET_UTF8), "describe a text");
  return type;
}

void write_scalar_attribute(hid_t object, const char* name, hid_t type, const void* value) {
  const Handle space(H5Screate(H5S_SCALAR), H5Sclose, "describe an attribute");
  const Handle attribute(H5Acreate2(object, name, type, space, H5P_DEFAULT, H5P_DEFAULT), H5Aclose,
                         fmt::format("create the attribute '{}'", name));
  check(H5Awrite(attribute, type, value), fmt::format("write the attribute '{}'", name));
}

// One value of the wanted class and nothing else: reading into a single variable must be safe for any file.
Handle open_scalar_attribute(hid_t object, const char* name, H5T_class_t wanted) {
  Handle attribute(H5Aopen(object, name, H5P_DEFAULT), H5Aclose, fmt::format("find the attribute '{}'", name));
  const Handle space(H5Aget_space(attribute), H5Sclose, "read an attribute");
  const Handle type(H5Aget_type(attribute), H5Tclose, "read an attribute");
  const bool text_as_expected = wanted != H5T_STRING || H5Tis_variable_str(type) > 0;
  if (H5Sget_simple_extent_npoints(space) != 1 || H5Tget_class(type) != wanted || !text_as_expected) {
    throw FileError(fmt::format("the attribute '{}' is not of the kind expected", name));
  }
  return attribute;
}

template <class T>
Handle create_dataset_of(hid_t parent, const std::string& name, std::span<const T> values, int components,
                         hid_t file_type, hid_t memory_type) {
  const std::string action = fmt::format("write '{}'", name);
  const hsize_t width = static_cast<hsize_t>(components);
  const std::array<hsize_t, 2> extent{values.size() / width, width};
  const int rank = components == 1 ? 1 : 2;
  const Handle space(H5Screate_simple(rank, extent.data(), nullptr), H5Sclose, action);

  const Handle links = property_list(H5P_LINK_CREATE);
  check(H5Pset_create_intermediate_group(links, 1), action);
  const Handle layout = property_list(H5P_DATASET_CREATE);
  // without the time of creation the same values give the same bytes
  check(H5Pset_obj_track_times(layout, false), action);
  constexpr hsize_t smallest_compressed_bytes = 4096, rows_per_chunk = 16384;
  if (values.size_bytes() >= smallest_compressed_bytes) {
    const std::array<hsize_t, 2> chunk{std::min(extent[0], rows_per_chunk), width};
    check(H5Pset_chunk(layout, rank, chunk.data()), action);
    check(H5Pset_shuffle(layout), action);
    check(H5Pset_deflate(layout, 1), action);
  }
  Handle dataset(H5Dcreate2(parent, name.c_str(), file_type, space, links, layout, H5P_DEFAULT), H5Dclose, action);
  if (!values.empty()) check(H5Dwrite(dataset, memory_type, H5S_ALL, H5S_ALL, H5P_DEFAULT, values.data()), action);
  return dataset;
}

template <class T>
std::vector<T> read_values_as(hid_t dataset, hid_t memory_type, std::size_t count) {
  std::vector<T> values(count);
  if (count > 0) check(H5Dread(dataset, memory_type, H5S_ALL, H5S_ALL, H5P_DEFAULT, values.data()), "read values");
  return values;
}

}  // namespace

Handle::Handle(hid_t id, Close close, std::string_view action) : id_(id), close_(close) {
  if (id_ < 0) throw FileError(fmt::format("cannot {}: {}", action, reason()));
}

void check(herr_t status, std::string_view action) {
  if (status < 0) throw FileError(fmt::format("cannot {}: {}", action, reason()));
}

Handle create_in_memory() {
  const Handle access = memory_access();
  const Handle creation = property_list(H5P_FILE_CREATE);
  check(H5Pset_link_creation_order(creation, H5P_CRT_ORDER_TRACKED | H5P_CRT_ORDER_INDEXED), "keep the order");
  return {H5Fcreate("new file", H5F_ACC_TRUNC, creation, access), H5Fclose, "create a file in memory"};
}

std::string image(const Handle& file, std::size_t room_before) {
  check(H5Fflush(file, H5F_SCOPE_GLOBAL), "complete a file in memory");
  const ssize_t size = H5Fget_file_image(file, nullptr, 0);
  std::string bytes(room_before + static_cast<std::size_t>(std::max<ssize_t>(size, 0)), '\0');
  if (size <= 0 || H5Fget_file_image(file, bytes.data() + room_before, bytes.size() - room_before) != size) {
    throw FileError(fmt::format("cannot complete a file in memory: {}", reason()));
  }
  return bytes;
}

Handle open_to_extend(const std::filesystem::path& path) {
  return {H5Fopen(path.c_str(), H5F_ACC_RDWR, H5P_DEFAULT), H5Fclose, fmt::format("open {}", path.string())};
}

void flush(const Handle& file) { check(H5Fflush(file, H5F_SCOPE_GLOBAL), "complete a file"); }

Handle open_image(std::string_view bytes) {
  const Handle access = memory_access();
  check(H5Pset_file_image(access, const_cast<char*>(bytes.data()), bytes.size()), "read a file in memory");
  return {H5Fopen("file image", H5F_ACC_RDONLY, access), H5Fclose, "read the file"};
}

Handle open_for_reading(const std::filesystem::path& path) {
  silence();
  std::error_code trouble;
  if (!std::filesystem::exists(path, trouble)) {
    throw FileError(fmt::format("{}: there is no such file", path.string()), file_remedy(ENOENT));
  }
  try {
    return {H5Fopen(path.c_str(), H5F_ACC_RDONLY, H5P_DEFAULT), H5Fclose, fmt::format("open {}", path.string())};
  } catch (const FileError& error) {
    throw FileError(error.problem(), whole_copy);
  }
}

Handle create_group(hid_t parent, const std::string& name) {
  return {H5Gcreate2(parent, name.c_str(), H5P_DEFAULT, H5P_DEFAULT, H5P_DEFAULT), H5Gclose,
          fmt::format("create '{}'", name)};
}

Handle open_group(hid_t parent, const std::string& name) {
  return {H5Gopen2(parent, name.c_str(), H5P_DEFAULT), H5Gclose, fmt::format("find '{}'", name)};
}

void create_external_link(hid_t parent, const std::string& name, const std::filesystem::path& file,
                          const std::string& object) {
  check(H5Lcreate_external(file.c_str(), object.c_str(), parent, name.c_str(), H5P_DEFAULT, H5P_DEFAULT),
        fmt::format("create '{}'", name));
}

bool is_external_link(hid_t parent, const std::string& name) {
  H5L_info_t info;
  check(H5Lget_info(parent, name.c_str(), &info, H5P_DEFAULT), fmt::format("find '{}'", name));
  return info.type == H5L_TYPE_EXTERNAL;
}

void copy(hid_t from, hid_t to, const std::string& name) {
  check(H5Ocopy(from, name.c_str(), to, name.c_str(), H5P_DEFAULT, H5P_DEFAULT), fmt::format("copy '{}'", name));
}

bool is_group(hid_t parent, const std::string& name) {
  const Handle object(H5Oopen(parent, name.c_str(), H5P_DEFAULT), H5Oclose, fmt::format("find '{}'", name));
  return H5Iget_type(object) == H5I_GROUP;
}

std::vector<std::string> member_names(hid_t group) {
  H5G_info_t info;
  check(H5Gget_info(group, &info), "list a group");
  const Handle creation(H5Gget_create_plist(group), H5Pclose, "list a group");
  unsigned order = 0;
  check(H5Pget_link_creation_order(creation, &order), "list a group");
  const H5_index_t by = (order & H5P_CRT_ORDER_INDEXED) != 0 ? H5_INDEX_CRT_ORDER : H5_INDEX_NAME;
  std::vector<std::string> names;
  for (hsize_t i = 0; i < info.nlinks; ++i) {
    const auto name_of = [&](char* out, std::size_t size) {
      return H5Lget_name_by_idx(group, ".", by, H5_ITER_INC, i, out, size, H5P_DEFAULT);
    };
    const ssize_t length = name_of(nullptr, 0);
    check(static_cast<herr_t>(std::min<ssize_t>(length, 0)), "list a group");
    std::string name(static_cast<std::size_t>(length), '\0');
    name_of(name.data(), name.size() + 1);
    names.push_back(std::move(name));
  }
  return names;
}

void write_attribute(hid_t object, const char* name, double value) {
  write_scalar_attribute(object, name, H5T_NATIVE_DOUBLE, &value);
}

void write_attribute(hid_t object, const char* name, std::int64_t value) {
  write_scalar_attribute(object, name, H5T_NATIVE_INT64, &value);
}

void write_attribute(hid_t object, const char* name, const std::string& value) {
  const char* text = value.c_str();
  write_scalar_attribute(object, name, text_type(), &text);
}

double read_real_attribute(hid_t object, const char* name) {
  const Handle attribute = open_scalar_attribute(object, name, H5T_FLOAT);
  double value = 0.0;
  check(H5Aread(attribute, H5T_NATIVE_DOUBLE, &value), fmt::format("read the attribute '{}'", name));
  return value;
}

std::int64_t read_integer_attribute(hid_t object, const char* name) {
  const Handle attribute = open_scalar_attribute(object, name, H5T_INTEGER);
  std::int64_t value = 0;
  check(H5Aread(attribute, H5T_NATIVE_INT64, &value), fmt::format("read the attribute '{}'", name));
  return value;
}

std::string read_text_attribute(hid_t object, const char* name) {
  const Handle attribute = open_scalar_attribute(object, name, H5T_STRING);
  char* text = nullptr;
  check(H5Aread(attribute, text_type(), &text), fmt::format("read the attribute '{}'", name));
  std::string value = text != nullptr ? text : "";
  H5free_memory(text);
  return value;
}

std::vector<std::string> attribute_names(hid_t object) {
  std::vector<std::string> names;
  const auto collect = [](hid_t, const char* name, const H5A_info_t*, void* out) -> herr_t {
    static_cast<std::vector<std::string>*>(out)->emplace_back(name);
    return 0;
  };
  check(H5Aiterate2(object, H5_INDEX_NAME, H5_ITER_INC, nullptr, collect, &names), "list attributes");
  return names;
}

Handle create_dataset(hid_t parent, const std::string& name, std::span<const double> values, int components) {
  return create_dataset_of(parent, name, values, components, H5T_IEEE_F64LE, H5T_NATIVE_DOUBLE);
}

Handle create_dataset(hid_t parent, const std::string& name, std::span<const std::int64_t> values, int components) {
  return create_dataset_of(parent, name, values, components, H5T_STD_I64LE, H5T_NATIVE_INT64);
}

Handle open_dataset(hid_t parent, const std::string& name) {
  return {H5Dopen2(parent, name.c_str(), H5P_DEFAULT), H5Dclose, fmt::format("find '{}'", name)};
}

Shape shape(hid_t dataset) {
  const Handle space(H5Dget_space(dataset), H5Sclose, "read a shape");
  const Handle type(H5Dget_type(dataset), H5Tclose, "read a type");
  std::array<hsize_t, 2> extent{0, 1};
  const int rank = H5Sget_simple_extent_ndims(space);
  if (rank != 1 && rank != 2) throw FileError("the values are not a table");
  H5Sget_simple_extent_dims(space, extent.data(), nullptr);
  const H5T_class_t kind = H5Tget_class(type);
  if (kind != H5T_INTEGER && kind != H5T_FLOAT) throw FileError("the values are not numbers");
  return {static_cast<std::int64_t>(extent[0]), static_cast<int>(extent[1]), kind == H5T_INTEGER};
}

Values read_values(hid_t dataset) {
  const Shape found = shape(dataset);
  const std::size_t count = static_cast<std::size_t>(found.rows) * static_cast<std::size_t>(found.components);
  if (found.is_integer) return read_values_as<std::int64_t>(dataset, H5T_NATIVE_INT64, count);
  return read_values_as<double>(dataset, H5T_NATIVE_DOUBLE, count);
}

}  // namespace rootsoil::hdf5
