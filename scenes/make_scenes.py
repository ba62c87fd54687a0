#!/usr/bin/env python3
"""Makes the scenes of this folder: run it here after a change, and commit what it writes.

Needs nothing but Python. The sky is written as Radiance HDR, the knot as binary PLY.
"""
import json
import math
import struct

ROOM = {"left": [0.63, 0.065, 0.05], "right": [0.14, 0.45, 0.091], "rest": [0.725, 0.71, 0.68]}
CAMERA = {"position": [0, 1, 6.8], "look_at": [0, 1, 0], "up": [0, 1, 0], "vertical_fov": 19.5}

# A unit box whose left front bottom corner is the origin: x in [0, 1], y in [0, 1], z in [-1, 0], normals outwards.
BOX = {
    "type": "mesh",
    "vertices": [[0, 0, 0], [1, 0, 0], [1, 0, -1], [0, 0, -1], [0, 1, 0], [1, 1, 0], [1, 1, -1], [0, 1, -1]],
    "triangles": [[0, 2, 1], [0, 3, 2], [4, 5, 6], [4, 6, 7], [0, 1, 5], [0, 5, 4],
                  [1, 2, 6], [1, 6, 5], [2, 3, 7], [2, 7, 6], [3, 0, 4], [3, 4, 7]],
}


def dump(path, scene):
    """JSON with one line for each array of numbers and for each small object, so that people can read it."""
    def text(value, indent):
        flat = json.dumps(value)
        if not isinstance(value, (dict, list)) or (len(flat) <= 100 and indent > 0):
            return flat
        pad = "  " * (indent + 1)
        if isinstance(value, dict):
            rows = [pad + json.dumps(k) + ": " + text(v, indent + 1) for k, v in value.items()]
            return "{\n" + ",\n".join(rows) + "\n" + "  " * indent + "}"
        rows = [pad + text(v, indent + 1) for v in value]
        return "[\n" + ",\n".join(rows) + "\n" + "  " * indent + "]"

    with open(path, "w") as f:
        f.write(text(scene, 0) + "\n")


def wall(center, half_u, half_v, material):
    return {"type": "rectangle", "center": center, "half_u": half_u, "half_v": half_v, "material": material}


def room(comment, **more):
    scene = {
        "$schema": "../docs/scene.schema.json",
        "version": 1,
        "comment": comment,
        "render": {"integrator": "direct", "max_depth": 16, "spp": 64},
        "film": {"resolution": [512, 512]},
        "camera": CAMERA,
        "materials": {name: {"type": "diffuse", "reflectance": color} for name, color in ROOM.items()},
        "shapes": {"box": BOX},
        "objects": [
            wall([-1, 1, 0], [0, 0, -1], [0, 1, 0], "left"),
            wall([1, 1, 0], [0, 0, 1], [0, 1, 0], "right"),
            wall([0, 0, 0], [1, 0, 0], [0, 0, -1], "rest"),
            wall([0, 2, 0], [1, 0, 0], [0, 0, 1], "rest"),
            wall([0, 1, -1], [1, 0, 0], [0, 1, 0], "rest"),
            {"type": "instance", "shape": "box", "material": "rest", "transform": [
                {"scale": [0.6, 0.6, 0.6]},
                {"rotate": {"axis": [0, 1, 0], "angle": 17}},
                {"translate": [-0.7, 0, 0.6]}]},
            {"type": "instance", "shape": "box", "material": "rest", "transform": [
                {"translate": [-1, 0, 1]},
                {"scale": [0.6, 1.2, 0.6]},
                {"rotate": {"axis": [0, 1, 0], "angle": -19}},
                {"translate": [0.7, 0, -0.5]}]},
        ],
    }
    for key, value in more.items():
        if isinstance(value, dict):
            scene[key].update(value)
        elif key in scene:
            scene[key] += value
        else:
            scene[key] = value
    return scene


POINT_LIGHT = {"type": "point", "position": [0, 1.5, 0.5], "flux": [17, 12, 5]}


