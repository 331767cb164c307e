// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <filesystem>
#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace fexp::io {

/// What a run comes to: printed at its end, written as summary.json, and printed by --json.
struct Summary {
  bool completed{};         ///< The whole duration was integrated.
  std::string exit_reason;  ///< "completed", "fault", "interrupted" or "output error"
  std::string message;      ///< One sentence on why it ended early; empty when completed.
  std::string title;
  std::int64_t steps{};
  double time{};      ///< [time]
  double duration{};  ///< Asked for [time]
  std::int64_t elements{};
  std::int64_t nodes{};
  std::int64_t bodies{};
  int threads{};
  int ranks{1};
  double energy_error{};             ///< Largest relative imbalance over the run [-]
  double linear_momentum_error{};    ///< Largest, relative to the sum of moduli [-]
  double angular_momentum_error{};   ///< Largest, relative to the sum of moduli [-]
  std::optional<double> residual{};  ///< Of a static analysis, at the end [-]
  std::string state_hash;            ///< 16 hexadecimal digits
  double wall_seconds{};
  double element_steps_per_second{};

  struct Energies {  ///< At the end [force*length]
    double kinetic{};
    double internal{};
    double contact{};
    double barrier{};
    double external{};
    double damping{};
    double friction{};
    double balance{};
  } energies;

  double step_smallest{};  ///< [time]
  double step_largest{};   ///< [time]
  std::int64_t frames{};   ///< In the results file
  std::int64_t epochs{};
  std::int64_t rollbacks{};
  std::int64_t retries{};  ///< Epochs done again with half the step after a fault
  std::int64_t islands_fewest{};
  std::int64_t islands_most{};
  std::int64_t contacts_most{};  ///< Most pairs in contact at the same time
  std::int64_t searches{};       ///< Contact searches
  double deepest_penetration{};  ///< Over contact distance [-]
  std::string kernel;            ///< Element kernel, e.g. "avx2"

  struct FaultPlace {  ///< Set when exit_reason is "fault"; negative: not known
    std::int64_t element{-1};
    std::int64_t node{-1};
    std::string body;
    std::string other_body;  ///< Of a pair in contact; empty: none
    std::string cure;
    std::optional<double> share;  ///< Of what the energy balance is off [-]
    struct Row {                  ///< Of `body` at the end of an epoch [time, force*length]
      std::int64_t step{};
      double time{};
      double dt{};
      double energy_error{};  ///< Of the model [-]
      double kinetic{};
      double internal{};
      double contact_work{};
      double off{};
    };
    std::vector<Row> history;  ///< The oldest first
  } fault;

  /// What mass scaling gave one part of a body.
  struct AddedMass {
    std::string body;
    std::string part;
    double mass{};   ///< Without it [mass]
    double added{};  ///< [mass]
  };
  std::vector<AddedMass> added_mass;
  struct Tie {
    std::string name;
    std::int64_t tied{};    ///< Nodes
    std::int64_t far{};     ///< Nodes of its set that are too far from the surface
    std::int64_t broken{};  ///< Nodes of those tied that are so no more
  };
  std::vector<Tie> ties;

  /// Two bodies that were nearer before the start than their thicknesses allow, or passed through each other, or a body
  /// and a rigid wall.
  struct Penetration {
    std::string body;
    std::string other_body;                ///< May be the same
    std::int64_t count{};                  ///< Nodes, and pairs of edges
    double depth{};                        ///< Of the deepest [length]
    double contact_distance{};             ///< There [length]
    std::vector<std::int64_t> nodes;       ///< Of the deepest: a node, or the ends of two edges
    std::vector<std::int64_t> elements;    ///< An element, or one at each edge
    std::int64_t crossings{};              ///< Edges that pass through elements
    std::string crossing_body;             ///< That of the first such edge, which passes through the other body
    std::vector<std::int64_t> crossing{};  ///< Its nodes, and the element
    std::string wall{};                    ///< Instead of another body, with no elements
  };
  struct InitialPenetrations {
    std::vector<Penetration> found;
    bool removed{};  ///< Nodes were moved
    std::int64_t moved_nodes{};
    double largest_move{};            ///< [length]
    std::int64_t farthest_node{-1};   ///< The node that was moved so far
    std::vector<Penetration> left{};  ///< What could not be removed
  } initial_penetrations;

  /// Who held what. Machines in the order in which they joined.
  struct Placement {
    struct MachineLine {
      std::string name;
      int threads{};  ///< That compute
      int native_threads{};
      int running_threads{};  ///< Of the process, computing or not
      double busy_seconds{};  ///< Spent stepping in the last world
    };
    struct FrameLine {
      std::int64_t step{};
      double time{};  ///< [time]
      std::string reason;
      std::vector<std::int64_t> elements;  // [machines known by then]
      std::vector<std::int64_t> nodes;     // [machines known by then]
      std::int64_t moved_elements{};       ///< So far
      std::int64_t moved_nodes{};
    };
    std::vector<MachineLine> machines;
    std::vector<FrameLine> frames;  ///< The first and the last of very many
    std::int64_t frames_left_out{};
    std::int64_t moved_elements{};
    std::int64_t moved_nodes{};
    double moved_ratio{};  ///< Moved elements over those of the model [-]
    std::int64_t moved_bytes{};
  } placement;

  /// Of the last world.
  struct Network {
    double messages_per_epoch{};
    double bytes_per_epoch{};
    double waiting_share{};         ///< Of its time, mean of the ranks [-]
    double snapshot_share{};        ///< Of its time, spent saving the state [-]
    double imbalance{};             ///< Work of the busiest machine over the mean, less 1 [-]
    double largest_island_share{};  ///< Of the work [-]
    double time_with_one_more{};    ///< Predicted, over the present time [-]
    int useful_machines{1};
    std::string balance;  ///< The same in words
  } network;

  std::vector<std::pair<std::string, std::string>> files;  ///< (what it is, path)
};

/// The summary with its keys in the order above.
[[nodiscard]] nlohmann::ordered_json to_json(const Summary& summary);

/// Replaces `path` by the summary as a whole. Throws OutputError.
void write_summary(const std::filesystem::path& path, const Summary& summary);

/// Whether the summary, if there is one, is of a run that went to its end. Throws OutputError when it cannot be read.
[[nodiscard]] bool is_completed(const std::filesystem::path& summary);

}  // namespace fexp::io
