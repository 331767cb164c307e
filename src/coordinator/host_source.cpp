// SPDX-License-Identifier: Apache-2.0
#include "coordinator/host_source.hpp"

#include <fmt/format.h>

#include <chrono>
#include <thread>
#include <utility>

#include "io/atomic_file.hpp"
#include "io/output_error.hpp"

namespace fexp::coordinator {

namespace {

constexpr double file_interval = 0.5;
constexpr double script_interval = 5.0;
constexpr double script_limit = 30.0;

}  // namespace

std::string run_host_script(const std::string& script) {
  using namespace std::chrono_literals;
  ChildProcess process({script});
  const auto end = std::chrono::steady_clock::now() + std::chrono::duration<double>(script_limit);
  while (!process.exited() && std::chrono::steady_clock::now() < end) {
    std::this_thread::sleep_for(10ms);
    process.look();
  }
  if (!process.succeeded()) {
    const std::string said = last_line(process.errors());
    throw io::OutputError(script,
                          process.exited()
                              ? fmt::format("failed ({}){}{}", process.status_text(), said.empty() ? "" : ": ", said)
                              : fmt::format("has not answered within {:.0f} s", script_limit),
                          "run it by hand to see why");
  }
  return process.output();
}

HostSource::HostSource(std::filesystem::path file, std::string script)
    : file_(std::move(file)), script_(std::move(script)) {}

std::optional<std::vector<Machine>> HostSource::look(double now, std::string& complaint) {
  if (!file_.empty()) {
    look_at_file(now, complaint);
  } else if (!script_.empty()) {
    look_at_script(now, complaint);
  }
  if (!new_) {
    return std::nullopt;
  }
  taken_ = std::exchange(new_, std::nullopt);
  ErrorList errors;
  std::vector<Machine> machines = parse_machines(*taken_, file_.empty() ? script_ : file_.string(), errors);
  if (!errors.empty()) {
    complain_once(errors.errors().front().text() + "; the last list stays in force", complaint);
    return std::nullopt;
  }
  complained_.clear();
  return machines;
}

void HostSource::look_at_file(double now, std::string& complaint) {
  if (now < next_look_) {
    return;
  }
  next_look_ = now + file_interval;
  try {
    const std::string text = io::read_whole(file_);
    // A file that an editor is still writing changes from one look to the next.
    if (text != taken_ && (text == seen_ || !taken_)) {
      new_ = text;
    }
    seen_ = text;
  } catch (const io::OutputError& error) {
    complain_once(fmt::format("{}; the last list of machines stays in force", error.what()), complaint);
  }
}

void HostSource::look_at_script(double now, std::string& complaint) {
  if (!running_) {
    if (now >= next_look_) {
      running_ = std::make_unique<ChildProcess>(std::vector<std::string>{script_});
      started_ = now;
    }
    return;
  }
  running_->look();
  const bool too_long = now - started_ > script_limit;
  if (!running_->exited() && !too_long) {
    return;
  }
  if (running_->succeeded()) {
    if (running_->output() != taken_) {
      new_ = running_->output();
    }
  } else {
    const std::string reason =
        too_long ? fmt::format("no answer within {:.0f} s", script_limit) : running_->status_text();
    const std::string said = last_line(running_->errors());
    complain_once(fmt::format("{} failed ({}{}{}); the last list of machines stays in force", script_, reason,
                              said.empty() ? "" : ": ", said),
                  complaint);
  }
  running_.reset();
  next_look_ = now + script_interval;
}

void HostSource::complain_once(const std::string& text, std::string& complaint) {
  if (text != complained_) {
    complaint = complained_ = text;
  }
}

std::vector<int> HostSource::descriptors() const { return running_ ? running_->descriptors() : std::vector<int>{}; }

}  // namespace fexp::coordinator
