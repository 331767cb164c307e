// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <filesystem>
#include <span>
#include <string>
#include <vector>

#include "io/vtkhdf_fields.hpp"
#include "model/model.hpp"

namespace fexp::io {

/// Keeps an XDMF file beside the results: a list of frames that points into the same HDF5 datasets, for readers that do
/// not know VTKHDF with time steps (ParaView before 5.12). The file is replaced as a whole, so it can always be opened.
class XdmfWriter {
 public:
  /// `results` is the name of the VTKHDF file, in the same directory as `path`.
  /// `times` are those of the frames that are in the results already; a file of that name is replaced.
  XdmfWriter(std::filesystem::path path, std::string results, const model::Model& model,
             std::span<const double> times = {});

  /// Lists one more frame, which must be in the results already. A long list is written out only when it has grown by
  /// a hundredth, so that the time spent on it stays small; close() writes the rest.
  void append(double time);
  void close();

 private:
  void write();
  void list(double time);
  [[nodiscard]] std::string frame_text(std::int64_t frame, double time) const;
  [[nodiscard]] std::string rows_text(const std::string& dataset, std::int64_t first, std::int64_t rows, int components,
                                      const std::string& number) const;

  std::filesystem::path path_;
  std::string results_;
  std::int64_t nodes_{};
  std::int64_t elements_{};
  Variety variety_{};
  std::string frames_text_;
  std::int64_t frames_{};
  std::int64_t written_{};
};

}  // namespace fexp::io
