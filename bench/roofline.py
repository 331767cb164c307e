#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Draws what `fexp bench --json` printed under the roofs of its machine: flops per second over flops per byte.

usage: bench/roofline.py MACHINE.json [PICTURE.svg]

Without a second name the picture goes to docs/images/roofline.svg. There is a panel for every number of threads.
"""
import argparse
import json
import math
from html import escape
from pathlib import Path

root = Path(__file__).resolve().parent.parent

# All in pixels: a panel's plot, and what stands around it.
WIDTH, HEIGHT = 560, 360
LEFT, TOP, GAP, BOTTOM = 64, 72, 88, 92
LINE = 15  # From label to label
COLOURS = {"plate": "#1f5fa8", "quiet_contact": "#5b9bd5", "four_spheres": "#b3541e", "separate_spheres": "#2e7d4f",
           "meeting_spheres": "#8e3b8a"}
INK, GREY = "#222222", "#8a8a8a"


def decades(low, high):
    """Values 1, 2 and 5 of every decade in the range."""
    first = math.floor(math.log10(low))
    last = math.ceil(math.log10(high))
    return [m * 10.0 ** e for e in range(first, last + 1) for m in (1, 2, 5) if low <= m * 10.0 ** e <= high]


def text(x, y, words, anchor="start", colour=INK, size=12, extra=""):
    return f'<text x="{x:.1f}" y="{y:.1f}" text-anchor="{anchor}" fill="{colour}" font-size="{size}"{extra}>' \
           f"{escape(words)}</text>"


def line(x1, y1, x2, y2, colour=INK, width=1.0, extra=""):
    return f'<line x1="{x1:.1f}" y1="{y1:.1f}" x2="{x2:.1f}" y2="{y2:.1f}" stroke="{colour}" ' \
           f'stroke-width="{width}"{extra}/>'


class Panel:
    """One number of threads: logarithmic axes, roofs and rows."""

    def __init__(self, left, limits, roofs, rows):
        self.left, (self.x_range, self.y_range) = left, limits
        self.roofs, self.rows = roofs, rows

    def x(self, intensity):
        low, high = self.x_range
        return self.left + WIDTH * math.log(intensity / low) / math.log(high / low)

    def y(self, flops):
        low, high = self.y_range
        return TOP + HEIGHT * (1.0 - math.log(flops / low) / math.log(high / low))

    def axes(self):
        right, bottom = self.left + WIDTH, TOP + HEIGHT
        for value in decades(*self.x_range):
            yield line(self.x(value), TOP, self.x(value), bottom, "#e6e6e6")
            yield text(self.x(value), bottom + 18, f"{value:g}", "middle")
        for value in decades(*self.y_range):
            yield line(self.left, self.y(value), right, self.y(value), "#e6e6e6")
            yield text(self.left - 8, self.y(value) + 4, f"{value / 1e9:g}", "end")
        yield f'<rect x="{self.left}" y="{TOP}" width="{WIDTH}" height="{HEIGHT}" fill="none" stroke="{INK}"/>'
        threads = self.roofs["threads"]
        yield text(self.left, TOP - 12, f"{threads} thread{'s' if threads > 1 else ''}", size=14,
                   extra=' font-weight="bold"')
        yield text(self.left + WIDTH / 2, bottom + 40, "flops per byte that must move", "middle")
        yield text(self.left - 46, TOP + HEIGHT / 2, "Gflop/s", "middle",
                   extra=f' transform="rotate(-90 {self.left - 46} {TOP + HEIGHT / 2})"')

    def roof(self):
        bandwidth, right = self.roofs["triad_bandwidth"], self.x_range[1]
        # To the peak or to the frame, whichever comes first.
        start = max(self.x_range[0], self.y_range[0] / bandwidth)
        end = min(self.roofs["peak_flops"] / bandwidth, right)
        yield line(self.x(start), self.y(start * bandwidth), self.x(end), self.y(end * bandwidth), INK, 2)
        angle = -math.degrees(math.atan2(self.y(start * bandwidth) - self.y(end * bandwidth),
                                         self.x(end) - self.x(start)))
        place = start * (end / start) ** 0.06
        x, y = self.x(place), self.y(place * bandwidth)
        yield text(x, y - 7, f"triad {bandwidth / 1e9:.3g} GB/s",
                   extra=f' transform="rotate({angle:.1f} {x:.1f} {y:.1f})"')
        for key, name, dash, above in (("fused_peak_flops", "fused multiply-adds", "", True),
                                       ("separate_peak_flops", "separate products and sums", "6 4", False)):
            flops = self.roofs[key]
            if flops <= 0.0:
                continue
            extra = f' stroke-dasharray="{dash}"' if dash else ""
            yield line(self.x(min(flops / bandwidth, right)), self.y(flops), self.x(right), self.y(flops), INK, 2,
                       extra)
            yield text(self.x(right) - 6, self.y(flops) + (-7 if above else 16), f"{name} {flops / 1e9:.3g} Gflop/s",
                       "end")

    def points(self):
        marks = []
        for row in self.rows:
            marks.append((row["flops_per_element_step"] / row["bytes_per_element_step"],
                          row["flops_per_element_step"] * row["element_steps_per_second"], row))
        marks.sort(key=lambda mark: -mark[1])
        if not marks:
            return
        # Labels stand one below the other to the right of the points, as near to theirs as the others allow.
        heights = [self.y(flops) for _, flops, _ in marks]
        for i in range(1, len(heights)):
            heights[i] = max(heights[i], heights[i - 1] + LINE)
        over = heights[-1] - (TOP + HEIGHT - 8)
        for i in reversed(range(len(heights))):
            heights[i] -= max(over, 0.0)
            if i > 0:
                over = max(heights[i - 1] - (heights[i] - LINE), 0.0)
        for (intensity, flops, row), height in zip(marks, heights):
            x, y, colour = self.x(intensity), self.y(flops), COLOURS.get(row["case"], INK)
            yield line(x, y, x + 34, height, GREY, 0.8)
            yield f'<circle cx="{x:.1f}" cy="{y:.1f}" r="4" fill="{colour}"/>'
            yield text(x + 38, height + 4, f"{row['case'].replace('_', ' ')} {row['elements']:,}: "
                       f"{row['element_steps_per_second'] / 1e6:.3g}", colour=colour, size=11)

    def parts(self):
        yield from self.axes()
        yield from self.roof()
        yield from self.points()


def picture(report):
    machine, rows = report["machine"], report["rows"]
    if not rows:
        raise SystemExit("no rows to draw; cure: run fexp bench with other cases than search alone")
    rates = [row["flops_per_element_step"] * row["element_steps_per_second"] for row in rows]
    intensities = [row["flops_per_element_step"] / row["bytes_per_element_step"] for row in rows]
    ridges = [one["peak_flops"] / one["triad_bandwidth"] for one in machine["by_threads"]]
    limits = ((min(intensities) / 8.0, max([*intensities, *ridges]) * 8.0),
              (min(rates) / 3.0, max(one["peak_flops"] for one in machine["by_threads"]) * 2.0))
    panels = [Panel(LEFT + i * (WIDTH + GAP), limits, roofs, [r for r in rows if r["threads"] == roofs["threads"]])
              for i, roofs in enumerate(sorted(machine["by_threads"], key=lambda one: one["threads"]))]
    width, height = LEFT + len(panels) * (WIDTH + GAP) - GAP + 24, TOP + HEIGHT + BOTTOM
    title = f"fexp on {machine['processor']}, {machine['hardware_threads']} hardware threads, " \
            f"kernel {machine['instruction_set']}"
    note = "Numbers at the points: triangles, and million element-steps/s. A point above the slope has its numbers in " \
           "caches; flops of contact are not counted."
    parts = [text(LEFT, 30, title, size=16, extra=' font-weight="bold"'),
             text(LEFT, height - 18, note, colour="#555555")]
    parts += [part for panel in panels for part in panel.parts()]
    body = "\n".join(parts)
    return f'<svg xmlns="http://www.w3.org/2000/svg" width="{width}" height="{height}" ' \
           f'viewBox="0 0 {width} {height}" font-family="Helvetica, Arial, sans-serif">\n' \
           f'<rect width="100%" height="100%" fill="white"/>\n{body}\n</svg>\n'


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("report", type=Path, help="what fexp bench --json printed")
    parser.add_argument("picture", type=Path, nargs="?", default=root / "docs/images/roofline.svg")
    options = parser.parse_args()
    options.picture.write_text(picture(json.loads(options.report.read_text(encoding="utf-8"))), encoding="utf-8")


if __name__ == "__main__":
    main()
