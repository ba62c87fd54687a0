"""Makes the four scenes of render.py, each hard in a way of its own: write_scenes(folder) returns {name: path}."""
import math
import pathlib
import random
import shutil
import sys

SCENES = pathlib.Path(__file__).resolve().parent.parent / "scenes"
sys.path.insert(0, str(SCENES))
import make_scenes  # noqa: E402  (a script beside the scenes, found by the line above)

SIZE = [256, 144]


def scene(comment, camera, materials, objects, lights=(), shapes=None):
    return {
        "version": 1, "comment": comment,
        "render": {"integrator": "path", "max_depth": 16},
        "film": {"resolution": SIZE},
        "camera": camera, "materials": materials, "shapes": shapes or {}, "objects": list(objects), "lights": list(lights),
    }


def diffuse(*color):
    return {"type": "diffuse", "reflectance": list(color), "two_sided": True}


def block(low, high, material):
    """An instance of the unit box from corner to corner."""
    (x0, y0, z0), (x1, y1, z1) = low, high
    return {"type": "instance", "shape": "box", "material": material,
            "transform": [{"scale": [x1 - x0, y1 - y0, z1 - z0]}, {"translate": [x0, y0, z1]}]}


def cornell():
    """A lamp above two boxes: colours bleed, and every lamp is seen from everywhere but the shadows."""
    room = make_scenes.room(
        "Boxes under a square lamp.",
        objects=[{"type": "rectangle", "center": [0, 1.98, 0], "half_u": [0.25, 0, 0], "half_v": [0, 0, 0.25],
                  "material": {"type": "diffuse", "reflectance": 0}, "light": {"radiance": [17, 12, 5]}}],
        render={"integrator": "path", "max_depth": 16}, film={"resolution": SIZE})
    del room["$schema"]
    return room


def interior():
    """A furnished room under a sky with a sun that comes in by one window: nearly all light has bounced before."""
    materials = {
        "plaster": diffuse(0.78, 0.76, 0.72), "floor": {"type": "diffuse", "reflectance": {
            "type": "checkerboard", "color0": [0.42, 0.27, 0.16], "color1": [0.33, 0.2, 0.11], "scale": [12, 16]}},
        "wood": diffuse(0.45, 0.28, 0.15), "cloth": diffuse(0.16, 0.25, 0.42), "rug": diffuse(0.55, 0.12, 0.1),
        "steel": {"type": "conductor", "metal": "steel", "roughness": 0.45}, "glaze": diffuse(0.7, 0.68, 0.3),
        "earth": diffuse(0.3, 0.27, 0.2),
    }
    thick = 0.3
    objects = [
        {"type": "rectangle", "center": [0, -0.3, 0], "half_u": [60, 0, 0], "half_v": [0, 0, -60], "material": "earth"},
        {"type": "rectangle", "center": [0, 0, 0], "half_u": [2.5, 0, 0], "half_v": [0, 0, -3.5], "material": "floor"},
        block([-2.5, 2.7, -3.5], [2.5, 3, 3.5], "plaster"),
        block([-2.5, 0, -3.5 - thick], [2.5, 2.7, -3.5], "plaster"),
        block([-2.5, 0, 3.5], [2.5, 2.7, 3.5 + thick], "plaster"),
        block([2.5, 0, -3.5], [2.5 + thick, 2.7, 3.5], "plaster"),
        # The wall with the window, in four parts round the opening.
        block([-2.5 - thick, 0, -3.5], [-2.5, 0.9, 3.5], "plaster"),
        block([-2.5 - thick, 2.2, -3.5], [-2.5, 2.7, 3.5], "plaster"),
        block([-2.5 - thick, 0.9, -3.5], [-2.5, 2.2, -1.9], "plaster"),
        block([-2.5 - thick, 0.9, 0.1], [-2.5, 2.2, 3.5], "plaster"),
        block([-2.55, 0.9, -0.93], [-2.45, 2.2, -0.87], "wood"),
        # A table with a ball and a vase, a sofa, a shelf, a rug.
        block([-1.1, 0.7, -2.0], [0.5, 0.76, -1.1], "wood"),
        *(block([x, 0, z], [x + 0.07, 0.7, z + 0.07], "wood") for x in (-1.05, 0.38) for z in (-1.95, -1.22)),
        {"type": "sphere", "center": [-0.65, 0.94, -1.5], "radius": 0.18, "material": "steel"},
        {"type": "sphere", "center": [-0.05, 0.9, -1.6], "radius": 0.14, "material": "glaze"},
        block([1.5, 0, -2.6], [2.4, 0.42, -0.4], "cloth"), block([2.2, 0.42, -2.6], [2.45, 0.95, -0.4], "cloth"),
        *(block([-0.9 + 0.02 * i, y, -3.45], [1.2, y + 0.04, -3.15], "wood") for i, y in enumerate((1.2, 1.6, 2.0))),
        *(block([-0.7 + 0.21 * i, 1.24, -3.4], [-0.6 + 0.21 * i, 1.42 + 0.03 * (i % 4), -3.2], ("rug", "cloth", "glaze")[i % 3])
          for i in range(8)),
        block([-0.6, 0, -1.0], [1.3, 0.015, 1.0], "rug"),
    ]
    sky = {"type": "environment", "path": "sun_sky.hdr", "rotation": 62}
    return scene("A room lit through a window.",
                 {"position": [1.5, 1.5, 3.3], "look_at": [-0.35, 1.0, -2.2], "vertical_fov": 48},
                 materials, objects, [sky], {"box": make_scenes.BOX})


