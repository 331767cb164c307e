// SPDX-License-Identifier: Apache-2.0
#include <benchmark/benchmark.h>
#include <fmt/format.h>
#include <unistd.h>

#include <chrono>
#include <cmath>
#include <cstdint>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <string>

#include "app/load.hpp"
#include "bench/scenes.hpp"
#include "cluster/simulation.hpp"

/// From a deck with a mesh file to the end of the first step.
namespace {

using fexp::at;
using fexp::Index;
using fexp::model::Mesh;

enum class Format { gmsh, obj, stl };

double seconds_since(std::chrono::steady_clock::time_point start) {
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
}

std::string gmsh_text(const Mesh& mesh) {
  std::string text = fmt::format("$MeshFormat\n2.2 0 8\n$EndMeshFormat\n$Nodes\n{}\n", mesh.position.size());
  for (std::size_t n = 0; n < mesh.position.size(); ++n) {
    const fexp::Vec3d& x = mesh.position[n];
    fmt::format_to(std::back_inserter(text), "{} {} {} {}\n", n + 1, x.x, x.y, x.z);
  }
  fmt::format_to(std::back_inserter(text), "$EndNodes\n$Elements\n{}\n", mesh.triangle.size());
  for (std::size_t e = 0; e < mesh.triangle.size(); ++e) {
    const auto& t = mesh.triangle[e];
    fmt::format_to(std::back_inserter(text), "{} 2 2 0 1 {} {} {}\n", e + 1, t[0] + 1, t[1] + 1, t[2] + 1);
  }
  return text + "$EndElements\n";
}

std::string obj_text(const Mesh& mesh) {
  std::string text;
  for (const fexp::Vec3d& x : mesh.position) {
    fmt::format_to(std::back_inserter(text), "v {} {} {}\n", x.x, x.y, x.z);
  }
  for (const auto& t : mesh.triangle) {
    fmt::format_to(std::back_inserter(text), "f {} {} {}\n", t[0] + 1, t[1] + 1, t[2] + 1);
  }
  return text;
}

template <class Value>
void append(std::string& bytes, Value value) {
  const auto* first = reinterpret_cast<const char*>(&value);
  bytes.append(first, sizeof(value));
}

std::string stl_bytes(const Mesh& mesh) {
  std::string bytes(80, ' ');
  append(bytes, static_cast<std::uint32_t>(mesh.triangle.size()));
  for (const auto& t : mesh.triangle) {
    bytes.append(3 * sizeof(float), '\0');
    for (const Index n : t) {
      const fexp::Vec3d& x = mesh.position[at(n)];
      for (const double value : {x.x, x.y, x.z}) {
        append(bytes, static_cast<float>(value));
      }
    }
    append(bytes, std::uint16_t{0});
  }
  return bytes;
}

constexpr const char* deck_text = R"([run]
duration = 1.0
epoch_steps = 1
[[material]]
name = "steel"
density = 7850.0
young = 2.1e11
poisson = 0.3
[[section]]
name = "shell"
material = "steel"
thickness = 0.001
[[body]]
name = "sphere"
section = "shell"
mesh = {{ kind = "file", path = "{}" }}
velocity = [1.0, 0.0, 0.0]
)";

/// A folder with a deck and its mesh, removed at the end.
class DeckFolder {
 public:
  DeckFolder(Format format, const Mesh& mesh)
      : folder_(std::filesystem::temp_directory_path() / fmt::format("fexp_bench_{}", getpid())) {
    std::filesystem::create_directories(folder_);
    const char* const name = format == Format::gmsh ? "mesh.msh" : format == Format::obj ? "mesh.obj" : "mesh.stl";
    const std::string bytes = format == Format::gmsh  ? gmsh_text(mesh)
                              : format == Format::obj ? obj_text(mesh)
                                                      : stl_bytes(mesh);
    std::ofstream(folder_ / name, std::ios::binary) << bytes;
    std::ofstream(deck()) << fmt::format(deck_text, name);
    mesh_bytes = static_cast<double>(bytes.size());
  }
  DeckFolder(const DeckFolder&) = delete;
  DeckFolder& operator=(const DeckFolder&) = delete;
  ~DeckFolder() {
    std::error_code ignored;
    std::filesystem::remove_all(folder_, ignored);
  }

  [[nodiscard]] std::filesystem::path deck() const { return folder_ / "deck.toml"; }

  double mesh_bytes{};

 private:
  std::filesystem::path folder_;
};

/// `load`: deck, mesh and model; `first_step`: islands, first contact search, first forces and one step.
void startup(benchmark::State& state, Format format) {
  const int cells = static_cast<int>(std::lround(std::sqrt(static_cast<double>(state.range(0)) / 12.0)));
  const Mesh mesh = fexp::model::generate_mesh(fexp::model::CubedSphere{fexp::bench::sphere_radius, cells});
  const DeckFolder files(format, mesh);
  double load = 0.0, first_step = 0.0;
  for (auto iteration : state) {
    const auto start = std::chrono::steady_clock::now();
    const fexp::app::Case loaded = fexp::app::load_case(files.deck());
    load += seconds_since(start);
    const auto start_of_run = std::chrono::steady_clock::now();
    fexp::cluster::Simulation simulation(loaded.model, fexp::solve::KernelChoice::automatic);
    simulation.run_epoch(HUGE_VAL);
    first_step += seconds_since(start_of_run);
  }
  state.counters["triangles"] = static_cast<double>(mesh.triangle.size());
  state.counters["mesh_megabytes"] = 1.0e-6 * files.mesh_bytes;
  state.counters["load_seconds"] = benchmark::Counter(load, benchmark::Counter::kAvgIterations);
  state.counters["first_step_seconds"] = benchmark::Counter(first_step, benchmark::Counter::kAvgIterations);
}

void sizes(benchmark::internal::Benchmark* b) {
  b->ArgName("elements")->RangeMultiplier(10)->Range(10'000, 1'000'000)->UseRealTime()->Iterations(1);
}

}  // namespace

BENCHMARK_CAPTURE(startup, gmsh, Format::gmsh)->Apply(sizes);
BENCHMARK_CAPTURE(startup, obj, Format::obj)->Apply(sizes);
BENCHMARK_CAPTURE(startup, stl, Format::stl)->Apply(sizes);
BENCHMARK_MAIN();
