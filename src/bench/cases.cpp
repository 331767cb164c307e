// SPDX-License-Identifier: Apache-2.0
#include "bench/cases.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <stdexcept>
#include <utility>

#include "base/stopwatch.hpp"
#include "bench/heap.hpp"
#include "bench/scenes.hpp"
#include "bench/search_scene.hpp"
#include "cluster/simulation.hpp"
#include "contact/box_tree.hpp"
#include "contact/whole_search.hpp"
#include "parallel/parallel.hpp"

namespace fexp::bench {

namespace {

/// What was done in some time.
struct Work {
  double element_steps{};
  double seconds{};
  Index steps{};
  Index searches{};
  double active_pairs{};  // Summed over epochs
  Index epochs{};
  Index islands{};
};

/// Steps a model by its case's course and takes the time.
class Stepper {
 public:
  Stepper(const StepCase& step_case, const model::Model& model) : case_(step_case), model_(model) { start(); }

  void warm_up() {
    Work not_counted;
    epoch(not_counted);
  }

  /// For so many seconds, but one epoch at least, and to the end of the duration where that is the course.
  Work work(double seconds) {
    Work done;
    while (done.epochs == 0 || done.seconds < seconds) {
      if (!fresh_ && case_.course != Course::on) {
        start();
      }
      do {
        epoch(done);
      } while (case_.course == Course::whole && simulation_->state().time < model_.run.duration);
    }
    return done;
  }

 private:
  /// The first four steps are not timed, unless they belong to a whole run.
  void start() {
    simulation_.emplace(model_, solve::KernelChoice::automatic);
    if (case_.course != Course::whole) {
      check(simulation_->run_epoch(four_steps(model_)));
    }
    fresh_ = true;
  }

  void epoch(Work& done) {
    const double target = case_.course == Course::whole ? model_.run.duration : HUGE_VAL;
    const Clock::time_point start = Clock::now();
    const cluster::EpochReport report = simulation_->run_epoch(target);
    done.seconds += seconds_since(start);
    check(report);
    fresh_ = false;
    done.element_steps += static_cast<double>(report.steps) * model_.element_count();
    done.steps += report.steps;
    done.searches += report.searches;
    done.active_pairs += report.active_pairs;
    done.epochs += 1;
    done.islands = report.islands;
  }

  void check(const cluster::EpochReport& report) const {
    if (report.fault.kind != cluster::FaultKind::none) {
      throw std::runtime_error("the case " + case_.name + " stopped: " + report.fault.message);
    }
  }

