// SPDX-License-Identifier: Apache-2.0
#include "io/atomic_file.hpp"

#include <cerrno>
#include <cstdio>
#include <memory>
#include <system_error>

#include "io/output_error.hpp"

namespace fexp::io {

namespace {

struct CloseFile {
  void operator()(std::FILE* file) const noexcept { static_cast<void>(std::fclose(file)); }
};
using OpenFile = std::unique_ptr<std::FILE, CloseFile>;

[[noreturn]] void fail(const std::filesystem::path& path, const char* doing) {
  const int code = errno;
  throw OutputError(path, std::string("cannot ") + doing + ": " + std::generic_category().message(code),
                    code == ENOSPC || code == EDQUOT || code == EFBIG
                        ? "free some space, or write elsewhere with --out"
                        : "check the path and that you may read and write there, or choose another with --out");
}

}  // namespace

void write_atomically(const std::filesystem::path& path, std::string_view text) {
  const std::filesystem::path unfinished = path.string() + ".new";
  OpenFile file(std::fopen(unfinished.c_str(), "wb"));
  if (!file) {
    fail(path, "write");
  }
  if (std::fwrite(text.data(), 1, text.size(), file.get()) != text.size() || std::fclose(file.release()) != 0) {
    const int code = errno;
    static_cast<void>(std::remove(unfinished.c_str()));
    errno = code;
    fail(path, "write");
  }
  if (std::rename(unfinished.c_str(), path.c_str()) != 0) {
    fail(path, "write");
  }
}

std::string read_whole(const std::filesystem::path& path) {
  const OpenFile file(std::fopen(path.c_str(), "rb"));
  if (!file) {
    fail(path, "read");
  }
  std::string text;
  char piece[65536];
  while (const std::size_t count = std::fread(piece, 1, sizeof(piece), file.get())) {
    text.append(piece, count);
  }
  if (std::ferror(file.get()) != 0) {
    fail(path, "read");
  }
  return text;
}

}  // namespace fexp::io
