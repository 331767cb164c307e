// SPDX-License-Identifier: Apache-2.0
#pragma once

namespace fexp::app {

/// While it lives, the first SIGINT, SIGTERM or SIGHUP is only remembered, so that the run can end in order; the second
/// ends the program at once. Signals that were ignored at the start (nohup) stay so. From then on a broken pipe or a
/// file above its size limit no longer ends the program, but is an error of whoever writes.
class SignalWatch {
 public:
  SignalWatch();
  SignalWatch(const SignalWatch&) = delete;
  SignalWatch& operator=(const SignalWatch&) = delete;
  ~SignalWatch();

  /// Number of the signal that came, or 0.
  [[nodiscard]] static int received() noexcept;
};

}  // namespace fexp::app
