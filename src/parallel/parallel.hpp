// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>
#include <tbb/task_arena.h>

#include <algorithm>
#include <functional>

#include "base/index.hpp"

/// oneTBB behind the few shapes of parallel work the solver uses. Which thread runs a piece may vary; what a piece
/// writes may not, so every result is the same for any number of threads.
namespace fexp::parallel {

/// Runs body(begin, end) over [0, count) cut into pieces of at least `grain`; runs in the calling thread when there is
/// only one piece.
template <class Body>
void for_ranges(Index count, Index grain, const Body& body) {
  if (count <= 0) {
    return;
  }
  if (count <= grain) {
    body(Index{0}, count);
    return;
  }
  tbb::parallel_for(tbb::blocked_range<Index>(0, count, static_cast<std::size_t>(grain)),
                    [&](const tbb::blocked_range<Index>& r) { body(r.begin(), r.end()); });
}

/// Runs body(i) for each i in [0, count).
template <class Body>
void for_each(Index count, Index grain, const Body& body) {
  for_ranges(count, grain, [&](Index begin, Index end) {
    for (Index i = begin; i < end; ++i) {
      body(i);
    }
  });
}

/// Runs `work` with at most `threads` threads (0: as many as the machine has).
template <class Work>
void with_threads(int threads, const Work& work) {
  tbb::task_arena arena(threads > 0 ? threads : tbb::task_arena::automatic);
  arena.execute([&] { work(); });
}

/// Threads available to the calling arena.
[[nodiscard]] inline int thread_count() { return tbb::this_task_arena::max_concurrency(); }

}  // namespace fexp::parallel
