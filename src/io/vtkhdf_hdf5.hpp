// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <hdf5.h>

#include <cstdint>
#include <filesystem>
#include <string>
#include <utility>
#include <vector>

#include "io/vtkhdf_fields.hpp"

/// The few HDF5 calls that results need, with owned handles and errors as exceptions. HDF5 itself prints nothing.
namespace fexp::io::hdf5 {

/// Owns one HDF5 identifier of any kind.
class Handle {
 public:
  using Close = herr_t (*)(hid_t);

  Handle() = default;
  Handle(hid_t id, Close close) noexcept : id_(id), close_(close) {}
  Handle(Handle&& other) noexcept : id_(std::exchange(other.id_, -1)), close_(other.close_) {}
  Handle& operator=(Handle&& other) noexcept {
    if (this != &other) {
      reset();
      id_ = std::exchange(other.id_, -1);
      close_ = other.close_;
    }
    return *this;
  }
  Handle(const Handle&) = delete;
  Handle& operator=(const Handle&) = delete;
  ~Handle() { reset(); }

  [[nodiscard]] hid_t id() const noexcept { return id_; }
  [[nodiscard]] explicit operator bool() const noexcept { return id_ >= 0; }
  /// Closes now; false when HDF5 could not (for a file: what was still in memory did not reach the disk).
  bool reset() noexcept { return id_ < 0 || close_(std::exchange(id_, -1)) >= 0; }

 private:
  hid_t id_{-1};
  Close close_{};
};

/// Keeps HDF5 from printing errors of the calling thread; what opens a file has done so on its own. Where HDF5 is built
/// for several threads, each has errors of its own.
void print_nothing();

/// Version of the HDF5 that is loaded.
[[nodiscard]] std::string library_version();

/// HDF5's name of a field's numbers, in memory and in the file.
[[nodiscard]] hid_t type_of(FieldType type);

/// Shape of a dataset: rows (the dimension that grows) and columns; columns 0 means one-dimensional.
struct Shape {
  hsize_t rows{};
  hsize_t columns{};
};

/// HDF5 calls on one file. Every failure becomes an OutputError that names the file.
class File {
 public:
  /// Creates or replaces a file. `chunk_capacity`: number of chunks a dataset's index holds before its tree must split.
  static File create(const std::filesystem::path& path, std::size_t chunk_capacity);
  static File open_to_append(const std::filesystem::path& path);
  static File open_to_read(const std::filesystem::path& path);

  [[nodiscard]] const std::filesystem::path& path() const noexcept { return path_; }
  void renamed_to(std::filesystem::path path) { path_ = std::move(path); }
  [[nodiscard]] hid_t id() const noexcept { return file_.id(); }

  /// Takes the disk space of all that is in memory, so that a full disk is met before metadata points to what is not
  /// there.
  void reserve();
  /// Hands everything in memory to the operating system.
  void flush();
  /// Likewise, and waits until it is on the disk.
  void sync();
  /// Leaves the file as it stands now: closing it writes no more to it.
  void abandon() noexcept;
  /// Closes the file; throws when what was in memory could not be written.
  void close();

  /// Throws OutputError with HDF5's innermost reason.
  [[noreturn]] void fail(const std::string& doing) const;
  /// `value` when it is no error code, otherwise fail().
  template <class T>
  T check(T value, const std::string& doing) const {
    if (value < 0) {
      fail(doing);
    }
    return value;
  }

  // Structure. Names are paths from the root.
  void make_group(const std::string& name);
  void make_link(const std::string& existing, const std::string& name);
  void set_attribute(const std::string& object, const std::string& name, const std::string& text);
  void set_attribute(const std::string& object, const std::string& name, const std::vector<std::int64_t>& values);
  [[nodiscard]] bool exists(const std::string& name) const;
  [[nodiscard]] std::string text_attribute(const std::string& object, const std::string& name) const;
  [[nodiscard]] std::int64_t integer_attribute(const std::string& object, const std::string& name) const;

  /// A dataset that never grows, written whole.
  void write_fixed(const std::string& name, hid_t type, Shape shape, const void* data);
  /// Strings of one length, padded with zeros.
  void write_strings(const std::string& name, const std::vector<std::string>& strings);
  [[nodiscard]] std::vector<std::string> read_strings(const std::string& name) const;

  struct Growth {
    hsize_t chunk_rows{};
    int deflate{};                      ///< 0: none
    const std::int64_t* fill{nullptr};  ///< Value of rows that are never written
  };
  /// An empty dataset of `columns` columns (0: one-dimensional) that grows along its first dimension.
  [[nodiscard]] Handle make_growing(const std::string& name, hid_t type, hsize_t columns, const Growth& growth);
  [[nodiscard]] Handle open_dataset(const std::string& name) const;
  [[nodiscard]] Shape shape_of(const Handle& dataset) const;
  /// Makes a dataset at least this long.
  void grow(const Handle& dataset, hsize_t rows) const;
  /// Writes or reads rows [begin, begin + rows) of a dataset.
  void write_rows(const Handle& dataset, hid_t type, hsize_t begin, hsize_t rows, const void* data) const;
  void read_rows(const Handle& dataset, hid_t type, hsize_t begin, hsize_t rows, void* data) const;

 private:
  File(std::filesystem::path path, Handle file) : path_(std::move(path)), file_(std::move(file)) {}

  [[nodiscard]] int descriptor() const noexcept;

  std::filesystem::path path_;
  Handle file_;
  haddr_t reserved_{};  // bytes from the file's beginning
};

}  // namespace fexp::io::hdf5
