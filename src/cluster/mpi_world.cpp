// SPDX-License-Identifier: Apache-2.0
#include "cluster/mpi_world.hpp"

#include <mpi.h>
#include <sched.h>
#include <unistd.h>

#include <algorithm>
#include <cstdlib>
#include <limits>
#include <thread>

namespace fexp::cluster {

namespace {

constexpr int tag = 1;
/// MPI counts in int. Longer messages go in pieces of this size; a shorter piece, perhaps an empty one, is the last.
constexpr std::size_t piece = std::size_t{1} << 28U;

void send(const Parcel& parcel, std::vector<MPI_Request>& requests) {
  for (std::size_t sent = 0;; sent += piece) {
    const std::size_t count = std::min(piece, parcel.bytes.size() - sent);
    MPI_Isend(parcel.bytes.data() + sent, static_cast<int>(count), MPI_BYTE, parcel.rank, tag, MPI_COMM_WORLD,
              &requests.emplace_back());
    if (count < piece) {
      return;
    }
  }
}

Parcel receive(int source) {
  Parcel parcel{source, {}};
  for (int count = 0;;) {
    MPI_Message message{};
    MPI_Status status{};
    MPI_Mprobe(source, tag, MPI_COMM_WORLD, &message, &status);
    MPI_Get_count(&status, MPI_BYTE, &count);
    const std::size_t before = parcel.bytes.size();
    parcel.bytes.resize(before + static_cast<std::size_t>(count));
    MPI_Mrecv(parcel.bytes.data() + before, count, MPI_BYTE, &message, MPI_STATUS_IGNORE);
    if (static_cast<std::size_t>(count) < piece) {
      return parcel;
    }
  }
}

class MpiCommunicator final : public Communicator {
 public:
  MpiCommunicator(int rank, int size) : rank_(rank), size_(size) {}
  [[nodiscard]] int rank() const noexcept override { return rank_; }
  [[nodiscard]] int size() const noexcept override { return size_; }

 protected:
  Bytes do_all_gather(std::span<const std::byte> own, std::span<const std::size_t> sizes) override {
    std::size_t total = 0;
    for (const std::size_t one : sizes) {
      total += one;
    }
    Bytes all(total);
    if (total <= static_cast<std::size_t>(std::numeric_limits<int>::max())) {
      std::vector<int> counts, offsets;
      int offset = 0;
      for (const std::size_t one : sizes) {
        counts.push_back(static_cast<int>(one));
        offsets.push_back(offset);
        offset += counts.back();
      }
      MPI_Allgatherv(own.data(), static_cast<int>(own.size()), MPI_BYTE, all.data(), counts.data(), offsets.data(),
                     MPI_BYTE, MPI_COMM_WORLD);
      return all;
    }
    std::size_t offset = 0;
    for (int r = 0; r < size_; ++r) {
      const std::size_t end = offset + sizes[static_cast<std::size_t>(r)];
      if (r == rank_) {
        std::copy(own.begin(), own.end(), all.begin() + static_cast<std::ptrdiff_t>(offset));
      }
      for (; offset < end; offset += std::min(piece, end - offset)) {
        MPI_Bcast(all.data() + offset, static_cast<int>(std::min(piece, end - offset)), MPI_BYTE, r, MPI_COMM_WORLD);
      }
    }
    return all;
  }

  std::vector<Parcel> do_exchange(const std::vector<Parcel>& parcels, std::span<const int> sources) override {
    std::vector<MPI_Request> requests;
    for (const Parcel& parcel : parcels) {
      send(parcel, requests);
    }
    std::vector<Parcel> come;
    for (const int source : sources) {
      come.push_back(receive(source));
    }
    MPI_Waitall(static_cast<int>(requests.size()), requests.data(), MPI_STATUSES_IGNORE);
    return come;
  }

 private:
  int rank_;
  int size_;
};

}  // namespace

bool is_mpi_process() {
  // What Open MPI's mpirun, srun with PMI-2 or PMIx, and Hydra set.
  return std::getenv("OMPI_COMM_WORLD_SIZE") != nullptr || std::getenv("PMIX_RANK") != nullptr ||
         std::getenv("PMI_RANK") != nullptr;
}

MpiWorld::MpiWorld() {
  // Open MPI's ranks spin while they wait; with more ranks and threads than cores that would stop the others' work.
  setenv("OMPI_MCA_mpi_yield_when_idle", "1", 0);
  int provided = 0;
  MPI_Init_thread(nullptr, nullptr, MPI_THREAD_SERIALIZED, &provided);
  MPI_Comm_rank(MPI_COMM_WORLD, &rank_);
  MPI_Comm_size(MPI_COMM_WORLD, &size_);
  MPI_Comm machine{};
  MPI_Comm_split_type(MPI_COMM_WORLD, MPI_COMM_TYPE_SHARED, rank_, MPI_INFO_NULL, &machine);
  MPI_Comm_size(machine, &machine_size_);
  MPI_Comm_rank(machine, &machine_rank_);
  MPI_Comm_free(&machine);
}

MpiWorld::~MpiWorld() { MPI_Finalize(); }

std::unique_ptr<Communicator> MpiWorld::communicator() const { return std::make_unique<MpiCommunicator>(rank_, size_); }

void MpiWorld::abort(int exit_code) {
  MPI_Abort(MPI_COMM_WORLD, exit_code);
  std::_Exit(exit_code);
}

int fair_threads(int machine_size, int machine_rank) {
  const int all = std::max(1, static_cast<int>(sysconf(_SC_NPROCESSORS_ONLN)));
  cpu_set_t set;
  CPU_ZERO(&set);
  const int mine = sched_getaffinity(0, sizeof(set), &set) == 0 ? CPU_COUNT(&set) : all;
  if (mine < all) {
    return std::max(1, mine);
  }
  return std::max(1, all / machine_size + (machine_rank < all % machine_size ? 1 : 0));
}

}  // namespace fexp::cluster
