// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "bench/element_step.hpp"
#include "bench/rate.hpp"
#include "model/model.hpp"

/// What `fexp bench` measures.
namespace fexp::bench {

/// Where a case is when its time is taken.
enum class Course {
  on,    ///< Epoch after epoch, as far as it gets
  anew,  ///< The first epoch, again and again, so that bodies that meet do so throughout
  whole  ///< The whole duration, again and again
};

/// Whole steps of a model, epoch by epoch as a run takes them, without output.
struct StepCase {
  std::string name;
  Course course{};
  bool on_all_threads{};  ///< Besides on one
  std::function<model::Model()> build;
  /// The same without contact, measured in turn with it; or nothing.
  std::function<model::Model()> build_without_contact;
};

/// The contact search of a sphere that touches nothing.
struct SearchCase {
  std::string name;
  Index elements{};  ///< About
};

[[nodiscard]] std::vector<StepCase> step_cases(bool quick);
[[nodiscard]] std::vector<SearchCase> search_cases(bool quick);

/// One case on so many threads. All times are by the clock.
struct StepRow {
  std::string name;
  Index elements{};
  Index nodes{};
  int threads{};
  Rate element_steps;                   ///< [1/s]
  Index steps{};                        ///< Of the shortest repetition
  Index islands{};                      ///< At the end
  double active_pairs{};                ///< Contacts at the ends of epochs, mean
  double searches{};                    ///< Contact searches per step
  std::optional<double> contact_share;  ///< Of a step, where there is a twin without contact [-]
  double heap_bytes{};                  ///< Of model and run
  ElementStepCost cost;
};

struct SearchRow {
  std::string name;
  Index elements{};
  Index nodes{};
  int threads{};
  Rate trees;     ///< Elements whose blocks are put into trees [1/s]
  Rate searches;  ///< Elements in whole searches [1/s]
};

/// Builds a case once and measures it on any numbers of threads. Throws when a run ends by a fault.
class StepMeasurement {
 public:
  explicit StepMeasurement(const StepCase& step_case);
  /// Every repetition takes about `seconds`, twice that where there is a twin without contact.
  [[nodiscard]] StepRow measure(int threads, double seconds) const;
  [[nodiscard]] const model::Model& model() const noexcept { return model_; }

 private:
  const StepCase& case_;
  double heap_before_;
  model::Model model_;
  double model_bytes_;
  std::vector<model::Model> without_contact_;  // One at most
};

/// Every repetition of trees and of searches takes about `seconds`.
[[nodiscard]] SearchRow measure_search(const SearchCase& search_case, int threads, double seconds);

}  // namespace fexp::bench