def cornell():
    dump("cornell_point.json", room("Boxes under one point light.", lights=[POINT_LIGHT]))
    dump("cornell_refraction.json", room(
        "Boxes under one point light, behind a ball that refracts with a relative index of 2.",
        materials={"refractor": {"type": "refraction", "eta": 2}},
        objects=[{"type": "sphere", "center": [0, 1, 1], "radius": 0.4, "material": "refractor"}],
        lights=[POINT_LIGHT]))
    dump("cornell_area.json", room(
        "Boxes under a square lamp: soft shadows.",
        materials={"black": {"type": "diffuse", "reflectance": [0, 0, 0]}},
        objects=[{"type": "rectangle", "name": "lamp", "center": [0, 1.98, 0], "half_u": [0.25, 0, 0], "half_v": [0, 0, 0.25],
                  "material": "black", "light": {"radiance": [17, 12, 5], "light_samples": 4}}]))


def spheres():
    def scene(comment, color, light):
        return {
            "$schema": "../docs/scene.schema.json", "version": 1, "comment": comment,
            "render": {"integrator": "direct", "spp": 64},
            "film": {"resolution": [256, 256]},
            "camera": CAMERA,
            "materials": {"white": {"type": "diffuse", "reflectance": color}},
            "objects": [{"type": "sphere", "center": [0, 1, 0], "radius": 1, "material": "white"}],
            "lights": [light],
        }

    dump("furnace_sphere.json", scene("A white sphere in a white environment: every pixel is 1.", [1, 1, 1],
                                      {"type": "environment", "radiance": [1, 1, 1]}))
    dump("sun_sphere.json", scene("A white sphere under a sky with a sun.", [0.8, 0.8, 0.8],
                                  {"type": "environment", "path": "sun_sky.hdr", "rotation": -60, "light_samples": 4}))


def direction(x, y, width, height):
    """That of a texel's centre: the top row is +Y, the centre column -Z, a quarter turn to its right +X."""
    theta, phi = math.pi * (y + 0.5) / height, 2 * math.pi * ((x + 0.5) / width - 0.5)
    return math.sin(theta) * math.sin(phi), math.cos(theta), -math.sin(theta) * math.cos(phi)


def sun_sky():
    """A clear sky by a simple gradient, brighter towards the sun and the horizon; the ground is a dull brown."""
    elevation = math.radians(38)
    sun = (0.0, math.sin(elevation), -math.cos(elevation))  # in the map's centre column

    def color(d):
        cosine = sum(a * b for a, b in zip(d, sun))
        if d[1] < 0:
            return [0.18, 0.16, 0.13]
        if cosine > math.cos(math.radians(1.6)):
            return [1400, 1250, 1000]
        haze = (1 - d[1]) ** 4
        glow = 0.9 * max(cosine, 0) ** 12
        return [a + (b - a) * haze + g * glow
                for a, b, g in zip((0.16, 0.33, 0.75), (0.75, 0.85, 1.0), (1.0, 0.85, 0.6))]

    write_hdr("sun_sky.hdr", color)


def evening_sky():
    """A low sun in the front left of the camera's back; opposite to it the sky turns from rose to blue."""
    sun = (-0.74, 0.38, 0.55)
    length = math.sqrt(sum(x * x for x in sun))
    # Colours at heights above the horizon (the sine of the elevation), joined by straight lines.
    steps = [(0.0, (1.5, 0.86, 0.5)), (0.035, (1.25, 0.74, 0.5)), (0.08, (0.85, 0.56, 0.52)), (0.15, (0.46, 0.44, 0.58)),
             (0.3, (0.22, 0.32, 0.58)), (1.0, (0.08, 0.17, 0.42))]

    def color(d):
        cosine = sum(a * b for a, b in zip(d, sun)) / length
        if cosine > math.cos(math.radians(1.8)):
            return [1500, 1150, 720]
        height = max(d[1], 0)  # the far shore is lost in the haze
        for (h0, c0), (h1, c1) in zip(steps, steps[1:]):
            if height <= h1:
                w = (height - h0) / (h1 - h0)
                sky = [a + (b - a) * w for a, b in zip(c0, c1)]
                break
        glow = 1.6 * max(cosine, 0) ** 10
        return [a + glow * g for a, g in zip(sky, (1.0, 0.72, 0.4))]

    write_hdr("evening_sky.hdr", color)