  const StepCase& case_;
  const model::Model& model_;
  std::optional<cluster::Simulation> simulation_;
  bool fresh_{};
};

model::Model built(const std::function<model::Model()>& build) {
  std::optional<model::Model> model;
  parallel::with_threads(0, [&] { model.emplace(build()); });
  return std::move(*model);
}

StepCase scene_case(const char* name, Scene scene, Index elements, bool on_all_threads) {
  StepCase made{name, Course::on, on_all_threads, [=] { return build(scene, elements); }, {}};
  if (scene == Scene::meeting_spheres) {
    made.course = Course::anew;
  }
  if (scene == Scene::flowing_plate) {
    made.course = Course::whole;
  }
  if (scene == Scene::quiet_plate) {
    made.build_without_contact = [=] { return build(Scene::plate, elements); };
  }
  return made;
}

StepCase four_spheres_case(int cells, bool on_all_threads, double part = 1.0) {
  return {"four_spheres", Course::whole, on_all_threads, [=] { return four_spheres(cells, part); }, {}};
}

/// How often a second something can be done; every repetition takes about `seconds`.
template <class Repeated>
Rate rate_of_calls(double seconds, const Repeated& repeated) {
  repeated();
  std::vector<double> rates;
  for (int repetition = 0; repetition < repetitions; ++repetition) {
    const Clock::time_point start = Clock::now();
    double calls = 0.0, past = 0.0;
    while (calls == 0.0 || past < seconds) {
      repeated();
      calls += 1.0;
      past = seconds_since(start);
    }
    rates.push_back(calls / past);
  }
  return rate_of(rates);
}

}  // namespace

std::vector<StepCase> step_cases(bool quick) {
  std::vector<StepCase> cases;
  const auto add = [&](const char* name, Scene scene, Index elements, bool on_all_threads) {
    cases.push_back(scene_case(name, scene, elements, on_all_threads));
  };
  add("plate", Scene::plate, quick ? 800 : 3200, false);
  add("plate", Scene::plate, quick ? 3200 : 200'000, true);
  if (!quick) {
    add("plate", Scene::plate, 1'000'000, false);
  }
  add("johnson_cook", Scene::flowing_plate, quick ? 800 : 3200, false);
  cases.push_back(four_spheres_case(sphere_cells, false));
  cases.push_back(four_spheres_case(2 * (quick ? 1 : 2) * sphere_cells, true));
  if (!quick) {
    cases.push_back(four_spheres_case(16 * sphere_cells, true, 0.25));
  }
  add("quiet_contact", Scene::quiet_plate, quick ? 3200 : 200'000, true);
  add("separate_spheres", Scene::separate_spheres, quick ? 5000 : 100'000, true);
  add("meeting_spheres", Scene::meeting_spheres, quick ? 5000 : 100'000, true);
  return cases;
}

std::vector<SearchCase> search_cases(bool quick) { return {{"search", quick ? 10'000 : 100'000}}; }

StepMeasurement::StepMeasurement(const StepCase& step_case)
    : case_(step_case),
      heap_before_(heap_bytes()),
      model_(built(step_case.build)),
      model_bytes_(heap_bytes() - heap_before_) {
  if (step_case.build_without_contact) {
    without_contact_.push_back(built(step_case.build_without_contact));
  }
}

StepRow StepMeasurement::measure(int threads, double seconds) const {
  StepRow row{case_.name, model_.element_count(),   model_.node_count(), threads, {}, 0, 0, 0.0, 0.0, {},
              0.0,        element_step_cost(model_)};
  parallel::with_threads(threads, [&] {
    const double before = heap_bytes();
    Stepper stepper(case_, model_);
    stepper.warm_up();
    row.heap_bytes = model_bytes_ + heap_bytes() - before;
    std::optional<Stepper> without_contact;
    if (!without_contact_.empty()) {
      without_contact.emplace(case_, without_contact_.front());
      without_contact->warm_up();
    }
    std::vector<double> rates, shares;
    Work all;
    row.steps = std::numeric_limits<Index>::max();
    for (int repetition = 0; repetition < repetitions; ++repetition) {
      const Work done = stepper.work(seconds);
      rates.push_back(done.element_steps / done.seconds);
      if (without_contact) {
        const Work less = without_contact->work(seconds);
        shares.push_back(1.0 - (less.seconds / less.element_steps) / (done.seconds / done.element_steps));
      }
      row.steps = std::min(row.steps, done.steps);
      row.islands = done.islands;
      all.steps += done.steps;
      all.searches += done.searches;
      all.active_pairs += done.active_pairs;
      all.epochs += done.epochs;
    }
    row.element_steps = rate_of(rates);
    row.active_pairs = all.active_pairs / all.epochs;
    row.searches = static_cast<double>(all.searches) / all.steps;
    if (without_contact) {
      row.contact_share = rate_of(shares).median;
    }
  });
  return row;
}

SearchRow measure_search(const SearchCase& search_case, int threads, double seconds) {
  SearchRow row;
  parallel::with_threads(threads, [&] {
    const SearchScene scene(search_case.elements);
    const model::Model& sphere = scene.sphere;
    row = {search_case.name, sphere.element_count(), sphere.node_count(), threads, {}, {}};
    contact::BoxTree tree;
    const Rate builds = rate_of_calls(seconds, [&] { tree.build(scene.block_boxes); });
    contact::WholeSearch search;
    contact::CandidateRows found;
    const std::vector<Index> bodies{0};
    const auto motion = model::initial_state(sphere).motion;
    search.assign(sphere, bodies);
    const Rate searches = rate_of_calls(seconds, [&] {
      const contact::Positions x{motion.data(), 0.0};
      search.find_partners(sphere, x, scene.skin);
      search.find_nodes(sphere, x, scene.skin, {}, found);
    });
    row.trees = scaled(row.elements, builds);
    row.searches = scaled(row.elements, searches);
  });
  return row;
}

}  // namespace fexp::bench
