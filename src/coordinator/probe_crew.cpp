// SPDX-License-Identifier: Apache-2.0
#include "coordinator/probe_crew.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

namespace fexp::coordinator {

void ProbeCrew::start(Purpose purpose, const Machine& machine, const std::vector<std::string>& command, double now,
                      double limit) {
  calls_.push_back({purpose, machine, std::make_unique<ChildProcess>(command), now, limit});
}

std::vector<ProbeCrew::Answer> ProbeCrew::take_answers(double now) {
  std::vector<Answer> answers;
  for (Call& call : calls_) {
    ChildProcess& process = *call.process;
    process.look();
    const bool too_long = now - call.started > call.limit;
    if (!process.exited() && !too_long) {
      continue;
    }
    Answer answer{call.purpose, call.machine, read_probe(process.output()), ""};
    if (!answer.probe) {
      const std::string said = last_line(process.errors());
      answer.words = !process.exited() ? fmt::format("it does not answer within {:g} s", call.limit)
                     : said.empty()    ? fmt::format("it gives no sensible answer ({})", process.status_text())
                                       : said;
    }
    answers.push_back(std::move(answer));
    call.process.reset();
  }
  std::erase_if(calls_, [](const Call& call) { return call.process == nullptr; });
  return answers;
}

bool ProbeCrew::is_busy_with(Purpose purpose) const {
  return std::ranges::any_of(calls_, [&](const Call& call) { return call.purpose == purpose; });
}

void ProbeCrew::give_up(Purpose purpose) {
  std::erase_if(calls_, [&](const Call& call) { return call.purpose == purpose; });
}

std::vector<int> ProbeCrew::descriptors() const {
  std::vector<int> all;
  for (const Call& call : calls_) {
    std::ranges::copy(call.process->descriptors(), std::back_inserter(all));
  }
  return all;
}

}  // namespace fexp::coordinator
