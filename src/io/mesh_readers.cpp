// SPDX-License-Identifier: Apache-2.0
#include "io/mesh_readers.hpp"

#include <fmt/format.h>

#include <system_error>
#include <vector>

#include "io/output_error.hpp"
#include "io/similar_names.hpp"
#include "io/text_scanner.hpp"

namespace fexp::io {

namespace {

namespace fs = std::filesystem;

constexpr std::string_view accepted_formats = ".msh (Gmsh 2.2 or 4.1 ASCII), .stl, .obj";

/// What to try when the file is not there: names of the same directory that look alike.
std::string missing_file_cure(const fs::path& path, const InputFiles& files) {
  if (files.from_memory()) {
    return "run the deck again from the start: its packed files lack this one";
  }
  const fs::path directory = path.has_parent_path() ? path.parent_path() : fs::path(".");
  std::error_code code;
  if (!fs::is_directory(directory, code)) {
    return fmt::format("the directory \"{}\" is not there either: correct the path", directory.string());
  }
  std::vector<std::string> names;
  constexpr std::size_t most_looked_at = 10000;
  for (fs::directory_iterator entry(directory, code), end; !code && entry != end && names.size() < most_looked_at;
       entry.increment(code)) {
    names.push_back(entry->path().filename().string());
  }
  const std::vector<std::string> similar = similar_names(path.filename().string(), names);
  return similar.empty() ? "correct the path, which is relative to the deck"
                         : fmt::format("did you mean \"{}\"?", fmt::join(similar, "\" or \""));
}

/// The file's bytes, or an error and nothing.
bool read_bytes(const fs::path& path, InputFiles& files, std::string& bytes, ErrorList& errors) {
  const Place place{path.string(), 0, 0};
  const InputFiles::Kind kind = files.kind(path);
  if (kind == InputFiles::Kind::missing) {
    errors.add(place, fmt::format("mesh file \"{}\" is not there", path.string()), std::string(accepted_formats),
               missing_file_cure(path, files));
    return false;
  }
  if (kind != InputFiles::Kind::file) {
    errors.add(place, fmt::format("\"{}\" is no file", path.string()), std::string(accepted_formats),
               "name a mesh file");
    return false;
  }
  try {
    bytes = files.read(path);
  } catch (const OutputError& failure) {
    errors.add(place, fmt::format("mesh file \"{}\": {}", path.string(), failure.message()), "a file you may read",
               failure.cure());
    return false;
  }
  if (bytes.empty()) {
    errors.add(place, fmt::format("mesh file \"{}\" is empty", path.string()), std::string(accepted_formats),
               "export the mesh again");
    return false;
  }
  return true;
}

}  // namespace

model::Mesh read_mesh(const fs::path& path, const MeshReadOptions& options, InputFiles& files, ErrorList& errors) {
  std::string bytes;
  if (!read_bytes(path, files, bytes, errors)) {
    return {};
  }
  const std::string extension = path.extension().string();
  const std::string file = path.string();
  const std::string_view text = bytes;
  const std::string_view begin = text.substr(std::min(text.find_first_not_of(" \t\r\n"), text.size()));
  try {
    if (same_but_case(extension, ".obj")) {
      return read_obj(text, file);
    }
    if (same_but_case(extension, ".msh") || begin.substr(0, 11) == "$MeshFormat") {
      return read_gmsh(text, file);
    }
    if (same_but_case(extension, ".stl") || is_binary_stl(text) || same_but_case(begin.substr(0, 6), "solid ")) {
      return read_stl(text, file, options.weld_tolerance);
    }
    errors.add({file, 0, 0}, fmt::format("the format of mesh file \"{}\" is not known", file),
               std::string(accepted_formats), "convert the mesh, or give the file the extension of its format");
  } catch (const InputErrors& found) {
    for (const InputError& error : found.errors()) {
      errors.add(error);
    }
  }
  return {};
}

}  // namespace fexp::io
