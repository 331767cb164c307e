// SPDX-License-Identifier: Apache-2.0
#include "app/memory_snapshots.hpp"

#include <fmt/format.h>
#include <sys/stat.h>

#include <algorithm>
#include <charconv>
#include <fstream>
#include <map>
#include <set>
#include <tuple>
#include <utility>

#include "base/hash.hpp"
#include "io/atomic_file.hpp"
#include "io/output_error.hpp"

namespace fexp::app {

namespace {

namespace fs = std::filesystem;

constexpr std::size_t moments_kept = 2;

std::string file_name(const SavedRun& saved) { return fmt::format("step-{:012}-{}.fexp", saved.step, saved.part); }

/// The step in a name that file_name made; negative when it is none.
std::int64_t step_of(const fs::path& path) {
  const std::string name = path.filename().string();
  std::int64_t step = -1;
  if (name.starts_with("step-") && name.ends_with(".fexp")) {
    std::from_chars(name.data() + 5, name.data() + name.size(), step);
  }
  return step;
}

/// Tells moments apart: two worlds may have saved the same step in other parts, or with other bodies in them.
struct Moment {
  std::int64_t step{};
  std::int64_t history{};
  std::vector<std::string> parts;
  [[nodiscard]] auto key() const { return std::tie(step, history, parts); }
  /// The latest first: clang 14 cannot walk the library's views backwards.
  friend bool operator<(const Moment& a, const Moment& b) { return a.key() > b.key(); }
  friend bool operator==(const Moment& a, const Moment& b) { return a.key() == b.key(); }
};

void pack(const Moment& moment, const std::string& part, ByteWriter& out) {
  out.value(moment.step);
  out.value(moment.history);
  out.text(part);
  out.value(static_cast<std::uint64_t>(moment.parts.size()));
  for (const std::string& one : moment.parts) {
    out.text(one);
  }
}

}  // namespace

MemorySnapshots::MemorySnapshots(fs::path folder, const std::string& host, cluster::Communicator& communicator)
    : folder_(std::move(folder)), communicator_(communicator) {
  std::error_code error;
  fs::create_directories(folder_, error);
  const std::vector<Bytes> hosts = communicator_.all_gather(std::as_bytes(std::span(host.data(), host.size())));
  const int size = communicator_.size();
  const auto buddy_of = [&](int rank) {
    // The next rank that is not lost together with this one, or the next one at least.
    for (int step = 1; step < size; ++step) {
      if (hosts[static_cast<std::size_t>((rank + step) % size)] != hosts[static_cast<std::size_t>(rank)]) {
        return (rank + step) % size;
      }
    }
    return (rank + 1) % size;
  };
  buddy_ = buddy_of(communicator_.rank());
  for (int r = 0; r < size; ++r) {
    if (r != communicator_.rank() && buddy_of(r) == communicator_.rank()) {
      kept_for_.push_back(r);
    }
  }
}

void MemorySnapshots::save(const cluster::Simulation& simulation, std::int64_t hash_every,
                           const std::optional<OutputMark>& mark) {
  // Rank 0 has written the outputs and knows how far they are, unless that has just failed.
  const Bytes told = communicator_.all_gather(mark ? mark->pack() : Bytes{}).front();
  if (told.empty()) {
    return;
  }
  SavedRun own;
  own.step = simulation.state().step;
  own.time = simulation.state().time;
  own.hash_every = hash_every;
  own.history = history_;
  own.mark = OutputMark::unpack(told, "the mark of rank 0");
  for (const cluster::Machine& machine : simulation.world().machines) {
    if (machine.present()) {
      own.parts.push_back(machine.name);
      own.part = machine.rank == simulation.rank() ? machine.name : own.part;
    }
  }
  std::vector<cluster::Parcel> parcels;
  if (!own.part.empty()) {
    own.piece = simulation.piece(simulation.own_bodies());
    if (buddy_ != communicator_.rank()) {
      parcels.push_back({buddy_, io::pack_sections(own.sections())});
    }
  } else if (buddy_ != communicator_.rank()) {
    parcels.push_back({buddy_, {}});
  }
  const std::vector<cluster::Parcel> come = communicator_.exchange(parcels, kept_for_);
  if (!own.part.empty()) {
    write(own);
  }
  for (const cluster::Parcel& parcel : come) {
    if (!parcel.bytes.empty()) {
      write(SavedRun::from(io::unpack_sections(parcel.bytes, "a buddy's snapshot"), "a buddy's snapshot"));
    }
  }
  remove_older(own.step);
}

void MemorySnapshots::write(const SavedRun& saved) const {
  const fs::path path = folder_ / file_name(saved);
  const fs::path fresh = path.string() + ".new";
  const std::vector<std::byte> bytes = io::pack_sections(saved.sections());
  std::ofstream file(fresh, std::ios::binary | std::ios::trunc);
  file.write(reinterpret_cast<const char*>(bytes.data()), static_cast<std::streamsize>(bytes.size()));
  file.close();
  std::error_code error;
  if (file) {
    fs::rename(fresh, path, error);
  } else {
    // Memory is full: the moment before stays, and the disk has checkpoints.
    fs::remove(fresh, error);
  }
}

/// Keeps the newest moments up to `step`, and nothing of a later one, which a lost world may have left.
void MemorySnapshots::remove_older(std::int64_t step) const {
  std::error_code error;
  std::vector<fs::path> files;
  std::set<std::int64_t> steps;
  for (const fs::directory_entry& entry : fs::directory_iterator(folder_, error)) {
    files.push_back(entry.path());
    if (const std::int64_t one = step_of(entry.path()); one >= 0 && one <= step) {
      steps.insert(one);
    }
  }
  while (steps.size() > moments_kept) {
    steps.erase(steps.begin());
  }
  for (const fs::path& file : files) {
    if (const std::int64_t one = step_of(file); one >= 0 && !steps.contains(one)) {
      fs::remove(file, error);
    }
  }
}

/// What this rank has, as far as it is sound.
std::vector<SavedRun> MemorySnapshots::present() const {
  std::vector<SavedRun> found;
  std::error_code error;
  for (const fs::directory_entry& entry : fs::directory_iterator(folder_, error)) {
    if (step_of(entry.path()) < 0) {
      continue;
    }
    try {
      found.push_back(SavedRun::from(io::read_sections(entry.path()), entry.path()));
    } catch (const io::OutputError&) {
      // One that was being written when its world was lost.
    }
  }
  return found;
}

std::optional<MemorySnapshots::Found> MemorySnapshots::newest(const TakeUps& take_ups) const {
  std::vector<SavedRun> own = present();
  ByteWriter out;
  out.value(static_cast<std::uint64_t>(own.size()));
  for (const SavedRun& saved : own) {
    pack({saved.step, saved.history, saved.parts}, saved.part, out);
  }
  // Who has which part of which moment.
  std::map<Moment, std::map<std::string, int>> moments;
  const std::vector<Bytes> all = communicator_.all_gather(out.bytes());
  for (std::size_t r = 0; r < all.size(); ++r) {
    ByteReader in(all[r]);
    const auto count = in.value<std::uint64_t>();
    for (std::uint64_t i = 0; i < count && in.sound(); ++i) {
      Moment moment;
      moment.step = in.value<std::int64_t>();
      moment.history = in.value<std::int64_t>();
      const std::string part = in.text();
      const auto parts = in.value<std::uint64_t>();
      for (std::uint64_t p = 0; p < parts && in.sound(); ++p) {
        moment.parts.push_back(in.text());
      }
      moments[moment].try_emplace(part, static_cast<int>(r));
    }
  }
  for (const auto& moment : moments) {
    const Moment& about = moment.first;
    const std::map<std::string, int>& holders = moment.second;
    if (!take_ups.keep(about.history, about.step) ||
        !std::ranges::all_of(about.parts, [&](const std::string& part) { return holders.contains(part); })) {
      continue;
    }
    Found found;
    found.step = about.step;
    for (SavedRun& saved : own) {
      if (Moment{saved.step, saved.history, saved.parts} == about && holders.at(saved.part) == communicator_.rank()) {
        found.parts.push_back(std::move(saved));
      }
    }
    // The lowest rank that has a part tells all what it says of the outputs.
    SavedRun head;
    if (!found.parts.empty()) {
      head = found.parts.front();
      head.piece.clear();
    }
    const Bytes told = found.parts.empty() ? Bytes{} : io::pack_sections(head.sections());
    for (const Bytes& bytes : communicator_.all_gather(told)) {
      if (!bytes.empty()) {
        found.about = SavedRun::from(io::unpack_sections(bytes, "a snapshot"), "a snapshot");
        break;
      }
    }
    return found;
  }
  return std::nullopt;
}

void MemorySnapshots::clear() const {
  std::error_code error;
  fs::remove_all(folder_, error);
}

}  // namespace fexp::app
