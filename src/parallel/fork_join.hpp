// SPDX-License-Identifier: Apache-2.0
#pragma once

#if defined(__SANITIZE_THREAD__)
#define FEXP_THREAD_SANITIZER 1
#elif defined(__has_feature)
#if __has_feature(thread_sanitizer)
#define FEXP_THREAD_SANITIZER 1
#endif
#endif

#ifdef FEXP_THREAD_SANITIZER
#include <sanitizer/tsan_interface.h>
/// Before a function's body: its own reads and writes are not looked at, those of functions it calls are.
#define FEXP_UNSEEN_BY_THREAD_SANITIZER __attribute__((no_sanitize("thread")))
#else
#define FEXP_UNSEEN_BY_THREAD_SANITIZER
#endif

namespace fexp::parallel {

#ifdef FEXP_THREAD_SANITIZER

/// Tells the thread sanitizer what it cannot see, because the distribution's libtbb is not instrumented: every piece of
/// a parallel loop begins after what stands before the loop and ends before what follows it. Nothing orders the pieces
/// among themselves, so that a race between them is found. To be made before the loop and destroyed after it.
class ForkJoin {
 public:
  ForkJoin() noexcept { __tsan_release(&fork_); }
  ForkJoin(const ForkJoin&) = delete;
  ForkJoin& operator=(const ForkJoin&) = delete;
  ~ForkJoin() { __tsan_acquire(&join_); }

  void begin_piece() noexcept { __tsan_acquire(&fork_); }
  void end_piece() noexcept { __tsan_release(&join_); }

 private:
  // Only their addresses count.
  char fork_{};
  char join_{};
};

#else

/// Nothing, in builds without the thread sanitizer.
class ForkJoin {
 public:
  void begin_piece() noexcept {}
  void end_piece() noexcept {}
};

#endif

}  // namespace fexp::parallel
