#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Progress: one refreshed line on a terminal, plain lines elsewhere, nothing when quiet.

usage: progress.py PROGRAM
"""
import fcntl
import os
import pty
import re
import struct
import subprocess
import termios
import time

import program

PIECES = ("%", "left", "time", "step", "dt", "energy error", "islands", "contacts", "element-steps/s")


class Progress(program.Case):
    """A run of a few seconds."""

    def setUp(self):
        super().setUp()
        self.name = self.write_deck(duration=12.0, cells=10, results_interval=20.0, history_interval=1.0)

    def on_terminal(self, columns, *words):
        """What the program writes to a terminal of so many columns."""
        ours, its = pty.openpty()
        fcntl.ioctl(its, termios.TIOCSWINSZ, struct.pack("HHHH", 24, columns, 0, 0))
        text = b""
        with subprocess.Popen([program.PROGRAM, "run", self.name, *words], stderr=its, stdout=subprocess.DEVNULL,
                              cwd=self.folder) as process:
            os.close(its)
            try:
                while piece := os.read(ours, 65536):
                    text += piece
            except OSError:  # the other end is closed
                pass
        os.close(ours)
        self.assertEqual(process.returncode, 0)
        return text.decode()

    def test_a_terminal_has_one_line_that_is_refreshed_and_removed(self):
        text = self.on_terminal(250)
        self.assertGreater(text.count("\r"), 3)
        self.assertNotIn("\n", text)
        first = text.split("\r")[1]
        for piece in PIECES:
            self.assertIn(piece, first)
        self.assertTrue(text.endswith("\r\x1b[K"))

    def test_a_narrow_terminal_is_not_scrolled(self):
        for line in self.on_terminal(40).split("\r"):
            self.assertLess(len(line.removesuffix("\x1b[K")), 40)

    def test_elsewhere_whole_lines_come_at_a_modest_rate(self):
        duration, seconds = 12.0, 0.0
        while seconds < 3.0:  # no line is due in a run of less than a second, however fast the machine
            self.write_deck(duration=duration, cells=10, results_interval=20.0, history_interval=1.0)
            begin = time.monotonic()
            result = self.fexp("run", self.name)
            seconds = time.monotonic() - begin
            duration *= 4.0
        lines = result.stderr.splitlines()
        self.assertTrue(1 <= len(lines) <= min(20.0, seconds), result.stderr)
        self.assertNotIn("\r", result.stderr)
        for piece in PIECES:
            self.assertIn(piece, lines[0])
        parts = [float(re.match(r" *([\d.]+) %", line).group(1)) for line in lines]
        self.assertEqual(parts, sorted(parts))

    def test_quiet_is_silent(self):
        result = self.fexp("run", self.name, "--quiet")
        self.assertEqual((result.returncode, result.stdout, result.stderr), (0, "", ""))


if __name__ == "__main__":
    program.main()
