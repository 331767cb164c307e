// SPDX-License-Identifier: Apache-2.0
#include "io/hdf5_driver.hpp"

#include <cstddef>

namespace fexp::io::hdf5 {

namespace {

/// HDF5 file format, version 1 B-trees: signature, type, level, number of entries and both siblings; keys and addresses
/// of chunks follow.
constexpr std::size_t node_head = 4 + 1 + 1 + 2 + 8 + 8;

H5FD_class_t posix_files{};

herr_t write_entries_first(H5FD_t* file, H5FD_mem_t type, hid_t transfer, haddr_t address, std::size_t size,
                           const void* buffer) {
  if (type != H5FD_MEM_BTREE || size <= node_head) {
    return posix_files.write(file, type, transfer, address, size, buffer);
  }
  const auto* const bytes = static_cast<const char*>(buffer);
  const herr_t entries =
      posix_files.write(file, type, transfer, address + node_head, size - node_head, bytes + node_head);
  return entries < 0 ? entries : posix_files.write(file, type, transfer, address, node_head, bytes);
}

herr_t query_without_gathering(const H5FD_t* file, unsigned long* flags) {
  const herr_t result = posix_files.query(file, flags);
  if (flags != nullptr) {
    *flags &= ~static_cast<unsigned long>(H5FD_FEAT_ACCUMULATE_METADATA);
  }
  return result;
}

hid_t register_driver() {
  // HDF5 shows the functions of a driver in its files only.
  const hid_t access = H5Pcreate(H5P_FILE_ACCESS);
  H5FD_t* const any =
      H5Pset_fapl_sec2(access) < 0 ? nullptr : H5FDopen("/dev/null", H5F_ACC_RDONLY, access, HADDR_UNDEF);
  H5Pclose(access);
  if (any == nullptr) {
    return H5I_INVALID_HID;
  }
  posix_files = *any->cls;
  H5FDclose(any);
  H5FD_class_t driver = posix_files;
  driver.name = "fexp_entries_first";
  driver.terminate = nullptr;
  driver.query = query_without_gathering;
  driver.write = write_entries_first;
  return H5FDregister(&driver);
}

}  // namespace

hid_t entries_first_driver() {
  static const hid_t driver = register_driver();
  return driver;
}

}  // namespace fexp::io::hdf5
