// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdio>
#include <nlohmann/json_fwd.hpp>
#include <string_view>

/// Printing that never throws: a run must not end because nobody listens any more. What standard output could not take
/// is found at the program's end.
namespace fexp::app {

inline void print_out(std::string_view text) noexcept {
  static_cast<void>(std::fwrite(text.data(), 1, text.size(), stdout));
}

/// Whatever stands on standard output so far comes first.
inline void print_error(std::string_view text) noexcept {
  static_cast<void>(std::fflush(stdout));
  static_cast<void>(std::fwrite(text.data(), 1, text.size(), stderr));
  static_cast<void>(std::fflush(stderr));
}

/// On standard output. Bytes of names that are no UTF-8 are replaced.
void print_json(const nlohmann::ordered_json& json);

}  // namespace fexp::app
