// SPDX-License-Identifier: Apache-2.0
#include "app/output_mark.hpp"

#include "io/output_error.hpp"

namespace fexp::app {

namespace {

constexpr std::uint32_t format = 1;

}  // namespace

std::uint64_t OutputMark::bytes_of(const std::filesystem::path& csv) const {
  const auto found = csv_bytes.find(csv.stem().string());
  if (found == csv_bytes.end()) {
    throw io::OutputError(csv, "cannot go on: the run did not write this file before the checkpoint",
                          "resume with the deck that the run began with, or run the deck again from the start");
  }
  return found->second;
}

Bytes OutputMark::pack() const {
  ByteWriter out;
  out.value(format);
  out.value(frames);
  out.value(frame_step);
  out.value(row_step);
  out.value(static_cast<std::uint64_t>(csv_bytes.size()));
  for (const auto& [name, bytes] : csv_bytes) {
    out.text(name);
    out.value(bytes);
  }
  out.value(searches);
  out.value(rollbacks);
  out.value(deepest);
  return out.take();
}

OutputMark OutputMark::unpack(std::span<const std::byte> bytes, const std::filesystem::path& origin) {
  ByteReader in(bytes);
  OutputMark mark;
  bool sound = in.value<std::uint32_t>() == format;
  mark.frames = in.value<std::int64_t>();
  mark.frame_step = in.value<std::int64_t>();
  mark.row_step = in.value<std::int64_t>();
  const auto files = in.value<std::uint64_t>();
  for (std::uint64_t i = 0; i < files && in.sound(); ++i) {
    const std::string name = in.text();
    mark.csv_bytes[name] = in.value<std::uint64_t>();
  }
  mark.searches = in.value<std::int64_t>();
  mark.rollbacks = in.value<std::int64_t>();
  mark.deepest = in.value<double>();
  sound = sound && in.sound() && in.at_end();
  if (!sound) {
    throw io::OutputError(origin, "does not tell how far the run's files had come",
                          "use the version of fexp that wrote it, or run the deck again from the start");
  }
  return mark;
}

}  // namespace fexp::app
