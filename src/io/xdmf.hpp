// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "model/model.hpp"

namespace fexp::io {

/// Keeps an XDMF file beside the results: a list of frames that points into the same HDF5 datasets, for readers that do
/// not know VTKHDF with time steps (ParaView before 5.12). The file is replaced as a whole, so it can always be opened.
class XdmfWriter {
 public:
  /// `results` is the name of the VTKHDF file, in the same directory as `path`.
  XdmfWriter(std::filesystem::path path, std::string results, const model::Model& model);

  /// Lists one more frame, which must be in the results already. A long list is written out only when it has grown by
  /// a hundredth, so that the time spent on it stays small; close() writes the rest.
  void append(double time);
  /// Drops frames after the first `frames`.
  void truncate(std::int64_t frames);
  void close();

 private:
  void write();
  [[nodiscard]] std::string frame_text(std::int64_t frame, double time) const;
  [[nodiscard]] std::string rows_text(const std::string& dataset, std::int64_t first, std::int64_t rows, int components,
                                      const std::string& number) const;

  std::filesystem::path path_;
  std::string results_;
  std::int64_t nodes_{};
  std::int64_t elements_{};
  std::string frames_text_;
  std::vector<std::size_t> frame_ends_;  // into frames_text_
  std::size_t written_{};
};

}  // namespace fexp::io
