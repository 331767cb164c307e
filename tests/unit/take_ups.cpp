// SPDX-License-Identifier: Apache-2.0
#include "app/take_ups.hpp"

#include <gtest/gtest.h>

#include <filesystem>
#include <initializer_list>

#include "io/atomic_file.hpp"
#include "io/output_error.hpp"

namespace fexp::app {
namespace {

TakeUps of(std::initializer_list<std::int64_t> steps) {
  TakeUps take_ups;
  for (const std::int64_t step : steps) {
    take_ups.add(step);
  }
  return take_ups;
}

TEST(take_ups, what_was_saved_since_the_last_one_is_of_use) { EXPECT_TRUE(of({0, 100}).keep(2, 1000)); }

TEST(take_ups, what_was_saved_before_one_is_of_use_up_to_its_step) {
  const TakeUps take_ups = of({0, 100, 300});
  EXPECT_TRUE(take_ups.keep(1, 100));
  EXPECT_FALSE(take_ups.keep(1, 101)) << "the files were cut back to step 100 since";
  EXPECT_TRUE(take_ups.keep(2, 300));
  EXPECT_FALSE(take_ups.keep(2, 301));
}

TEST(take_ups, a_step_that_was_passed_again_is_not_what_it_was) {
  // Cut back to 0 after step 500 was saved, then beyond 500 again: the files may have other lengths there now.
  EXPECT_FALSE(of({0, 0, 700}).keep(1, 500));
}

TEST(take_ups, are_the_same_from_a_file_and_from_bytes) {
  const std::filesystem::path file = std::filesystem::path(testing::TempDir()) / "fexp_take_ups.csv";
  const TakeUps take_ups = of({0, 70, 30});
  take_ups.write(file);
  for (const TakeUps& other : {TakeUps::read(file), TakeUps::unpack(take_ups.pack())}) {
    EXPECT_EQ(other.count(), 3);
    EXPECT_TRUE(other.keep(1, 30));
    EXPECT_FALSE(other.keep(1, 31));
    EXPECT_FALSE(other.keep(2, 31));
  }
  io::write_atomically(file, "step\n12\nx\n");
  EXPECT_THROW(static_cast<void>(TakeUps::read(file)), io::OutputError);
  std::filesystem::remove(file);
  EXPECT_EQ(TakeUps::read(file).count(), 0);
}

}  // namespace
}  // namespace fexp::app
