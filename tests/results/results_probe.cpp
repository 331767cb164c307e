// SPDX-License-Identifier: Apache-2.0
//
// Writes results of made-up frames for the Python checks beside this file, and dies where it is told to: this program
// defines the calls through which HDF5 writes, so it can end at any of them, also in the middle of one.

#include <fcntl.h>
#include <sys/syscall.h>
#include <unistd.h>

#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <exception>
#include <filesystem>
#include <optional>
#include <string>

#include "io/vtkhdf.hpp"
#include "io/xdmf.hpp"
#include "support/hand_model.hpp"

namespace {

long writes = 0;         // calls that change a file so far
long last_write = -1;    // die at this one; -1: never
int share_written = 0;   // eighths of that call's bytes that still reach the file
long bytes_written = 0;  // or so many bytes, if any

/// Counts a call that would write `size` bytes. True when the process is to end after the given part of them.
bool ends_here() { return ++writes == last_write; }

[[noreturn]] void die() { _exit(9); }

}  // namespace

// The parameter names are this program's, not the system's.
// NOLINTBEGIN(readability-inconsistent-declaration-parameter-name)
extern "C" ssize_t pwrite64(int fd, const void* data, size_t size, off64_t offset) {
  if (ends_here()) {
    const size_t bytes = static_cast<size_t>(bytes_written);
    syscall(SYS_pwrite64, fd, data, bytes > 0 && bytes < size ? bytes : size * static_cast<size_t>(share_written) / 8,
            offset);
    die();
  }
  return syscall(SYS_pwrite64, fd, data, size, offset);
}

extern "C" ssize_t pwrite(int fd, const void* data, size_t size, off_t offset) {
  return pwrite64(fd, data, size, offset);
}

extern "C" int ftruncate64(int fd, off64_t size) noexcept {
  if (ends_here()) {
    die();
  }
  return static_cast<int>(syscall(SYS_ftruncate, fd, size));
}

extern "C" int ftruncate(int fd, off_t size) noexcept { return ftruncate64(fd, size); }
// NOLINTEND(readability-inconsistent-declaration-parameter-name)

namespace fexp {
namespace {

struct Arguments {
  std::string path;
  long frames{3};
  Index bodies{3};
  Index cells{10};
  long resume{-1};
  long expected{64};
  int deflate{0};
  std::string xdmf;
  bool tell{false};  // a line after each complete frame
};

Arguments parse(int count, char** values) {
  Arguments arguments;
  for (int i = 1; i < count; ++i) {
    const std::string argument = values[i];
    const std::size_t equals = argument.find('=');
    const std::string name = argument.substr(0, equals);
    const std::string value = equals == std::string::npos ? "" : argument.substr(equals + 1);
    if (name == "frames") {
      arguments.frames = std::stol(value);
    } else if (name == "bodies") {
      arguments.bodies = std::stoi(value);
    } else if (name == "cells") {
      arguments.cells = std::stoi(value);
    } else if (name == "resume") {
      arguments.resume = std::stol(value);
    } else if (name == "expected") {
      arguments.expected = std::stol(value);
    } else if (name == "deflate") {
      arguments.deflate = std::stoi(value);
    } else if (name == "die_at") {
      last_write = std::stol(value);
    } else if (name == "share") {
      share_written = std::stoi(value);
    } else if (name == "bytes") {
      bytes_written = std::stol(value);
    } else if (name == "xdmf") {
      arguments.xdmf = value;
    } else if (name == "tell") {
      arguments.tell = true;
    } else {
      arguments.path = argument;
    }
  }
  return arguments;
}

void write(const Arguments& arguments) {
  const model::Model model = test::strips(arguments.bodies, arguments.cells);
  std::vector<Index> islands;
  for (Index b = 0; b < arguments.bodies; ++b) {
    islands.push_back(b / 2);
  }
  io::ResultsOptions options;
  options.title = "made up";
  options.expected_frames = arguments.expected;
  options.deflate = arguments.deflate;
  io::ResultsWriter writer = arguments.resume >= 0
                                 ? io::ResultsWriter::resume(arguments.path, model, arguments.resume, options)
                                 : io::ResultsWriter(arguments.path, model, options);
  std::optional<io::XdmfWriter> xdmf;
  if (!arguments.xdmf.empty()) {
    xdmf.emplace(arguments.xdmf, std::filesystem::path(arguments.path).filename(), model);
  }
  std::printf("created %ld\n", writes);
  model::Frame frame;
  std::vector<Vec3d> force(model.reference_position.size());
  for (long f = writer.frames(); f < arguments.frames; ++f) {
    for (Index n = 0; n < model.node_count(); ++n) {
      force[at(n)] = {test::made_up(n, 9, f), test::made_up(n, 10, f), test::made_up(n, 11, f)};
    }
    model::capture_into(model, test::strip_state(model, f), force, islands, frame);
    writer.append(frame);
    if (xdmf) {
      xdmf->append(frame.time);
    }
    if (arguments.tell) {
      std::printf("frame %ld %ld\n", writer.frames(), writes);
      static_cast<void>(std::fflush(stdout));
    }
  }
  writer.close();
  if (xdmf) {
    xdmf->close();
  }
  std::printf("closed %ld\n", writes);
}

}  // namespace
}  // namespace fexp

int main(int count, char** values) {
  try {
    fexp::write(fexp::parse(count, values));
  } catch (const std::exception& error) {
    static_cast<void>(std::fprintf(stderr, "%s\n", error.what()));
    return 1;
  }
  return 0;
}
