// SPDX-License-Identifier: Apache-2.0
#include "app/ranks.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cstdlib>
#include <exception>
#include <stdexcept>
#include <thread>

#include "base/byte_stream.hpp"
#include "coordinator/places.hpp"
#include "parallel/parallel.hpp"

namespace fexp::app {

namespace {

/// What a rank says of itself when a world begins.
struct Introduction {
  std::string name;
  std::string version;
  int threads{};
  int native_threads{};
  bool computes{true};

  [[nodiscard]] Bytes pack() const {
    ByteWriter out;
    out.text(name);
    out.text(version);
    out.value(threads);
    out.value(native_threads);
    out.value(computes);
    return out.take();
  }
  [[nodiscard]] static Introduction unpack(const Bytes& bytes) {
    ByteReader in(bytes);
    Introduction one;
    one.name = in.text();
    one.version = in.text();
    one.threads = in.value<int>();
    one.native_threads = in.value<int>();
    one.computes = in.value<bool>();
    return one;
  }
};

/// "c1", and for a second rank there "c1#2".
std::string free_name(const std::string& name, const std::vector<cluster::Machine>& taken) {
  std::string text = name;
  for (int number = 2; std::ranges::find(taken, text, &cluster::Machine::name) != taken.end(); ++number) {
    text = fmt::format("{}#{}", name, number);
  }
  return text;
}

}  // namespace

std::string machine_name() {
  const char* given = std::getenv("FEXP_HOST");  // NOLINT(concurrency-mt-unsafe)
  if (given != nullptr && *given != '\0') {
    return given;
  }
  return coordinator::own_name();
}

Ranks::Ranks() {
  if (cluster::is_mpi_process()) {
    mpi_.emplace();
    communicator_ = mpi_->communicator();
  } else {
    communicator_ = std::make_shared<cluster::LoneCommunicator>();
  }
}

int Ranks::threads(int asked) const {
  return asked > 0 || !mpi_ ? asked : cluster::fair_threads(mpi_->machine_size(), mpi_->machine_rank());
}

cluster::World Ranks::join(const WorldSettings& settings) {
  if (settings.latency_seconds > 0.0 && mpi_) {
    communicator_ = std::make_shared<cluster::SlowCommunicator>(
        mpi_->communicator(), std::chrono::duration<double>(settings.latency_seconds));
  }
  Introduction own;
  own.name = machine_name();
  own.version = FEXP_VERSION;
  own.threads = parallel::thread_count();
  own.native_threads = static_cast<int>(std::thread::hardware_concurrency());
  own.computes = !(settings.writer_only && rank() == 0);
  cluster::World world;
  world.communicator = communicator_;
  world.rule = settings.rule;
  const std::vector<Bytes> all = communicator_->all_gather(own.pack());
  for (std::size_t r = 0; r < all.size(); ++r) {
    const Introduction one = Introduction::unpack(all[r]);
    if (one.version != own.version) {
      throw std::runtime_error(
          fmt::format("fexp {} runs here and fexp {} on {}; cure: install one version on all machines", own.version,
                      one.version, one.name));
    }
    if (one.computes) {
      cluster::Machine machine;
      machine.name = free_name(one.name, world.machines);
      machine.rank = static_cast<int>(r);
      machine.threads = one.threads;
      machine.native_threads = one.native_threads;
      machine.speed = one.threads;
      world.machines.push_back(machine);
    }
  }
  return world;
}

Bytes Ranks::from_first(std::span<const std::byte> bytes) {
  return communicator_->all_gather(is_first() ? bytes : std::span<const std::byte>{}).front();
}

bool Ranks::all(bool good) {
  const Bytes own(1, static_cast<std::byte>(good));
  const std::vector<std::size_t> sizes(static_cast<std::size_t>(size()), 1);
  return std::ranges::all_of(communicator_->all_gather(own, sizes), [](std::byte b) { return b != std::byte{}; });
}

void Ranks::on_first(const std::function<void()>& work) {
  std::exception_ptr failed;
  if (is_first()) {
    try {
      work();
    } catch (...) {
      failed = std::current_exception();
    }
  }
  const bool good = all(!failed);
  if (failed) {
    std::rethrow_exception(failed);
  }
  if (!good) {
    throw EndedElsewhere{};
  }
}

Case Ranks::load(const std::filesystem::path& deck, io::InputFiles& files) {
  if (!several()) {
    return load_case(deck, files);
  }
  std::optional<Case> loaded;
  std::vector<std::byte> packed;
  on_first([&] {
    loaded.emplace(load_case(deck, files));
    packed = files.pack();
  });
  packed = from_first(packed);
  if (loaded) {
    return *std::move(loaded);
  }
  files = io::InputFiles::unpack(packed, "the files of rank 0");
  return load_case(files.deck(), files);
}

}  // namespace fexp::app
