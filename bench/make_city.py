#!/usr/bin/env python3
"""Writes a town of N buildings as CityJSON, for measurements of growth: make_city.py N [--seed S] [-o FILE].

Houses with gable or flat roofs stand along a grid of streets. Each has roof, walls and ground, and the attributes that
planners have: function, yearOfConstruction, measuredHeight, storeysAboveGround. The same N and seed give the same bytes.
"""
import argparse
import json
import math
import random
import sys

FUNCTIONS = ["residential", "residential", "residential", "commercial", "industrial", "public"]


def house(rng, x, y, vertices):
    """Vertices in millimetres; the boundaries of a solid, what its faces are, and its attributes."""
    width, depth = rng.uniform(7, 14), rng.uniform(8, 16)
    storeys = min(12, 1 + int(rng.expovariate(0.6)))
    eaves = 3.0 * storeys + rng.uniform(0.2, 0.8)
    turn = rng.uniform(-0.06, 0.06)
    gable = storeys <= 4 and rng.random() < 0.75
    ridge = eaves + (width / 2 * math.tan(rng.uniform(0.5, 0.85)) if gable else 0)
    first = len(vertices)

    def put(u, v, z):
        vertices.append([round(1000 * (x + u * math.cos(turn) - v * math.sin(turn))),
                         round(1000 * (y + u * math.sin(turn) + v * math.cos(turn))), round(1000 * z)])

    for z in (0, eaves):
        for u, v in ((0, 0), (width, 0), (width, depth), (0, depth)):
            put(u, v, z)
    if gable:
        put(width / 2, 0, ridge)
        put(width / 2, depth, ridge)
        faces = [[0, 3, 2, 1], [0, 1, 5, 8, 4], [1, 2, 6, 5], [2, 3, 7, 9, 6], [3, 0, 4, 7], [4, 8, 9, 7], [5, 6, 9, 8]]
        kinds = [2, 1, 1, 1, 1, 0, 0]
    else:
        faces = [[0, 3, 2, 1], [0, 1, 5, 4], [1, 2, 6, 5], [2, 3, 7, 6], [3, 0, 4, 7], [4, 5, 6, 7]]
        kinds = [2, 1, 1, 1, 1, 0]
    attributes = {"function": rng.choice(FUNCTIONS), "yearOfConstruction": rng.randint(1750, 2020),
                  "measuredHeight": round(ridge, 2), "storeysAboveGround": storeys}
    return [[[first + k for k in face]] for face in faces], kinds, attributes


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("count", type=int)
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("-o", "--output")
    options = parser.parse_args()
    rng = random.Random(options.seed)
    side = max(1, math.ceil(math.sqrt(options.count)))
    surfaces = [{"type": "RoofSurface"}, {"type": "WallSurface"}, {"type": "GroundSurface"}]
    vertices, objects = [], {}
    for i in range(options.count):
        column, row = i % side, i // side
        x = column * 17 + (column // 10) * 14 + rng.uniform(0, 2)
        y = row * 20 + (row // 2) * 14 + rng.uniform(0, 2)
        boundaries, kinds, attributes = house(rng, x, y, vertices)
        objects["house-%06d" % i] = {
            "type": "Building", "attributes": attributes,
            "geometry": [{"type": "Solid", "lod": "2", "boundaries": [boundaries],
                          "semantics": {"surfaces": surfaces, "values": [kinds]}}]}
    city = {"type": "CityJSON", "version": "2.0",
            "transform": {"scale": [0.001, 0.001, 0.001], "translate": [400000, 5600000, 0]},
            "metadata": {"referenceSystem": "https://www.opengis.net/def/crs/EPSG/0/25832"},
            "CityObjects": objects, "vertices": vertices}
    out = open(options.output, "w", encoding="utf-8") if options.output else sys.stdout
    json.dump(city, out, separators=(",", ":"))
    out.write("\n")
    if options.output:
        out.close()


if __name__ == "__main__":
    main()
