# SPDX-License-Identifier: Apache-2.0
"""A network of hosts on this machine, each with processes, memory and an address of its own. A switch joins them; cables
can be pulled and hosts frozen or switched off. Needs root and iproute2; what it makes goes away with this process.

The hosts see the files of this machine, except that a folder can be hidden from all but the first. lab_agent.py stands
in for ssh, whose server would run on every host.
"""

import os
import shutil
import signal
import socket
import subprocess
import sys
import threading
import time
from pathlib import Path

HERE = Path(__file__).resolve().parent
NETWORK = "10.77.0"
MPIRUN = (f"--mca btl tcp,self --mca btl_tcp_if_include {NETWORK}.0/24 --mca oob_tcp_if_include {NETWORK}.0/24")


def enter_own_network():
    """Starts this program again in a network and a table of mounts that nobody else has. Without the means for that,
    says so and ends it with exit code 77, which is known as a skipped test."""
    if os.environ.get("FEXP_LAB") == str(os.getpid()):
        return
    missing = [tool for tool in ("ip", "unshare", "nsenter", "mount") if not shutil.which(tool)]
    reason = "root is needed" if os.geteuid() != 0 else f"not found: {' '.join(missing)}" if missing else ""
    if not reason:
        attempt = subprocess.run(["unshare", "--net", "--mount", "--pid", "--fork", "--uts", "ip", "link", "add", "x",
                                  "type", "bridge"], check=False, capture_output=True, text=True)
        reason = attempt.stderr.strip() if attempt.returncode != 0 else ""
    if reason:
        print(f"skipped: no network of hosts can be made on this machine: {reason}")
        sys.exit(77)
    os.environ["FEXP_LAB"] = str(os.getpid())
    os.execvp("unshare", ["unshare", "--net", "--mount", sys.executable, *sys.argv])


def ip(*words):
    subprocess.run(["ip", *map(str, words)], check=True)


class Server(threading.Thread):
    """Runs commands on the hosts for lab_agent.py: what an ssh server does on each of them. A command lives on when the
    agent that asked for it is killed."""

    def __init__(self, owner, path):
        super().__init__(daemon=True)
        self.lab = owner
        self.socket = socket.socket(socket.AF_UNIX)
        self.socket.bind(str(path))
        self.socket.listen()

    def run(self):
        while True:
            try:
                connection = self.socket.accept()[0]
            except OSError:
                return
            threading.Thread(target=self.serve, args=(connection,), daemon=True).start()

    def serve(self, connection):
        with connection:
            text, descriptors, _, _ = socket.recv_fds(connection, 1 << 20, 3)
            address, command = text.decode().split(" ", 1)
            name = f"c{address.rsplit('.', 1)[1]}"
            code = 255
            try:
                if name in self.lab.hosts and name not in self.lab.frozen:
                    code = subprocess.run(self.lab.command_on(name, ["sh", "-c", command]), check=False, cwd="/",
                                          stdin=descriptors[0], stdout=descriptors[1], stderr=descriptors[2],
                                          start_new_session=True).returncode
                else:
                    connection.recv(1)  # Until the agent is tired of waiting
            finally:
                for descriptor in descriptors:
                    os.close(descriptor)
            try:
                connection.sendall(str(code).encode())
            except OSError:
                pass  # The agent was killed

    def close(self):
        self.socket.shutdown(socket.SHUT_RDWR)
        self.socket.close()


class Lab:
    """Hosts c1, c2 ... with addresses 10.77.0.1, 10.77.0.2 ..."""

    def __init__(self, count, folder, hidden):
        """`folder`: for the lab's own files; `hidden`: a folder that only the first host sees."""
        self.folder = folder
        self.count = count
        folder.mkdir()
        self.server = Server(self, folder / "server")
        self.server.start()
        ip("link", "set", "lo", "up")
        ip("link", "add", "switch", "type", "bridge")
        ip("link", "set", "switch", "up")
        self.hosts, self.frozen = {}, set()
        for number in range(1, count + 1):
            self.switch_on(number, hidden)

    def switch_on(self, number, hidden):
        name = f"c{number}"
        hide = f"mount -t tmpfs hidden {hidden}; " if number > 1 else ""
        # Its own memory, and the proc file system of its own processes.
        command = (f"mount --make-rprivate /; mount -t tmpfs memory /dev/shm; {hide}mount -t proc proc /proc; "
                   f"hostname {name}; echo ready; exec sleep infinity >/dev/null")
        host = subprocess.Popen(["unshare", "--net", "--mount", "--uts", "--pid", "--fork", "--kill-child", "sh", "-ec",
                                 command], stdout=subprocess.PIPE, text=True)
        with host.stdout:
            if host.stdout.readline() != "ready\n":
                raise RuntimeError(f"host {name} does not start")
        children = Path(f"/proc/{host.pid}/task/{host.pid}/children").read_text(encoding="utf-8")
        self.hosts[name] = host, int(children.split()[0])
        first = self.hosts[name][1]
        ip("link", "add", f"cable{number}", "type", "veth", "peer", "name", "eth0", "netns", first)
        ip("link", "set", f"cable{number}", "master", "switch", "up")
        for words in (("addr", "add", f"{NETWORK}.{number}/24", "dev", "eth0"), ("link", "set", "eth0", "up"),
                      ("link", "set", "lo", "up")):
            subprocess.run(["nsenter", "-t", str(first), "-n", "ip", *words], check=True)

    def command_on(self, name, words):
        return ["nsenter", "-t", str(self.hosts[name][1]), "--net", "--mount", "--uts", "--pid",
                *map(str, words)]

    def processes_of(self, name, word):
        """Processes of a host with this word in their command line, by the ids they have here."""
        namespace = os.readlink(f"/proc/{self.hosts[name][1]}/ns/pid")
        found = []
        for path in Path("/proc").glob("[0-9]*"):
            try:
                if os.readlink(path / "ns/pid") == namespace and word in (path / "cmdline").read_bytes().decode(
                        errors="replace").split("\0"):
                    found.append(int(path.name))
            except OSError:
                continue
        return found

    def cut(self, name):
        ip("link", "set", f"cable{name[1:]}", "down")

    def mend(self, name):
        ip("link", "set", f"cable{name[1:]}", "up")

    def freeze(self, name, number=signal.SIGSTOP):
        """Nothing runs there any more, and nothing can be started; only the network card lives."""
        first = self.hosts[name][1]
        namespace = os.readlink(f"/proc/{first}/ns/pid")
        (self.frozen.add if number == signal.SIGSTOP else self.frozen.discard)(name)
        for path in Path("/proc").glob("[0-9]*"):
            try:
                if int(path.name) != first and os.readlink(path / "ns/pid") == namespace:
                    os.kill(int(path.name), number)
            except OSError:
                continue

    def thaw(self, name):
        self.freeze(name, signal.SIGCONT)

    def switch_off(self, name):
        """All its processes and its memory are gone at once."""
        self.cut(name)
        host = self.hosts.pop(name)[0]
        host.kill()
        host.wait()

    def close(self):
        for name in list(self.hosts):
            self.switch_off(name)
        time.sleep(0.1)
        ip("link", "del", "switch")
        for number in range(1, self.count + 1):
            subprocess.run(["ip", "link", "del", f"cable{number}"], check=False, capture_output=True)
        self.server.close()
