// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <gtest/gtest.h>

#include <fmt/format.h>

#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <fstream>
#include <string>

/// One table over all verification tests: each row is printed, checked and, when FEXP_VERIFICATION_ROWS names a file,
/// appended to it, from where docs/verification.md is generated.
namespace fexp::test {

struct VerificationRow {
  std::string number;  ///< Number of the case in docs/verification.md
  std::string title;
  std::string quantity;
  double reference{};
  double result{};
  double tolerance{};   ///< Largest accepted error
  bool relative{true};  ///< Error relative to the reference, else absolute
  std::string source;
};

/// Checks |result - reference| (over |reference|) <= tolerance and writes the row.
inline void verify(const VerificationRow& row) {
  const double difference = std::abs(row.result - row.reference);
  const double error = row.relative ? difference / std::abs(row.reference) : difference;
  std::printf("%-4s %-34s %-34s reference %.9g  result %.9g  error %.2e  tolerance %.1e  (%s)\n", row.number.c_str(),
              row.title.c_str(), row.quantity.c_str(), row.reference, row.result, error, row.tolerance,
              row.source.c_str());
  EXPECT_LE(error, row.tolerance) << row.title << ": " << row.quantity;
  if (const char* path = std::getenv("FEXP_VERIFICATION_ROWS")) {
    std::ofstream(path, std::ios::app) << fmt::format("{}\t{}\t{}\t{:.9g}\t{:.9g}\t{:.2e}\t{:.1e}\t{}\n", row.number,
                                                      row.title, row.quantity, row.reference, row.result, error,
                                                      row.tolerance, row.source);
  }
}

}  // namespace fexp::test
