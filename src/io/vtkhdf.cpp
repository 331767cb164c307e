// SPDX-License-Identifier: Apache-2.0
#include "io/vtkhdf.hpp"

#include <algorithm>
#include <system_error>
#include <vector>

#include "io/output_error.hpp"
#include "io/vtkhdf_fields.hpp"
#include "io/vtkhdf_hdf5.hpp"

namespace fexp::io {

namespace {

using hdf5::Handle;

constexpr std::int64_t zero = 0;
constexpr std::int64_t one = 1;
constexpr hsize_t step_rows = 64;  // rows in a chunk of the datasets with one row per frame

/// One frame is one chunk, so that growing never touches the bytes of a complete frame; HDF5 allows no chunk of 4 GiB.
hsize_t chunk_rows(Index rows, hsize_t bytes_of_row) {
  constexpr hsize_t largest = hsize_t{1} << 30;
  return std::clamp<hsize_t>(static_cast<hsize_t>(rows), 1, largest / bytes_of_row);
}

std::vector<std::string> names_of(const model::Model& model) {
  std::vector<std::string> names;
  for (const model::Body& body : model.bodies) {
    names.push_back(body.name);
  }
  return names;
}

}  // namespace

struct ResultsWriter::Parts {
  hdf5::File file;
  std::int64_t frames{};
  Index nodes{};
  Index elements{};
  int deflate{};
  Variety variety{};
  bool usable{true};
  bool abandoned{};

  struct Growing {
    Handle dataset;
    const ResultField* field;
  };
  Handle points{};
  std::vector<Growing> growing{};
  // One row per frame.
  Handle values{};
  Handle steps{};
  Handle point_offsets{};
  Handle element_offsets{};
  std::vector<Handle> constant_offsets{};  // never written: their rows have the fill value

