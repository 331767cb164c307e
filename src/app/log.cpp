// SPDX-License-Identifier: Apache-2.0
#include "app/log.hpp"

#include <fmt/chrono.h>
#include <fmt/format.h>

#include <cerrno>
#include <ctime>
#include <system_error>

#include "io/output_error.hpp"

namespace fexp::app {

namespace {

[[noreturn]] void fail(const std::filesystem::path& path) {
  throw io::OutputError(path, "cannot write the log: " + std::generic_category().message(errno),
                        "free some space or choose a directory that you may write to, with --out");
}

}  // namespace

Log::Log(std::filesystem::path path, Begin begin)
    : path_(std::move(path)), file_(std::fopen(path_.c_str(), begin == Begin::anew ? "we" : "ae")) {
  if (!file_) {
    fail(path_);
  }
}

void Log::line(std::string_view text) {
  const std::string whole = fmt::format("{:%Y-%m-%d %H:%M:%S}  {}\n", fmt::localtime(std::time(nullptr)), text);
  if (std::fwrite(whole.data(), 1, whole.size(), file_.get()) != whole.size() || std::fflush(file_.get()) != 0) {
    fail(path_);
  }
}

}  // namespace fexp::app
