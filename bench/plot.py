#!/usr/bin/env python3
"""Draws what `accel_bench --study FILE.csv` wrote, as SVG: rays per second and build times over the number of triangles.

    bench/plot.py STUDY.csv [FOLDER]        writes study-rays.svg, study-build.svg and study-build-all.svg (docs/images)

Needs nothing but Python's standard library. render.py draws with it too.
"""
import csv
import math
import pathlib
import sys
from collections import defaultdict

WIDTH, HEIGHT = 760, 440
LEFT, RIGHT, TOP, BOTTOM = 70, 190, 44, 54
COLOURS = ["#1b6ca8", "#d1495b", "#2e8b57", "#e08e0b", "#6a4c93"]
BUILDS = {"build": ("study-build.svg", "one thread"), "build all": ("study-build-all.svg", "all threads")}
EMBREE_PEERS = {"Embree medium": "Steradian sah", "Embree high": "Steradian high-quality"}  # one colour


def read(path):
    """{measure: {series: [(triangles, value, lowest, highest), ...]}}, sorted by triangles."""
    table = defaultdict(lambda: defaultdict(list))
    with open(path, newline="") as file:
        for row in csv.DictReader(file):
            point = tuple(float(row[key]) for key in ("triangles", "value", "lowest", "highest"))
            table[row["measure"]][row["series"]].append(point)
    for series in table.values():
        for points in series.values():
            points.sort()
    return table


class Axis:
    """Values to pixels, with ticks."""

    def __init__(self, values, start, end, logarithmic):
        self.start, self.end, self.log = start, end, logarithmic
        low, high = min(values), max(values)
        if logarithmic:
            slack = 0.02  # decades: 972 triangles may stand on the line of 1000
            self.low, self.high = math.floor(math.log10(low) + slack), math.ceil(math.log10(high) - slack)
            self.high = max(self.high, self.low + 1)
            self.ticks = [10.0**e for e in range(self.low, self.high + 1)]
        else:
            step = 10 ** math.floor(math.log10(high)) / 2
            while high / step > 8:
                step *= 2
            self.low, self.high = 0, step * math.ceil(high / step)
            self.ticks = [i * step for i in range(round(self.high / step) + 1)]

    def __call__(self, value):
        place = math.log10(value) if self.log else value
        return self.start + (place - self.low) / (self.high - self.low) * (self.end - self.start)


def text(x, y, words, anchor="middle", extra=""):
    words = str(words).replace("&", "&amp;").replace("<", "&lt;")
    return f'<text x="{x:.1f}" y="{y:.1f}" text-anchor="{anchor}"{extra}>{words}</text>'


def label(value):
    if value >= 1000:
        exponent = round(math.log10(value))
        return f"10{''.join('⁰¹²³⁴⁵⁶⁷⁸⁹'[int(d)] for d in str(exponent))}" if value == 10.0**exponent else f"{value:g}"
    return f"{value:g}"


def frame(x, y, title, x_name, y_name):
    out = [text(LEFT, 24, title, "start", ' font-weight="bold"')]
    for tick in y.ticks:
        out.append(f'<path d="M{LEFT} {y(tick):.1f}H{WIDTH - RIGHT}" stroke="#ddd"/>')
        out.append(text(LEFT - 8, y(tick) + 4, label(tick), "end"))
    for tick in x.ticks:
        out.append(f'<path d="M{x(tick):.1f} {TOP}V{HEIGHT - BOTTOM}" stroke="#eee"/>')
        out.append(text(x(tick), HEIGHT - BOTTOM + 18, label(tick)))
    out.append(text((LEFT + WIDTH - RIGHT) / 2, HEIGHT - 14, x_name))
    middle = (TOP + HEIGHT - BOTTOM) / 2
    out.append(text(18, middle, y_name, "middle", f' transform="rotate(-90 18 {middle})"'))
    return out


def curve(points, x, y, colour, dashed):
    path = "L".join(f"{x(p[0]):.1f} {y(p[1]):.1f}" for p in points)
    dash = ' stroke-dasharray="6 4"' if dashed else ""
    out = [f'<path d="M{path}" fill="none" stroke="{colour}" stroke-width="2"{dash}/>']
    for place, value, lowest, highest in points:  # the dot is the median, the bar all repetitions
        out.append(f'<circle cx="{x(place):.1f}" cy="{y(value):.1f}" r="2.6" fill="{colour}"/>')
        out.append(f'<path d="M{x(place):.1f} {y(lowest):.1f}V{y(highest):.1f}" stroke="{colour}"/>')
    return out


def key(entries):
    out = []
    for row, (name, colour, dashed) in enumerate(entries):
        x, y = WIDTH - RIGHT + 14, TOP + 8 + 20 * row
        dash = ' stroke-dasharray="6 4"' if dashed else ""
        out.append(f'<path d="M{x} {y}h24" stroke="{colour}" stroke-width="2"{dash}/>')
        out.append(text(x + 30, y + 4, name, "start"))
    return out


def draw(path, title, x_name, y_name, lines, logarithmic):
    """`lines` is a list of (name, colour, dashed, points), a point (x, value, lowest, highest)."""
    points = [point for line in lines for point in line[3]]
    x = Axis([p[0] for p in points], LEFT, WIDTH - RIGHT, True)
    y = Axis([v for p in points for v in p[1:]], HEIGHT - BOTTOM, TOP, logarithmic)
    body = [f'<rect width="{WIDTH}" height="{HEIGHT}" fill="#fff"/>'] + frame(x, y, title, x_name, y_name)
    for _, colour, dashed, series in lines:
        body += curve(series, x, y, colour, dashed)
    body += key([line[:3] for line in lines])
    head = (f'<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 {WIDTH} {HEIGHT}" font-size="12" '
            'font-family="sans-serif" fill="#222">')
    path.write_text("\n".join([head, *body, "</svg>", ""]), encoding="utf-8")
    print(path)


def ray_lines(table):
    measures = [measure for measure in table if measure not in BUILDS]
    return [(f"{series}, {measure}", COLOURS[i % len(COLOURS)], series != "Steradian", points)
            for i, measure in enumerate(measures) for series, points in table[measure].items()]


def build_lines(builds):
    """Nanoseconds a triangle: what grows like n log n is a line that rises slowly."""
    ours = [series for series in builds if series not in EMBREE_PEERS]
    lines = []
    for series, points in builds.items():
        colour = COLOURS[ours.index(EMBREE_PEERS.get(series, series)) % len(COLOURS)]
        each = [(n, *(1e6 * milliseconds / n for milliseconds in values)) for n, *values in points]
        lines.append((series, colour, series in EMBREE_PEERS, each))
    return lines


def main(arguments):
    if len(arguments) not in (1, 2) or arguments[0].startswith("-"):
        print(__doc__.strip(), file=sys.stderr)
        return 2
    folder = pathlib.Path(arguments[1] if len(arguments) == 2 else "docs/images")
    table = read(arguments[0])
    if not table:
        print(f"{arguments[0]}: no figures in it", file=sys.stderr)
        return 3
    folder.mkdir(parents=True, exist_ok=True)
    draw(folder / "study-rays.svg", "Rays, one thread", "triangles", "millions of rays per second", ray_lines(table), True)
    for measure, (name, threads) in BUILDS.items():
        if measure in table:
            draw(folder / name, f"Build, {threads}", "triangles", "nanoseconds a triangle", build_lines(table[measure]), True)
    return 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
