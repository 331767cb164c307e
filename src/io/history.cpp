// SPDX-License-Identifier: Apache-2.0
#include "io/history.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <fstream>
#include <iterator>
#include <system_error>
#include <utility>

#include "io/atomic_file.hpp"
#include "io/output_error.hpp"

namespace fexp::io {

namespace {

constexpr std::size_t waiting_limit = 65536;

[[noreturn]] void fail(const std::filesystem::path& path, int code) {
  throw OutputError(path, "cannot write the history: " + std::generic_category().message(code),
                    "free some space or choose a directory that you may write to, with --out");
}

/// A text cell in quotes where it needs them.
std::string csv_text(std::string_view text) {
  if (text.find_first_of(",\"\n\r") == std::string_view::npos) {
    return std::string(text);
  }
  std::string result = "\"";
  for (const char c : text) {
    result += c;
    if (c == '"') {
      result += c;
    }
  }
  return result + '"';
}

std::string header_line(const std::vector<Column>& columns) {
  std::string line;
  for (const Column& column : columns) {
    line += line.empty() ? "" : ",";
    line += csv_text(column.unit.empty() ? column.name : column.name + " [" + column.unit + "]");
  }
  return line + "\n";
}

struct CellText {
  std::string& line;
  void operator()(std::int64_t value) const { fmt::format_to(std::back_inserter(line), "{}", value); }
  void operator()(double value) const { fmt::format_to(std::back_inserter(line), "{}", value); }
  void operator()(std::string_view value) const { line += csv_text(value); }
};

/// Whether a file that a run goes on with is still what the run had written: a header, and rows up to `bytes`.
void check_beginning(const std::filesystem::path& path, const std::string& header, std::uint64_t bytes) {
  const auto refuse = [&path](const std::string& why) {
    throw OutputError(path, "cannot go on: " + why,
                      "put the file back as the run left it, or run the deck again from the start");
  };
  std::error_code error;
  const std::uintmax_t size = std::filesystem::file_size(path, error);
  if (error) {
    refuse("the file is missing");
  }
  std::ifstream file(path, std::ios::binary);
  std::string beginning(header.size(), '\0');
  if (!file.read(beginning.data(), static_cast<std::streamsize>(header.size())) || beginning != header) {
    refuse("the file has other columns");
  }
  if (size < bytes) {
    refuse(fmt::format("the file has {} bytes, and the run had written {} before the checkpoint", size, bytes));
  }
  char last = '\0';
  if (bytes < header.size() || !file.seekg(static_cast<std::streamoff>(bytes - 1)).get(last) || last != '\n') {
    refuse(fmt::format("no row ends at byte {}, where the checkpoint was made: the file has been changed", bytes));
  }
}

std::vector<std::string> split(std::string_view line) {
  std::vector<std::string> cells(1);
  bool inside = false;
  for (std::size_t i = 0; i < line.size(); ++i) {
    const char c = line[i];
    if (c == '"') {
      if (inside && i + 1 < line.size() && line[i + 1] == '"') {
        cells.back() += c;
        ++i;
      } else {
        inside = !inside;
      }
    } else if (c == ',' && !inside) {
      cells.emplace_back();
    } else if (c != '\r') {
      cells.back() += c;
    }
  }
  return cells;
}

}  // namespace

std::string UnitNames::of(std::string_view dimension) const {
  std::string text;
  for (std::size_t begin = 0; begin < dimension.size();) {
    const std::size_t end = std::min(dimension.find_first_of("*/^ ,-0123456789", begin), dimension.size());
    const std::string word(dimension.substr(begin, end - begin));
    const std::string* name = word == "length"        ? &length
                              : word == "time"        ? &time
                              : word == "mass"        ? &mass
                              : word == "force"       ? &force
                              : word == "temperature" ? &temperature
                                                      : &word;
    text += name->empty() ? word : *name;
    if (end < dimension.size()) {
      text += dimension[end];
    }
    begin = end + 1;
  }
  return text;
}

CsvWriter::CsvWriter(std::filesystem::path path, std::vector<Column> columns)
    : CsvWriter(std::move(path), std::move(columns), O_TRUNC) {
  waiting_ = header_line(columns_);
  flush();
}

CsvWriter::CsvWriter(std::filesystem::path path, std::vector<Column> columns, int flags)
    : path_(std::move(path)), columns_(std::move(columns)) {
  file_ = ::open(path_.c_str(), O_WRONLY | O_CREAT | O_APPEND | O_CLOEXEC | flags, 0666);
  if (file_ < 0) {
    fail(path_, errno);
  }
}

CsvWriter CsvWriter::resume(std::filesystem::path path, std::vector<Column> columns, std::uint64_t bytes) {
  check_beginning(path, header_line(columns), bytes);
  CsvWriter writer(std::move(path), std::move(columns), 0);
  if (ftruncate(writer.file_, static_cast<off_t>(bytes)) != 0) {
    fail(writer.path_, errno);
  }
  writer.bytes_ = bytes;
  return writer;
}

CsvWriter::CsvWriter(CsvWriter&& other) noexcept
    : path_(std::move(other.path_)),
      columns_(std::move(other.columns_)),
      waiting_(std::move(other.waiting_)),
      bytes_(other.bytes_),
      file_(std::exchange(other.file_, -1)) {}

CsvWriter& CsvWriter::operator=(CsvWriter&& other) noexcept {
  std::swap(path_, other.path_);
  std::swap(columns_, other.columns_);
  std::swap(waiting_, other.waiting_);
  std::swap(bytes_, other.bytes_);
  std::swap(file_, other.file_);
  return *this;
}

CsvWriter::~CsvWriter() {
  try {
    close();
  } catch (const OutputError&) {
    // Whoever wants to hear of it calls close().
  }
}

void CsvWriter::row(std::span<const Cell> cells) {
  if (cells.size() != columns_.size()) {
    throw OutputError(path_, fmt::format("a row of {} cells for {} columns", cells.size(), columns_.size()),
                      "report this as an error of fexp");
  }
  for (std::size_t i = 0; i < cells.size(); ++i) {
    if (i > 0) {
      waiting_ += ',';
    }
    std::visit(CellText{waiting_}, cells[i]);
  }
  waiting_ += '\n';
  if (waiting_.size() >= waiting_limit) {
    flush();
  }
}

void CsvWriter::flush() {
  std::size_t done = 0;
  while (done < waiting_.size()) {
    const ssize_t count = ::write(file_, waiting_.data() + done, waiting_.size() - done);
    if (count >= 0) {
      done += static_cast<std::size_t>(count);
      bytes_ += static_cast<std::uint64_t>(count);
    } else if (errno != EINTR) {
      const int code = errno;
      waiting_.clear();
      fail(path_, code);
    }
  }
  waiting_.clear();
}

void CsvWriter::sync() {
  flush();
  // A place that is no file on a disk (a pipe, a device) cannot be synchronised, nor cut back later.
  if (fsync(file_) != 0 && errno != EINVAL && errno != EROFS) {
    fail(path_, errno);
  }
}

void CsvWriter::close() {
  if (file_ < 0) {
    return;
  }
  flush();
  if (::close(std::exchange(file_, -1)) != 0) {
    fail(path_, errno);
  }
}

void add_vector_columns(std::vector<Column>& columns, const std::string& name, const std::string& unit) {
  for (const char* component : {"_x", "_y", "_z"}) {
    columns.push_back({name + component, unit});
  }
}

void add_vector_cells(std::vector<Cell>& cells, const Vec3d& value) {
  cells.insert(cells.end(), {Cell(value.x), Cell(value.y), Cell(value.z)});
}

CsvTable read_csv(const std::filesystem::path& path) {
  const std::string text = read_whole(path);
  CsvTable table;
  for (std::size_t begin = 0; begin < text.size();) {
    const std::size_t end = text.find('\n', begin);
    if (end == std::string::npos) {
      break;
    }
    std::vector<std::string> cells = split(std::string_view(text).substr(begin, end - begin));
    if (begin == 0) {
      table.header = std::move(cells);
    } else {
      table.rows.push_back(std::move(cells));
    }
    begin = end + 1;
  }
  return table;
}

}  // namespace fexp::io
