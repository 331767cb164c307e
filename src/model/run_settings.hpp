// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <string>
#include <string_view>
#include <tuple>

#include "base/field.hpp"

namespace fexp::model {

struct RunSettings {
  static constexpr std::array<std::string_view, 2> analyses{"dynamic", "static"};
  static constexpr std::array<std::string_view, 3> relaxations{"automatic", "viscous", "kinetic"};

  std::string analysis{"dynamic"};
  double duration{};                    ///< [time]
  double safety{0.9};                   ///< Step over the critical step [-]
  double minimum_step{-1.0};            ///< Elements get mass to reach this step [time]; negative: none does
  double damping{0.0};                  ///< Mass-proportional damping coefficient [1/time]
  double stiffness_damping{0.0};        ///< Stiffness-proportional damping coefficient [time]
  double energy_drift_limit{0.05};      ///< Largest relative energy imbalance [-]
  double step_collapse{1.0e-3};         ///< Stop when the critical step falls below this part of the first one [-]
  double drilling{0.1};                 ///< Drilling tie factor beta [-]
  double residual{1.0e-6};              ///< At which a static analysis ends [-]
  std::string relaxation{"automatic"};  ///< How a static analysis is damped
  int epoch_steps{64};                  ///< Most steps between two looks at the interaction graph

  static constexpr Range safety_range{0.0, 1.0, false, true, "> 0 and <= 1"};
  static constexpr Range drilling_range{0.0, 1.0, true, true, "0 to 1"};
  static constexpr Range collapse_range{0.0, 1.0, true, false, ">= 0 and < 1"};
  static constexpr Range fraction_range{0.0, 1.0, false, false, "> 0 and < 1"};
  static constexpr Range epoch_range{1.0, 100000.0, true, true, "1 to 100000"};
  [[nodiscard]] bool is_static() const noexcept { return analysis == "static"; }

  static constexpr auto fields = std::tuple{
      Field{"analysis", "-",
            "What is looked for: the motion, or the state of rest that it comes to by itself under damping "
            "(\"static\").",
            &RunSettings::analysis, Choices(analyses)},
      Field{"duration", "time", "Time to integrate over; a static analysis ends before, as soon as it is at rest.",
            &RunSettings::duration, positive, Presence::required},
      Field{"safety", "-", "Step as a part of the critical step.", &RunSettings::safety, safety_range},
      Field{"minimum_step", "time",
            "Mass scaling: elements that would need a smaller step get as much mass as it takes; none when left out.",
            &RunSettings::minimum_step, positive},
      Field{"damping", "1/time", "Mass-proportional damping: force -damping x mass x velocity on every node.",
            &RunSettings::damping, non_negative},
      Field{
          "stiffness_damping", "time",
          "Stiffness-proportional damping: resultants gain stiffness_damping x elastic stiffness x rate of strain. The "
          "critical step becomes smaller.",
          &RunSettings::stiffness_damping, non_negative},
      Field{"energy_drift_limit", "-", "The run stops when the relative energy imbalance exceeds this.",
            &RunSettings::energy_drift_limit, positive},
      Field{"step_collapse", "-", "The run stops when the critical step falls below this part of the first one.",
            &RunSettings::step_collapse, collapse_range},
      Field{"drilling", "-", "Factor of the drilling tie; 0 switches it off.", &RunSettings::drilling, drilling_range},
      Field{"residual", "-",
            "A static analysis ends when unbalanced forces and velocities are below this part of the largest so far.",
            &RunSettings::residual, fraction_range},
      Field{
          "relaxation", "-",
          "How a static analysis is damped: by a force against the velocity (\"viscous\"), by stopping all motion when "
          "the kinetic energy has passed a peak (\"kinetic\"), or by both, and by one alone where both do not help.",
          &RunSettings::relaxation, Choices(relaxations)},
      Field{"epoch_steps", "-", "Most steps between two looks at the interaction graph.", &RunSettings::epoch_steps,
            epoch_range},
  };
};

}  // namespace fexp::model