def write_hdr(path, color, width=256, height=128):
    """color(direction) for each texel, as Radiance HDR."""
    with open(path, "wb") as f:
        f.write(b"#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n-Y %d +X %d\n" % (height, width))
        for y in range(height):
            f.write(bytes([2, 2, width >> 8, width & 255]))
            row = b"".join(rgbe(color(direction(x, y, width, height))) for x in range(width))
            for c in range(4):
                f.write(run_lengths(row[c::4]))


def rgbe(color):
    largest = max(color)
    mantissa, exponent = math.frexp(largest)
    scale = mantissa * 256 / largest
    return bytes([int(c * scale) for c in color] + [exponent + 128])


def run_lengths(values):
    out, i = bytearray(), 0
    while i < len(values):
        run = 1
        while run < 127 and i + run < len(values) and values[i + run] == values[i]:
            run += 1
        if run >= 4:
            out += bytes([128 + run, values[i]])
            i += run
            continue
        start = i
        while i < len(values) and i - start < 128 and not (
                i + 3 < len(values) and values[i] == values[i + 1] == values[i + 2] == values[i + 3]):
            i += 1
        out += bytes([i - start]) + bytes(values[start:i])
    return bytes(out)


def knot(path, segments=256, sides=24, radius=0.17):
    """A (2, 3) torus knot, lying flat around the y axis, about 1 m across."""
    def center(t):
        r = 0.42 * (2 + math.cos(3 * t)) / 2
        return [r * math.cos(2 * t), 0.42 * math.sin(3 * t) / 1.6, r * math.sin(2 * t)]

    def sub(a, b): return [x - y for x, y in zip(a, b)]
    def cross(a, b): return [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]]

    def unit(a):
        length = math.sqrt(sum(x * x for x in a))
        return [x / length for x in a]

    vertices = []
    for i in range(segments):
        t = 2 * math.pi * i / segments
        h = 1e-3
        tangent = unit(sub(center(t + h), center(t - h)))
        # Frenet frame: it turns smoothly and closes, because the curve has no straight part.
        bend = sub([a + b for a, b in zip(center(t + h), center(t - h))], [2 * c for c in center(t)])
        binormal = unit(cross(tangent, bend))
        normal = cross(binormal, tangent)
        for j in range(sides):
            a = 2 * math.pi * j / sides
            n = [math.cos(a) * u + math.sin(a) * v for u, v in zip(normal, binormal)]
            vertices.append([c + radius * x for c, x in zip(center(t), n)] + n)
    faces = []
    for i in range(segments):
        for j in range(sides):
            a, b = i * sides + j, i * sides + (j + 1) % sides
            c, d = ((i + 1) % segments) * sides + (j + 1) % sides, ((i + 1) % segments) * sides + j
            faces += [[a, b, c], [a, c, d]]
    # Outwards: the first face's normal must agree with its vertices' normals.
    p = [v[:3] for v in vertices]
    n = cross(sub(p[faces[0][1]], p[faces[0][0]]), sub(p[faces[0][2]], p[faces[0][0]]))
    if sum(x * y for x, y in zip(n, vertices[faces[0][0]][3:])) < 0:
        faces = [[a, c, b] for a, b, c in faces]
    with open(path, "wb") as f:
        f.write((f"ply\nformat binary_little_endian 1.0\nelement vertex {len(vertices)}\n"
                 + "".join(f"property float {k}\n" for k in ("x", "y", "z", "nx", "ny", "nz"))
                 + f"element face {len(faces)}\nproperty list uchar int vertex_indices\nend_header\n").encode())
        for v in vertices:
            f.write(struct.pack("<6f", *v))
        for face in faces:
            f.write(struct.pack("<B3i", 3, *face))


