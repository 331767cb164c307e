// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <tbb/version.h>

namespace fexp::parallel {

/// Version of the oneTBB that is loaded.
[[nodiscard]] inline const char* library_version() noexcept { return TBB_runtime_version(); }

}  // namespace fexp::parallel
