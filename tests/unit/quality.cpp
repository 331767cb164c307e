// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numeric>
#include <string>
#include <string_view>
#include <vector>

#include "parallel/parallel.hpp"
#include "quality/assess.hpp"
#include "support/descriptions.hpp"

namespace fexp::quality {
namespace {

using Labels = std::vector<std::int64_t>;

model::Mesh plate(int cells_x, int cells_y, const Vec3d& corner, double side = 1.0) {
  model::Plate p;
  p.length_x = side * cells_x;
  p.length_y = side * cells_y;
  p.cells_x = cells_x;
  p.cells_y = cells_y;
  model::Mesh mesh = model::generate_mesh(p);
  for (Vec3d& x : mesh.position) {
    x += corner;
  }
  return mesh;
}

/// Labels as a file would give them: nodes from 1000 on, elements from 5000 on.
model::Mesh labelled(model::Mesh mesh) {
  mesh.node_label.resize(mesh.position.size());
  std::iota(mesh.node_label.begin(), mesh.node_label.end(), 1000);
  mesh.triangle_label.resize(mesh.triangle.size());
  std::iota(mesh.triangle_label.begin(), mesh.triangle_label.end(), 5000);
  return mesh;
}

/// One mesh of both, with no node in common.
model::Mesh beside(model::Mesh a, const model::Mesh& b) {
  const auto offset = static_cast<Index>(a.position.size());
  a.position.insert(a.position.end(), b.position.begin(), b.position.end());
  for (const auto& t : b.triangle) {
    a.triangle.push_back({t[0] + offset, t[1] + offset, t[2] + offset});
  }
  a.part.insert(a.part.end(), b.part.begin(), b.part.end());
  return a;
}

/// Bodies "a", "b" and so on of these meshes, of thickness 0.1, that touch each other.
struct Scene {
  explicit Scene(std::vector<model::Mesh> given)
      : meshes(std::move(given)), d(test::description({1.0, 1.0, 0.3}, 0.1)) {
    d.contact.enabled = true;
    for (std::size_t b = 0; b < meshes.size(); ++b) {
      test::add_body(d, std::string(1, static_cast<char>('a' + b)), model::Plate{});
      meshes[b] = labelled(std::move(meshes[b]));
    }
  }

  [[nodiscard]] model::Model model() const {
    ErrorList errors;
    model::Model built = model::build_model(d, meshes, errors);
    for (const InputError& error : errors.errors()) {
      ADD_FAILURE() << error.text();
    }
    return built;
  }
  [[nodiscard]] std::vector<Finding> findings() const { return assess(model(), meshes); }
  /// The finding of a kind; none: one without a kind.
  [[nodiscard]] Finding find(std::string_view kind) const {
    const std::vector<Finding> all = findings();
    const auto of_kind = [&](const Finding& f) { return f.kind == kind; };
    EXPECT_LE(std::count_if(all.begin(), all.end(), of_kind), 1) << kind;
    const auto found = std::find_if(all.begin(), all.end(), of_kind);
    return found == all.end() ? Finding{} : *found;
  }
  [[nodiscard]] std::vector<std::string> warnings() const {
    std::vector<std::string> kinds;
    for (const Finding& f : findings()) {
      if (f.severity == Severity::warning) {
        kinds.emplace_back(f.kind);
        EXPECT_FALSE(f.message.empty());
        EXPECT_FALSE(f.cure.empty()) << f.kind;
      }
    }
    return kinds;
  }