def objects():
    """Rough metals and clear and frosted glass under an evening sky with a low sun: glossy light paths and caustics."""
    materials = {
        "ground": diffuse(0.4, 0.38, 0.36),
        "gold": {"type": "conductor", "metal": "gold", "roughness": 0.4},
        "brushed": {"type": "conductor", "metal": "aluminium", "roughness": [0.7, 0.25]},
        "copper": {"type": "conductor", "metal": "copper", "roughness": 0.6},
        "glass": {"type": "glass"}, "frosted": {"type": "glass", "roughness": 0.4},
    }
    things = [
        {"type": "disk", "normal": [0, 1, 0], "radius": 30, "material": "ground"},
        {"type": "mesh", "path": "knot.ply", "material": "gold",
         "transform": [{"rotate": {"axis": [1, 0, 0], "angle": 62}}, {"translate": [0, 0.87, 0]}]},
        {"type": "sphere", "center": [-1.15, 0.38, 0.8], "radius": 0.38, "material": "glass"},
        {"type": "sphere", "center": [1.1, 0.34, 0.9], "radius": 0.34, "material": "frosted"},
        {"type": "sphere", "center": [0.1, 0.22, 1.35], "radius": 0.22, "material": "copper"},
        {"type": "disk", "center": [0, 1.2, -1.9], "normal": [0.1, 0.05, 1], "radius": 1.2, "material": "brushed"},
    ]
    sky = {"type": "environment", "path": "evening_sky.hdr"}
    return scene("Metals and glass under a sky.",
                 {"position": [0, 1.5, 5.9], "look_at": [0, 0.72, 0], "vertical_fov": 29}, materials, things, [sky])


def lamp_mesh(centers, size):
    """One triangle for each lamp, turned at random: a mesh of triangles that share nothing."""
    vertices = []
    for x, y, z, turn in centers:
        for corner in range(3):
            angle = turn + 2 * math.pi * corner / 3
            vertices.append([round(x + size * math.cos(angle), 4), round(y, 4), round(z + size * math.sin(angle), 4)])
    return {"vertices": vertices, "triangles": [[3 * i, 3 * i + 1, 3 * i + 2] for i in range(len(centers))]}


def lamps(count=10_000):
    """Strings of small lamps in a hall of columns: ten colours, powers over two decades, most lamps far from any place."""
    numbers = random.Random(20)
    colors = [(1, 0.25, 0.1), (1, 0.6, 0.2), (1, 0.85, 0.6), (0.3, 0.6, 1), (0.2, 1, 0.5)]
    strings, per_string = 50, count // 50
    groups = [[] for _ in range(10)]
    for s in range(strings):
        x0, x1 = numbers.uniform(-14, 14), numbers.uniform(-14, 14)
        z0, z1 = -1.5 - 0.56 * s, -1.5 - 0.56 * s + numbers.uniform(-4, 4)
        height, sag = numbers.uniform(2.5, 5), numbers.uniform(0.4, 1.8)
        for i in range(per_string):
            t = (i + 0.5) / per_string
            groups[s % 10].append((x0 + t * (x1 - x0), height - sag * 4 * t * (1 - t), z0 + t * (z1 - z0), numbers.uniform(0, 7)))
    materials = {"stone": diffuse(0.6, 0.57, 0.52), "marble": diffuse(0.75, 0.75, 0.78), "dark": diffuse(0, 0, 0),
                 "bronze": {"type": "conductor", "metal": "copper", "roughness": 0.5}}
    things = [
        {"type": "rectangle", "center": [0, 0, -14], "half_u": [16, 0, 0], "half_v": [0, 0, -17], "material": "stone"},
        {"type": "rectangle", "center": [0, 3.5, -30], "half_u": [16, 0, 0], "half_v": [0, 3.5, 0], "material": "stone"},
        {"type": "sphere", "center": [0, 0.9, -5], "radius": 0.9, "material": "bronze"},
        *(block([x, 0, z - 0.6], [x + 0.6, 5.5, z], "marble") for x in (-8, -4.5, 3.9, 7.4) for z in (-3, -8, -13, -18, -23)),
    ]
    for i, group in enumerate(groups):
        power = 3.0 * 100 ** (i / 9)
        things.append({"type": "mesh", "material": "dark", **lamp_mesh(group, 0.025),
                       "light": {"radiance": [round(power * c, 4) for c in colors[i % 5]], "two_sided": True}})
    return scene(f"{count} lamps.", {"position": [0, 2.2, 3.5], "look_at": [0, 1.7, -8], "vertical_fov": 45},
                 materials, things, [], {"box": make_scenes.BOX})


FILES = ("sun_sky.hdr", "evening_sky.hdr", "knot.ply")
ALL = {"cornell": cornell, "interior": interior, "objects": objects, "lamps": lamps}


def write_scenes(folder, names):
    folder = pathlib.Path(folder)
    folder.mkdir(parents=True, exist_ok=True)
    for name in FILES:  # beside the scenes, which are then the same bytes wherever they lie
        shutil.copy(SCENES / name, folder)
    paths = {}
    for name in names:
        paths[name] = folder / f"{name}.json"
        make_scenes.dump(paths[name], ALL[name]())
    return paths
