// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <string>
#include <string_view>

#include "base/errors.hpp"
#include "io/input_files.hpp"
#include "model/mesh.hpp"

/// Triangle meshes from files: Gmsh .msh 2.2 and 4.1 ASCII, STL ASCII and binary, Wavefront OBJ.
namespace fexp::io {

struct MeshReadOptions {
  /// STL corners closer than this become one node [length]; negative: 1e-6 of the bounding box diagonal.
  double weld_tolerance{-1.0};
};

/// Reads a mesh; the format follows from the extension (.msh, .stl, .obj in any case) or else from the content. Nodes
/// that no triangle uses are left out. When the file is unfit, adds the errors and returns a mesh without triangles.
/// The mesh's connectivity is not judged here; model::check_mesh does that.
[[nodiscard]] model::Mesh read_mesh(const std::filesystem::path& path, const MeshReadOptions& options,
                                    InputFiles& files, ErrorList& errors);

/// The single formats, from text in memory. `file` is the name used in errors; they throw InputErrors.
[[nodiscard]] model::Mesh read_gmsh(std::string_view text, const std::string& file);
[[nodiscard]] model::Mesh read_stl(std::string_view bytes, const std::string& file, double weld_tolerance);
[[nodiscard]] model::Mesh read_obj(std::string_view text, const std::string& file);

/// Whether the bytes have exactly the size that a binary STL file announces in its header.
[[nodiscard]] bool is_binary_stl(std::string_view bytes) noexcept;

}  // namespace fexp::io
