// SPDX-License-Identifier: Apache-2.0
#include "app/balance_text.hpp"

#include <fmt/format.h>

namespace fexp::app {

std::string balance_text(const cluster::BalanceReport& balance) {
  if (!(balance.largest_share > 0.0)) {
    return "nothing measured yet";
  }
  std::string text =
      fmt::format("the busiest machine has {:.0f} % more to do than the mean; ", 100.0 * balance.imbalance);
  const double saved = 100.0 * (1.0 - balance.with_one_more);
  if (balance.useful_machines <= 1) {
    return text +
           fmt::format("one island is {:.0f} % of the work: more machines do not help", 100.0 * balance.largest_share);
  }
  if (saved >= 1.0) {
    text += fmt::format("one more machine would save {:.0f} % of the time; ", saved);
  } else {
    text += "one more machine would save nothing; ";
  }
  return text + fmt::format("the largest island is {:.2g} % of the work: more than {} machines do not help",
                            100.0 * balance.largest_share, balance.useful_machines);
}

}  // namespace fexp::app
