// SPDX-License-Identifier: Apache-2.0
#include "app/print.hpp"

#include <nlohmann/json.hpp>

namespace fexp::app {

void print_json(const nlohmann::ordered_json& json) {
  print_out(json.dump(2, ' ', false, nlohmann::ordered_json::error_handler_t::replace) + "\n");
}

}  // namespace fexp::app
