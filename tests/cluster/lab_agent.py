#!/usr/bin/python3
# SPDX-License-Identifier: Apache-2.0
"""Takes ssh's part in a network of lab.py: lab_agent.py LAB [options] ADDRESS COMMAND... runs the command on that host, if
a packet gets there and back."""
import socket
import sys

words = sys.argv[2:]
while words[0].startswith("-"):
    words.pop(0)
address, command = words[0], " ".join(words[1:])
try:
    socket.create_connection((address, 9), timeout=3.0)
except ConnectionRefusedError:
    pass  # It is there, and nobody listens at this port
except OSError as error:
    print(f"ssh: connect to host {address} port 22: {error.strerror or 'Connection timed out'}", file=sys.stderr)
    sys.exit(255)
server = socket.socket(socket.AF_UNIX)
server.connect(f"{sys.argv[1]}/server")
socket.send_fds(server, [f"{address} {command}".encode()], [0, 1, 2])
sys.exit(int(server.recv(16) or b"255"))
