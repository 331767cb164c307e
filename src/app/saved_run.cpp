// SPDX-License-Identifier: Apache-2.0
#include "app/saved_run.hpp"

#include "io/output_error.hpp"

namespace fexp::app {

std::vector<io::Section> SavedRun::sections() const {
  ByteWriter about;
  about.text(FEXP_VERSION);
  about.value(step);
  about.value(time);
  about.value(hash_every);
  about.value(history);
  about.text(part);
  about.value(static_cast<std::uint64_t>(parts.size()));
  for (const std::string& one : parts) {
    about.text(one);
  }
  return {{"about", about.take()}, {"outputs", mark.pack()}, {"piece", piece}};
}

SavedRun SavedRun::from(std::span<const io::Section> sections, const std::filesystem::path& file) {
  ByteReader about(io::section_named(sections, "about", file).bytes);
  const std::string version = about.text();
  SavedRun saved;
  saved.step = about.value<std::int64_t>();
  saved.time = about.value<double>();
  saved.hash_every = about.value<std::int64_t>();
  saved.history = about.value<std::int64_t>();
  saved.part = about.text();
  const auto count = about.value<std::uint64_t>();
  for (std::uint64_t i = 0; i < count && about.sound(); ++i) {
    saved.parts.push_back(about.text());
  }
  if (version != FEXP_VERSION) {
    throw io::OutputError(file, "it was written by fexp " + version + ", and this is fexp " FEXP_VERSION,
                          "go on with the version that began the run");
  }
  if (!about.sound()) {
    throw io::OutputError(file, "it ends too early", "take an earlier one");
  }
  saved.mark = OutputMark::unpack(io::section_named(sections, "outputs", file).bytes, file);
  saved.piece = io::section_named(sections, "piece", file).bytes;
  return saved;
}

}  // namespace fexp::app
