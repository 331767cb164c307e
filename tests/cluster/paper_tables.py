#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""The tables of the paper from runs on several ranks: where the four spheres are computed when, and that nothing of
their results depends on it.

usage: paper_tables.py PROGRAM
"""
import json

import real


class Tables(real.Case):
    deck_file = real.EXAMPLES / "four_spheres.toml"

    def check_tables(self, threads):
        process = self.start_real("c1", "c2", "c3", threads=threads, words=("--at", "90 add c4=localhost"))
        placement = self.finish(process)["placement"]
        self.assertEqual([frame["elements"] for frame in placement["frames"]],
                         [[384, 192, 192], [576, 0, 192], [768, 0, 0, 0], [192, 192, 192, 192]])
        self.assertEqual([frame["nodes"] for frame in placement["frames"]],
                         [[196, 98, 98], [294, 0, 98], [392, 0, 0, 0], [98, 98, 98, 98]])
        self.assertEqual((placement["moved_elements"], placement["moved_nodes"], placement["moved_ratio"]),
                         (960, 490, 1.25))
        self.assertEqual([(machine["name"], machine["threads"]) for machine in placement["machines"]],
                         [(name, threads) for name in ("c1", "c2", "c3", "c4")])

    def test_a_fourth_machine_joins_when_all_spheres_touch_and_gets_one_when_they_part(self):
        self.check_tables(1)

    def test_and_so_it_is_with_two_threads_on_every_machine(self):
        self.check_tables(2)

    def test_plain_mpirun_gives_the_same_to_the_last_bit_on_any_number_of_ranks(self):
        for ranks, threads in ((3, 1), (2, 2), (5, 1)):
            with self.subTest(ranks=ranks, threads=threads):
                out = f"plain{ranks}"
                result = self.mpirun_plain(ranks, "run", "deck.toml", "--out", out, "--json", "--quiet", "--threads",
                                           threads, *self.run_words)
                self.assertEqual(result.returncode, 0, result.stderr)
                self.assertEqual(json.loads(result.stdout)["ranks"], ranks)
                self.check_equal(out)


if __name__ == "__main__":
    real.main()
