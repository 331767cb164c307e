# SPDX-License-Identifier: Apache-2.0
"""Starts a coordinator with workers that only count steps (fake_worker.py), and watches what becomes of them."""

import json
import os
import shutil
import signal
import sys
import time
from pathlib import Path

HERE = Path(__file__).resolve().parent
sys.path.insert(0, str(HERE.parent / "app"))
import program  # noqa: E402  (from the folder above)

MEMORY = Path(f"/dev/shm/fexp-{os.getuid()}")


def environment_of(process):
    try:
        text = Path(f"/proc/{process}/environ").read_bytes()
    except OSError:
        return {}
    return dict(line.split("=", 1) for line in text.decode(errors="replace").split("\0") if "=" in line)


def is_alive(process):
    """It runs or could run; what nobody has waited for is dead all the same."""
    try:
        return Path(f"/proc/{process}/stat").read_text(encoding="utf-8").rsplit(")", 1)[1].split()[0] not in "ZX"
    except OSError:
        return False


def parent_of(process):
    text = Path(f"/proc/{process}/stat").read_text(encoding="utf-8", errors="replace")
    return int(text.rsplit(")", 1)[1].split()[1])


def processes_in(folder):
    """Processes that work in this folder, by their ids."""
    found = []
    for path in Path("/proc").glob("[0-9]*/cwd"):
        try:
            if path.resolve() == folder and is_alive(path.parent.name):
                found.append(int(path.parent.name))
        except OSError:
            continue
    return found


class Case(program.Case):
    """A test with a deck, a list of machines and at most a few runs."""

    def setUp(self):
        super().setUp()
        self.write_deck()
        (self.folder / "runtime").mkdir(mode=0o700)
        self.environment = {**os.environ, "XDG_RUNTIME_DIR": str(self.folder / "runtime"),
                            "FEXP_WORKER": f"{sys.executable} {HERE / 'fake_worker.py'}",
                            "FAKE_HOSTS": str(self.folder), "FAKE_STEPS": "1000000", "FAKE_EPOCH": "0.05"}
        self.addCleanup(self.clean_up)

    def clean_up(self):
        for path in self.folder.glob("*/cluster.json"):
            run_id = json.loads(path.read_text(encoding="utf-8"))["run_id"]
            for process in self.processes("worker", run_id):
                os.kill(process, signal.SIGKILL)
            shutil.rmtree(MEMORY / run_id, ignore_errors=True)

    def write_hosts(self, *lines):
        (self.folder / "hosts").write_text("".join(f"{line}\n" for line in lines), encoding="utf-8")

    def far_hosts(self, *names):
        """Machines far1, far2, ... that are reached through agent.sh, or others as write_hosts takes them. Addresses, as
        mpirun asks the name server for names, and may wait for seconds."""
        self.write_hosts(*(f"{name}=198.51.100.{name[3:]}" if name.startswith("far") else name for name in names))

    def local_hosts(self, *names):
        self.write_hosts(*(f"{name}=localhost" for name in names))

    def cluster(self, *words):
        return self.fexp("cluster", *words, env=self.environment)

    def start_run(self, *words, out="run", **changes):
        """Starts a run on the machines of the hosts file."""
        hosts = [] if "--discover" in words else ["--hosts", "hosts"]
        return self.start("cluster", "run", "deck.toml", "--out", out, *hosts, *words,
                          env={**self.environment, **changes})

    def wait_for(self, condition, seconds=20.0, process=None):
        end = time.monotonic() + seconds
        while not condition():
            if process is not None and process.poll() is not None:
                self.fail(f"it has ended: {process.communicate()}")
            if time.monotonic() > end:
                self.fail(f"waited for too long; the log says\n{self.log()}")
            time.sleep(0.02)

    def log(self, out="run"):
        path = self.folder / out / "cluster.log"
        return path.read_text(encoding="utf-8") if path.exists() else ""

    def record(self, out="run"):
        return json.loads((self.folder / out / "cluster.json").read_text(encoding="utf-8"))

    def status(self, out="run"):
        result = self.cluster("status", "--run", out, "--json")
        self.assertEqual(result.returncode, 0, result.stderr)
        return json.loads(result.stdout)

    def states(self, out="run"):
        return {machine["name"]: machine["state"] for machine in self.status(out)["machines"]}

    def wait_for_world(self, world, process, out="run", seconds=20.0):
        """Until this world, or a later one, has made steps."""
        def is_there():
            if f"world {world} is stepping" not in self.log(out):
                return False
            status = self.status(out)
            return status["phase"] == "running" and status["worker"].get("step", 0) > 0
        self.wait_for(is_there, seconds, process)

    def machines_of_world(self, world, out="run"):
        for entry in self.record(out)["worlds"]:
            if entry["world"] == world:
                return [machine.split("=")[0] for machine in entry["machines"]]
        return None

    def first_step(self, world, out="run"):
        text = self.log(out).split(f"world {world} is stepping, from step ")[1]
        return int(text.split("\n")[0])

    def processes(self, word, run_id):
        """Ids of all processes whose command line has the word and the run's id, mpirun itself excepted."""
        found = []
        for path in Path("/proc").glob("[0-9]*/cmdline"):
            try:
                words = path.read_bytes().decode(errors="replace").split("\0")
            except OSError:
                continue
            if word in words and run_id in words and "mpirun" not in words:
                found.append(int(path.parent.name))
        return found

    def worker(self, machine, out="run"):
        """Id of the worker on a machine."""
        mine = [process for process in self.processes("worker", self.record(out)["run_id"])
                if environment_of(process).get("FEXP_HOST") == machine]
        self.assertEqual(len(mine), 1, f"workers on {machine}")
        return mine[0]

    def mpirun(self, process):
        """Id of the mpirun that a coordinator has started."""
        for path in Path("/proc").glob("[0-9]*/stat"):
            try:
                text = path.read_text(encoding="utf-8", errors="replace")
            except OSError:
                continue
            name, rest = text.split("(", 1)[1].rsplit(")", 1)
            if name == "mpirun" and int(rest.split()[1]) == process.pid:
                return int(path.parent.name)
        return self.fail("no mpirun")

    def finish(self, process, out="run"):
        """Lets the run complete; nothing of it is left on the machine."""
        (self.folder / out / "finish").touch()
        output, error = process.communicate(timeout=20)
        self.assertEqual(process.returncode, 0, error)
        record = self.record(out)
        self.assertEqual(record["state"], "completed")
        self.assertEqual(record["worlds"][-1]["ended"], "completed")
        self.assertEqual(self.processes("worker", record["run_id"]), [])
        self.assertEqual(list((self.folder / "runtime/fexp").glob("*.sock")), [])
        memory = MEMORY / record["run_id"]
        self.assertEqual([path.name for path in memory.glob("*") if path.name != "_ranks"], [])
        return output, error


main = program.main
