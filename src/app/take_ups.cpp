// SPDX-License-Identifier: Apache-2.0
#include "app/take_ups.hpp"

#include <fmt/format.h>

#include <charconv>
#include <span>
#include <string>
#include <system_error>

#include "io/atomic_file.hpp"
#include "io/history.hpp"
#include "io/output_error.hpp"

namespace fexp::app {

TakeUps TakeUps::read(const std::filesystem::path& file) {
  TakeUps result;
  std::error_code error;
  if (!std::filesystem::exists(file, error)) {
    return result;
  }
  const io::CsvTable table = io::read_csv(file);
  for (const std::vector<std::string>& row : table.rows) {
    std::int64_t step = -1;
    if (row.size() == 1) {
      std::from_chars(row[0].data(), row[0].data() + row[0].size(), step);
    }
    if (step < 0) {
      throw io::OutputError(file, "it is not a list of steps", "put the file back as the run left it");
    }
    result.add(step);
  }
  return result;
}

void TakeUps::write(const std::filesystem::path& file) const {
  std::string text = "step\n";
  for (const std::int64_t step : steps_) {
    text += fmt::format("{}\n", step);
  }
  io::write_durably(file, std::as_bytes(std::span(text.data(), text.size())));
}

bool TakeUps::keep(std::int64_t history, std::int64_t step) const noexcept {
  for (std::int64_t later = history; later < count(); ++later) {
    if (later < 0 || steps_[static_cast<std::size_t>(later)] < step) {
      return false;
    }
  }
  return true;
}

Bytes TakeUps::pack() const {
  ByteWriter out;
  out.list(steps_);
  return out.take();
}

TakeUps TakeUps::unpack(const Bytes& bytes) {
  TakeUps result;
  result.steps_ = ByteReader(bytes).list<std::int64_t>();
  return result;
}

}  // namespace fexp::app
