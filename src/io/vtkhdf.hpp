// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "io/vtkhdf_fields.hpp"
#include "model/capture.hpp"
#include "model/cutout.hpp"
#include "model/model.hpp"

namespace fexp::io {

/// The mesh that results are of: a model's, or a part of it. Both must outlive it.
struct ResultsMesh {
  std::span<const std::array<Index, 3>> triangle;  // [elements]
  std::span<const Index> node_body;                // [nodes]
  std::span<const std::int64_t> node_label;        // [nodes]
  std::span<const std::int64_t> element_label;     // [elements]
  std::vector<std::string> body_name;              // [bodies of the model]
  Variety variety{};

  explicit ResultsMesh(const model::Model& model);
  ResultsMesh(const model::Model& model, const model::Cutout& cutout);
};

struct ResultsOptions {
  std::string title;
  /// Frames the run is expected to write. The file's index has room for twice as many before it must be reorganised,
  /// which is the one moment at which a kill could harm it.
  std::int64_t expected_frames{64};
  int deflate{0};  ///< 0 (none) to 9
};

/// Writes results frame by frame into one VTKHDF file (transient unstructured grid). A frame counts only when it is
/// complete, so a killed run leaves a file with all complete frames. Positions are written per frame, the triangles
/// once. HDF5 is not re-entrant: one thread at a time may use writers and readers. Failures throw OutputError; then the
/// frames before stay readable and the writer accepts no more.
class ResultsWriter {
 public:
  /// Creates the file, replacing one of that name.
  ResultsWriter(const std::filesystem::path& path, const model::Model& model, const ResultsOptions& options = {});
  ResultsWriter(const std::filesystem::path& path, const ResultsMesh& mesh, const ResultsOptions& options = {});
  ResultsWriter(ResultsWriter&&) noexcept;
  ResultsWriter& operator=(ResultsWriter&&) noexcept;
  ~ResultsWriter();

  /// Opens a file to go on after its first `frames` frames; later ones are dropped. The file keeps the options it was
  /// made with, unless no frame is kept.
  [[nodiscard]] static ResultsWriter resume(const std::filesystem::path& path, const model::Model& model,
                                            std::int64_t frames, const ResultsOptions& options = {});

  void append(const model::Frame& frame);

  /// Puts all frames so far on the disk.
  void sync();

  /// Complete frames in the file.
  [[nodiscard]] std::int64_t frames() const noexcept;

  /// Closes the file and reports what its destructor could not.
  void close();

 private:
  struct Parts;
  explicit ResultsWriter(std::unique_ptr<Parts> parts);

  std::unique_ptr<Parts> parts_;
};

}  // namespace fexp::io
