# SPDX-License-Identifier: Apache-2.0
"""Cluster runs with workers that compute, compared with a run on one machine."""

import json
import math
import os
import re
import shutil
import subprocess
import tempfile
from pathlib import Path

import cluster
import program
import results

ROOT = {"OMPI_ALLOW_RUN_AS_ROOT": "1", "OMPI_ALLOW_RUN_AS_ROOT_CONFIRM": "1"} if os.getuid() == 0 else {}
KEEP = tempfile.TemporaryDirectory(prefix="fexp-reference-")
REFERENCES = Path(KEEP.name)
EXAMPLES = cluster.HERE.parent.parent / "examples"


def write_deck_that_takes(seconds, deck_file, target):
    """Writes a deck as long as one thread of this machine computes for so many seconds, but not shorter than it is. What
    happens to machines during a run takes time of its own, which must not be longer than the run is on a fast machine."""
    text = deck_file.read_text(encoding="utf-8")
    duration = re.compile(r"^duration = ([0-9.]+)$", re.MULTILINE)
    given = float(duration.search(text)[1])
    target.write_text(duration.sub(f"duration = {given / 10}", text), encoding="utf-8")
    trial = json.loads(subprocess.run([program.PROGRAM, "run", target, "--out", target.with_suffix(".trial"), "--json",
                                       "--quiet", "--threads", "1"], check=True, capture_output=True, text=True).stdout)
    times = math.ceil(seconds / (10 * trial["wall_seconds"]))
    target.write_text(duration.sub(f"duration = {given * max(times, 1)}", text), encoding="utf-8")


class Case(cluster.Case):
    """A test of one deck; `deck_file` names it. The run on one machine is made once for all tests of a deck."""

    deck_file = cluster.HERE / "box.toml"
    run_words = ("--hash-every", "10")
    seconds = 0.0  # How long one thread has to compute, at least

    @classmethod
    def setUpClass(cls):
        super().setUpClass()
        cls.reference = REFERENCES / cls.deck_file.stem
        cls.deck = cls.deck_file
        if cls.seconds:
            cls.deck = REFERENCES / f"{cls.deck_file.stem}_{cls.seconds}.toml"
            cls.reference = cls.deck.with_suffix(".run")
            if not cls.deck.exists():
                write_deck_that_takes(cls.seconds, cls.deck_file, cls.deck)
        if cls.reference.exists():
            return
        result = subprocess.run([program.PROGRAM, "run", cls.deck, "--out", cls.reference, "--json", "--quiet",
                                 *cls.run_words], check=False, capture_output=True, text=True, timeout=200)
        if result.returncode != 0:
            raise RuntimeError(f"the run on one machine failed: {result.stderr}")

    def setUp(self):
        super().setUp()
        del self.environment["FEXP_WORKER"]
        self.environment.update(ROOT)
        shutil.copy(self.deck, self.folder / "deck.toml")

    def write_deck(self, name="deck.toml", **changes):
        """There is one already."""
        return name

    def start_real(self, *names, words=(), out="run", threads=1, **changes):
        self.local_hosts(*names)
        return self.start_run("--threads", str(threads), "--json", *self.run_words, *words, out=out, **changes)

    def resume(self):
        return self.start("cluster", "resume", "run", "--json", env=self.environment)

    def check_equal(self, out="run", reference=None):
        found = results.differences(self.folder / out, reference or self.reference)
        self.assertEqual(found, [], f"{found}\n{self.log(out)}")

    def finish(self, process, out="run", seconds=90):
        """The run completes and is equal to the one on one machine; nothing of it is left in memory. Its summary."""
        output, error = process.communicate(timeout=seconds)
        self.assertEqual(process.returncode, 0, error + self.log(out))
        self.check_equal(out)
        record = self.record(out)
        self.assertEqual(record["state"], "completed")
        self.assertEqual(self.processes("worker", record["run_id"]), [])
        self.assertEqual(list((self.folder / "runtime/fexp").glob("*.sock")), [])
        self.assertFalse((cluster.MEMORY / record["run_id"]).exists(), "something is left in memory")
        self.assertEqual(list((self.folder / out).glob("checkpoints/*")), [])
        return json.loads(output)

    def wait_for_step(self, step, process, out="run"):
        """Until the run, as far as the coordinator knows, has come beyond a step."""
        def is_there():
            status = self.cluster("status", "--run", out, "--json")
            return status.returncode == 0 and json.loads(status.stdout)["step"] >= step
        self.wait_for(is_there, process=process)

    def memory(self, machine, out="run"):
        return cluster.MEMORY / self.record(out)["run_id"] / machine

    def wait_for_snapshot(self, process, machines, out="run"):
        """Until there is a snapshot, with a copy at the buddy, of so many machines."""
        def is_there():
            files = (cluster.MEMORY / self.record(out)["run_id"]).glob("*/snapshots/*.fexp")
            found = [path.name.split("-")[1] for path in files]
            return found and found.count(min(found)) == 2 * machines
        self.wait_for(is_there, process=process)

    def mpirun_plain(self, ranks, *words, **options):
        """The program on ranks of a plain mpirun."""
        return subprocess.run(["mpirun", "--oversubscribe", "-n", str(ranks), program.PROGRAM, *map(str, words)],
                              check=False, capture_output=True, text=True, cwd=self.folder, timeout=200,
                              env={**self.environment, **options})



main = program.main
