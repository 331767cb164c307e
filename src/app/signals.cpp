// SPDX-License-Identifier: Apache-2.0
#include "app/signals.hpp"

#include <csignal>

namespace fexp::app {

namespace {

constexpr int ending[] = {SIGINT, SIGTERM, SIGHUP};
constexpr int writing[] = {SIGPIPE, SIGXFSZ};

volatile std::sig_atomic_t received_signal = 0;

void back_to_default() {
  for (const int signal : ending) {
    struct sigaction action {};
    if (sigaction(signal, nullptr, &action) == 0 && action.sa_handler != SIG_IGN) {
      action.sa_handler = SIG_DFL;
      sigaction(signal, &action, nullptr);
    }
  }
}

void remember(int signal) {
  received_signal = signal;
  back_to_default();
}

}  // namespace

SignalWatch::SignalWatch() {
  received_signal = 0;
  for (const int signal : ending) {
    struct sigaction action {};
    if (sigaction(signal, nullptr, &action) == 0 && action.sa_handler != SIG_IGN) {
      action.sa_handler = remember;
      action.sa_flags = SA_RESTART;
      sigaction(signal, &action, nullptr);
    }
  }
  for (const int signal : writing) {
    static_cast<void>(std::signal(signal, SIG_IGN));
  }
}

SignalWatch::~SignalWatch() { back_to_default(); }

int SignalWatch::received() noexcept { return received_signal; }

}  // namespace fexp::app
