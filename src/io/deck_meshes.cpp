// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <utility>

#include "io/deck.hpp"
#include "io/mesh_readers.hpp"

namespace fexp::io {

namespace {

namespace fs = std::filesystem;
using model::BodyDescription;

/// Memory that one triangle of a running model takes at least [bytes]; about 640 without contact, 1900 with it.
constexpr double least_bytes_per_triangle = 600.0;

double physical_memory() {
  const long pages = sysconf(_SC_PHYS_PAGES), page = sysconf(_SC_PAGESIZE);
  return pages > 0 && page > 0 ? static_cast<double>(pages) * static_cast<double>(page) : HUGE_VAL;
}

/// Triangles of all copies of a body; `mesh` is what a file gave.
double triangles_of(const BodyDescription& body, const model::Mesh& mesh) {
  const auto* generator = std::get_if<model::MeshGenerator>(&body.mesh);
  const double each =
      generator != nullptr ? model::triangle_count(*generator) : static_cast<double>(mesh.triangle.size());
  const model::Array array = body.array.value_or(model::Array{});
  return each * array.count[0] * array.count[1] * array.count[2];
}

/// Whether indices and memory are enough for all the bodies; the largest one gets the error.
bool check_size(const std::vector<BodyDescription>& bodies, const std::vector<model::Mesh>& meshes, ErrorList& errors) {
  // Corners are numbered 3 x element + corner.
  constexpr double most_indices = std::numeric_limits<Index>::max() / 3.0;
  const double most = std::min(most_indices, physical_memory() / least_bytes_per_triangle);
  double sum = 0.0, largest = 0.0;
  std::size_t culprit = 0;
  for (std::size_t b = 0; b < bodies.size(); ++b) {
    const double triangles = triangles_of(bodies[b], meshes[b]);
    sum += triangles;
    if (triangles > largest) {
      largest = triangles;
      culprit = b;
    }
  }
  if (sum <= most) {
    return true;
  }
  errors.add(bodies[culprit].place,
             fmt::format("the model would have {:.6g} triangles, {:.6g} of them in body \"{}\"", sum, largest,
                         bodies[culprit].name),
             fmt::format("at most {:.4g} triangles {}", most,
                         most == most_indices ? "in a model" : "in this machine's memory"),
             "use coarser meshes, or fewer copies in its array");
  return false;
}

/// Reads mesh files, each but once.
class FileMeshes {
 public:
  FileMeshes(fs::path directory, InputFiles& files, ErrorList& errors)
      : directory_(std::move(directory)), files_(files), errors_(errors) {}

  model::Mesh read(const BodyDescription& body, const model::MeshFile& file) {
    const fs::path path = (directory_ / file.path).lexically_normal();
    const auto [it, fresh] = meshes_.try_emplace({path.string(), file.weld_tolerance});
    if (fresh) {
      ErrorList found;
      it->second = read_mesh(path, {file.weld_tolerance}, files_, found);
      const bool is_file = files_.kind(path) == InputFiles::Kind::file;
      for (InputError error : found.errors()) {
        if (is_file) {
          error.message += fmt::format(" (mesh of body \"{}\", {})", body.name, body.mesh_place.text());
        } else {  // The deck is what is wrong.
          error.message += fmt::format(" (mesh of body \"{}\")", body.name);
          error.place = body.mesh_place;
        }
        errors_.add(std::move(error));
      }
    }
    return it->second;
  }

 private:
  fs::path directory_;
  InputFiles& files_;
  ErrorList& errors_;
  std::map<std::pair<std::string, double>, model::Mesh> meshes_;
};

}  // namespace

std::vector<model::Mesh> load_meshes(const Deck& deck, const fs::path& directory, InputFiles& files,
                                     ErrorList& errors) {
  const std::vector<BodyDescription>& bodies = deck.description.bodies;
  std::vector<model::Mesh> meshes(bodies.size());
  FileMeshes file_meshes(directory, files, errors);
  for (std::size_t b = 0; b < bodies.size(); ++b) {
    if (const auto* file = std::get_if<model::MeshFile>(&bodies[b].mesh)) {
      meshes[b] = file_meshes.read(bodies[b], *file);
    }
  }
  if (check_size(bodies, meshes, errors)) {
    for (std::size_t b = 0; b < bodies.size(); ++b) {
      if (const auto* generator = std::get_if<model::MeshGenerator>(&bodies[b].mesh)) {
        meshes[b] = model::generate_mesh(*generator);
      }
    }
  }
  return meshes;
}

}  // namespace fexp::io
