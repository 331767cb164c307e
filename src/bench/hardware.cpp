// SPDX-License-Identifier: Apache-2.0
#include "bench/hardware.hpp"

#include <unistd.h>

#include <algorithm>
#include <barrier>
#include <cstdint>
#include <filesystem>
#include <fstream>
#include <map>
#include <memory>
#include <string>
#include <system_error>
#include <thread>
#include <utility>
#include <vector>

#include "base/aligned_vector.hpp"
#include "base/stopwatch.hpp"

namespace fexp::bench {

namespace {

namespace fs = std::filesystem;

/// Rounds of the arithmetic loops between two looks at the clock: some milliseconds.
constexpr std::int64_t arithmetic_rounds = 1'000'000;

std::string first_word(const fs::path& path) {
  std::ifstream file(path);
  std::string word;
  file >> word;
  return word;
}

/// "32768K" in bytes.
double size_of(const std::string& text) {
  if (text.empty() || text.find_first_not_of("0123456789") == 0) {
    return 0.0;
  }
  const double number = std::stod(text);
  return text.back() == 'K' ? 1024.0 * number : text.back() == 'M' ? 1024.0 * 1024.0 * number : number;
}

/// Array that no thread has touched yet, so that its pages lie where the thread is that touches them first.
class Untouched {
 public:
  explicit Untouched(std::size_t count) : count_(count), data_(CacheLineAllocator<double>().allocate(count)) {}
  Untouched(const Untouched&) = delete;
  Untouched& operator=(const Untouched&) = delete;
  ~Untouched() { CacheLineAllocator<double>().deallocate(data_, count_); }
  [[nodiscard]] double* data() const noexcept { return data_; }

 private:
  std::size_t count_;
  double* data_;
};

/// Runs round(thread) on all threads together, again and again for `seconds`, after prepare(thread) and a round
/// that is not timed. Returns the rounds per second of each repetition. Threads of their own, not the solver's: each is
/// to do its part every time.
template <class Prepare, class Round>
Rate rounds_per_second(int threads, double seconds, const Prepare& prepare, const Round& round) {
  std::barrier gate(threads);
  std::vector<double> rates;
  bool goes_on = true;  // Written by the first thread while the others wait
  const auto work = [&](int thread) {
    prepare(thread);
    for (int repetition = 0; repetition < repetitions; ++repetition) {
      round(thread);
      gate.arrive_and_wait();
      const Clock::time_point start = Clock::now();
      double rounds = 0.0;
      for (bool once_more = true; once_more;) {
        round(thread);
        gate.arrive_and_wait();
        rounds += 1.0;
        if (thread == 0) {
          const double past = seconds_since(start);
          goes_on = past < seconds;
          if (!goes_on) {
            rates.push_back(rounds / past);
          }
        }
        gate.arrive_and_wait();
        once_more = goes_on;
      }
    }
  };
  std::vector<std::jthread> others;
  for (int thread = 1; thread < threads; ++thread) {
    others.emplace_back(work, thread);
  }
  work(0);
  others.clear();
  return rate_of(rates);
}

Rate measure_triad(TriadLoop triad, int threads, std::size_t array_bytes, double seconds) {
  // Whole cache lines for each thread.
  const std::size_t share = array_bytes / sizeof(double) / static_cast<std::size_t>(threads) / 8 * 8;
  const std::size_t count = share * static_cast<std::size_t>(threads);
  const Untouched a(count), b(count), c(count);
  const auto first = [&](const Untouched& array, int thread) {
    return array.data() + share * static_cast<std::size_t>(thread);
  };
  const auto prepare = [&](int thread) {
    std::uninitialized_fill_n(first(a, thread), share, 0.0);
    std::uninitialized_fill_n(first(b, thread), share, 1.0);
    std::uninitialized_fill_n(first(c, thread), share, 2.0);
  };
  const auto round = [&](int thread) { triad(first(a, thread), first(b, thread), first(c, thread), 3.0, share); };
  const Rate rounds = rounds_per_second(threads, seconds, prepare, round);
  return scaled(3.0 * sizeof(double) * static_cast<double>(count), rounds);
}

Rate measure_arithmetic(ArithmeticLoop loop, double flops, int threads, double seconds) {
  if (loop == nullptr) {
    return {};
  }
  std::vector<double> results(static_cast<std::size_t>(threads));
  // All numbers stay of the order of one, as those that are too small to be normal take longer.
  const auto round = [&](int thread) {
    results[static_cast<std::size_t>(thread)] = loop(arithmetic_rounds, 1.0, 1.0e-9);
  };
  const Rate rounds = rounds_per_second(
      threads, seconds, [](int) {}, round);
  return scaled(flops * static_cast<double>(arithmetic_rounds) * threads, rounds);
}

}  // namespace

double Roofs::peak_flops() const noexcept { return std::max(fused.best, separate.best); }

double last_cache_bytes() {
  // The processors that share a cache have the same list of them; the last level has the largest number.
  std::map<std::pair<std::string, std::string>, std::pair<int, double>> caches;
  std::error_code error;
  for (const fs::directory_entry& processor : fs::directory_iterator("/sys/devices/system/cpu", error)) {
    for (const fs::directory_entry& cache : fs::directory_iterator(processor.path() / "cache", error)) {
      const std::string level = first_word(cache.path() / "level");
      const std::string shared = first_word(cache.path() / "shared_cpu_list");
      const double bytes = size_of(first_word(cache.path() / "size"));
      if (!level.empty() && bytes > 0.0) {
        caches[{level, shared}] = {std::stoi(level), bytes};
      }
    }
  }
  int last = 0;
  for (const auto& [name, cache] : caches) {
    last = std::max(last, cache.first);
  }
  double sum = 0.0;
  for (const auto& [name, cache] : caches) {
    sum += cache.first == last ? cache.second : 0.0;
  }
  return sum;
}

std::size_t triad_array_bytes(double caches, double factor) {
  constexpr double least = 64.0 * 1024.0 * 1024.0;
  const double memory = static_cast<double>(sysconf(_SC_PHYS_PAGES)) * static_cast<double>(sysconf(_SC_PAGESIZE));
  return static_cast<std::size_t>(std::min(std::max(factor * caches, least), memory / 12.0));
}

Roofs measure_roofs(const ArithmeticKernels& kernels, int threads, std::size_t array_bytes, double seconds) {
  return {threads, measure_triad(kernels.triad, threads, array_bytes, seconds),
          measure_arithmetic(kernels.fused, kernels.fused_flops, threads, seconds),
          measure_arithmetic(kernels.separate, kernels.separate_flops, threads, seconds)};
}

}  // namespace fexp::bench
