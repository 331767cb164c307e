#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Builds the benchmarks, runs them and writes medians to bench/results/<machine>/*.csv.

usage: bench/run.py [--machine NAME] [--repetitions N] [--filter REGEX] [benchmark ...]

Without names runs steps, search, memory, startup and placement. `spread` is (largest - smallest) / median of the
repetitions: on a machine with other work compare ratios, and CPU times before wall times.
"""
import argparse
import csv
import json
import os
import re
import subprocess
import tempfile
from datetime import date
from pathlib import Path
from statistics import median

root = Path(__file__).resolve().parent.parent
build = root / "build" / "bench"
all_benchmarks = ["steps", "search", "memory", "startup", "placement"]
# Largest resident memory is the process's, so every case of these has a process of its own; it hardly varies.
own_processes = ["memory", "placement"]
# What Google Benchmark reports of every run beside the counters.
own_keys = {"name", "family_index", "per_family_instance_index", "run_name", "run_type", "repetitions",
            "repetition_index", "threads", "iterations", "real_time", "cpu_time", "time_unit"}


def processor():
    """Name and family; virtual machines give all generations of a maker one name."""
    known = dict(re.findall(r"^(model name|cpu family)\s*: (.*)$", Path("/proc/cpuinfo").read_text(), re.MULTILINE))
    name = known.get("model name", os.uname().machine)
    return f"{name}, family {known['cpu family']}" if "cpu family" in known else name


def machine_name():
    words = re.sub(r"\((r|tm)\)|cpu|processor|@[^,]*", " ", processor().lower())
    return "-".join(re.findall(r"[a-z0-9.]+", words)) + f"-{os.cpu_count()}-threads"


def make():
    configure = ["cmake", "--preset", "release", "-B", build, "-DFEXP_TESTS=OFF", "-DFEXP_BENCH=ON"]
    subprocess.run(configure, cwd=root, check=True, stdout=subprocess.DEVNULL)
    subprocess.run(["cmake", "--build", build], cwd=root, check=True)


def run(program, names, repetitions):
    """The reports of all repetitions of the benchmarks that match."""
    with tempfile.NamedTemporaryFile(suffix=".json") as out:
        done = subprocess.run([program, f"--benchmark_filter={names}", f"--benchmark_repetitions={repetitions}",
                               f"--benchmark_out={out.name}", "--benchmark_out_format=json"],
                              check=False, capture_output=True, text=True)
        if done.returncode != 0:
            raise SystemExit(f"{program} failed:\n{done.stderr}")
        text = Path(out.name).read_text()
    return [r for r in json.loads(text)["benchmarks"] if r["run_type"] == "iteration"] if text.strip() else []


def reports(name, names, repetitions):
    program = build / "bench" / f"bench_{name}"
    if name not in own_processes:
        return run(program, names, repetitions)
    listed = subprocess.run([program, "--benchmark_list_tests", f"--benchmark_filter={names}"], check=True,
                            capture_output=True, text=True).stdout.split()
    return [report for case in listed for report in run(program, f"^{re.escape(case)}$", 1)]


def case_of(run_name):
    """Case and number of threads (None where it is no parameter) from names such as
    plate/elements:1000/threads:2/iterations:30/real_time and memory/plate/elements:10000/iterations:1."""
    parts = run_name.split("/")
    words = [p for p in parts if ":" not in p and p != "real_time" and p not in all_benchmarks]
    threads = next((int(p.split(":")[1]) for p in parts if p.startswith("threads:")), None)
    return "/".join(words), threads


def rows_of(found):
    runs = {}
    for report in found:
        if report.get("error_occurred"):
            raise SystemExit(f"{report['run_name']}: {report['error_message']}")
        runs.setdefault(report["run_name"], []).append(report)
    for run_name, repeated in runs.items():
        case, threads = case_of(run_name)
        scale = {"ns": 1e-9, "us": 1e-6, "ms": 1e-3, "s": 1.0}[repeated[0]["time_unit"]]
        seconds = [scale * r["real_time"] for r in repeated]
        size = "triangles" if "triangles" in repeated[0] else "bodies"
        row = {"case": case, "elements" if size == "triangles" else size: int(repeated[0][size])}
        if threads is not None:
            row["threads"] = threads
        row |= {"repetitions": len(repeated), "seconds": median(seconds),
                "spread": (max(seconds) - min(seconds)) / median(seconds)}
        row |= {key: median(r[key] for r in repeated) for key in repeated[0] if key not in own_keys | {size}}
        yield row


def in_columns(rows):
    """The rows with all columns of all cases; None where a case does not have one."""
    columns = list(dict.fromkeys(column for row in rows for column in row))
    return [{column: row.get(column) for column in columns} for row in rows]


def text_of(value):
    if value is None:
        return ""
    return f"{value:.4g}" if isinstance(value, float) else str(value)


def show(name, rows):
    columns = list(rows[0])
    table = [columns] + [[text_of(row[c]) for c in columns] for row in rows]
    widths = [max(len(line[i]) for line in table) for i in range(len(columns))]
    print(f"\n{name}")
    for line in table:
        print("  " + "  ".join(cell.rjust(width) for cell, width in zip(line, widths)), flush=True)


def write(path, rows):
    with path.open("w", newline="") as file:
        writer = csv.writer(file, lineterminator="\n")
        writer.writerow(rows[0])
        writer.writerows([text_of(value) for value in row.values()] for row in rows)


def describe(folder, loads):
    compiler = subprocess.run(["g++", "--version"], check=True, capture_output=True, text=True).stdout.splitlines()[0]
    commit = subprocess.run(["git", "rev-parse", "--short", "HEAD"], cwd=root, capture_output=True, text=True,
                            check=False).stdout.strip()
    (folder / "machine.txt").write_text(
        f"processor      {processor()}, {os.cpu_count()} hardware threads\n"
        f"system         {os.uname().sysname} {os.uname().release}\n"
        f"compiler       {compiler}, preset release\n"
        f"version        {commit or 'unknown'}, {date.today()}\n"
        f"load average   {loads[0]:.1f} before, {loads[1]:.1f} after\n")


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("benchmark", nargs="*", help="steps, search, memory, startup or placement")
    parser.add_argument("--machine", default=machine_name(), help="name of the folder under bench/results")
    parser.add_argument("--repetitions", type=int, default=3)
    parser.add_argument("--filter", default=".", help="only cases that match; prints and writes nothing")
    options = parser.parse_args()
    unknown = set(options.benchmark) - set(all_benchmarks)
    if unknown:
        parser.error(f"unknown benchmark {', '.join(sorted(unknown))}; there are {', '.join(all_benchmarks)}")
    make()
    folder = root / "bench" / "results" / options.machine
    load_before = os.getloadavg()[0]
    for name in options.benchmark or all_benchmarks:
        rows = in_columns(list(rows_of(reports(name, options.filter, options.repetitions))))
        if not rows:
            continue
        show(name, rows)
        if options.filter == ".":
            folder.mkdir(parents=True, exist_ok=True)
            write(folder / f"{name}.csv", rows)
            describe(folder, (load_before, os.getloadavg()[0]))


if __name__ == "__main__":
    main()
