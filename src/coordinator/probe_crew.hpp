// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "coordinator/child_process.hpp"
#include "coordinator/machine.hpp"
#include "coordinator/probe.hpp"

namespace fexp::coordinator {

/// Probes of machines under way, each a program of its own that is ended when it takes too long.
class ProbeCrew {
 public:
  enum class Purpose {
    check,   ///< Before a machine is used
    look,    ///< When a world seems to stand still
    clean,   ///< After a world was lost
    forget,  ///< After the run
  };
  struct Answer {
    Purpose purpose{};
    Machine machine;
    std::optional<Probe> probe;
    std::string words;  ///< Why there is none
  };

  void start(Purpose purpose, const Machine& machine, const std::vector<std::string>& command, double now,
             double limit);
  /// Those that have come to an end since the last call.
  [[nodiscard]] std::vector<Answer> take_answers(double now);
  [[nodiscard]] bool is_busy_with(Purpose purpose) const;
  void give_up(Purpose purpose);

  [[nodiscard]] std::vector<int> descriptors() const;

 private:
  struct Call {
    Purpose purpose{};
    Machine machine;
    std::unique_ptr<ChildProcess> process;
    double started{};
    double limit{};
  };
  std::vector<Call> calls_;
};

}  // namespace fexp::coordinator
