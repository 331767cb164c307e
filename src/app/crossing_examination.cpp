// SPDX-License-Identifier: Apache-2.0
#include "app/crossing_examination.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <iterator>
#include <map>
#include <set>
#include <span>

#include "base/errors.hpp"
#include "io/output_error.hpp"
#include "io/similar_names.hpp"
#include "io/vtkhdf_reader.hpp"
#include "quality/crossing_watch.hpp"

namespace fexp::app {

namespace {

namespace fs = std::filesystem;

/// Edges and nodes told of in each pair of bodies and frame.
constexpr std::size_t most_told = 3;

[[noreturn]] void throw_nonsense(const fs::path& path, const std::string& what) {
  throw io::OutputError(path, what, "write the results again");
}

/// The bodies that a name means, as in a deck: one, or all copies of an array.
std::vector<Index> bodies_called(const std::string& name, const std::vector<std::string>& bodies) {
  std::vector<Index> found;
  for (std::size_t b = 0; b < bodies.size(); ++b) {
    if (bodies[b] == name || bodies[b].starts_with(name + "[")) {
      found.push_back(static_cast<Index>(b));
    }
  }
  if (found.empty()) {
    std::vector<std::string> known;
    std::ranges::transform(bodies, std::back_inserter(known),
                           [](const std::string& body) { return body.substr(0, body.find('[')); });
    known.erase(std::unique(known.begin(), known.end()), known.end());
    const std::vector<std::string> similar = io::similar_names(name, known);
    ErrorList errors;
    errors.add({"--exclude"}, fmt::format("no body \"{}\"", name), "names of bodies",
               similar.empty() ? "\"fexp info\" and the deck have their names"
                               : fmt::format("did you mean {}?", fmt::join(similar, " or ")));
    errors.throw_if_any();
  }
  return found;
}

/// Results that are looked at frame by frame.
class Examination {
 public:
  Examination(const fs::path& path, const std::vector<std::pair<std::string, std::string>>& exclude)
      : path_(path),
        reader_(path),
        node_label_(reader_.node_labels()),
        element_label_(reader_.element_labels()),
        surfaces_(read_surfaces()) {
    if (reader_.frames() == 0) {
      throw io::OutputError(path_, "there are no frames", "let the run go on, or run the deck again");
    }
    const std::vector<std::string>& names = reader_.body_names();
    for (const auto& [one, other] : exclude) {
      for (const Index a : bodies_called(one, names)) {
        for (const Index b : bodies_called(other, names)) {
          excluded_.insert(std::minmax(a, b));
        }
      }
    }
    const auto fields = io::result_fields();
    deleted_ = std::ranges::find(fields, "deleted", &io::ResultField::name);
  }

  CrossingsReport report() {
    CrossingsReport report{path_.string(), {}};
    quality::CrossingWatch watch(surfaces_);
    for (std::int64_t frame = 0; frame < reader_.frames(); ++frame) {
      const std::vector<Vec3d> position = read_positions(frame);
      const quality::FrameCrossings found = watch.look(position, read_alive(frame));
      const auto f = static_cast<std::size_t>(frame);
      report.frames.push_back({frame, reader_.steps()[f], reader_.times()[f], pairs_of(found, position)});
    }
    return report;
  }

 private:
  [[nodiscard]] quality::Surfaces read_surfaces() const {
    const std::vector<std::int64_t> connectivity = reader_.connectivity();
    std::vector<Index> node_body = reader_.node_bodies();
    const auto bodies = static_cast<Index>(reader_.body_names().size());
    if (std::ranges::any_of(node_body, [&](Index b) { return b < 0 || b >= bodies; }) ||
        std::ranges::any_of(connectivity, [&](std::int64_t n) { return n < 0 || n >= reader_.nodes(); })) {
      throw_nonsense(path_, "the results file's nodes and bodies make no sense");
    }
    std::vector<std::array<Index, 3>> triangles(at(reader_.elements()));
    for (std::size_t t = 0; t < triangles.size(); ++t) {
      for (std::size_t i = 0; i < 3; ++i) {
        triangles[t][i] = static_cast<Index>(connectivity[3 * t + i]);
      }
    }
    return {std::move(triangles), std::move(node_body), bodies};
  }

