#!/usr/bin/env python3
"""Measures whole renders: samples per second, and how far the picture is from the truth after some seconds.

    bench/render.py [--command build/release/bin/steradian] [--seconds 10,30,100] [--scenes cornell,interior,objects,lamps]
                    [--threads N] [--references FOLDER] [--reference-spp N] [--against EARLIER.json] [--out FOLDER]

Writes FOLDER/render.json (for a later --against), render.md (the table) and render.svg (error over seconds).

The error is sqrt(mean(((I - R) / (R + 0.01))²)) over all pixels and colours, the quantity of --target-error. The truth R
is the mean of two long renders with seeds of their own; what their difference says R itself is off by is taken out. They
are made where they are missing and kept in the folder of references, named by what the scene file says: they take a while.
A render is ended by --time-limit, so that all pixels have the same number of samples, and counted with the seconds that it
reports.

Needs nothing but Python's standard library.
"""
import argparse
import array
import hashlib
import json
import math
import pathlib
import platform
import subprocess
import sys
import tempfile
import time

import plot
import render_scenes

REFERENCE_SEEDS = (101, 102)
LEAST = 0.01  # as in --target-error


def read_pfm(path):
    with open(path, "rb") as file:
        kind, size, scale = (file.readline().split() for _ in range(3))
        values = array.array("f", file.read())
    if kind != [b"PF"] or len(values) != 3 * int(size[0]) * int(size[1]):
        raise SystemExit(f"{path}: not a colour PFM")
    if (float(scale[0]) < 0) != (sys.byteorder == "little"):
        values.byteswap()
    return values


def steradian(command, scene, output, *options):
    """Runs one render and returns its statistics."""
    words = [command, "render", str(scene), "--quiet", "--json", "-o", str(output), *map(str, options)]
    process = subprocess.run(words, stdout=subprocess.PIPE, text=True)
    if process.returncode != 0:
        raise SystemExit(f"{' '.join(words)}: failed with {process.returncode}")
    return json.loads(process.stdout)


def reference(arguments, scene):
    """The truth, and for each value the variance of it."""
    name = hashlib.sha256(scene.read_bytes()).hexdigest()[:16]
    folder = pathlib.Path(arguments.references)
    folder.mkdir(parents=True, exist_ok=True)
    halves = []
    for seed in REFERENCE_SEEDS:
        path = folder / f"{scene.stem}-{name}-{arguments.reference_spp}-{seed}.pfm"
        if not path.exists():
            print(f"{scene.stem}: rendering a reference of {arguments.reference_spp} samples a pixel", file=sys.stderr, flush=True)
            unfinished = path.with_suffix(".part.pfm")
            steradian(arguments.command, scene, unfinished, "--spp", arguments.reference_spp, "--seed", seed)
            unfinished.rename(path)
        halves.append(read_pfm(path))
    truth = [0.5 * (a + b) for a, b in zip(*halves)]
    return truth, [0.25 * (a - b) ** 2 for a, b in zip(*halves)]


def error_of(picture, truth, variance):
    """And the error of the truth itself, which has been taken out."""
    weights = [1 / (r + LEAST) ** 2 for r in truth]
    seen = math.fsum((i - r) ** 2 * w for i, r, w in zip(picture, truth, weights)) / len(truth)
    of_truth = math.fsum(v * w for v, w in zip(variance, weights)) / len(truth)
    return math.sqrt(max(seen - of_truth, 0)), math.sqrt(of_truth)


def measure(arguments, scene, work):
    truth, variance = reference(arguments, scene)
    rows = []
    for seconds in arguments.seconds:
        picture = work / "picture.pfm"
        threads = ["--threads", arguments.threads] if arguments.threads else []
        s = steradian(arguments.command, scene, picture, "--time-limit", f"{seconds:g}s", *threads)
        error, of_truth = error_of(read_pfm(picture), truth, variance)
        rows.append({"wanted": seconds, "seconds": s["seconds"], "samples": s["samples"], "threads": s["threads"],
                     "spp": s["samples"] / (s["width"] * s["height"]), "error": error, "error_of_reference": of_truth})
        print(f"{scene.stem}: {s['seconds']:.1f} s, {rows[-1]['spp']:.0f} samples a pixel, error {error:.4f} "
              f"(reference {of_truth:.4f})", file=sys.stderr, flush=True)
    return rows


