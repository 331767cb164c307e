// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <string>
#include <string_view>

/// Where the processes of a cluster run find each other and keep what must outlive a world. A run has an id of 16
/// hexadecimal digits, the same on all machines. Paths contain the machine's name, so that several machines may share
/// one file system in memory.
namespace fexp::coordinator {

/// A new id, different from every other one.
[[nodiscard]] std::string new_run_id();
/// 16 hexadecimal digits.
[[nodiscard]] bool is_run_id(std::string_view text);

/// /dev/shm/fexp-UID/RUNID: what the run keeps in memory.
[[nodiscard]] std::filesystem::path run_memory(std::string_view run_id);
/// /dev/shm/fexp-UID/RUNID/MACHINE
[[nodiscard]] std::filesystem::path machine_memory(std::string_view run_id, std::string_view machine);
/// Touched by the machine's worker several times a second, by a thread that waits for nothing else.
[[nodiscard]] std::filesystem::path heartbeat_file(std::string_view run_id, std::string_view machine);
/// The machine's own snapshots and those it keeps for its buddy.
[[nodiscard]] std::filesystem::path snapshot_folder(std::string_view run_id, std::string_view machine);
/// Held with flock by the machine's worker while it may write snapshots: the next world's worker waits for it.
[[nodiscard]] std::filesystem::path worker_lock(std::string_view run_id, std::string_view machine);

/// Makes the directory and those above it, open to this user alone. Throws OutputError, also when somebody else owns
/// the directory.
void make_private_directory(const std::filesystem::path& path);

/// Folder of the sockets of this user's coordinators: $XDG_RUNTIME_DIR/fexp, or /tmp/fexp-UID when there is none.
[[nodiscard]] std::filesystem::path socket_folder();
/// Longest path a socket may have, in bytes.
inline constexpr std::size_t longest_socket_path = 107;
[[nodiscard]] std::filesystem::path socket_file(std::string_view run_id);

/// Name of this machine as the system knows it.
[[nodiscard]] std::string own_name();
/// Whether an address (a name or a number) means this machine. Asks no name server.
[[nodiscard]] bool is_own_address(std::string_view address);

}  // namespace fexp::coordinator
