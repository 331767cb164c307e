// SPDX-License-Identifier: Apache-2.0
#include "io/vtkhdf_reader.hpp"

#include <cstring>
#include <limits>

#include "io/output_error.hpp"
#include "io/vtkhdf_hdf5.hpp"

namespace fexp::io {

struct ResultsReader::File {
  hdf5::File file;

  template <class T>
  std::vector<T> rows(const std::string& name, hid_t type, std::int64_t begin, std::size_t count,
                      std::size_t columns = 1) const {
    std::vector<T> values(count * columns);
    file.read_rows(file.open_dataset(name), type, static_cast<hsize_t>(begin), count, values.data());
    return values;
  }
  [[nodiscard]] std::int64_t first_number(const std::string& name) const {
    return rows<std::int64_t>(name, H5T_NATIVE_INT64, 0, 1).front();
  }
};

ResultsReader::ResultsReader(const std::filesystem::path& path)
    : file_(std::make_unique<File>(File{hdf5::File::open_to_read(path)})) {
  const hdf5::File& file = file_->file;
  if (!file.exists("/VTKHDF/Steps") || !file.exists("/fexp/step")) {
    throw OutputError(path, "not a results file of fexp", "give a results.vtkhdf or a run directory");
  }
  if (file.integer_attribute("/fexp", "format") != results_format) {
    throw OutputError(path, "the results are of another version of fexp", "use that version, or write them again");
  }
  const std::int64_t node_count = file_->first_number("/VTKHDF/NumberOfPoints");
  const std::int64_t element_count = file_->first_number("/VTKHDF/NumberOfCells");
  const std::int64_t frame_count = file.integer_attribute("/VTKHDF/Steps", "NSteps");
  constexpr std::int64_t most = std::numeric_limits<Index>::max();
  if (node_count < 0 || node_count > most || element_count < 0 || element_count > most || frame_count < 0) {
    throw OutputError(path, "the results file's sizes make no sense", "write the results again");
  }
  nodes_ = static_cast<Index>(node_count);
  elements_ = static_cast<Index>(element_count);
  const auto count = static_cast<std::size_t>(frame_count);
  times_ = file_->rows<double>("/VTKHDF/Steps/Values", H5T_NATIVE_DOUBLE, 0, count);
  steps_ = file_->rows<std::int64_t>("/fexp/step", H5T_NATIVE_INT64, 0, count);
  body_names_ = file.read_strings("/fexp/body_names");
  variety_.plastic = file.integer_attribute("/fexp", "plastic") != 0;
  variety_.tied = file.integer_attribute("/fexp", "tied") != 0;
  title_ = file.text_attribute("/fexp", "title");
  program_ = file.text_attribute("/fexp", "program");
}

ResultsReader::ResultsReader(ResultsReader&&) noexcept = default;
ResultsReader::~ResultsReader() = default;

std::vector<Index> ResultsReader::node_bodies() const {
  return file_->rows<Index>("/fexp/node_body", H5T_NATIVE_INT32, 0, at(nodes_));
}

std::vector<std::int64_t> ResultsReader::node_labels() const {
  return file_->rows<std::int64_t>("/fexp/node_label", H5T_NATIVE_INT64, 0, at(nodes_));
}

std::vector<std::int64_t> ResultsReader::element_labels() const {
  return file_->rows<std::int64_t>("/fexp/element_label", H5T_NATIVE_INT64, 0, at(elements_));
}

std::vector<std::int64_t> ResultsReader::connectivity() const {
  return file_->rows<std::int64_t>("/VTKHDF/Connectivity", H5T_NATIVE_INT64, 0, 3 * at(elements_));
}

std::vector<double> ResultsReader::points(std::int64_t frame) const {
  return file_->rows<double>("/VTKHDF/Points", H5T_NATIVE_DOUBLE, frame * nodes_, at(nodes_), 3);
}

std::vector<std::byte> ResultsReader::raw(const ResultField& field, std::int64_t frame) const {
  const std::size_t rows = rows_of(field);
  const std::int64_t begin = field.constant(variety_) ? 0 : frame * static_cast<std::int64_t>(rows);
  return file_->rows<std::byte>(path_of(field), hdf5::type_of(field.type), begin, rows, row_bytes(field));
}

std::vector<double> ResultsReader::numbers(const ResultField& field, std::int64_t frame) const {
  const std::size_t rows = rows_of(field);
  const std::int64_t begin = field.constant(variety_) ? 0 : frame * static_cast<std::int64_t>(rows);
  return file_->rows<double>(path_of(field), H5T_NATIVE_DOUBLE, begin, rows,
                             static_cast<std::size_t>(field.components));
}

}  // namespace fexp::io
