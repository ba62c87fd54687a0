#!/usr/bin/env python3
"""Writes the seeds of the glTF fuzz target, fuzz/corpus/gltf/, its dictionary, fuzz/dictionaries/gltf, and fuzz/corpus/webp/.

    fuzz/formats/make_gltf_corpus.py

Small files that together use every part of the reader. They are the same bytes each time. Needs the libraries that the
reader needs, and for Draco the program draco_encoder (Debian's package draco).
"""
import base64
import ctypes
import json
import pathlib
import re
import struct
import subprocess
import tempfile

FUZZ = pathlib.Path(__file__).resolve().parent.parent
OUT = FUZZ / "corpus" / "gltf"
TRIANGLE = [0, 0, 0, 1, 0, 0, 0, 1, 0]
FLOAT, U8, I8, U16, I16, U32 = 5126, 5121, 5120, 5123, 5122, 5125
CODES = {FLOAT: "f", U8: "B", I8: "b", U16: "H", I16: "h", U32: "I"}
SIZES = {"SCALAR": 1, "VEC2": 2, "VEC3": 3, "VEC4": 4}


class File:
    """A glTF file under construction: a JSON tree and one buffer."""

    def __init__(self, **members):
        self.data = b""
        self.tree = {"asset": {"version": "2.0"}, **members}

    def add(self, table, element):
        self.tree.setdefault(table, []).append(element)
        return len(self.tree[table]) - 1

    def view(self, data, **more):
        self.data += b"\0" * (-len(self.data) % 4)
        begin = len(self.data)
        self.data += data
        return self.add("bufferViews", {"buffer": 0, "byteOffset": begin, "byteLength": len(data), **more})

    def accessor(self, kind, component, values, **more):
        data = struct.pack(f"<{len(values)}{CODES[component]}", *values)
        return self.add("accessors", {"bufferView": self.view(data), "componentType": component, "type": kind,
                                      "count": len(values) // SIZES[kind], **more})

    def mesh(self, attributes, **more):
        return self.add("meshes", {"primitives": [{"attributes": attributes, **more}]})

    def text(self):
        tree = dict(self.tree)
        if self.data:
            uri = "data:application/octet-stream;base64," + base64.b64encode(self.data).decode()
            tree["buffers"] = [{"byteLength": len(self.data), "uri": uri}]
        return json.dumps(tree, separators=(",", ":")).encode()

    def binary(self):
        tree = dict(self.tree)
        if self.data:
            tree["buffers"] = [{"byteLength": len(self.data)}]
        body = json.dumps(tree, separators=(",", ":")).encode()
        out = b""
        for kind, chunk, pad in ((b"JSON", body, b" "), (b"BIN\0", self.data, b"\0")):
            chunk += pad * (-len(chunk) % 4)
            out += struct.pack("<I", len(chunk)) + kind + chunk
        return b"glTF" + struct.pack("<II", 2, 12 + len(out)) + out


def indexed():
    f = File(nodes=[{"mesh": 0}], scenes=[{"nodes": [0]}], scene=0)
    attributes = {"POSITION": f.accessor("VEC3", FLOAT, TRIANGLE, min=[0, 0, 0], max=[1, 1, 0]),
                  "NORMAL": f.accessor("VEC3", FLOAT, [0, 0, 1] * 3),
                  "TEXCOORD_0": f.accessor("VEC2", FLOAT, [0, 0, 1, 0, 0, 1])}
    f.mesh(attributes, indices=f.accessor("SCALAR", U16, [0, 1, 2]), mode=4)
    return f.text()


def strip_and_fan():
    f = File(nodes=[{"mesh": 0}, {"mesh": 1}])
    p = f.accessor("VEC3", FLOAT, TRIANGLE + [1, 1, 0])
    f.mesh({"POSITION": p}, mode=5, indices=f.accessor("SCALAR", U8, [0, 1, 2, 3]))
    f.mesh({"POSITION": p}, mode=6, indices=f.accessor("SCALAR", U32, [0, 1, 3, 2]))
    return f.binary()


def quantized():
    f = File(nodes=[{"mesh": 0}], extensionsUsed=["KHR_mesh_quantization"], extensionsRequired=["KHR_mesh_quantization"])
    corners = [(0, 0, 0, 0), (300, 0, 255, 0), (0, 300, 0, 255)]
    data = b"".join(struct.pack("<hhhhbbbbBBBB", x, y, 0, 0, 0, 0, 127, 0, u, v, 9, 9) for x, y, u, v in corners)
    view = f.view(data, byteStride=16)
    at = lambda offset, kind, component, **more: f.add("accessors", {
        "bufferView": view, "byteOffset": offset, "componentType": component, "count": 3, "type": kind, **more})
    f.mesh({"POSITION": at(0, "VEC3", I16), "NORMAL": at(8, "VEC3", I8, normalized=True),
            "TEXCOORD_0": at(12, "VEC2", U8, normalized=True)})
    return f.binary()


def sparse():
    f = File(nodes=[{"mesh": 0}])
    p = f.accessor("VEC3", FLOAT, TRIANGLE)
    f.tree["accessors"][p]["sparse"] = {
        "count": 2, "indices": {"bufferView": f.view(struct.pack("<HH", 0, 2)), "componentType": U16},
        "values": {"bufferView": f.view(struct.pack("<6f", 5, 6, 7, 8, 9, 10))}}
    f.mesh({"POSITION": p})
    return f.text()


def nodes():
    f = File(nodes=[{"children": [1, 2, 3], "translation": [1, 2, 3], "rotation": [0, 0, 0.6, 0.8], "scale": [1, 2, 1]},
                    {"mesh": 0, "matrix": [1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 5, 1], "name": "a"},
                    {"camera": 0, "extensions": {"KHR_lights_punctual": {"light": 2}}},
                    {"camera": 1, "extensions": {"KHR_lights_punctual": {"light": 0}}},
                    {"extensions": {"KHR_lights_punctual": {"light": 1}}}],
             scenes=[{"nodes": [0, 4]}, {"nodes": []}], scene=0,
             cameras=[{"type": "perspective", "perspective": {"yfov": 1, "znear": 0.1, "aspectRatio": 2}},
                      {"type": "orthographic", "orthographic": {"xmag": 1, "ymag": 1, "znear": 0, "zfar": 9}}],
             extensionsUsed=["KHR_lights_punctual"],
             extensions={"KHR_lights_punctual": {"lights": [
                 {"type": "point", "intensity": 5, "range": 9}, {"type": "directional", "color": [1, 1, 0.5]},
                 {"type": "spot", "spot": {"innerConeAngle": 0.1, "outerConeAngle": 0.5}}]}})
    f.mesh({"POSITION": f.accessor("VEC3", FLOAT, TRIANGLE)})
    return f.text()


def instancing():
    f = File(extensionsUsed=["EXT_mesh_gpu_instancing"])
    f.mesh({"POSITION": f.accessor("VEC3", FLOAT, TRIANGLE)})
    attributes = {"TRANSLATION": f.accessor("VEC3", FLOAT, [0, 0, 0, 3, 0, 0]),
                  "ROTATION": f.accessor("VEC4", I16, [0, 0, 0, 32767, 0, 23170, 0, 23170], normalized=True),
                  "SCALE": f.accessor("VEC3", FLOAT, [1, 1, 1, 2, 2, 2])}
    f.tree["nodes"] = [{"mesh": 0, "extensions": {"EXT_mesh_gpu_instancing": {"attributes": attributes}}}]
    return f.binary()


MATERIALS = [
    {"pbrMetallicRoughness": {"baseColorFactor": [1, 0.5, 0.2, 0.5], "metallicFactor": 0.5, "roughnessFactor": 0.3},
     "alphaMode": "BLEND", "doubleSided": True},
    {"emissiveFactor": [1, 1, 0], "extensions": {"KHR_materials_emissive_strength": {"emissiveStrength": 5}}},
    {"extensions": {"KHR_materials_unlit": {}}},
    {"extensions": {"KHR_materials_clearcoat": {"clearcoatFactor": 1, "clearcoatRoughnessFactor": 0.1},
                    "KHR_materials_sheen": {"sheenColorFactor": [1, 0, 0], "sheenRoughnessFactor": 0.5},
                    "KHR_materials_anisotropy": {"anisotropyStrength": 0.5, "anisotropyRotation": 1}}},
    {"pbrMetallicRoughness": {"metallicFactor": 0, "roughnessFactor": 0},
     "extensions": {"KHR_materials_transmission": {"transmissionFactor": 1}, "KHR_materials_ior": {"ior": 1.4},
                    "KHR_materials_volume": {"thicknessFactor": 1, "attenuationDistance": 2,
                                             "attenuationColor": [1, 0.5, 0.5]}}},
    {"extensions": {"KHR_materials_specular": {"specularFactor": 0.5, "specularColorFactor": [1, 2, 1]},
                    "KHR_materials_diffuse_transmission": {"diffuseTransmissionFactor": 0.5}}},
]


def materials():
    f = File(materials=MATERIALS, extensionsUsed=sorted({e for m in MATERIALS for e in m.get("extensions", {})}),
             nodes=[{"mesh": i} for i in range(len(MATERIALS))])
    p = f.accessor("VEC3", FLOAT, TRIANGLE)
    for i in range(len(MATERIALS)):
        f.mesh({"POSITION": p}, material=i)
    return f.text()


def variants():
    f = File(nodes=[{"mesh": 0}], materials=[{}, {"doubleSided": True}],
             extensions={"KHR_materials_variants": {"variants": [{"name": "a"}, {"name": "b"}]}})
    f.mesh({"POSITION": f.accessor("VEC3", FLOAT, TRIANGLE)}, material=0, extensions={
        "KHR_materials_variants": {"mappings": [{"material": 1, "variants": [0, 1]}]}})
    return f.text()


TEXTURED_EXTENSIONS = {
    "KHR_materials_specular": {"specularTexture": {"index": 0}, "specularColorTexture": {"index": 1}},
    "KHR_materials_clearcoat": {"clearcoatFactor": 1, "clearcoatTexture": {"index": 0}, "clearcoatRoughnessFactor": 1,
                                "clearcoatRoughnessTexture": {"index": 1}, "clearcoatNormalTexture": {"index": 0}},
    "KHR_materials_anisotropy": {"anisotropyStrength": 0.5, "anisotropyRotation": 1, "anisotropyTexture": {"index": 1}},
    "KHR_materials_sheen": {"sheenColorFactor": [1, 1, 1], "sheenRoughnessFactor": 1,
                            "sheenRoughnessTexture": {"index": 0}},
    "KHR_materials_iridescence": {"iridescenceFactor": 1, "iridescenceTexture": {"index": 1}},
    "KHR_materials_diffuse_transmission": {"diffuseTransmissionFactor": 1, "diffuseTransmissionTexture": {"index": 0},
                                           "diffuseTransmissionColorTexture": {"index": 1}},
}


def textured(picture, kind):
    f = File(extensionsUsed=sorted([*TEXTURED_EXTENSIONS, "KHR_materials_pbrSpecularGlossiness"]), nodes=[{"mesh": 0}, {"mesh": 1}], samplers=[{"magFilter": 9728, "wrapS": 33071, "wrapT": 33648}],
             textures=[{"source": 0, "sampler": 0}, {"source": 0}],
             materials=[{"pbrMetallicRoughness": {
                 "baseColorTexture": {"index": 0, "extensions": {"KHR_texture_transform": {
                     "offset": [0.5, 0], "scale": [2, 2], "rotation": 0.5, "texCoord": 0}}},
                 "metallicRoughnessTexture": {"index": 1, "texCoord": 0}},
                 "normalTexture": {"index": 1, "scale": 0.5}, "occlusionTexture": {"index": 1},
                 "emissiveTexture": {"index": 1}, "emissiveFactor": [1, 1, 1], "alphaMode": "MASK", "alphaCutoff": 0.4,
                 "extensions": TEXTURED_EXTENSIONS},
                 {"extensions": {"KHR_materials_pbrSpecularGlossiness": {
                     "diffuseFactor": [1, 0.5, 0.2, 1], "diffuseTexture": {"index": 0}, "specularFactor": [0.5, 0.4, 0.3],
                     "glossinessFactor": 0.7, "specularGlossinessTexture": {"index": 1}}}}])
    f.add("images", {"bufferView": f.view(picture), "mimeType": kind})
    attributes = {"POSITION": f.accessor("VEC3", FLOAT, TRIANGLE), "TEXCOORD_0": f.accessor("VEC2", FLOAT, [0, 0, 1, 0, 0, 1])}
    for material in (0, 1):
        f.mesh(attributes, material=material)
    return f.binary()


def moving():
    """A little of skins, morph targets and animation."""
    f = File(nodes=[{"mesh": 0, "skin": 0, "weights": [0.5]}, {"name": "bone", "children": [2]}, {}],
             scenes=[{"nodes": [0, 1]}])
    p = f.accessor("VEC3", FLOAT, TRIANGLE)
    identity = [1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1]
    data = struct.pack("<32f", *identity, *identity)
    matrices = f.add("accessors", {"bufferView": f.view(data), "componentType": FLOAT, "type": "MAT4", "count": 2})
    f.add("skins", {"joints": [1, 2], "inverseBindMatrices": matrices})
    f.mesh({"POSITION": p, "JOINTS_0": f.accessor("VEC4", U8, [0, 1, 0, 0] * 3),
            "WEIGHTS_0": f.accessor("VEC4", FLOAT, [0.5, 0.5, 0, 0] * 3), "COLOR_0": p}, targets=[{"POSITION": p}])
    times, moves = f.accessor("SCALAR", FLOAT, [0, 1]), f.accessor("VEC3", FLOAT, [0, 0, 0, 1, 0, 0])
    f.add("animations", {"samplers": [{"input": times, "output": moves, "interpolation": "LINEAR"}],
                         "channels": [{"sampler": 0, "target": {"node": 1, "path": "translation"}}]})
    return f.binary()


IDENTITY = [1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1]


def animated():
    """Every path and interpolation, and normalised integers."""
    f = File(nodes=[{"mesh": 0, "weights": [0.5, 1]}, {"children": [0], "name": "parent"}], scenes=[{"nodes": [1]}])
    p = f.accessor("VEC3", FLOAT, TRIANGLE)
    n = f.accessor("VEC3", FLOAT, [0, 0, 1] * 3)
    small = f.accessor("VEC3", I8, [127, 0, 0, 0, -127, 0, 1, 2, 3], normalized=True)
    moved = f.add("accessors", {"componentType": FLOAT, "type": "VEC3", "count": 3, "sparse": {
        "count": 1, "indices": {"bufferView": f.view(struct.pack("<H", 2)), "componentType": U16},
        "values": {"bufferView": f.view(struct.pack("<3f", 5, 6, 7))}}})
    f.mesh({"POSITION": p, "NORMAL": n, "TEXCOORD_0": f.accessor("VEC2", FLOAT, [0, 0, 1, 0, 0, 1])},
           targets=[{"POSITION": moved, "NORMAL": small}, {"POSITION": small}])
    f.tree["meshes"][0]["weights"] = [0, 1]
    times = f.accessor("SCALAR", FLOAT, [0, 0.25, 1])
    two = f.accessor("SCALAR", FLOAT, [0, 1])
    outputs = [("translation", "STEP", times, f.accessor("VEC3", FLOAT, range(9)), 1),
               ("rotation", "LINEAR", times, f.accessor("VEC4", I16, [0, 0, 0, 32767, 0, 0, 32767, 0, 0, 32767, 0, 0], normalized=True), 1),
               ("scale", "CUBICSPLINE", two, f.accessor("VEC3", FLOAT, [0, 0, 0, 1, 1, 1, 1, 0, 0, 0, 0, 0, 2, 2, 2, 0, 0, 0]), 1),
               ("weights", "LINEAR", two, f.accessor("SCALAR", U8, [0, 255, 255, 0], normalized=True), 0),
               ("rotation", "CUBICSPLINE", two, f.accessor("VEC4", FLOAT, [0, 0, 0, 0, 0, 0, 0, 1, 0, 0, 0, 1] * 2), 0)]
    f.add("animations", {
        "name": "all",
        "samplers": [{"input": i, "output": o, "interpolation": kind} for _, kind, i, o, _ in outputs],
        "channels": [{"sampler": k, "target": {"node": node, "path": path}} for k, (path, *_, node) in enumerate(outputs)]})
    return f.binary()


def skinned():
    """Two sets of joints, two skins of one mesh, a morph before them."""
    f = File(nodes=[{"mesh": 0, "skin": 0}, {"mesh": 0, "skin": 1, "weights": [0.5]}, {"children": [3], "scale": [1, -1, 1]},
                    {"rotation": [0, 0, 0.6, 0.8]}])
    p = f.accessor("VEC3", FLOAT, TRIANGLE)
    data = struct.pack("<32f", *IDENTITY, *IDENTITY)
    matrices = f.add("accessors", {"bufferView": f.view(data), "componentType": FLOAT, "type": "MAT4", "count": 2})
    f.tree["skins"] = [{"joints": [2, 3], "inverseBindMatrices": matrices}, {"joints": [3, 2, 2]}]
    f.mesh({"POSITION": p, "NORMAL": f.accessor("VEC3", FLOAT, [0, 0, 1] * 3),
            "TANGENT": f.accessor("VEC4", FLOAT, [1, 0, 0, 1] * 3),
            "JOINTS_0": f.accessor("VEC4", U8, [0, 1, 0, 0] * 3), "JOINTS_1": f.accessor("VEC4", U16, [1, 0, 1, 0] * 3),
            "WEIGHTS_0": f.accessor("VEC4", U8, [128, 64, 0, 0] * 3, normalized=True),
            "WEIGHTS_1": f.accessor("VEC4", U16, [4096, 12288, 0, 0] * 3, normalized=True)}, targets=[{"POSITION": p}])
    return f.text()


def webp(width, height, channels, lossless):
    library = ctypes.CDLL("libwebp.so.7")
    pixels = bytes((i * 53 + i // 7) % 256 for i in range(width * height * channels))
    out = ctypes.POINTER(ctypes.c_uint8)()
    name = f"WebPEncode{'Lossless' if lossless else ''}{'RGBA' if channels == 4 else 'RGB'}"
    encode = getattr(library, name)
    encode.restype = ctypes.c_size_t
    quality = [] if lossless else [ctypes.c_float(75)]
    size = encode(pixels, width, height, width * channels, *quality, ctypes.byref(out))
    return ctypes.string_at(out, size)


def meshopt(name, *arguments, size=4096):
    library = ctypes.CDLL("libmeshoptimizer.so.2d")
    encode = getattr(library, "meshopt_encode" + name)
    encode.restype = ctypes.c_size_t
    out = ctypes.create_string_buffer(size)
    written = encode(out, ctypes.c_size_t(size), *arguments)
    return out.raw[:written]


def meshopt_vertices(data, stride):
    return meshopt("VertexBuffer", data, ctypes.c_size_t(len(data) // stride), ctypes.c_size_t(stride))


def meshopt_indices(name, indices):
    return meshopt(name, (ctypes.c_uint32 * len(indices))(*indices), ctypes.c_size_t(len(indices)))


def meshopt_file():
    """Every mode and every filter."""
    f = File(extensionsUsed=["EXT_meshopt_compression"], extensionsRequired=["EXT_meshopt_compression"],
             nodes=[{"mesh": 0, "rotation": [0, 0, 0, 1]}, {"mesh": 1}])

    def view(data, mode, count, stride, filter="NONE"):
        begin = len(f.data)
        f.data += data
        return f.add("bufferViews", {
            "buffer": 0, "byteLength": count * stride, **({"byteStride": stride} if mode == "ATTRIBUTES" else {}),
            "extensions": {"EXT_meshopt_compression": {"buffer": 0, "byteOffset": begin, "byteLength": len(data),
                                                       "byteStride": stride, "count": count, "mode": mode, "filter": filter}}})

    n = 6
    points = [(x, y, x * y % 3) for y in range(n) for x in range(n)]
    floats = struct.pack(f"<{3 * n * n}f", *[c for p in points for c in p])
    exponents = struct.pack(f"<{3 * n * n}I", *[(0xFC << 24 | c * 16) & 0xFFFFFFFF for p in points for c in p])
    normals = struct.pack(f"<{4 * n * n}b", *[c for i in range(n * n) for c in (i, -i, 127, 0)])
    turns = struct.pack(f"<{4 * n * n}h", *[c for i in range(n * n) for c in (i * 50, -i * 30, 7, 0x7FFC | i % 4)])
    corners = [y * n + x + d for y in range(n - 1) for x in range(n - 1) for d in (0, 1, n, 1, n + 1, n)]
    whole = {"count": n * n, "componentType": FLOAT, "type": "VEC3"}
    p = f.add("accessors", {"bufferView": view(meshopt_vertices(floats, 12), "ATTRIBUTES", n * n, 12), **whole})
    q = f.add("accessors", {"bufferView": view(meshopt_vertices(exponents, 12), "ATTRIBUTES", n * n, 12, "EXPONENTIAL"), **whole})
    k = f.add("accessors", {"bufferView": view(meshopt_vertices(normals, 4), "ATTRIBUTES", n * n, 4, "OCTAHEDRAL"),
                            "count": n * n, "componentType": I8, "normalized": True, "type": "VEC3"})
    r = f.add("accessors", {"bufferView": view(meshopt_vertices(turns, 8), "ATTRIBUTES", n * n, 8, "QUATERNION"),
                            "count": n * n, "componentType": I16, "normalized": True, "type": "VEC4"})
    indices = [f.add("accessors", {"bufferView": view(meshopt_indices(name, corners), mode, len(corners), size),
                                   "count": len(corners), "componentType": kind, "type": "SCALAR"})
               for name, mode, size, kind in (("IndexBuffer", "TRIANGLES", 2, U16), ("IndexSequence", "INDICES", 4, U32))]
    f.mesh({"POSITION": p, "NORMAL": k}, indices=indices[0])
    f.mesh({"POSITION": q}, indices=indices[1])
    f.tree["nodes"][1]["extensions"] = {"EXT_mesh_gpu_instancing": {"attributes": {"ROTATION": r}}}
    return f.binary()


def draco_file(level):
    """A grid with normals and texture coordinates; level 0 of the encoder is sequential, the others are edgebreaker."""
    n = 4
    lines = [f"v {x} {y} {x * y % 3}" for y in range(n) for x in range(n)]
    lines += [f"vt {x / n} {y / n}" for y in range(n) for x in range(n)]
    lines += [f"vn {(x - 1) / 3} {(y - 2) / 3} {(-1) ** x * 2 / 3}" for y in range(n) for x in range(n)]
    for y in range(n - 1):
        for x in range(n - 1):
            a = y * n + x + 1
            lines += [f"f {i}/{i}/{i} {j}/{j}/{j} {k}/{k}/{k}" for i, j, k in ((a, a + 1, a + n), (a + 1, a + n + 1, a + n))]
    with tempfile.TemporaryDirectory() as folder:
        (pathlib.Path(folder) / "grid.obj").write_text("\n".join(lines) + "\n")
        subprocess.run(["draco_encoder", "-i", "grid.obj", "-o", "grid.drc", "-cl", str(level)], cwd=folder, check=True,
                       stdout=subprocess.DEVNULL)
        data = (pathlib.Path(folder) / "grid.drc").read_bytes()
    f = File(nodes=[{"mesh": 0}], extensionsUsed=["KHR_draco_mesh_compression"],
             extensionsRequired=["KHR_draco_mesh_compression"])
    view = f.view(data)
    add = lambda kind, component, count: f.add("accessors", {"componentType": component, "type": kind, "count": count})
    attributes = {"POSITION": add("VEC3", FLOAT, n * n), "TEXCOORD_0": add("VEC2", FLOAT, n * n),
                  "NORMAL": add("VEC3", FLOAT, n * n)}
    f.mesh(attributes, indices=add("SCALAR", U16, 6 * (n - 1) ** 2), extensions={
        "KHR_draco_mesh_compression": {"bufferView": view, "attributes": {"POSITION": 0, "TEXCOORD_0": 1, "NORMAL": 2}}})
    return f.binary()


def webp_textured():
    """The same as textured(), by EXT_texture_webp."""
    f = File(nodes=[{"mesh": 0}], textures=[{"extensions": {"EXT_texture_webp": {"source": 0}}}],
             materials=[{"pbrMetallicRoughness": {"baseColorTexture": {"index": 0}}, "alphaMode": "BLEND"}],
             extensionsUsed=["EXT_texture_webp"])
    f.add("images", {"bufferView": f.view(webp(5, 3, 4, True)), "mimeType": "image/webp"})
    f.mesh({"POSITION": f.accessor("VEC3", FLOAT, TRIANGLE), "TEXCOORD_0": f.accessor("VEC2", FLOAT, [0, 0, 1, 0, 0, 1])},
           material=0)
    return f.binary()


def pictures():
    return {f"{'lossless' if lossless else 'lossy'}{channels}.webp": webp(19, 11, channels, lossless)
            for lossless in (True, False) for channels in (3, 4)}


def files():
    png, jpeg = (FUZZ / "corpus/png/rgba.png").read_bytes(), (FUZZ / "corpus/jpeg/rgb.jpg").read_bytes()
    return {"indexed.gltf": indexed(), "strip_and_fan.glb": strip_and_fan(), "quantized.glb": quantized(),
            "sparse.gltf": sparse(), "nodes.gltf": nodes(), "instancing.glb": instancing(), "materials.gltf": materials(),
            "variants.gltf": variants(), "png.glb": textured(png, "image/png"), "jpeg.glb": textured(jpeg, "image/jpeg"),
            "moving.glb": moving(), "animated.glb": animated(), "skinned.gltf": skinned(), "meshopt.glb": meshopt_file(), "webp.glb": webp_textured(),
            "draco_sequential.glb": draco_file(0), "draco_edgebreaker.glb": draco_file(7)}


def dictionary():
    """Every string in the reader's code that may be a key or a word of the format."""
    words = set()
    for path in sorted((FUZZ.parent / "src/formats/gltf").glob("*.cpp")):
        words |= set(re.findall(r'"([A-Za-z][A-Za-z0-9_]{2,40})"', path.read_text()))
    return "".join(f'"\\"{word}\\""\n' for word in sorted(words))


def main():
    for folder, made in ((OUT, files()), (FUZZ / "corpus" / "webp", pictures())):
        folder.mkdir(parents=True, exist_ok=True)
        for name, data in made.items():
            (folder / name).write_bytes(data)
    (FUZZ / "dictionaries").mkdir(exist_ok=True)
    (FUZZ / "dictionaries" / "gltf").write_text(dictionary())


if __name__ == "__main__":
    main()
