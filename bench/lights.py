#!/usr/bin/env python3
"""Measures what many lights cost, and what choosing among them by importance brings.

    bench/lights.py [--command build/release/bin/steradian] [--threads N] [--triangles 100000] [--seconds 5]

A hall of 40 m x 40 m under a ceiling of small triangles, each turned its own way, ten thousand times brighter here than
there. Of the triangles all emit, or ten of them, or none; so the geometry is the same, and so are the rays of the
camera. Prints the time per sample for each, and with all of them the error after some seconds by each --light-choice
(and with no light samples at all), against a reference of sixteen times the samples of the best.

Needs nothing but Python's standard library.
"""
import argparse
import json
import math
import pathlib
import random
import tempfile

from render import read_pfm, steradian

SIZE = [160, 90]


def triangle(rng):
    center = [rng.uniform(-20, 20), rng.uniform(4, 5), rng.uniform(-20, 20)]
    return [[c + rng.uniform(-0.05, 0.05) for c in center] for _ in range(3)]


def mesh(triangles, material, light=None):
    out = {"type": "mesh", "material": material, "vertices": [p for t in triangles for p in t],
           "triangles": [[3 * i, 3 * i + 1, 3 * i + 2] for i in range(len(triangles))]}
    if light:
        out["light"] = {"radiance": light, "two_sided": True}
    return out


def hall(count, emitting):
    """The triangles are sixteen meshes of different brightness, and one of ten triangles."""
    rng = random.Random(5)
    single = [triangle(rng) for _ in range(10)]
    groups = [[triangle(rng) for _ in range((count - 10) // 16)] for _ in range(16)]
    objects = [
        {"type": "rectangle", "center": [0, 0, 0], "half_u": [20, 0, 0], "half_v": [0, 0, -20], "material": "floor"},
        {"type": "rectangle", "center": [0, 3, -20], "half_u": [20, 0, 0], "half_v": [0, 3, 0], "material": "floor"}]
    for i in range(60):
        objects.append({"type": "sphere", "center": [rng.uniform(-15, 15), 0.6, rng.uniform(-19, 8)], "radius": 0.6,
                        "material": "floor"})
    area = 0.00375
    objects.append(mesh(single, "dark", 2000 if emitting != "none" else None))
    for k, group in enumerate(groups):
        objects.append(mesh(group, "dark", 40 * 0.54 ** k / area * 0.01 if emitting == "all" else None))
    return {
        "version": 1, "render": {"integrator": "path", "max_depth": 4}, "film": {"resolution": SIZE},
        "camera": {"position": [0, 3.8, 19], "look_at": [0, 0, 10], "vertical_fov": 40},
        "materials": {"floor": {"type": "diffuse", "reflectance": 0.6, "two_sided": True},
                      "dark": {"type": "diffuse", "reflectance": 0.1, "two_sided": True}},
        "objects": objects, "lights": []}


def error(picture, reference):
    least = 0.01
    return math.sqrt(sum(((a - b) / (b + least)) ** 2 for a, b in zip(picture, reference)) / len(reference))


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--command", default="build/release/bin/steradian")
    parser.add_argument("--threads", type=int, default=1)
    parser.add_argument("--triangles", type=int, default=100000)
    parser.add_argument("--seconds", type=float, default=5)
    parser.add_argument("--cost-only", action="store_true", help="time per sample, no errors")
    o = parser.parse_args()
    threads = ["--threads", o.threads]
    with tempfile.TemporaryDirectory() as folder:
        folder = pathlib.Path(folder)
        scenes = {}
        for emitting in ("none", "ten", "all"):
            scenes[emitting] = folder / f"{emitting}.json"
            scenes[emitting].write_text(json.dumps(hall(o.triangles, emitting)))

        def render(scene, spp, *options):
            said = steradian(o.command, scenes[scene], folder / "out.pfm", "--spp", spp, *threads, *options)
            return said["seconds"], read_pfm(folder / "out.pfm")

        print("| emitting triangles | µs a sample |\n|---|---|")
        for emitting in scenes:
            seconds = min(render(emitting, 16)[0] for _ in range(3))
            print(f"| {emitting} | {1e6 * seconds / (16 * SIZE[0] * SIZE[1]):.2f} |", flush=True)
        if o.cost_only:
            return

        ways = [["--light-choice", w] for w in ("bvh", "power", "uniform")] + [["--light-sampling", "bsdf"]]
        rate = {}
        for way in ways:
            rate[way[1]] = 16 / render("all", 16, *way)[0]
        spp = {name: max(1, round(o.seconds * r)) for name, r in rate.items()}
        reference = render("all", 16 * spp["bvh"], "--seed", 99)[1]
        print("\n| chosen by | samples a pixel | error |\n|---|---|---|")
        for way in ways:
            picture = render("all", spp[way[1]], *way)[1]
            print(f"| {way[1]} | {spp[way[1]]} | {100 * error(picture, reference):.1f} % |", flush=True)


if __name__ == "__main__":
    main()