def efficiency(row):
    """Inverse of squared error times seconds: twice as much is worth twice the machine."""
    return 1 / (row["error"] ** 2 * row["seconds"])


def table(results, earlier):
    seconds = [row["wanted"] for row in next(iter(results.values()))]
    head = ["scene", "thousand samples a second", *(f"error after {s:g} s" for s in seconds), "samples a pixel", "error of the reference"]
    if earlier:
        head += ["samples a second ÷ before", "efficiency ÷ before"]
    lines = [head, ["---"] * len(head)]
    for name, rows in results.items():
        last = rows[-1]
        line = [name, f"{1e-3 * last['samples'] / last['seconds']:.0f}", *(f"{row['error']:.4f}" for row in rows),
                f"{last['spp']:.0f}", f"{last['error_of_reference']:.4f}"]
        if earlier:
            before = {row["wanted"]: row for row in earlier.get(name, [])}.get(last["wanted"])
            line += ["–", "–"] if before is None else [
                f"**{last['samples'] / last['seconds'] * before['seconds'] / before['samples']:.2f}**",
                f"**{efficiency(last) / efficiency(before):.2f}**"]
        lines.append(line)
    return "".join("| " + " | ".join(line) + " |\n" for line in lines)


def curves(results, earlier):
    lines = []
    for i, (name, rows) in enumerate(results.items()):
        colour = plot.COLOURS[i % len(plot.COLOURS)]
        for label, dashed, series in ((name, False, rows), (f"{name}, before", True, (earlier or {}).get(name, []))):
            points = [(row["seconds"], row["error"], row["error"], row["error"]) for row in series if row["error"] > 0]
            if points:
                lines.append((label, colour, dashed, points))
    return lines


def numbers(text):
    return [float(word) for word in text.split(",")]


def parse(words):
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--command", default="build/release/bin/steradian")
    parser.add_argument("--seconds", type=numbers, default=[10.0, 30.0, 100.0])
    parser.add_argument("--scenes", type=lambda text: text.split(","), default=list(render_scenes.ALL))
    parser.add_argument("--threads", type=int, default=0, help="0: all")
    parser.add_argument("--references", default="out/references")
    parser.add_argument("--reference-spp", type=int, default=8192, help="of each of the two halves")
    parser.add_argument("--against", help="a render.json of before")
    parser.add_argument("--out", default="out/render")
    arguments = parser.parse_args(words)
    if unknown := [name for name in arguments.scenes if name not in render_scenes.ALL]:
        parser.error(f"there is no scene '{unknown[0]}': {', '.join(render_scenes.ALL)}")
    if min(arguments.seconds) <= 0 or sorted(set(arguments.seconds)) != arguments.seconds:
        parser.error("--seconds: rising numbers above 0 are expected")
    return arguments


def main(words):
    arguments = parse(words)
    out = pathlib.Path(arguments.out)
    out.mkdir(parents=True, exist_ok=True)
    earlier = json.loads(pathlib.Path(arguments.against).read_text())["scenes"] if arguments.against else None
    results = {}
    with tempfile.TemporaryDirectory() as folder:
        work = pathlib.Path(folder)
        for name, scene in render_scenes.write_scenes(work, arguments.scenes).items():
            results[name] = measure(arguments, scene, work)
    record = {"date": time.strftime("%Y-%m-%d"), "machine": platform.machine(), "scenes": results}
    (out / "render.json").write_text(json.dumps(record, indent=1) + "\n")
    (out / "render.md").write_text(table(results, earlier))
    plot.draw(out / "render.svg", "Error of whole renders", "seconds", "error", curves(results, earlier), True)
    print(table(results, earlier), end="")
    return 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