  std::vector<model::Mesh> meshes;
  model::Description d;
};

using Kinds = std::vector<std::string>;

TEST(quality, a_plate_alone_has_free_edges_to_note_and_nothing_to_warn_of) {
  Scene scene({plate(4, 3, {})});
  scene.d.bodies[0].velocity = {1.0, 0.0, 0.0};
  const std::vector<Finding> all = scene.findings();
  ASSERT_EQ(all.size(), 1U);
  EXPECT_EQ(all[0].kind, "free_edges");
  EXPECT_EQ(all[0].severity, Severity::note);
  EXPECT_EQ(all[0].body, "a");
  EXPECT_EQ(all[0].count, 14);
}

TEST(quality, a_seam_that_was_not_welded_is_told_as_pieces_open_edges_and_duplicate_nodes) {
  Scene scene({beside(plate(2, 2, {}), plate(2, 2, {2.0, 0.0, 0.0}))});
  scene.d.bodies[0].velocity = {1.0, 0.0, 0.0};
  EXPECT_EQ(scene.warnings(), (Kinds{"pieces", "open_seam", "duplicate_nodes"}));
  const Finding pieces = scene.find("pieces");
  EXPECT_EQ(pieces.count, 2);
  EXPECT_EQ(pieces.ids.size(), 2U);
  EXPECT_NE(pieces.message.find("8, 8 elements"), std::string::npos) << pieces.message;
  EXPECT_EQ(scene.find("open_seam").count, 2);
  const Finding nodes = scene.find("duplicate_nodes");
  EXPECT_EQ(nodes.count, 3);
  EXPECT_EQ(nodes.ids.size(), nodes.other_ids.size());
  const model::Mesh& mesh = scene.meshes[0];
  for (std::size_t i = 0; i < nodes.ids.size(); ++i) {
    EXPECT_EQ(mesh.position[static_cast<std::size_t>(nodes.ids[i] - 1000)],
              mesh.position[static_cast<std::size_t>(nodes.other_ids[i] - 1000)]);
  }
}

TEST(quality, nodes_are_near_up_to_a_fiftieth_of_their_elements_and_edges_up_to_a_twentieth_of_their_length) {
  const double size = std::sqrt(0.5);  // of elements with an area of a half
  const auto warnings_at = [](double gap) {
    Scene scene({beside(plate(2, 2, {}), plate(2, 2, {2.0 + gap, 0.0, 0.0}))});
    scene.d.bodies[0].velocity = {1.0, 0.0, 0.0};
    return scene.warnings();
  };
  EXPECT_EQ(warnings_at(0.0199 * size), (Kinds{"pieces", "open_seam", "duplicate_nodes"}));
  EXPECT_EQ(warnings_at(0.0201 * size), (Kinds{"pieces", "open_seam"}));
  EXPECT_EQ(warnings_at(0.0499), (Kinds{"pieces", "open_seam"}));
  EXPECT_EQ(warnings_at(0.0501), (Kinds{"pieces"}));
}

TEST(quality, an_open_seam_is_seen_where_the_nodes_on_its_sides_do_not_match) {
  Scene scene({beside(plate(3, 3, {}), plate(2, 2, {3.0, 0.0, 0.0}, 1.5))});
  scene.d.bodies[0].velocity = {1.0, 0.0, 0.0};
  const Finding seam = scene.find("open_seam");
  EXPECT_EQ(seam.severity, Severity::warning);
  EXPECT_GE(seam.count, 3);
}

TEST(quality, edges_that_cross_are_no_seam) {
  model::Mesh upright = plate(2, 2, {});
  for (Vec3d& x : upright.position) {
    x = {1.0, x.x - 0.5, x.y};  // Its lower edge crosses the rim of the other plate.
  }
  Scene scene({plate(2, 2, {}), upright});
  scene.d.bodies[0].velocity = {1.0, 0.0, 0.0};
  EXPECT_EQ(scene.find("open_seam").count, 0);
}

TEST(quality, bodies_side_by_side_are_not_joined_by_nodes_in_one_place) {
  Scene scene({plate(2, 2, {}), plate(2, 2, {2.0, 0.0, 0.0})});
  EXPECT_EQ(scene.warnings(), (Kinds{"open_seam", "unjoined_bodies"}));
  const Finding finding = scene.find("unjoined_bodies");
  EXPECT_EQ(finding.body, "a");
  EXPECT_EQ(finding.other_body, "b");
  EXPECT_EQ(finding.count, 3);
  // Two that are held everywhere need not be joined.
  test::fix(scene.d, "all", {"x", "y", "z", "rx", "ry", "rz"});
  EXPECT_EQ(scene.find("unjoined_bodies").count, 0);
}

TEST(quality, copies_of_an_array_are_told_of_once_and_pairs_between_them_too) {
  Scene scene({beside(plate(2, 2, {}), plate(2, 2, {2.0, 0.0, 0.0}))});
  scene.d.bodies[0].array = model::Array{{3, 1, 1}, {4.0, 0.0, 0.0}};
  const model::Model model = scene.model();
  const std::vector<Finding> nodes = near_nodes(model);
  ASSERT_EQ(nodes.size(), 2U);
  EXPECT_EQ(nodes[0].kind, "unjoined_bodies");
  EXPECT_EQ(nodes[0].count, 6);
  EXPECT_EQ(nodes[1].kind, "duplicate_nodes");
  EXPECT_EQ(nodes[1].count, 3);
}

TEST(quality, shells_overlap_that_are_nearer_than_half_their_thicknesses) {
  const auto finding_at = [](double distance, bool contact) {
    Scene scene({plate(2, 2, {}), plate(2, 2, {0.1, 0.1, distance})});
    scene.d.contact.enabled = contact;
    return scene.find("overlapping_shells");
  };
  EXPECT_EQ(finding_at(0.1, true).count, 0) << "they touch";
  const Finding near = finding_at(0.09, true);
  EXPECT_GT(near.count, 0);
  EXPECT_EQ(near.severity, Severity::warning);
  EXPECT_NEAR(near.numbers[0].second, 0.09, 1e-12);
  EXPECT_NEAR(near.numbers[1].second, 0.1, 1e-12);
  EXPECT_EQ(finding_at(0.09, false).severity, Severity::note) << "contact is off";
  EXPECT_EQ(finding_at(0.0, false).severity, Severity::warning) << "the same shell twice";
}

TEST(quality, a_part_that_is_there_twice_overlaps_itself) {
  Scene scene({beside(plate(3, 3, {}), plate(3, 3, {}))});
  const Finding finding = scene.find("overlapping_shells");
  EXPECT_EQ(finding.count, 18);
  EXPECT_EQ(finding.other_body, "");
  EXPECT_NE(finding.cure.find("twice"), std::string::npos);
}

TEST(quality, shells_that_cross_or_lie_side_by_side_do_not_overlap) {
  model::Mesh upright = plate(2, 2, {});
  for (Vec3d& x : upright.position) {
    x = {0.7, x.x, x.y - 1.0};
  }
  EXPECT_EQ(Scene({plate(2, 2, {}), upright}).find("overlapping_shells").count, 0);
  EXPECT_EQ(Scene({plate(2, 2, {}), plate(2, 2, {2.01, 0.0, 0.01})}).find("overlapping_shells").count, 0);
}

TEST(quality, a_flat_shell_thicker_than_its_elements_does_not_overlap_itself) {
  Scene scene({plate(6, 6, {}, 0.02)});
  EXPECT_EQ(scene.find("overlapping_shells").count, 0);
}

TEST(quality, normals_that_were_turned_are_those_that_fewer_elements_have) {
  Scene scene({plate(3, 3, {})});
  EXPECT_EQ(scene.find("turned_normals").count, 0);
  std::swap(scene.meshes[0].triangle[7][1], scene.meshes[0].triangle[7][2]);
  const Finding one = scene.find("turned_normals");
  EXPECT_EQ(one.ids, Labels{5007});
  EXPECT_EQ(one.cure.find("odd one here"), std::string::npos);
  // The first element decides even when it is alone.
  Scene first({plate(3, 3, {})});
  std::swap(first.meshes[0].triangle[0][1], first.meshes[0].triangle[0][2]);
  const Finding finding = first.find("turned_normals");
  EXPECT_EQ(finding.ids, Labels{5000});
  EXPECT_NE(finding.cure.find("odd one here"), std::string::npos);
}

TEST(quality, each_piece_has_normals_of_its_own) {
  Scene scene({beside(plate(2, 2, {}), plate(2, 2, {5.0, 0.0, 0.0}))});
  for (std::size_t t = 8; t < 16; ++t) {
    std::swap(scene.meshes[0].triangle[t][1], scene.meshes[0].triangle[t][2]);
  }
  EXPECT_EQ(scene.find("turned_normals").count, 0);
}

TEST(quality, a_piece_is_idle_when_nothing_acts_on_it_and_nothing_can_hit_it) {
  const auto kind = [](const auto& change) {
    Scene scene({plate(2, 2, {})});
    change(scene.d);
    return scene.find("idle").count == 1;
  };
  EXPECT_TRUE(kind([](model::Description&) {}));
  EXPECT_FALSE(kind([](model::Description& d) { d.bodies[0].velocity = {0.0, 0.0, 1.0}; }));
  EXPECT_FALSE(kind([](model::Description& d) { d.bodies[0].angular_velocity = {0.0, 0.0, 1.0}; }));
  EXPECT_FALSE(kind([](model::Description& d) { d.gravity.push_back({{0.0, 0.0, -1.0}, "", {}}); }));
  EXPECT_TRUE(kind([](model::Description& d) { d.gravity.push_back({{0.0, 0.0, 0.0}, "", {}}); }));
  EXPECT_FALSE(kind([](model::Description& d) { d.pressure.push_back({{"a"}, "", 1.0, "", {}}); }));
  EXPECT_FALSE(kind([](model::Description& d) { d.forces.push_back({"all", {1.0, 0.0, 0.0}, {}, false, "", {}}); }));
  EXPECT_FALSE(kind([](model::Description& d) { d.symmetry.push_back({"all", {1.0, 0.0, 0.0}, {}}); }));
  EXPECT_FALSE(kind([](model::Description& d) { test::fix(d, "all", {"x"}); }));
  EXPECT_FALSE(kind([](model::Description& d) { d.prescribed.push_back({"all", "x", 1.0, "", {}}); }));
  EXPECT_TRUE(kind([](model::Description& d) { d.spheres.push_back({{"ball"}, {0.0, 0.0, 5.0}, 1.0}); }));
  EXPECT_FALSE(kind([](model::Description& d) {
    d.spheres.push_back({{"ball"}, {0.0, 0.0, 5.0}, 1.0});
    d.spheres[0].velocity = {0.0, 0.0, -1.0};
  }));
  EXPECT_FALSE(kind([](model::Description& d) {
    d.spheres.push_back({{"ball"}, {0.0, 0.0, 5.0}, 1.0});
    d.spheres[0].mass = 1.0;
  }));
}

TEST(quality, what_another_body_can_hit_is_waiting_and_what_it_cannot_is_idle) {
  Scene scene({plate(2, 2, {}), plate(2, 2, {0.0, 0.0, 3.0})});
  scene.d.bodies[1].velocity = {0.0, 0.0, -1.0};
  EXPECT_EQ(scene.find("waiting").body, "a");
  EXPECT_EQ(scene.find("waiting").severity, Severity::note);
  EXPECT_EQ(scene.warnings(), Kinds{});
  scene.d.contact.exclude.push_back({"b", "a"});
  EXPECT_EQ(scene.find("idle").body, "a");
  scene.d.contact.exclude.clear();
  scene.d.contact.enabled = false;
  EXPECT_EQ(scene.find("idle").body, "a");
}

TEST(quality, a_piece_that_nothing_holds_is_found_in_a_body_that_is_held) {
  Scene scene({beside(plate(2, 2, {}), plate(2, 2, {5.0, 0.0, 0.0}))});
  test::add_box_set(scene.d, "left", {-1.0, -1.0, -1.0}, {0.5, 5.0, 1.0});
  test::fix(scene.d, "left", {"x"});
  scene.d.contact.self = false;
  const Finding idle = scene.find("idle");
  EXPECT_EQ(idle.count, 1);
  ASSERT_EQ(idle.ids.size(), 1U);
  EXPECT_GE(idle.ids[0], 5008);
}

TEST(quality, slivers_are_few_elements_that_set_a_step_half_as_long_again_without_them) {
  // One node of a plate is moved towards a side of its element.
  const auto finding_at = [](double x) {
    Scene scene({plate(10, 10, {})});
    model::Mesh& mesh = scene.meshes[0];
    const auto node = std::find(mesh.position.begin(), mesh.position.end(), Vec3d{5.0, 5.0, 0.0});
    node->x = x;
    return scene.find("slivers");
  };
  EXPECT_EQ(finding_at(5.0).count, 0);
  EXPECT_EQ(finding_at(4.9).count, 0);
  const Finding finding = finding_at(4.05);
  EXPECT_GE(finding.count, 1);
  EXPECT_LE(finding.count, 6);
  ASSERT_EQ(finding.numbers.size(), 3U);
  EXPECT_GE(finding.numbers[1].second, 1.5 * finding.numbers[0].second);
  EXPECT_LT(finding.numbers[2].second, 0.06);
}

TEST(quality, fine_parts_of_a_mesh_are_no_slivers) {
  Scene scene({beside(plate(10, 10, {}), plate(10, 10, {20.0, 0.0, 0.0}, 0.2))});
  EXPECT_EQ(scene.find("slivers").count, 0);
}

TEST(quality, findings_are_the_same_for_any_number_of_threads) {
  Scene scene({beside(plate(40, 40, {}), plate(40, 40, {40.0, 0.0, 0.0})), plate(40, 40, {0.2, 0.2, 0.05})});
  const auto texts = [&](int threads) {
    std::vector<std::string> all;
    parallel::with_threads(threads, [&] {
      for (const Finding& f : scene.findings()) {
        all.push_back(f.message);
        for (const std::int64_t id : f.ids) {
          all.push_back(std::to_string(id));
        }
      }
    });
    return all;
  };
  EXPECT_EQ(texts(1), texts(3));
}

}  // namespace
}  // namespace fexp::quality
