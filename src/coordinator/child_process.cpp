// SPDX-License-Identifier: Apache-2.0
#include "coordinator/child_process.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/prctl.h>
#include <sys/syscall.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <csignal>
#include <cstring>
#include <sstream>
#include <string_view>

extern char** environ;  // NOLINT(readability-redundant-declaration)

namespace fexp::coordinator {

namespace {

constexpr std::size_t most_kept = std::size_t{64} << 10U;
constexpr int cannot_start = 127;

/// A pipe whose reading end does not wait; both -1 when there can be none.
std::array<int, 2> make_pipe() {
  std::array<int, 2> ends{-1, -1};
  if (pipe2(ends.data(), O_CLOEXEC) == 0) {
    static_cast<void>(fcntl(ends[0], F_SETFL, O_NONBLOCK));
  }
  return ends;
}

std::vector<std::string> environment_with(const std::map<std::string, std::string>& changes) {
  std::vector<std::string> lines;
  for (char** line = environ; *line != nullptr; ++line) {
    const std::string_view text = *line;
    if (!changes.contains(std::string(text.substr(0, text.find('='))))) {
      lines.emplace_back(text);
    }
  }
  for (const auto& [name, value] : changes) {
    lines.push_back(fmt::format("{}={}", name, value));
  }
  return lines;
}

std::vector<char*> pointers_to(std::vector<std::string>& words) {
  std::vector<char*> pointers;
  for (std::string& word : words) {
    pointers.push_back(word.data());
  }
  pointers.push_back(nullptr);
  return pointers;
}

/// After fork: only what is allowed between fork and exec in a program with threads.
[[noreturn]] void become(char* const* words, char* const* environment, pid_t parent, int output, int errors) {
  prctl(PR_SET_PDEATHSIG, SIGTERM);
  if (getppid() != parent) {
    _exit(cannot_start);
  }
  setpgid(0, 0);
  const int nothing = open("/dev/null", O_RDONLY);  // NOLINT(cppcoreguidelines-pro-type-vararg)
  dup2(nothing, STDIN_FILENO);
  dup2(output, STDOUT_FILENO);
  dup2(errors, STDERR_FILENO);
  for (const int signal : {SIGINT, SIGTERM, SIGHUP, SIGPIPE, SIGXFSZ}) {
    static_cast<void>(std::signal(signal, SIG_DFL));
  }
  environ = const_cast<char**>(environment);
  execvp(words[0], words);
  const std::string_view reason = strerrorname_np(errno);
  for (const std::string_view text : {std::string_view("cannot start "), std::string_view(words[0]),
                                      std::string_view(": "), reason, std::string_view("\n")}) {
    static_cast<void>(!write(STDERR_FILENO, text.data(), text.size()));
  }
  _exit(cannot_start);
}

void drain(int& descriptor, std::string& text) {
  std::array<char, 16384> bytes{};
  while (descriptor >= 0) {
    const ssize_t count = read(descriptor, bytes.data(), bytes.size());
    if (count > 0) {
      text.append(bytes.data(), static_cast<std::size_t>(count));
      if (text.size() > most_kept) {
        text.erase(0, text.size() - most_kept);
      }
    } else if (count == 0 || (errno != EAGAIN && errno != EINTR)) {
      close(descriptor);
      descriptor = -1;
    } else if (errno == EAGAIN) {
      return;
    }
  }
}

}  // namespace

ChildProcess::ChildProcess(const std::vector<std::string>& words,
                           const std::map<std::string, std::string>& environment) {
  std::vector<std::string> arguments = words;
  std::vector<std::string> variables = environment_with(environment);
  const std::vector<char*> argument_pointers = pointers_to(arguments);
  const std::vector<char*> variable_pointers = pointers_to(variables);
  const std::array<int, 2> output = make_pipe();
  const std::array<int, 2> errors = make_pipe();
  const pid_t parent = getpid();
  id_ = output[0] >= 0 && errors[0] >= 0 ? fork() : -1;
  if (id_ == 0) {
    become(argument_pointers.data(), variable_pointers.data(), parent, output[1], errors[1]);
  }
  const int failure = errno;
  for (const int end : {output[1], errors[1]}) {
    if (end >= 0) {
      close(end);
    }
  }
  output_descriptor_ = output[0];
  errors_descriptor_ = errors[0];
  if (id_ < 0) {
    exited_ = true;
    status_ = cannot_start << 8;
    errors_ = fmt::format("cannot start {}: {}\n", words.front(), strerrordesc_np(failure));
    return;
  }
  // Here too, so that the group is there before the first signal to it.
  static_cast<void>(setpgid(id_, id_));
  // The library of Debian 12 declares pidfd_open for C only.
  end_descriptor_ = static_cast<int>(syscall(SYS_pidfd_open, id_, 0));  // NOLINT(cppcoreguidelines-pro-type-vararg)
}

ChildProcess::~ChildProcess() {
  if (!exited_) {
    send_signal(SIGKILL);
    static_cast<void>(waitpid(id_, &status_, 0));
  }
  for (const int descriptor : descriptors()) {
    if (descriptor >= 0) {
      close(descriptor);
    }
  }
}

void ChildProcess::look() {
  if (!exited_ && waitpid(id_, &status_, WNOHANG) == id_) {
    exited_ = true;
    if (end_descriptor_ >= 0) {
      close(end_descriptor_);
      end_descriptor_ = -1;
    }
  }
  drain(output_descriptor_, output_);
  drain(errors_descriptor_, errors_);
}

std::string ChildProcess::status_text() const {
  return WIFSIGNALED(status_) ? fmt::format("signal {}", WTERMSIG(status_))
                              : fmt::format("exit code {}", WEXITSTATUS(status_));
}

void ChildProcess::send_signal(int signal) const {
  if (!exited_) {
    static_cast<void>(kill(-id_, signal));
  }
}

std::vector<int> ChildProcess::descriptors() const { return {output_descriptor_, errors_descriptor_, end_descriptor_}; }

std::string last_line(const std::string& text) {
  std::istringstream stream(text);
  std::string last;
  for (std::string line; std::getline(stream, line);) {
    const std::size_t end = line.find_last_not_of(" \t\r");
    if (end != line.npos) {
      last = line.substr(0, end + 1);
    }
  }
  return last;
}

}  // namespace fexp::coordinator
