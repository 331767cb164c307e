// SPDX-License-Identifier: Apache-2.0
#include "io/vtkhdf_hdf5.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/mman.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstring>
#include <system_error>

#include "io/hdf5_driver.hpp"
#include "io/output_error.hpp"

namespace fexp::io::hdf5 {

void print_nothing() { H5Eset_auto2(H5E_DEFAULT, nullptr, nullptr); }

namespace {

/// Before any other call. A file that could not be closed (a full disk) stays on HDF5's list after its memory is freed,
/// and the clean-up at the program's end would follow it. That clean-up has nothing to do here: handles close
/// themselves.
void set_up() {
  H5dont_atexit();
  print_nothing();
}

/// HDF5 lists a failure from the outermost call inwards; the innermost knows the operating system's words.
std::string innermost_reason() {
  std::string reason;
  const auto take = [](unsigned, const H5E_error2_t* error, void* text) -> herr_t {
    *static_cast<std::string*>(text) = error->desc != nullptr ? error->desc : "";
    return 0;
  };
  H5Ewalk2(H5E_DEFAULT, H5E_WALK_DOWNWARD, take, &reason);
  constexpr std::string_view before = "error message = '";
  if (const std::size_t begin = reason.find(before); begin != std::string::npos) {
    const std::size_t end = reason.find('\'', begin + before.size());
    return reason.substr(begin + before.size(), end - begin - before.size());
  }
  return reason.empty() ? "unknown reason" : reason;
}

std::string cure_for(const std::string& reason) {
  if (reason.find("No space") != std::string::npos || reason.find("quota") != std::string::npos ||
      reason.find("too large") != std::string::npos) {
    return "free some space, or write elsewhere with --out; the frames written so far can be read";
  }
  if (reason.find("Permission") != std::string::npos || reason.find("Read-only") != std::string::npos) {
    return "write to a directory that you may write to, with --out";
  }
  if (reason.find("No such file") != std::string::npos) {
    return "check the path";
  }
  return "check that the disk is there and that this is a results file of fexp";
}

// Nothing is written to the file between two flushes but raw data in places that no metadata points to yet. A lock
// would keep ParaView from looking at a run that goes on.
Handle access_list(const File* file) {
  Handle list(H5Pcreate(H5P_FILE_ACCESS), H5Pclose);
  H5AC_cache_config_t config{};
  config.version = H5AC__CURR_CACHE_CONFIG_VERSION;
  bool good = list && H5Pget_mdc_config(list.id(), &config) >= 0;
  config.incr_mode = H5C_incr__off;
  config.flash_incr_mode = H5C_flash_incr__off;
  config.decr_mode = H5C_decr__off;
  config.evictions_enabled = false;
  good = good && H5Pset_mdc_config(list.id(), &config) >= 0 && H5Pset_file_locking(list.id(), false, true) >= 0 &&
         H5Pset_meta_block_size(list.id(), 0) >= 0 && H5Pset_fclose_degree(list.id(), H5F_CLOSE_STRONG) >= 0 &&
         H5Pset_cache(list.id(), 0, 0, 0, 0.0) >= 0 && H5Pset_driver(list.id(), entries_first_driver(), nullptr) >= 0;
  if (!good) {
    file->fail("set up HDF5");
  }
  return list;
}

Handle simple_space(Shape shape) {
  const std::array<hsize_t, 2> sizes{shape.rows, shape.columns};
  return {H5Screate_simple(shape.columns == 0 ? 1 : 2, sizes.data(), nullptr), H5Sclose};
}

}  // namespace

std::string library_version() {
  set_up();
  unsigned major = 0, minor = 0, release = 0;
  H5get_libversion(&major, &minor, &release);
  return fmt::format("{}.{}.{}", major, minor, release);
}

hid_t type_of(FieldType type) {
  switch (type) {
    case FieldType::double_precision:
      return H5T_NATIVE_DOUBLE;
    case FieldType::integer:
      return H5T_NATIVE_INT32;
    case FieldType::single_precision:
      break;
  }
  return H5T_NATIVE_FLOAT;
}

File File::create(const std::filesystem::path& path, std::size_t chunk_capacity) {
  set_up();
  File file(path, {});
  const Handle creation(H5Pcreate(H5P_FILE_CREATE), H5Pclose);
  const std::size_t half = std::clamp<std::size_t>((chunk_capacity + 1) / 2, 32, 32767);
  file.check(H5Pset_istore_k(creation.id(), static_cast<unsigned>(half)), "set up HDF5");
  const Handle access = access_list(&file);
  file.file_ = Handle(H5Fcreate(path.c_str(), H5F_ACC_TRUNC, creation.id(), access.id()), H5Fclose);
  file.check(file.id(), "create the results file");
  return file;
}

File File::open_to_append(const std::filesystem::path& path) {
  set_up();
  File file(path, {});
  const Handle access = access_list(&file);
  file.file_ = Handle(H5Fopen(path.c_str(), H5F_ACC_RDWR, access.id()), H5Fclose);
  file.check(file.id(), "open the results file");
  // A killed run may have left indices that point beyond the end the file knows of.
  file.check(H5Fincrement_filesize(file.id(), 0), "set the end of the results file");
  return file;
}

File File::open_to_read(const std::filesystem::path& path) {
  set_up();
  File file(path, {});
  const Handle access(H5Pcreate(H5P_FILE_ACCESS), H5Pclose);
  file.check(H5Pset_file_locking(access.id(), false, true), "set up HDF5");
  file.check(H5Pset_fclose_degree(access.id(), H5F_CLOSE_STRONG), "set up HDF5");
  file.file_ = Handle(H5Fopen(path.c_str(), H5F_ACC_RDONLY, access.id()), H5Fclose);
  file.check(file.id(), "open the results file");
  return file;
}

int File::descriptor() const noexcept {
  void* descriptor = nullptr;
  return H5Fget_vfd_handle(id(), H5P_DEFAULT, &descriptor) < 0 ? -1 : *static_cast<int*>(descriptor);
}

void File::reserve() {
  haddr_t end = 0;
  check(H5Fget_eoa(id(), &end), "find the end of the results file");
  if (end <= reserved_) {
    return;
  }
  const int error = posix_fallocate(descriptor(), static_cast<off_t>(reserved_), static_cast<off_t>(end - reserved_));
  // Where a file system cannot reserve, the write will tell.
  if (error == ENOSPC || error == EDQUOT || error == EFBIG) {
    const std::string reason = std::generic_category().message(error);
    throw OutputError(path_, "cannot write results: " + reason, cure_for(reason));
  }
  reserved_ = end;
}

void File::abandon() noexcept {
  // HDF5 has no way to close a file without writing what it holds; what it writes now goes nowhere.
  int nowhere = memfd_create("abandoned", MFD_CLOEXEC);
  nowhere = nowhere < 0 ? ::open("/dev/null", O_RDWR | O_CLOEXEC) : nowhere;
  if (nowhere >= 0) {
    static_cast<void>(dup3(nowhere, descriptor(), O_CLOEXEC));
    static_cast<void>(::close(nowhere));
  }
}

void File::flush() { check(H5Fflush(id(), H5F_SCOPE_LOCAL), "write results"); }

void File::sync() {
  flush();
  if (fsync(descriptor()) != 0) {
    const std::string reason = std::generic_category().message(errno);
    throw OutputError(path_, "cannot write results: " + reason, cure_for(reason));
  }
}

void File::close() {
  if (!file_.reset()) {
    fail("finish the results file");
  }
}

void File::fail(const std::string& doing) const {
  const std::string reason = innermost_reason();
  throw OutputError(path_, "cannot " + doing + ": " + reason, cure_for(reason));
}

void File::make_group(const std::string& name) {
  const Handle group(H5Gcreate2(id(), name.c_str(), H5P_DEFAULT, H5P_DEFAULT, H5P_DEFAULT), H5Gclose);
  check(group.id(), "create group " + name);
}

void File::make_link(const std::string& existing, const std::string& name) {
  check(H5Lcreate_hard(id(), existing.c_str(), id(), name.c_str(), H5P_DEFAULT, H5P_DEFAULT), "create link " + name);
}

void File::set_attribute(const std::string& object, const std::string& name, const std::string& text) {
  const std::string doing = "write attribute " + name;
  const Handle type(H5Tcopy(H5T_C_S1), H5Tclose);
  check(H5Tset_size(type.id(), std::max<std::size_t>(text.size(), 1)), doing);
  check(H5Tset_strpad(type.id(), H5T_STR_NULLPAD), doing);
  const Handle space(H5Screate(H5S_SCALAR), H5Sclose);
  const Handle owner(H5Oopen(id(), object.c_str(), H5P_DEFAULT), H5Oclose);
  check(owner.id(), doing);
  const Handle attribute(H5Acreate2(owner.id(), name.c_str(), type.id(), space.id(), H5P_DEFAULT, H5P_DEFAULT),
                         H5Aclose);
  check(attribute.id(), doing);
  check(H5Awrite(attribute.id(), type.id(), text.c_str()), doing);
}

void File::set_attribute(const std::string& object, const std::string& name, const std::vector<std::int64_t>& values) {
  const std::string doing = "write attribute " + name;
  const Handle owner(H5Oopen(id(), object.c_str(), H5P_DEFAULT), H5Oclose);
  check(owner.id(), doing);
  if (check(H5Aexists(owner.id(), name.c_str()), doing) > 0) {
    const Handle attribute(H5Aopen(owner.id(), name.c_str(), H5P_DEFAULT), H5Aclose);
    check(attribute.id(), doing);
    check(H5Awrite(attribute.id(), H5T_NATIVE_INT64, values.data()), doing);
    return;
  }
  const Handle space = values.size() == 1 ? Handle(H5Screate(H5S_SCALAR), H5Sclose)
                                          : simple_space({static_cast<hsize_t>(values.size()), 0});
  const Handle attribute(H5Acreate2(owner.id(), name.c_str(), H5T_STD_I64LE, space.id(), H5P_DEFAULT, H5P_DEFAULT),
                         H5Aclose);
  check(attribute.id(), doing);
  check(H5Awrite(attribute.id(), H5T_NATIVE_INT64, values.data()), doing);
}

bool File::exists(const std::string& name) const {
  for (std::size_t slash = name.find('/', 1); slash != std::string::npos; slash = name.find('/', slash + 1)) {
    if (H5Lexists(id(), name.substr(0, slash).c_str(), H5P_DEFAULT) <= 0) {
      return false;
    }
  }
  return H5Lexists(id(), name.c_str(), H5P_DEFAULT) > 0;
}

std::string File::text_attribute(const std::string& object, const std::string& name) const {
  const Handle attribute(H5Aopen_by_name(id(), object.c_str(), name.c_str(), H5P_DEFAULT, H5P_DEFAULT), H5Aclose);
  check(attribute.id(), "read attribute " + name);
  const Handle type(H5Aget_type(attribute.id()), H5Tclose);
  std::string text(H5Tget_size(type.id()), '\0');
  check(H5Aread(attribute.id(), type.id(), text.data()), "read attribute " + name);
  text.resize(std::strlen(text.c_str()));
  return text;
}

std::int64_t File::integer_attribute(const std::string& object, const std::string& name) const {
  const Handle attribute(H5Aopen_by_name(id(), object.c_str(), name.c_str(), H5P_DEFAULT, H5P_DEFAULT), H5Aclose);
  check(attribute.id(), "read attribute " + name);
  const Handle space(H5Aget_space(attribute.id()), H5Sclose);
  std::vector<std::int64_t> values(static_cast<std::size_t>(H5Sget_simple_extent_npoints(space.id())));
  check(H5Aread(attribute.id(), H5T_NATIVE_INT64, values.data()), "read attribute " + name);
  return values.empty() ? 0 : values.front();
}

void File::write_fixed(const std::string& name, hid_t type, Shape shape, const void* data) {
  const std::string doing = "write " + name;
  const Handle space = simple_space(shape);
  const Handle dataset(H5Dcreate2(id(), name.c_str(), type, space.id(), H5P_DEFAULT, H5P_DEFAULT, H5P_DEFAULT),
                       H5Dclose);
  check(dataset.id(), doing);
  if (shape.rows > 0) {
    check(H5Dwrite(dataset.id(), type, H5S_ALL, H5S_ALL, H5P_DEFAULT, data), doing);
  }
}

void File::write_strings(const std::string& name, const std::vector<std::string>& strings) {
  std::size_t length = 1;
  for (const std::string& text : strings) {
    length = std::max(length, text.size());
  }
  std::string bytes(length * strings.size(), '\0');
  for (std::size_t i = 0; i < strings.size(); ++i) {
    strings[i].copy(bytes.data() + i * length, length);
  }
  const Handle type(H5Tcopy(H5T_C_S1), H5Tclose);
  check(H5Tset_size(type.id(), length), "write " + name);
  check(H5Tset_strpad(type.id(), H5T_STR_NULLPAD), "write " + name);
  check(H5Tset_cset(type.id(), H5T_CSET_UTF8), "write " + name);
  write_fixed(name, type.id(), {static_cast<hsize_t>(strings.size()), 0}, bytes.data());
}

std::vector<std::string> File::read_strings(const std::string& name) const {
  const Handle dataset = open_dataset(name);
  const Handle type(H5Dget_type(dataset.id()), H5Tclose);
  const std::size_t length = H5Tget_size(type.id());
  std::string bytes(length * shape_of(dataset).rows, '\0');
  check(H5Dread(dataset.id(), type.id(), H5S_ALL, H5S_ALL, H5P_DEFAULT, bytes.data()), "read " + name);
  std::vector<std::string> strings;
  for (std::size_t begin = 0; begin < bytes.size(); begin += length) {
    const std::string padded = bytes.substr(begin, length);
    strings.push_back(padded.substr(0, padded.find('\0')));
  }
  return strings;
}

Handle File::make_growing(const std::string& name, hid_t type, hsize_t columns, const Growth& growth) {
  const std::string doing = "create " + name;
  const int rank = columns == 0 ? 1 : 2;
  const std::array<hsize_t, 2> none{0, columns};
  const std::array<hsize_t, 2> unlimited{H5S_UNLIMITED, columns};
  const std::array<hsize_t, 2> chunk{growth.chunk_rows, columns};
  const Handle space(H5Screate_simple(rank, none.data(), unlimited.data()), H5Sclose);
  const Handle list(H5Pcreate(H5P_DATASET_CREATE), H5Pclose);
  check(H5Pset_chunk(list.id(), rank, chunk.data()), doing);
  if (growth.fill != nullptr) {
    check(H5Pset_fill_value(list.id(), H5T_NATIVE_INT64, growth.fill), doing);
  } else {
    check(H5Pset_fill_time(list.id(), H5D_FILL_TIME_NEVER), doing);
  }
  if (growth.deflate > 0) {
    check(H5Pset_shuffle(list.id()), doing);
    check(H5Pset_deflate(list.id(), static_cast<unsigned>(growth.deflate)), doing);
  }
  Handle dataset(H5Dcreate2(id(), name.c_str(), type, space.id(), H5P_DEFAULT, list.id(), H5P_DEFAULT), H5Dclose);
  check(dataset.id(), doing);
  return dataset;
}

Handle File::open_dataset(const std::string& name) const {
  Handle dataset(H5Dopen2(id(), name.c_str(), H5P_DEFAULT), H5Dclose);
  check(dataset.id(), "open " + name);
  return dataset;
}

Shape File::shape_of(const Handle& dataset) const {
  const Handle space(H5Dget_space(dataset.id()), H5Sclose);
  std::array<hsize_t, 2> sizes{};
  if (check(H5Sget_simple_extent_ndims(space.id()), "read a shape") > 2) {
    fail("read a dataset of more than two dimensions");
  }
  check(H5Sget_simple_extent_dims(space.id(), sizes.data(), nullptr), "read a shape");
  return {sizes[0], sizes[1]};
}

void File::grow(const Handle& dataset, hsize_t rows) const {
  const Shape shape = shape_of(dataset);
  if (rows > shape.rows) {
    const std::array<hsize_t, 2> sizes{rows, shape.columns};
    check(H5Dset_extent(dataset.id(), sizes.data()), "write results");
  }
}

namespace {

/// Rows of a dataset, and the memory they go to or come from.
struct Selection {
  Handle space;
  Handle memory;
};

Selection select_rows(const File& file, const Handle& dataset, hsize_t begin, hsize_t rows) {
  const Shape shape = file.shape_of(dataset);
  Handle space(H5Dget_space(dataset.id()), H5Sclose);
  const std::array<hsize_t, 2> start{begin, 0};
  const std::array<hsize_t, 2> count{rows, shape.columns};
  file.check(H5Sselect_hyperslab(space.id(), H5S_SELECT_SET, start.data(), nullptr, count.data(), nullptr),
             "select rows");
  return {.space = std::move(space), .memory = simple_space({rows, shape.columns})};
}

}  // namespace

void File::write_rows(const Handle& dataset, hid_t type, hsize_t begin, hsize_t rows, const void* data) const {
  const Selection selection = select_rows(*this, dataset, begin, rows);
  check(H5Dwrite(dataset.id(), type, selection.memory.id(), selection.space.id(), H5P_DEFAULT, data), "write results");
}

void File::read_rows(const Handle& dataset, hid_t type, hsize_t begin, hsize_t rows, void* data) const {
  const Selection selection = select_rows(*this, dataset, begin, rows);
  check(H5Dread(dataset.id(), type, selection.memory.id(), selection.space.id(), H5P_DEFAULT, data), "read results");
}

}  // namespace fexp::io::hdf5
