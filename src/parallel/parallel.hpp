// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <tbb/blocked_range.h>
#include <tbb/global_control.h>
#include <tbb/parallel_for.h>
#include <tbb/task_arena.h>

#include <algorithm>
#include <optional>
#include <vector>

#include "base/index.hpp"
#include "parallel/fork_join.hpp"

/// oneTBB behind the few shapes of parallel work the solver uses. Which thread runs a piece may vary; what a piece
/// writes may not, so every result is the same for any number of threads.
namespace fexp::parallel {

namespace detail {

template <class Body>
void run_piece(ForkJoin& fork_join, const Body& body, const tbb::blocked_range<Index>& piece) {
  fork_join.begin_piece();
  body(piece.begin(), piece.end());
  fork_join.end_piece();
}

}  // namespace detail

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
  ForkJoin fork_join;
  // What the lambda holds is copied by oneTBB from task to task, before the sanitizer can be told that a piece begins.
  tbb::parallel_for(tbb::blocked_range<Index>(0, count, static_cast<std::size_t>(grain)),
                    [&](const tbb::blocked_range<Index>& piece)
                        FEXP_UNSEEN_BY_THREAD_SANITIZER { detail::run_piece(fork_join, body, piece); });
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

/// Folds part(begin, end) over consecutive pieces of `piece` items: combine(...combine(combine(first, p0), p1)..., pn).
/// The pieces are computed in parallel; where they are cut and in which order they are combined depends on the range
/// alone, so that floating-point sums are the same for any number of threads.
template <class Value, class Part, class Combine>
[[nodiscard]] Value ordered_fold(IndexRange range, Index piece, Value first, const Part& part, const Combine& combine) {
  std::vector<Value> parts(at((range.size() + piece - 1) / piece));
  for_each(static_cast<Index>(parts.size()), 1, [&](Index i) {
    const Index begin = range.begin + i * piece;
    parts[at(i)] = part(begin, std::min(begin + piece, range.end));
  });
  for (const Value& value : parts) {
    first = combine(first, value);
  }
  return first;
}

/// Runs `work` with `threads` threads (0: as many as the machine has). There may be more threads than cores, which is
/// slow, but lets one machine show that results do not depend on their number.
template <class Work>
void with_threads(int threads, const Work& work) {
  std::optional<tbb::global_control> limit;
  if (threads > 0) {
    limit.emplace(tbb::global_control::max_allowed_parallelism, static_cast<std::size_t>(threads));
  }
  tbb::task_arena arena(threads > 0 ? threads : tbb::task_arena::automatic);
  arena.execute([&] { work(); });
}

/// Threads available to the calling arena.
[[nodiscard]] inline int thread_count() { return tbb::this_task_arena::max_concurrency(); }

}  // namespace fexp::parallel
