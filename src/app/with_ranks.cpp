// SPDX-License-Identifier: Apache-2.0
#include "app/with_ranks.hpp"

#include <fmt/format.h>

#include <exception>
#include <new>
#include <string>

#include "app/print.hpp"
#include "base/errors.hpp"
#include "io/output_error.hpp"
#include "parallel/parallel.hpp"

namespace fexp::app {

namespace {

[[noreturn]] void end_all(const Ranks& ranks, const std::string& why) {
  print_error(fmt::format("fexp: rank {} on {}: {}\n", ranks.rank(), machine_name(), why));
  cluster::MpiWorld::abort(static_cast<int>(ExitCode::internal));
}

}  // namespace

ExitCode with_ranks(int threads, const std::function<ExitCode(Ranks&)>& work) {
  Ranks ranks;
  ExitCode code = ExitCode::internal;
  try {
    parallel::with_threads(ranks.threads(threads), [&] { code = work(ranks); });
  } catch (const EndedElsewhere&) {
    code = ExitCode::done;
  } catch (const InputErrors&) {
    throw;  // The other ranks know of it, and leave as well.
  } catch (const io::OutputError&) {
    throw;
  } catch (const std::bad_alloc&) {
    if (ranks.several()) {
      end_all(ranks, "out of memory; cure: give this machine fewer ranks, or the run more machines");
    }
    throw;
  } catch (const std::exception& error) {
    if (ranks.several()) {
      end_all(ranks, error.what());
    }
    throw;
  }
  return code;
}

}  // namespace fexp::app
