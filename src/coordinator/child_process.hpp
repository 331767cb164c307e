// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <sys/types.h>

#include <map>
#include <string>
#include <vector>

namespace fexp::coordinator {

/// A program that was started, with its output. It reads nothing, has a process group of its own (Ctrl-C does not reach
/// it), and is sent SIGTERM when this process dies. Nothing here waits.
class ChildProcess {
 public:
  /// `words`: program and arguments; the program is looked for as a shell does. `environment` is put over this
  /// process's own. When it cannot be started it ends with code 127, and its errors say why.
  explicit ChildProcess(const std::vector<std::string>& words,
                        const std::map<std::string, std::string>& environment = {});
  ChildProcess(const ChildProcess&) = delete;
  ChildProcess& operator=(const ChildProcess&) = delete;
  /// Kills the group if the process still lives, and waits for it.
  ~ChildProcess();

  /// Takes what it has written, and notices its end.
  void look();
  [[nodiscard]] bool exited() const noexcept { return exited_; }
  /// It has exited with code 0.
  [[nodiscard]] bool succeeded() const noexcept { return exited_ && status_ == 0; }
  /// "exit code 1" or "signal 9"
  [[nodiscard]] std::string status_text() const;
  /// To its process group.
  void send_signal(int signal) const;

  /// The end of what it has written, at most 64 KiB each.
  [[nodiscard]] const std::string& output() const noexcept { return output_; }
  [[nodiscard]] const std::string& errors() const noexcept { return errors_; }
  /// To poll for reading: its outputs, and its end (-1: none).
  [[nodiscard]] std::vector<int> descriptors() const;
  [[nodiscard]] pid_t id() const noexcept { return id_; }

 private:
  pid_t id_{-1};
  int status_{};
  bool exited_{};
  int output_descriptor_{-1};
  int errors_descriptor_{-1};
  int end_descriptor_{-1};
  std::string output_;
  std::string errors_;
};

/// The last line of what a process has written that is not blank, or empty.
[[nodiscard]] std::string last_line(const std::string& text);

}  // namespace fexp::coordinator