def hero():
    """A golden knot on a tiled stage, glass and mirror balls, and a spiral of one shared box, in a calm lake at evening."""
    def hue(t):
        """From terracotta over sand and sage to deep blue."""
        stops = [(0.66, 0.19, 0.1), (0.78, 0.45, 0.18), (0.72, 0.62, 0.38), (0.26, 0.46, 0.36), (0.08, 0.28, 0.48), (0.2, 0.12, 0.38)]
        i = min(int(t * (len(stops) - 1)), len(stops) - 2)
        w = t * (len(stops) - 1) - i
        return [round(a + (b - a) * w, 3) for a, b in zip(stops[i], stops[i + 1])]

    count = 30
    materials = {f"slab{i}": {"type": "diffuse", "reflectance": hue(i / (count - 1))} for i in range(count)}
    objects = [
        {"type": "rectangle", "center": [0, 0, 0], "half_u": [4000, 0, 0], "half_v": [0, 0, -4000], "material": "lake"},
        {"type": "disk", "center": [0, 0.004, 0.3], "normal": [0, 1, 0], "radius": 1.8, "material": "stage"},
        {"type": "mesh", "path": "knot.ply", "material": "gold",
         "transform": [{"rotate": {"axis": [1, 0, 0], "angle": 62}}, {"rotate": {"axis": [0, 1, 0], "angle": -20}},
                       {"translate": [0, 0.875, 0]}]},
        {"type": "sphere", "center": [-1.02, 0.374, 0.95], "radius": 0.37, "material": "glass"},
        {"type": "sphere", "center": [1.04, 0.334, 0.85], "radius": 0.33, "material": "mirror"},
        {"type": "sphere", "center": [0.38, 0.154, 1.4], "radius": 0.15, "material": "slab0"},
        {"type": "sphere", "center": [-0.28, 0.114, 1.5], "radius": 0.11, "material": "slab24"},
        {"type": "sphere", "center": [0.06, 0.084, 1.72], "radius": 0.08, "material": "slab13"},
    ]
    for i in range(count):
        t = i / (count - 1)
        objects.append({"type": "instance", "shape": "box", "material": f"slab{i}", "transform": [
            {"translate": [-0.5, 0, 0.5]}, {"scale": [0.2, round(0.12 + 1.85 * t ** 1.3, 3), 0.5]},
            {"translate": [0, 0, round(-2.6 - 0.2 * t, 3)]}, {"rotate": {"axis": [0, 1, 0], "angle": round(72 - 140 * t, 2)}}]})
    dump("hero.json", {
        "$schema": "../docs/scene.schema.json", "version": 1,
        "comment": "What the program can do: instances, a mesh, glass, mirrors, textures, a sky with a sun.",
        "render": {"integrator": "direct", "max_depth": 12, "spp": 256},
        "film": {"resolution": [960, 540]},
        "camera": {"position": [0, 1.5, 5.9], "look_at": [0, 0.72, 0], "vertical_fov": 29},
        "textures": {"tiles": {"type": "checkerboard", "color0": [0.8, 0.77, 0.7], "color1": [0.3, 0.29, 0.3], "scale": [12, 12]}},
        "materials": {
            "lake": {"type": "mirror", "reflectance": [0.62, 0.66, 0.7]},
            "stage": {"type": "diffuse", "reflectance": "tiles"},
            "gold": {"type": "mirror", "reflectance": [1.0, 0.76, 0.33]},
            "mirror": {"type": "mirror", "reflectance": [0.92, 0.93, 0.94]},
            "glass": {"type": "glass", "eta": 1.5},
            **materials,
        },
        "shapes": {"box": BOX},
        "objects": objects,
        "lights": [{"type": "environment", "path": "evening_sky.hdr", "light_samples": 2}],
    })


