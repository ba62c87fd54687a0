#!/usr/bin/env python3
"""Makes a large glTF file to measure loading with: 100 tiles of relief, each with a texture of its own.

    bench/large_gltf.py OUT.glb [--triangles 1000000] [--textures 100] [--side 2048]

Half of the textures are PNG, half JPEG, all RGB of 8 bits. Prints what is in the file. The same arguments make the same
bytes. Needs nothing but Python's standard library.
"""
import argparse
import array
import json
import math
import random
import struct
import sys
import zlib

TILE = 1.0  # metres


def png(side, seed):
    """Soft waves under a little noise: the file is about two thirds as large as the texels."""
    chance = random.Random(seed)
    noise = chance.randbytes(3 * side + 4096)
    wave = bytes(128 + round(90 * math.sin(x * 0.01 + seed)) & 0xf8 for x in range(3 * side + 4096))
    rows = []
    for y in range(side):
        n, w = chance.randrange(4096), y % 4096
        mixed = int.from_bytes(wave[w:w + 3 * side], "big") ^ (
            int.from_bytes(noise[n:n + 3 * side], "big") & int.from_bytes(b"\x07" * (3 * side), "big"))
        rows.append(b"\0" + mixed.to_bytes(3 * side, "big"))

    def chunk(kind, data):
        return struct.pack(">I", len(data)) + kind + data + struct.pack(">I", zlib.crc32(kind + data))

    header = struct.pack(">IIBBBBB", side, side, 8, 2, 0, 0, 0)
    return (b"\x89PNG\r\n\x1a\n" + chunk(b"IHDR", header) + chunk(b"IDAT", zlib.compress(b"".join(rows), 1)) +
            chunk(b"IEND", b""))


# Codes for JPEG: of DC differences by their number of bits, all of 4 bits; of AC coefficients by (zeros before it, bits).
DC_SYMBOLS = list(range(12))
AC_SYMBOLS = [0x00] + [zeros << 4 | bits for zeros in range(4) for bits in range(1, 6)]


