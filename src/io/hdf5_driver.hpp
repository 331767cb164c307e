// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <hdf5.h>

namespace fexp::io::hdf5 {

/// Driver by which HDF5 writes files that a kill in the middle of a write leaves readable: HDF5's own for POSIX files
/// ("sec2"), but for two things.
/// - A node of an index of chunks is written with its entries first, and with their number after that. HDF5 looks at as
///   many entries as the number says; with the number first, one may be counted that is not there, and half of the
///   others are not found beside it.
/// - Metadata are written as they are, one at a time, and not gathered with what is beside them in the file.
/// Below 0 where HDF5 cannot set it up.
[[nodiscard]] hid_t entries_first_driver();

}  // namespace fexp::io::hdf5