def metals():
    """Two rows of balls, polished on the left, rough on the right, and a brushed one, in a studio."""
    roughnesses = [0, 0.15, 0.3, 0.5, 0.75, 1]
    materials = {
        "floor": {"type": "diffuse", "reflectance": {"type": "checkerboard", "color0": [0.25, 0.25, 0.27],
                                                     "color1": [0.16, 0.16, 0.17], "scale": 24}},
        "lamp": {"type": "diffuse", "reflectance": 0},
    }
    objects = [{"type": "rectangle", "half_u": [8, 0, 0], "half_v": [0, 0, -8], "material": "floor"}]
    for row, (metal, z) in enumerate((("gold", 0), ("chromium", -1.25))):
        for i, roughness in enumerate(roughnesses):
            name = f"{metal}{i}"
            materials[name] = {"type": "conductor", "metal": metal, "roughness": roughness}
            objects.append({"type": "sphere", "center": [1.1 * (i - 2.5), 0.5, z], "radius": 0.5, "material": name})
    materials["brushed"] = {"type": "conductor", "metal": "copper", "roughness": [0.75, 0.2]}
    objects.append({"type": "disk", "center": [0, 1.1, -2.6], "normal": [0, 0.1, 1], "radius": 1, "material": "brushed"})
    for x, color in ((-3.5, [9, 8.2, 7]), (3.5, [6, 7, 9])):
        objects.append({"type": "rectangle", "center": [x, 4, 2], "half_u": [0.8, 0, 0], "half_v": [0, 0, 0.8],
                        "material": "lamp", "light": {"radiance": color, "light_samples": 2, "two_sided": True}})
    dump("metals.json", {
        "$schema": "../docs/scene.schema.json",
        "version": 1,
        "comment": "Gold and chromium from polished to rough, and brushed copper.",
        "render": {"integrator": "direct", "max_depth": 8, "spp": 64},
        "film": {"resolution": [720, 405]},
        "camera": {"position": [0, 2.4, 7.5], "look_at": [0, 0.62, -0.7], "vertical_fov": 28},
        "materials": materials,
        "objects": objects,
        "lights": [{"type": "environment", "path": "evening_sky.hdr", "light_samples": 4}],
    })


def frosted():
    """Glass from clear to frosted, and a pane in front of coloured clay balls."""
    materials = {
        "floor": {"type": "diffuse", "reflectance": {"type": "checkerboard", "color0": 0.7, "color1": [0.2, 0.3, 0.35],
                                                     "scale": 32}},
        "pane": {"type": "thin_glass", "transmittance": [0.85, 0.95, 0.9]},
        "lamp": {"type": "diffuse", "reflectance": 0},
    }
    objects = [{"type": "rectangle", "half_u": [8, 0, 0], "half_v": [0, 0, -8], "material": "floor"}]
    for i, roughness in enumerate((0, 0.2, 0.35, 0.5, 0.75)):
        materials[f"glass{i}"] = {"type": "glass", "roughness": roughness}
        objects.append({"type": "sphere", "center": [1.2 * (i - 2), 0.5, 0], "radius": 0.5, "material": f"glass{i}"})
    for i, (color, roughness) in enumerate((([0.7, 0.2, 0.12], 0), ([0.7, 0.2, 0.12], 1))):
        materials[f"clay{i}"] = {"type": "diffuse", "reflectance": color, "roughness": roughness}
        objects.append({"type": "sphere", "center": [2.2 * i - 1.1, 0.7, -2], "radius": 0.7, "material": f"clay{i}"})
    objects.append({"type": "rectangle", "center": [-1.1, 0.9, -1.1], "half_u": [0.9, 0, 0.1], "half_v": [0, 0.9, 0],
                    "material": "pane"})
    objects.append({"type": "rectangle", "center": [-2.5, 4, 3], "half_u": [0.8, 0, 0], "half_v": [0, 0, 0.8],
                    "material": "lamp", "light": {"radiance": [14, 13, 12], "light_samples": 2}})
    dump("frosted.json", {
        "$schema": "../docs/scene.schema.json",
        "version": 1,
        "comment": "Glass from clear to frosted, a window pane, smooth and rough clay.",
        "render": {"integrator": "direct", "max_depth": 8, "spp": 64},
        "film": {"resolution": [720, 405]},
        "camera": {"position": [0, 2.2, 7.5], "look_at": [0, 0.6, -0.7], "vertical_fov": 27},
        "materials": materials,
        "objects": objects,
        "lights": [{"type": "environment", "radiance": [0.6, 0.7, 0.9], "light_samples": 2}],
    })