  void make_structure(const ResultsMesh& mesh, const ResultsOptions& options);
  void make_steps();
  void make_own_group(const ResultsMesh& mesh, const ResultsOptions& options);
  void write_topology(const ResultsMesh& mesh);
  void open_datasets();
  void release_datasets();
  [[nodiscard]] bool fits(const model::Frame& frame) const;
  void grow_to(std::int64_t count);
  void write_frame(const model::Frame& frame);
};

void ResultsWriter::Parts::write_topology(const ResultsMesh& mesh) {
  const std::int64_t node_count = nodes;
  const std::int64_t element_count = elements;
  const std::int64_t corner_count = 3 * element_count;
  file.write_fixed("/VTKHDF/NumberOfPoints", H5T_NATIVE_INT64, {1, 0}, &node_count);
  file.write_fixed("/VTKHDF/NumberOfCells", H5T_NATIVE_INT64, {1, 0}, &element_count);
  file.write_fixed("/VTKHDF/NumberOfConnectivityIds", H5T_NATIVE_INT64, {1, 0}, &corner_count);

  std::vector<std::int64_t> numbers;
  numbers.reserve(static_cast<std::size_t>(corner_count));
  for (const auto& corners : mesh.triangle) {
    numbers.insert(numbers.end(), corners.begin(), corners.end());
  }
  file.write_fixed("/VTKHDF/Connectivity", H5T_NATIVE_INT64, {numbers.size(), 0}, numbers.data());
  numbers.clear();
  for (std::int64_t e = 0; e <= element_count; ++e) {
    numbers.push_back(3 * e);
  }
  file.write_fixed("/VTKHDF/Offsets", H5T_NATIVE_INT64, {numbers.size(), 0}, numbers.data());
  constexpr std::uint8_t vtk_triangle = 5;
  const std::vector<std::uint8_t> types(mesh.triangle.size(), vtk_triangle);
  file.write_fixed("/VTKHDF/Types", H5T_NATIVE_UINT8, {types.size(), 0}, types.data());
}

// Parts, cells and connectivity are the same for all frames, so their offsets are constant; fields of one place share
// their offsets. Hard links say so without a byte more.
void ResultsWriter::Parts::make_steps() {
  const std::string group = "/VTKHDF/Steps/";
  file.make_group("/VTKHDF/Steps");
  file.make_group(group + "PointDataOffsets");
  file.make_group(group + "CellDataOffsets");
  file.set_attribute("/VTKHDF/Steps", "NSteps", std::vector<std::int64_t>{0});
  (void)file.make_growing(group + "Values", H5T_NATIVE_DOUBLE, 0, {step_rows});
  (void)file.make_growing(group + "PointOffsets", H5T_NATIVE_INT64, 0, {step_rows});
  (void)file.make_growing(group + "PartOffsets", H5T_NATIVE_INT64, 0, {step_rows, 0, &zero});
  (void)file.make_growing(group + "NumberOfParts", H5T_NATIVE_INT64, 0, {step_rows, 0, &one});
  (void)file.make_growing(group + "CellOffsets", H5T_NATIVE_INT64, 1, {step_rows, 0, &zero});
  file.make_link(group + "CellOffsets", group + "ConnectivityIdOffsets");
  (void)file.make_growing("/fexp/element_offsets", H5T_NATIVE_INT64, 0, {step_rows});
  for (const ResultField& field : result_fields()) {
    const bool node = field.place == FieldPlace::node;
    const std::string offsets = group + (node ? "PointDataOffsets/" : "CellDataOffsets/") + std::string(field.name);
    const std::string same = field.constant(variety) ? group + "PartOffsets"
                             : node                  ? group + "PointOffsets"
                                                     : std::string("/fexp/element_offsets");
    file.make_link(same, offsets);
  }
}

void ResultsWriter::Parts::make_own_group(const ResultsMesh& mesh, const ResultsOptions& options) {
  file.make_group("/fexp");
  file.set_attribute("/fexp", "format", std::vector<std::int64_t>{results_format});
  file.set_attribute("/fexp", "plastic", std::vector<std::int64_t>{variety.plastic ? 1 : 0});
  file.set_attribute("/fexp", "tied", std::vector<std::int64_t>{variety.tied ? 1 : 0});
  file.set_attribute("/fexp", "program", "fexp " FEXP_VERSION);
  file.set_attribute("/fexp", "title", options.title);
  (void)file.make_growing("/fexp/step", H5T_NATIVE_INT64, 0, {step_rows});
  file.write_strings("/fexp/body_names", mesh.body_name);
  file.write_fixed("/fexp/node_body", H5T_NATIVE_INT32, {mesh.node_body.size(), 0}, mesh.node_body.data());
  file.write_fixed("/fexp/node_label", H5T_NATIVE_INT64, {mesh.node_label.size(), 0}, mesh.node_label.data());
  file.write_fixed("/fexp/element_label", H5T_NATIVE_INT64, {mesh.element_label.size(), 0}, mesh.element_label.data());
}

void ResultsWriter::Parts::make_structure(const ResultsMesh& mesh, const ResultsOptions& options) {
  file.make_group("/VTKHDF");
  file.set_attribute("/VTKHDF", "Version", std::vector<std::int64_t>{2, 0});
  file.set_attribute("/VTKHDF", "Type", "UnstructuredGrid");
  file.make_group("/VTKHDF/PointData");
  file.make_group("/VTKHDF/CellData");
  write_topology(mesh);
  constexpr hsize_t point_bytes = sizeof(Vec3d);
  (void)file.make_growing("/VTKHDF/Points", H5T_NATIVE_DOUBLE, 3, {chunk_rows(nodes, point_bytes), deflate});
  file.set_attribute("/VTKHDF/Points", "unit", "length");
  for (const ResultField& field : result_fields()) {
    const bool node = field.place == FieldPlace::node;
    const hsize_t columns = field.components == 1 ? 0 : static_cast<hsize_t>(field.components);
    (void)file.make_growing(path_of(field), hdf5::type_of(field.type), columns,
                            {chunk_rows(node ? nodes : elements, row_bytes(field)), deflate});
    file.set_attribute(path_of(field), "unit", std::string(field.unit));
    file.set_attribute(path_of(field), "meaning", std::string(field.meaning));
  }
  make_own_group(mesh, options);
  make_steps();
}

void ResultsWriter::Parts::open_datasets() {
  points = file.open_dataset("/VTKHDF/Points");
  for (const ResultField& field : result_fields()) {
    growing.push_back({file.open_dataset(path_of(field)), &field});
  }
  values = file.open_dataset("/VTKHDF/Steps/Values");
  point_offsets = file.open_dataset("/VTKHDF/Steps/PointOffsets");
  element_offsets = file.open_dataset("/fexp/element_offsets");
  steps = file.open_dataset("/fexp/step");
  for (const char* name : {"PartOffsets", "NumberOfParts", "CellOffsets"}) {
    constant_offsets.push_back(file.open_dataset(std::string("/VTKHDF/Steps/") + name));
  }
}

void ResultsWriter::Parts::release_datasets() {
  growing.clear();
  constant_offsets.clear();
  for (Handle* handle : {&points, &values, &steps, &point_offsets, &element_offsets}) {
    handle->reset();
  }
}

bool ResultsWriter::Parts::fits(const model::Frame& frame) const {
  return frame.position.size() == at(nodes) && frame.displacement.size() == at(nodes) &&
         frame.membrane_force.size() == at(elements) && frame.island.size() == at(elements);
}

void ResultsWriter::Parts::grow_to(std::int64_t count) {
  const auto frame_count = static_cast<hsize_t>(count);
  const auto node_rows = static_cast<hsize_t>(nodes);
  const auto element_rows = static_cast<hsize_t>(elements);
  file.grow(points, frame_count * node_rows);
  for (const Growing& g : growing) {
    const hsize_t blocks = g.field->constant(variety) ? std::min<hsize_t>(frame_count, 1) : frame_count;
    file.grow(g.dataset, blocks * (g.field->place == FieldPlace::node ? node_rows : element_rows));
  }
  for (const Handle* rows : {&values, &steps, &point_offsets, &element_offsets}) {
    file.grow(*rows, frame_count);
  }
  for (const Handle& rows : constant_offsets) {
    file.grow(rows, frame_count);
  }
}

void ResultsWriter::Parts::write_frame(const model::Frame& frame) {
  const auto index = static_cast<hsize_t>(frames);
  const auto node_rows = static_cast<hsize_t>(nodes);
  const auto element_rows = static_cast<hsize_t>(elements);
  grow_to(frames + 1);
  file.write_rows(points, H5T_NATIVE_DOUBLE, index * node_rows, node_rows, frame.position.data());
  for (const Growing& g : growing) {
    if (g.field->constant(variety) && frames > 0) {
      continue;
    }
    const hsize_t rows = g.field->place == FieldPlace::node ? node_rows : element_rows;
    file.write_rows(g.dataset, hdf5::type_of(g.field->type), index * rows, rows, g.field->data(frame));
  }
  const std::int64_t point_offset = frames * nodes;
  const std::int64_t element_offset = frames * elements;
  file.write_rows(values, H5T_NATIVE_DOUBLE, index, 1, &frame.time);
  file.write_rows(steps, H5T_NATIVE_INT64, index, 1, &frame.step);
  file.write_rows(point_offsets, H5T_NATIVE_INT64, index, 1, &point_offset);
  file.write_rows(element_offsets, H5T_NATIVE_INT64, index, 1, &element_offset);
}

ResultsWriter::ResultsWriter(std::unique_ptr<Parts> parts) : parts_(std::move(parts)) {}
ResultsWriter::ResultsWriter(ResultsWriter&&) noexcept = default;
ResultsWriter& ResultsWriter::operator=(ResultsWriter&&) noexcept = default;
ResultsWriter::~ResultsWriter() = default;

ResultsMesh::ResultsMesh(const model::Model& model)
    : triangle(model.triangle),
      node_body(model.node_body),
      node_label(model.node_label),
      element_label(model.element_label),
      body_name(names_of(model)),
      variety(Variety::of(model)) {}

ResultsMesh::ResultsMesh(const model::Model& model, const model::Cutout& cutout)
    : triangle(cutout.triangle),
      node_body(cutout.node_body),
      node_label(cutout.node_label),
      element_label(cutout.element_label),
      body_name(names_of(model)),
      variety(Variety::of(model)) {}

ResultsWriter::ResultsWriter(const std::filesystem::path& path, const model::Model& model,
                             const ResultsOptions& options)
    : ResultsWriter(path, ResultsMesh(model), options) {}

// The file gets its name when its structure is complete, so under that name it can always be opened.
ResultsWriter::ResultsWriter(const std::filesystem::path& path, const ResultsMesh& mesh,
                             const ResultsOptions& options) {
  const std::filesystem::path unfinished = path.string() + ".new";
  const auto capacity = static_cast<std::size_t>(std::clamp<std::int64_t>(2 * options.expected_frames, 128, 65534));
  parts_ = std::make_unique<Parts>(Parts{.file = hdf5::File::create(unfinished, capacity),
                                         .nodes = static_cast<Index>(mesh.node_body.size()),
                                         .elements = static_cast<Index>(mesh.triangle.size()),
                                         .deflate = options.deflate,
                                         .variety = mesh.variety});
  parts_->make_structure(mesh, options);
  parts_->open_datasets();
  parts_->file.flush();
  std::error_code error;
  std::filesystem::rename(unfinished, path, error);
  if (error) {
    throw OutputError(path, "cannot create the results file: " + error.message(), "write elsewhere with --out");
  }
  parts_->file.renamed_to(path);
}

ResultsWriter ResultsWriter::resume(const std::filesystem::path& path, const model::Model& model, std::int64_t frames,
                                    const ResultsOptions& options) {
  if (frames == 0) {
    // Killed within its first frame, a file may hold half an index: there is nothing to keep.
    return {path, model, options};
  }
  std::error_code error;
  if (!std::filesystem::exists(path, error)) {
    throw OutputError(path, "cannot go on: the file is missing",
                      "put the file back as the run left it, or run the deck again from the start");
  }
  auto parts = std::make_unique<Parts>(Parts{.file = hdf5::File::open_to_append(path),
                                             .frames = frames,
                                             .nodes = model.node_count(),
                                             .elements = model.element_count(),
                                             .variety = Variety::of(model)});
  const std::int64_t present = parts->file.integer_attribute("/VTKHDF/Steps", "NSteps");
  std::int64_t node_count = 0;
  std::int64_t element_count = 0;
  parts->file.read_rows(parts->file.open_dataset("/VTKHDF/NumberOfPoints"), H5T_NATIVE_INT64, 0, 1, &node_count);
  parts->file.read_rows(parts->file.open_dataset("/VTKHDF/NumberOfCells"), H5T_NATIVE_INT64, 0, 1, &element_count);
  if (frames < 0 || frames > present || node_count != parts->nodes || element_count != parts->elements) {
    throw OutputError(path,
                      "cannot go on after frame " + std::to_string(frames) + ": the file holds " +
                          std::to_string(present) + " frames of " + std::to_string(node_count) + " nodes and " +
                          std::to_string(element_count) + " elements",
                      "resume the run that wrote this file");
  }
  // Dropped frames are written over where they stand. To free their space would shorten the file, and between that and
  // the note of its new length nobody could open it.
  parts->file.set_attribute("/VTKHDF/Steps", "NSteps", std::vector<std::int64_t>{frames});
  parts->file.flush();
  parts->open_datasets();
  return ResultsWriter(std::move(parts));
}

// Two flushes: the second one alone makes the frame count, when all of it is in the file.
void ResultsWriter::append(const model::Frame& frame) {
  if (!parts_->usable) {
    throw OutputError(parts_->file.path(), "no frame can follow one that could not be written",
                      "start the run again after curing the first error");
  }
  if (!parts_->fits(frame)) {
    throw OutputError(parts_->file.path(), "the frame is not of the model that the file was made for",
                      "capture it from that model");
  }
  parts_->usable = false;
  hdf5::print_nothing();
  try {
    parts_->write_frame(frame);
    parts_->file.reserve();
    parts_->file.flush();
    parts_->file.set_attribute("/VTKHDF/Steps", "NSteps", std::vector<std::int64_t>{parts_->frames + 1});
    parts_->file.flush();
  } catch (const OutputError&) {
    // What remains in memory speaks of data that are not in the file.
    parts_->file.abandon();
    parts_->abandoned = true;
    throw;
  }
  ++parts_->frames;
  parts_->usable = true;
}

void ResultsWriter::sync() {
  if (!parts_->abandoned) {
    parts_->file.sync();
  }
}

std::int64_t ResultsWriter::frames() const noexcept { return parts_->frames; }

void ResultsWriter::close() {
  parts_->usable = false;
  parts_->release_datasets();
  if (!parts_->abandoned) {
    parts_->file.close();
  }
}

}  // namespace fexp::io
