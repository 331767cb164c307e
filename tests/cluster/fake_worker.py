#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Takes the worker's part in tests of the coordinator: counts steps instead of computing, without MPI.

usage: fake_worker.py worker --run-id ID --world K --socket PATH [--threads N] [--writer-only]

The ranks meet after every epoch in files beside the run's memory, so a rank that does not run holds up all of them, as
a reduction would. FAKE_STEPS: steps of the run; FAKE_EPOCH: seconds that an epoch of 10 steps takes. Files in the
directory of the run change what rank 0 does: "full" makes it end with an error of output, "silent" keeps it from
starting, "wrong" makes it end before it starts, "finish" makes the run complete after the present epoch.
"""
import argparse
import json
import os
import socket
import sys
import threading
import time
from pathlib import Path

EPOCH = 10


class Ranks:
    """The place where the ranks of a world meet."""

    def __init__(self, folder, world, rank, count):
        self.folder, self.world, self.rank, self.count = folder, world, rank, count
        folder.mkdir(parents=True, exist_ok=True)

    def put(self, name, text):
        path = self.folder / f"{self.world}-{name}"
        fresh = path.with_suffix(f".{self.rank}")
        fresh.write_text(str(text), encoding="utf-8")
        fresh.rename(path)

    def get(self, name):
        try:
            return (self.folder / f"{self.world}-{name}").read_text(encoding="utf-8")
        except FileNotFoundError:
            return ""

    def follow(self):
        """The other ranks: take part in every epoch until rank 0 ends the world."""
        while not self.get("end"):
            epoch = self.get("epoch")
            if epoch != self.get(f"done{self.rank}"):
                self.put(f"done{self.rank}", epoch)
            time.sleep(0.005)

    def lead(self, epoch, interrupted):
        """Rank 0: one epoch; returns early when `interrupted` says so."""
        self.put("epoch", epoch)
        others = range(1, self.count)
        while any(self.get(f"done{rank}") != str(epoch) for rank in others):
            if interrupted():
                return
            time.sleep(0.005)


class Channel:
    def __init__(self, path, world):
        self.socket = socket.socket(socket.AF_UNIX)
        self.socket.connect(path)
        self.text = b""
        self.lost = False
        self.command = ""
        self.send({"hello": "world", "world": world})

    def send(self, message):
        try:
            self.socket.sendall(json.dumps(message).encode() + b"\n")
        except OSError:
            self.lost = True

    def poll(self, seconds=0.0):
        self.socket.settimeout(seconds)
        while b"\n" not in self.text and not self.lost:
            try:
                more = self.socket.recv(65536)
            except (BlockingIOError, TimeoutError):
                return None
            except OSError:
                more = b""
            self.lost = not more
            self.text += more
        line, _, self.text = self.text.partition(b"\n")
        return json.loads(line) if line else None

    def is_lost(self):
        """Takes what has come; a command is kept."""
        self.command = (self.poll() or {}).get("command", self.command)
        return self.lost


def beat(path, launcher):
    """Shows that it is alive, until its launch daemon is gone: MPI ends a process then, whatever it waits for."""
    path.parent.mkdir(parents=True, exist_ok=True)
    while os.getppid() == launcher:
        path.touch()
        time.sleep(0.2)
    os._exit(1)


def lead(arguments, ranks):
    channel = Channel(arguments.socket, arguments.world)
    greeting = channel.poll(10.0)
    run = Path(greeting["run"])
    snapshot = ranks.folder / "snapshot"
    step = int(snapshot.read_text(encoding="utf-8")) if snapshot.exists() else 0
    while (run / "silent").exists():
        time.sleep(0.05)
    if (run / "wrong").exists():
        print("fexp: cannot read the deck", file=sys.stderr)
        ranks.put("end", "wrong")
        sys.exit(7)
    channel.send({"event": "started", "step": step, "time": 0.1 * step})
    events = [event for event in greeting["events"] if event > step]
    reason = ""
    while not reason and step < int(os.environ.get("FAKE_STEPS", "200")) and not (run / "finish").exists():
        time.sleep(float(os.environ.get("FAKE_EPOCH", "0.05")))
        ranks.lead(step + EPOCH, channel.is_lost)
        if (run / "full").exists():
            reason = "output_error"
            break
        step += EPOCH
        snapshot.with_suffix(".new").write_text(str(step), encoding="utf-8")
        snapshot.with_suffix(".new").rename(snapshot)
        channel.send({"event": "status", "step": step, "time": 0.1 * step, "islands": 3})
        lost = channel.is_lost()
        reason = {"reform": "reform", "stop": "interrupted"}.get(channel.command, "")
        if lost:
            reason = "lost_coordinator"
        elif not reason and any(event <= step for event in events):
            reason = "reform"
    reason = reason or "completed"
    if reason == "completed":
        summary = {"completed": True, "steps": step, "machines": greeting["machines"]}
        (run / "summary.json").write_text(json.dumps(summary) + "\n", encoding="utf-8")
    channel.send({"event": "ended", "reason": reason, "exit_code": 130 if reason == "interrupted" else 0,
                  "message": "no space left" if reason == "output_error" else "", "step": step})
    ranks.put("end", reason)


def main():
    parser = argparse.ArgumentParser()
    parser.add_argument("worker", choices=["worker"])
    parser.add_argument("--run-id", required=True)
    parser.add_argument("--world", type=int, required=True)
    parser.add_argument("--socket", required=True)
    parser.add_argument("--threads", type=int)
    parser.add_argument("--writer-only", action="store_true")
    arguments = parser.parse_args()
    memory = Path(f"/dev/shm/fexp-{os.getuid()}") / arguments.run_id
    memory.parent.mkdir(mode=0o700, exist_ok=True)
    rank, count = int(os.environ["OMPI_COMM_WORLD_RANK"]), int(os.environ["OMPI_COMM_WORLD_SIZE"])
    alive = memory / os.environ["FEXP_HOST"] / "alive"
    threading.Thread(target=beat, args=(alive, os.getppid()), daemon=True).start()
    ranks = Ranks(memory / "_ranks", arguments.world, rank, count)
    if rank == 0:
        lead(arguments, ranks)
    else:
        ranks.follow()


if __name__ == "__main__":
    main()