def photometric(path):
    """An IES file of a downlight with two wings along its plane 0."""
    vertical, horizontal = range(0, 91, 5), range(0, 181, 15)

    def candela(v, h):
        wings = math.exp(-((v - 38) / 14) ** 2) * (0.35 + 0.65 * math.cos(math.radians(h)) ** 2)
        return 900 * (wings + 0.45 * math.exp(-(v / 22) ** 2)) * math.sqrt(max(math.cos(math.radians(v)), 0))

    rows = [[str(v) for v in vertical], [str(h) for h in horizontal]]
    rows += [[f"{candela(v, h):.1f}" for v in vertical] for h in horizontal]
    with open(path, "w", encoding="ascii") as out:
        out.write("IESNA:LM-63-2002\n[TEST] made up\n[MANUFAC] Steradian\n[LUMINAIRE] a downlight with two wings\nTILT=NONE\n")
        out.write(f"1 -1 1 {len(vertical)} {len(horizontal)} 1 2 0.1 0.1 0\n1 1 20\n")
        out.writelines(" ".join(row) + "\n" for row in rows)


def downlights():
    """Lights from a photometric file on a wall, and a textured one."""
    photometric("downlight.ies")
    lamp = {"type": "goniometric", "path": "downlight.ies", "intensity": [0.02, 0.017, 0.013]}
    dump("downlights.json", {
        "$schema": "../docs/scene.schema.json",
        "version": 1,
        "comment": "Three downlights from a photometric file, turned by 0, 45 and 90 degrees, and a screen.",
        "render": {"max_depth": 6, "spp": 256},
        "film": {"resolution": [960, 480]},
        "camera": {"position": [0, 1.5, 4.6], "look_at": [0, 1.25, 0], "vertical_fov": 38},
        "textures": {"screen": {"type": "checkerboard", "color0": [0.1, 0.5, 1], "color1": [1, 0.3, 0.05],
                                "scale": [8, 4]}},
        "materials": {
            "plaster": {"type": "diffuse", "reflectance": [0.75, 0.73, 0.7]},
            "floor": {"type": "diffuse", "reflectance": [0.35, 0.3, 0.26]},
            "metal": {"type": "conductor", "metal": "aluminium", "roughness": 0.3},
        },
        "objects": [
            {"type": "rectangle", "center": [0, 1.4, 0], "half_u": [3.4, 0, 0], "half_v": [0, 1.4, 0],
             "material": "plaster"},
            {"type": "rectangle", "center": [0, 0, 2.5], "half_u": [3.4, 0, 0], "half_v": [0, 0, -2.5],
             "material": "floor"},
            {"type": "rectangle", "center": [0, 2.8, 2.5], "half_u": [3.4, 0, 0], "half_v": [0, 0, 2.5],
             "material": "plaster"},
            {"type": "sphere", "center": [-1.5, 0.3, 0.9], "radius": 0.3, "material": "metal"},
            {"type": "rectangle", "center": [1.5, 0.35, 0.7], "half_u": [0.5, 0, 0], "half_v": [0, 0.25, -0.05],
             "light": {"radiance": 6, "texture": "screen"}},
        ],
        "lights": [dict(lamp, position=[x, 2.7, 0.35], rotation=turn) for x, turn in ((-2, 0), (0, 45), (2, 90))],
    })


if __name__ == "__main__":
    cornell()
    spheres()
    sun_sky()
    evening_sky()
    knot("knot.ply")
    hero()
    metals()
    frosted()
    downlights()