  [[nodiscard]] std::vector<Vec3d> read_positions(std::int64_t frame) const {
    const std::vector<double> points = reader_.points(frame);
    if (!std::ranges::all_of(points, [](double x) { return std::isfinite(x); })) {
      throw_nonsense(path_, fmt::format("positions in frame {} are not finite", frame));
    }
    std::vector<Vec3d> positions(at(reader_.nodes()));
    for (std::size_t n = 0; n < positions.size(); ++n) {
      positions[n] = {points[3 * n], points[3 * n + 1], points[3 * n + 2]};
    }
    return positions;
  }

  [[nodiscard]] std::vector<char> read_alive(std::int64_t frame) const {
    const std::vector<double> deleted = reader_.numbers(*deleted_, frame);
    std::vector<char> alive(deleted.size());
    std::ranges::transform(deleted, alive.begin(), [](double d) { return d == 0.0 ? '\1' : '\0'; });
    return alive;
  }

  [[nodiscard]] const std::string& name(Index body) const { return reader_.body_names()[at(body)]; }

  /// The pair's entry, or none where it is left out.
  PairCrossings* entry(Index a, Index b, std::map<std::pair<Index, Index>, PairCrossings>& pairs) const {
    const std::pair<Index, Index> key = std::minmax(a, b);
    if (excluded_.contains(key)) {
      return nullptr;
    }
    PairCrossings& pair = pairs[key];
    pair.body = name(key.first);
    pair.other_body = name(key.second);
    return &pair;
  }

  [[nodiscard]] ToldCut told(const quality::EdgeCut& cut, const std::vector<Vec3d>& position, bool at_start) const {
    const auto& nodes = surfaces_.edge[at(cut.edge)];
    const auto& corners = surfaces_.triangle[at(cut.triangle)];
    const Vec3d &p = position[at(nodes[0])], &q = position[at(nodes[1])], &a = position[at(corners[0])];
    const Vec3d normal = cross(position[at(corners[1])] - a, position[at(corners[2])] - a);
    const double depth_p = dot(normal, p - a), depth_q = dot(normal, q - a);
    // Both may be rounded to nothing where the signs, which are exact, differ.
    const double part = depth_p == depth_q ? 0.5 : depth_p / (depth_p - depth_q);
    return {node_label_[at(nodes[0])],
            node_label_[at(nodes[1])],
            name(surfaces_.node_body[at(nodes[0])]),
            element_label_[at(cut.triangle)],
            name(surfaces_.body_of_triangle(cut.triangle)),
            p + part * (q - p),
            at_start};
  }

  [[nodiscard]] std::vector<PairCrossings> pairs_of(const quality::FrameCrossings& found,
                                                    const std::vector<Vec3d>& position) const {
    std::map<std::pair<Index, Index>, PairCrossings> pairs;
    const auto add = [&](const quality::EdgeCut& cut, bool at_start) {
      const Index body = surfaces_.node_body[at(surfaces_.edge[at(cut.edge)][0])];
      PairCrossings* pair = entry(body, surfaces_.body_of_triangle(cut.triangle), pairs);
      if (pair != nullptr) {
        ++pair->edges;
        pair->edges_at_start += at_start ? 1 : 0;
        if (pair->first_edges.size() < most_told) {
          pair->first_edges.push_back(told(cut, position, at_start));
        }
      }
    };
    for (const quality::EdgeCut& cut : found.new_cuts) {
      add(cut, false);
    }
    for (const quality::EdgeCut& cut : found.cuts) {
      if (!std::binary_search(found.new_cuts.begin(), found.new_cuts.end(), cut)) {
        add(cut, true);
      }
    }
    for (const quality::NodePassage& passage : found.through) {
      const Index body = surfaces_.node_body[at(passage.node)];
      PairCrossings* pair = entry(body, passage.body, pairs);
      if (pair != nullptr) {
        ++pair->nodes;
        if (pair->first_nodes.size() < most_told) {
          pair->first_nodes.push_back(
              {node_label_[at(passage.node)], name(body), name(passage.body), position[at(passage.node)]});
        }
      }
    }
    std::vector<PairCrossings> list;
    for (auto& [key, pair] : pairs) {
      list.push_back(std::move(pair));
    }
    return list;
  }

  fs::path path_;
  io::ResultsReader reader_;
  std::vector<std::int64_t> node_label_, element_label_;
  quality::Surfaces surfaces_;
  std::set<std::pair<Index, Index>> excluded_;
  std::span<const io::ResultField>::iterator deleted_;
};

}  // namespace

CrossingsReport examine_crossings(const fs::path& results,
                                  const std::vector<std::pair<std::string, std::string>>& exclude) {
  return Examination(results, exclude).report();
}

}  // namespace fexp::app