def jpeg(side, seed):
    """Baseline, three components of full resolution; each block is one of 64 with a few waves in it."""
    chance = random.Random(seed)
    dc_code = {symbol: format(i, "04b") for i, symbol in enumerate(DC_SYMBOLS)}
    ac_code = {symbol: format(i, "05b") for i, symbol in enumerate(AC_SYMBOLS)}

    def number(value):
        """How many bits, and which."""
        bits = abs(value).bit_length()
        return bits, format(value if value > 0 else value + (1 << bits) - 1, "0{}b".format(bits)) if bits else ""

    waves = []
    for _ in range(64):
        text = ""
        for _ in range(chance.randrange(4, 12)):
            bits, digits = number(chance.choice((-1, 1)) * chance.randrange(1, 12))
            text += ac_code[chance.randrange(3) << 4 | bits] + digits
        waves.append(text + ac_code[0])
    blocks = (side + 7) // 8
    parts, before = [], [0, 0, 0]
    for _ in range(blocks * blocks):
        for component in range(3):
            value = chance.randrange(-40, 40)
            bits, digits = number(value - before[component])
            before[component] = value
            parts.append(dc_code[bits] + digits + waves[chance.randrange(64)])
    stream = "".join(parts)
    stream += "1" * (-len(stream) % 8)
    data = int(stream, 2).to_bytes(len(stream) // 8, "big").replace(b"\xff", b"\xff\0")

    def segment(marker, content):
        return struct.pack(">BBH", 0xff, marker, len(content) + 2) + content

    def table(kind, length, symbols):
        counts = [0] * 16
        counts[length - 1] = len(symbols)
        return bytes([kind]) + bytes(counts) + bytes(symbols)

    frame = struct.pack(">BHHB", 8, side, side, 3) + b"".join(bytes([k, 0x11, 0]) for k in (1, 2, 3))
    scan = bytes([3, 1, 0, 2, 0, 3, 0, 0, 63, 0])
    return (b"\xff\xd8" + segment(0xdb, b"\0" + bytes([8] * 64)) + segment(0xc0, frame) +
            segment(0xc4, table(0x00, 4, DC_SYMBOLS)) + segment(0xc4, table(0x10, 5, AC_SYMBOLS)) +
            segment(0xda, scan) + data + b"\xff\xd9")


def relief(cells):
    """A tile of cells × cells × 2 triangles: positions, normals and texture coordinates as floats, and indices."""
    positions, normals, uvs = array.array("f"), array.array("f"), array.array("f")
    for j in range(cells + 1):
        for i in range(cells + 1):
            u, v = i / cells, j / cells
            a, b = 9 * u, 7 * v
            slope = (0.05 * 9 * math.cos(a) * math.sin(b), 0.05 * 7 * math.sin(a) * math.cos(b))
            length = math.sqrt(1 + slope[0] ** 2 + slope[1] ** 2)
            positions.extend((TILE * u, TILE * 0.05 * math.sin(a) * math.sin(b), TILE * v))
            normals.extend((-slope[0] / length, 1 / length, -slope[1] / length))
            uvs.extend((u, v))
    indices = array.array("I")
    for j in range(cells):
        for i in range(cells):
            k = j * (cells + 1) + i
            indices.extend((k, k + cells + 1, k + 1, k + 1, k + cells + 1, k + cells + 2))
    return positions, normals, uvs, indices


class File:
    """Parts of the binary chunk, written as they come."""

    def __init__(self):
        self.parts, self.size, self.views, self.accessors = [], 0, [], []

    def view(self, data):
        self.views.append({"buffer": 0, "byteOffset": self.size, "byteLength": len(data)})
        data += b"\0" * (-len(data) % 4)
        self.parts.append(data)
        self.size += len(data)
        return len(self.views) - 1

    def accessor(self, values, kind, width, component, **more):
        view = self.view(values.tobytes())
        self.accessors.append({"bufferView": view, "componentType": component, "count": len(values) // width,
                               "type": kind, **more})
        return len(self.accessors) - 1


def make(out, triangles, textures, side):
    file = File()
    cells = max(1, round(math.sqrt(triangles / textures / 2)))
    across = math.ceil(math.sqrt(textures))
    meshes, nodes, images, encoded = [], [], [], {"png": 0, "jpeg": 0}
    geometry = 0
    for k in range(textures):
        positions, normals, uvs, indices = relief(cells)
        start = file.size
        attributes = {
            "POSITION": file.accessor(positions, "VEC3", 3, 5126, min=[0, -TILE * 0.05, 0], max=[TILE, TILE * 0.05, TILE]),
            "NORMAL": file.accessor(normals, "VEC3", 3, 5126), "TEXCOORD_0": file.accessor(uvs, "VEC2", 2, 5126)}
        index = file.accessor(indices, "SCALAR", 1, 5125)
        geometry += file.size - start
        meshes.append({"primitives": [{"attributes": attributes, "indices": index, "material": k}]})
        nodes.append({"mesh": k, "translation": [k % across * TILE, 0, k // across * TILE]})
        kind = "jpeg" if k % 2 else "png"
        data = jpeg(side, k) if kind == "jpeg" else png(side, k)
        encoded[kind] += len(data)
        images.append({"bufferView": file.view(data), "mimeType": "image/" + kind})
    document = {
        "asset": {"version": "2.0"}, "buffers": [{"byteLength": file.size}], "bufferViews": file.views,
        "accessors": file.accessors, "meshes": meshes, "nodes": nodes, "images": images,
        "textures": [{"source": k} for k in range(textures)],
        "materials": [{"pbrMetallicRoughness": {"metallicFactor": 0, "baseColorTexture": {"index": k}}}
                      for k in range(textures)]}
    text = json.dumps(document, separators=(",", ":")).encode()
    text += b" " * (-len(text) % 4)
    with open(out, "wb") as stream:
        stream.write(struct.pack("<4sII", b"glTF", 2, 12 + 8 + len(text) + 8 + file.size))
        stream.write(struct.pack("<II", len(text), 0x4e4f534a) + text + struct.pack("<II", file.size, 0x004e4942))
        for part in file.parts:
            stream.write(part)
    mebi = 1 << 20
    texels = textures * side * side * 3
    print(f"{2 * cells * cells * textures} triangles, {geometry / mebi:.0f} MiB of geometry; {textures} textures of "
          f"{side} x {side}, {texels / mebi:.0f} MiB of texels, from {encoded['png'] / mebi:.0f} MiB of PNG and "
          f"{encoded['jpeg'] / mebi:.0f} MiB of JPEG; together {(geometry + texels) / mebi:.0f} MiB")


def main():
    parser = argparse.ArgumentParser(description=__doc__.split("\n\n")[0])
    parser.add_argument("out")
    parser.add_argument("--triangles", type=int, default=1_000_000)
    parser.add_argument("--textures", type=int, default=100)
    parser.add_argument("--side", type=int, default=2048)
    given = parser.parse_args()
    if sys.byteorder != "little":
        raise SystemExit("glTF is little-endian, and so must the machine be")
    make(given.out, given.triangles, given.textures, given.side)


if __name__ == "__main__":
    main()
