// SPDX-License-Identifier: Apache-2.0
#include "io/atomic_file.hpp"

#include <fcntl.h>
#include <unistd.h>

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

using Pieces = std::span<const std::span<const std::byte>>;

enum class Reach { system, disk };

bool write_all(std::FILE* file, Pieces pieces, Reach reach) {
  for (const std::span<const std::byte> piece : pieces) {
    if (!piece.empty() && std::fwrite(piece.data(), 1, piece.size(), file) != piece.size()) {
      return false;
    }
  }
  return reach == Reach::system || (std::fflush(file) == 0 && fsync(fileno(file)) == 0);
}

void replace_file(const std::filesystem::path& path, Pieces pieces, Reach reach) {
  const std::filesystem::path unfinished = path.string() + ".new";
  OpenFile file(std::fopen(unfinished.c_str(), "wb"));
  if (!file) {
    fail(path, "write");
  }
  if (!write_all(file.get(), pieces, reach) || std::fclose(file.release()) != 0) {
    const int code = errno;
    static_cast<void>(std::remove(unfinished.c_str()));
    errno = code;
    fail(path, "write");
  }
  if (std::rename(unfinished.c_str(), path.c_str()) != 0) {
    fail(path, "write");
  }
}

}  // namespace

void write_atomically(const std::filesystem::path& path, std::string_view text) {
  const std::span<const std::byte> piece = std::as_bytes(std::span(text));
  replace_file(path, std::span(&piece, 1), Reach::system);
}

void write_durably(const std::filesystem::path& path, Pieces pieces) {
  replace_file(path, pieces, Reach::disk);
  sync_directory(path.parent_path());
}

void write_durably(const std::filesystem::path& path, std::span<const std::byte> bytes) {
  write_durably(path, Pieces(&bytes, 1));
}

void sync_directory(const std::filesystem::path& directory) {
  const std::filesystem::path name = directory.empty() ? "." : directory;
  const int opened = ::open(name.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC);
  if (opened < 0) {
    fail(name, "write to the disk");
  }
  const int code = fsync(opened) == 0 ? 0 : errno;
  static_cast<void>(::close(opened));
  // Some file systems have no such call for directories.
  if (code != 0 && code != EINVAL && code != ENOTSUP) {
    errno = code;
    fail(name, "write to the disk");
  }
}

std::string read_whole(const std::filesystem::path& path) {
  const OpenFile file(std::fopen(path.c_str(), "rb"));
  if (!file) {
    fail(path, "read");
  }
  std::string text;
  std::error_code none;
  if (const auto size = std::filesystem::file_size(path, none); !none) {
    text.reserve(size);  // Of a mesh file, so that it is not copied while it grows.
  }
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
