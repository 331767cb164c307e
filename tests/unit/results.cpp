// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <cmath>
#include <cstring>
#include <fstream>
#include <nlohmann/json.hpp>
#include <vector>

#include "io/atomic_file.hpp"
#include "io/output_error.hpp"
#include "io/run_directory.hpp"
#include "io/summary.hpp"
#include "io/vtkhdf.hpp"
#include "io/vtkhdf_info.hpp"
#include "io/vtkhdf_reader.hpp"
#include "io/xdmf.hpp"
#include "model/capture.hpp"
#include "model/element_stresses.hpp"
#include "parallel/parallel.hpp"
#include "support/descriptions.hpp"
#include "support/file_size_limit.hpp"
#include "support/hand_model.hpp"
#include "support/temporary_directory.hpp"

namespace fexp {
namespace {

using test::TemporaryDirectory;

model::Frame frame_of(const model::Model& model, std::int64_t number) {
  std::vector<Vec3d> force(model.reference_position.size());
  for (Index n = 0; n < model.node_count(); ++n) {
    force[at(n)] = {test::made_up(n, 9, number), test::made_up(n, 10, number), test::made_up(n, 11, number)};
  }
  const std::vector<Index> islands(model.bodies.size(), 7);
  return model::capture(model, test::strip_state(model, number), force, islands);
}

const io::ResultField& field(std::string_view name) {
  for (const io::ResultField& f : io::result_fields()) {
    if (f.name == name) {
      return f;
    }
  }
  throw std::runtime_error("no such field");
}

TEST(capture, surface_stress_of_pure_bending_is_six_m_over_t_squared) {
  model::Model model = test::strips(1, 1);
  model::State state = model::initial_state(model);
  const double t = model.sections[0].thickness;
  const auto set = [&](model::ElementRow row, double value) {
    state.history[at(row) * at(model::block_lanes)] = value;
  };
  set(model::row_mxx, 3.0);
  const model::Frame bent = model::capture(model, state, {}, {});
  EXPECT_FLOAT_EQ(bent.von_mises_top[0], static_cast<float>(6.0 * 3.0 / (t * t)));
  EXPECT_FLOAT_EQ(bent.von_mises_bottom[0], bent.von_mises_top[0]);

  set(model::row_nxx, 6.0 * 3.0 / t);
  const model::Frame stretched = model::capture(model, state, {}, {});
  EXPECT_FLOAT_EQ(stretched.von_mises_top[0], 2.0F * bent.von_mises_top[0]);
  EXPECT_FLOAT_EQ(stretched.von_mises_bottom[0], 0.0F);
  EXPECT_EQ(stretched.von_mises_top[1], 0.0F) << "the other element has no stress";
}

TEST(element_stresses, are_membrane_and_bending_on_both_sides) {
  const model::Model model = test::strips(1, 1);
  model::State state = model::initial_state(model);
  const double t = model.sections[0].thickness;
  const auto set = [&](model::ElementRow row, double value) {
    state.history[at(row) * at(model::block_lanes)] = value;
  };
  set(model::row_nxx, 2.0 * t);
  set(model::row_nyy, -3.0 * t);
  set(model::row_mxy, 0.5 * t * t);
  set(model::row_qyz, 7.0);
  const model::ElementStresses stresses = model::element_stresses(model, state, 0);
  for (std::size_t i = 0; i < 3; ++i) {
    EXPECT_DOUBLE_EQ(stresses.top[i], (std::array{2.0, -3.0, 3.0}[i]));
    EXPECT_DOUBLE_EQ(stresses.bottom[i], (std::array{2.0, -3.0, -3.0}[i]));
  }
  EXPECT_EQ(stresses.shear_force[1], 7.0);
  EXPECT_EQ(stresses.thickness, t);
  EXPECT_EQ(stresses.plastic_strain, 0.0);
  EXPECT_FALSE(stresses.deleted);
}

/// Of points that heat, wherever the hottest is; elements that do not heat have none.
TEST(element_stresses, have_the_highest_temperature_of_the_points) {
  model::Description d = test::description(test::steel, 0.01);
  physics::J2Linear law{{7850.0, 2.1e11, 0.3}, 250e6, 2e9};
  test::add_body(d, "plate", model::Plate{1.0, 1.0, 1, 1, "one"});
  d.materials[0].law = law;
  const model::Model cold = test::build(d);
  EXPECT_EQ(model::element_stresses(cold, model::initial_state(cold), 0).temperature, 0.0);
  law.heating = physics::AdiabaticHeating{477.0, 1793.0, -20.0, -30.0};
  d.materials[0].law = law;
  const model::Model hot = test::build(d);
  model::State state = model::initial_state(hot);
  EXPECT_EQ(model::element_stresses(hot, state, 1).temperature, -30.0);
  for (const int point : {0, 2, 4}) {
    const Index row = hot.blocks[0].layer_row + hot.sections[0].layered.temperature_row(point);
    state.layers[at(row) * at(model::block_lanes)] = -25.0 + point;
    EXPECT_EQ(model::element_stresses(hot, state, 0).temperature, -25.0 + point);
  }
  EXPECT_EQ(model::capture(hot, state, {}, {}).temperature, (std::vector<float>{-21.0F, -30.0F}));
}

TEST(capture, von_mises_of_pure_shear_is_root_three_times_the_shear) {
  EXPECT_DOUBLE_EQ(model::von_mises(0.0, 0.0, 2.0), 2.0 * std::sqrt(3.0));
  EXPECT_DOUBLE_EQ(model::von_mises(5.0, 5.0, 0.0), 5.0);
  EXPECT_DOUBLE_EQ(model::von_mises(-4.0, 0.0, 0.0), 4.0);
}

TEST(capture, a_frame_filled_before_holds_the_new_state_alone) {
  const model::Model large = test::strips(3, 20);
  const model::Model small = test::strips(2, 3);
  model::Frame frame = frame_of(large, 1);
  model::capture_into(small, test::strip_state(small, 4), {}, {}, frame);
  EXPECT_EQ(frame.step, 40);
  ASSERT_EQ(frame.position.size(), small.reference_position.size());
  ASSERT_EQ(frame.body.size(), small.triangle.size());
  EXPECT_EQ(frame.contact_force[0], (std::array<float, 3>{}));
  EXPECT_EQ(frame.island[0], no_index);
  EXPECT_EQ(frame.body.front(), 0);
  EXPECT_EQ(frame.body.back(), 1);
}

TEST(capture, is_the_same_for_one_thread_and_many) {
  const model::Model model = test::strips(2, 20000);
  model::Frame one;
  model::Frame many;
  parallel::with_threads(1, [&] { one = frame_of(model, 5); });
  parallel::with_threads(8, [&] { many = frame_of(model, 5); });
  EXPECT_EQ(one.position, many.position);
  EXPECT_EQ(one.von_mises_top, many.von_mises_top);
  EXPECT_EQ(one.contact_force, many.contact_force);
}

TEST(results, read_back_what_was_captured_bit_by_bit) {
  const TemporaryDirectory directory;
  const model::Model model = test::strips(3, 10);
  io::ResultsWriter writer(directory / "r.vtkhdf", model, {.title = "strips"});
  for (std::int64_t f = 0; f < 5; ++f) {
    writer.append(frame_of(model, f));
  }
  writer.close();
  const io::ResultsReader reader(directory / "r.vtkhdf");
  ASSERT_EQ(reader.frames(), 5);
  EXPECT_EQ(reader.title(), "strips");
  EXPECT_EQ(reader.body_names(), (std::vector<std::string>{"strip[0]", "strip[1]", "strip[2]"}));
  EXPECT_EQ(reader.node_bodies(), model.node_body);
  EXPECT_EQ(reader.element_labels(), model.element_label);
  for (std::int64_t f = 0; f < 5; ++f) {
    const model::Frame frame = frame_of(model, f);
    EXPECT_EQ(reader.steps()[static_cast<std::size_t>(f)], frame.step);
    EXPECT_EQ(reader.times()[static_cast<std::size_t>(f)], frame.time);
    const std::vector<double> points = reader.points(f);
    EXPECT_EQ(std::memcmp(points.data(), frame.position.data(), points.size() * sizeof(double)), 0);
    for (const io::ResultField& each : io::result_fields()) {
      const std::vector<std::byte> bytes = reader.raw(each, f);
      EXPECT_EQ(std::memcmp(bytes.data(), each.data(frame), bytes.size()), 0) << each.name << " of frame " << f;
    }
  }
}

TEST(results, not_a_number_and_infinity_come_back) {
  const TemporaryDirectory directory;
  const model::Model model = test::strips(1, 2);
  model::Frame frame = frame_of(model, 0);
  frame.position[1].y = NAN;
  frame.velocity[2][0] = INFINITY;
  io::ResultsWriter(directory / "r.vtkhdf", model).append(frame);
  const io::ResultsReader reader(directory / "r.vtkhdf");
  EXPECT_TRUE(std::isnan(reader.points(0)[4]));
  EXPECT_TRUE(std::isinf(reader.numbers(field("velocity"), 0)[6]));
  EXPECT_EQ(io::read_info(directory / "r.vtkhdf").fields[0].not_finite, 1);
}

TEST(results, can_be_read_while_they_are_written) {
  const TemporaryDirectory directory;
  const model::Model model = test::strips(2, 4);
  io::ResultsWriter writer(directory / "r.vtkhdf", model);
  EXPECT_EQ(io::ResultsReader(directory / "r.vtkhdf").frames(), 0);
  for (std::int64_t f = 0; f < 3; ++f) {
    writer.append(frame_of(model, f));
    const io::ResultsReader reader(directory / "r.vtkhdf");
    ASSERT_EQ(reader.frames(), f + 1);
    EXPECT_EQ(reader.points(f)[0], frame_of(model, f).position[0].x);
  }
}

TEST(results, go_on_after_the_frame_they_are_cut_to) {
  const TemporaryDirectory directory;
  const model::Model model = test::strips(2, 4);
  {
    io::ResultsWriter writer(directory / "r.vtkhdf", model);
    for (std::int64_t f = 0; f < 6; ++f) {
      writer.append(frame_of(model, f));
    }
  }
  io::ResultsWriter writer = io::ResultsWriter::resume(directory / "r.vtkhdf", model, 2);
  EXPECT_EQ(writer.frames(), 2);
  writer.append(frame_of(model, 9));
  writer.close();
  const io::ResultsReader reader(directory / "r.vtkhdf");
  EXPECT_EQ(reader.steps(), (std::vector<std::int64_t>{0, 10, 90}));
  EXPECT_EQ(reader.points(2)[0], frame_of(model, 9).position[0].x);
  EXPECT_EQ(reader.points(1)[0], frame_of(model, 1).position[0].x);
  EXPECT_THROW((void)io::ResultsWriter::resume(directory / "r.vtkhdf", model, 4), io::OutputError);
  EXPECT_THROW((void)io::ResultsWriter::resume(directory / "r.vtkhdf", test::strips(2, 5), 1), io::OutputError);
}

TEST(results, a_full_disk_is_an_error_that_names_the_cure_and_keeps_the_frames_before) {
  const TemporaryDirectory directory;
  const model::Model model = test::strips(2, 2000);
  const std::filesystem::path path = directory / "r.vtkhdf";
  std::int64_t written = 0;
  {
    io::ResultsWriter writer(path, model);
    writer.append(frame_of(model, 0));
    const test::FileSizeLimit limit(static_cast<rlim_t>(std::filesystem::file_size(path) + 3000000));
    try {
      for (; written < 100; ++written) {
        writer.append(frame_of(model, written + 1));
      }
      FAIL() << "the limit was not reached";
    } catch (const io::OutputError& error) {
      EXPECT_EQ(error.path(), path);
      EXPECT_NE(std::string(error.what()).find("File too large"), std::string::npos) << error.what();
      EXPECT_NE(error.cure().find("free some space"), std::string::npos) << error.what();
    }
    EXPECT_THROW(writer.append(frame_of(model, 0)), io::OutputError) << "a gap between frames";
  }
  const io::ResultsReader reader(path);
  EXPECT_GT(written, 1);
  ASSERT_EQ(reader.frames(), written + 1);
  for (std::int64_t f = 0; f <= written; ++f) {
    EXPECT_EQ(reader.points(f)[3], frame_of(model, f).position[1].x);
    EXPECT_EQ(reader.raw(field("island"), f).size(), 4 * model.triangle.size());
  }
}

TEST(results, a_place_that_cannot_be_written_is_an_error_with_path) {
  const model::Model model = test::strips(1, 1);
  try {
    const io::ResultsWriter writer("/proc/nowhere/r.vtkhdf", model);
    FAIL() << "wrote into /proc";
  } catch (const io::OutputError& error) {
    EXPECT_NE(error.path().string().find("/proc/nowhere/r.vtkhdf"), std::string::npos);
    EXPECT_FALSE(error.cure().empty());
  }
}

TEST(results, a_file_that_is_no_results_file_is_refused_with_its_path) {
  const TemporaryDirectory directory;
  std::ofstream(directory / "text.vtkhdf") << "nothing of the kind";
  EXPECT_THROW(io::ResultsReader(directory / "text.vtkhdf"), io::OutputError);
  EXPECT_THROW(io::ResultsReader(directory / "missing.vtkhdf"), io::OutputError);
}

TEST(results, a_frame_of_another_model_is_refused) {
  const TemporaryDirectory directory;
  const model::Model model = test::strips(1, 1);
  io::ResultsWriter writer(directory / "r.vtkhdf", model);
  EXPECT_THROW(writer.append(frame_of(test::strips(1, 2), 0)), io::OutputError);
  writer.append(frame_of(model, 0));
  EXPECT_EQ(writer.frames(), 1);
}

TEST(xdmf, is_whole_after_every_frame_and_lists_each) {
  const TemporaryDirectory directory;
  io::XdmfWriter writer(directory / "r.xdmf2", "r.vtkhdf", test::strips(1, 1));
  for (int f = 0; f < 5; ++f) {
    writer.append(0.5 * f);
    const std::string text = io::read_whole(directory / "r.xdmf2");
    EXPECT_EQ(text.substr(text.size() - 8), "</Xdmf>\n");
    EXPECT_NE(text.find("<Grid Name=\"frame " + std::to_string(f) + "\">"), std::string::npos);
    EXPECT_EQ(text.find("<Grid Name=\"frame " + std::to_string(f + 1) + "\">"), std::string::npos);
  }
}

TEST(xdmf, made_from_the_times_of_frames_is_what_their_appending_makes) {
  const TemporaryDirectory directory;
  const model::Model model = test::strips(1, 1);
  io::XdmfWriter one(directory / "one.xdmf2", "r.vtkhdf", model);
  for (const double time : {0.0, 0.1, 0.25, 0.5}) {
    one.append(time);
  }
  one.close();
  const std::vector<double> before{0.0, 0.1};
  io::XdmfWriter other(directory / "other.xdmf2", "r.vtkhdf", model, before);
  EXPECT_NE(io::read_whole(directory / "other.xdmf2").find("frame 1"), std::string::npos);
  other.append(0.25);
  other.append(0.5);
  other.close();
  EXPECT_EQ(io::read_whole(directory / "one.xdmf2"), io::read_whole(directory / "other.xdmf2"));
}

TEST(run_directory, never_takes_a_name_that_is_taken) {
  const TemporaryDirectory directory;
  const std::filesystem::path before = std::filesystem::current_path();
  std::filesystem::current_path(directory.path());
  EXPECT_EQ(io::RunDirectory::create("some/four.toml", "a = 1\n", "", false).path(), "four.run");
  EXPECT_EQ(io::RunDirectory::create("some/four.toml", "a = 2\n", "", false).path(), "four-2.run");
  EXPECT_EQ(io::read_whole("four.run/deck.toml"), "a = 1\n");
  EXPECT_EQ(io::RunDirectory::create("some/four.toml", "a = 3\n", "", true).path(), "four.run");
  EXPECT_EQ(io::read_whole("four.run/deck.toml"), "a = 3\n");
  std::filesystem::current_path(before);
}

TEST(run_directory, a_named_directory_with_something_in_it_needs_force_and_keeps_foreign_files) {
  const TemporaryDirectory directory;
  const std::filesystem::path out = directory / "mine";
  const io::RunDirectory first = io::RunDirectory::create("d.toml", "x", out, false);
  first.write_versions(io::present_versions("scalar"));
  std::ofstream(out / "energies.csv") << "old\n";
  std::ofstream(out / "notes.md") << "mine\n";
  EXPECT_THROW((void)io::RunDirectory::create("d.toml", "y", out, false), io::OutputError);
  EXPECT_EQ(io::read_whole(out / "deck.toml"), "x");
  (void)io::RunDirectory::create("d.toml", "y", out, true);
  EXPECT_EQ(io::read_whole(out / "deck.toml"), "y");
  EXPECT_FALSE(std::filesystem::exists(out / "energies.csv")) << "an earlier run's history would pass for this one's";
  EXPECT_EQ(io::read_whole(out / "notes.md"), "mine\n");
}

TEST(run_directory, with_force_spares_tables_in_a_directory_that_is_no_run) {
  const TemporaryDirectory directory;
  std::ofstream(directory / "measured.csv") << "mine\n";
  (void)io::RunDirectory::create("d.toml", "y", directory.path(), true);
  EXPECT_TRUE(std::filesystem::exists(directory / "measured.csv"));
}

TEST(run_directory, versions_name_program_compiler_and_libraries) {
  std::string text;
  for (const auto& [what, version] : io::present_versions("avx2").lines) {
    EXPECT_FALSE(version.empty()) << what;
    text += what + " ";
  }
  EXPECT_EQ(text.find("fexp compiler kernel HDF5 oneTBB"), 0U) << text;
}

TEST(summary, keys_come_in_order_and_values_are_kept) {
  io::Summary summary;
  summary.completed = true;
  summary.exit_reason = "completed";
  summary.steps = 1200;
  summary.energy_error = 1.25e-3;
  summary.state_hash = "0123456789abcdef";
  summary.files = {{"results", "a.run/results.vtkhdf"}};
  const TemporaryDirectory directory;
  io::write_summary(directory / "summary.json", summary);
  const auto json = nlohmann::ordered_json::parse(io::read_whole(directory / "summary.json"));
  EXPECT_EQ(json.begin().key(), "completed");
  for (const char* key : {"completed", "steps", "time", "elements", "nodes", "bodies", "threads", "ranks",
                          "energy_error", "linear_momentum_error", "angular_momentum_error", "state_hash",
                          "wall_seconds", "element_steps_per_second", "files"}) {
    EXPECT_TRUE(json.contains(key)) << key;
  }
  EXPECT_EQ(json["steps"], 1200);
  EXPECT_EQ(json["energy_error"], 1.25e-3);
  EXPECT_EQ(json["state_hash"], "0123456789abcdef");
  EXPECT_EQ(json["files"]["results"], "a.run/results.vtkhdf");
  EXPECT_FALSE(json.contains("fault"));
}

TEST(summary, a_name_that_is_no_text_does_not_stop_it) {
  io::Summary summary;
  summary.title = "bad \xff byte";
  const TemporaryDirectory directory;
  io::write_summary(directory / "summary.json", summary);
  EXPECT_TRUE(nlohmann::json::accept(io::read_whole(directory / "summary.json")));
}

TEST(info, tells_complete_from_killed_runs_and_finds_the_ranges) {
  const TemporaryDirectory directory;
  const io::RunDirectory run = io::RunDirectory::create("d.toml", "x", directory / "d.run", false);
  const model::Model model = test::strips(2, 4);
  io::ResultsWriter writer(run.results(), model, {.title = "two strips"});
  writer.append(frame_of(model, 0));
  writer.append(frame_of(model, 3));
  EXPECT_EQ(io::read_info(run.path()).completeness.substr(0, 10), "unfinished");
  io::Summary summary;
  summary.completed = true;
  io::write_summary(run.summary(), summary);
  const io::ResultsInfo info = io::read_info(run.path());
  EXPECT_EQ(info.completeness, "complete");
  EXPECT_EQ(info.times.size(), 2U);
  EXPECT_EQ(info.bodies.size(), 2U);
  ASSERT_EQ(info.fields.size(), io::result_fields().size() + 1);
  float highest = 0.0F;
  for (const std::int64_t f : {0, 3}) {
    const model::Frame frame = frame_of(model, f);
    highest = std::max(highest, *std::max_element(frame.von_mises_top.begin(), frame.von_mises_top.end()));
  }
  for (const io::FieldRange& range : info.fields) {
    EXPECT_LE(range.low, range.high) << range.name;
    if (range.name == "von_mises_top") {
      EXPECT_EQ(range.high, static_cast<double>(highest));
    }
  }
  EXPECT_NE(info.text().find("two strips"), std::string::npos);
  EXPECT_EQ(io::to_json(info)["frames"], 2);
}

}  // namespace
}  // namespace fexp
