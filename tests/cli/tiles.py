#!/usr/bin/env python3
"""Tiles against the one big picture. Usage: tiles.py FOLDER ZOOM TILE PICTURE.png: exit status 1 when a pixel differs.
tiles.py same FOLDER FOLDER: when two folders of tiles differ. tiles.py packed FILE.mbtiles FOLDER: when a file does."""
import os
import sqlite3
import struct
import sys
import zlib


def paeth(a, b, c):
    p = a + b - c
    pa, pb, pc = abs(p - a), abs(p - b), abs(p - c)
    return a if pa <= pb and pa <= pc else b if pb <= pc else c


def read_png(path):
    """Width, height, and rows of RGBA bytes."""
    data = open(path, "rb").read()
    assert data[:8] == b"\x89PNG\r\n\x1a\n", path
    at, packed = 8, b""
    while at < len(data):
        size, kind = struct.unpack(">I4s", data[at:at + 8])
        body = data[at + 8:at + 8 + size]
        if kind == b"IHDR":
            width, height, depth, colour = struct.unpack(">IIBB", body[:10])
        elif kind == b"IDAT":
            packed += body
        at += 12 + size
    assert depth == 8 and colour in (2, 6), "%s: depth %d, colour %d" % (path, depth, colour)
    step = 3 if colour == 2 else 4
    raw, rows, before = zlib.decompress(packed), [], bytes(width * step)
    for y in range(height):
        start = y * (width * step + 1)
        way, row = raw[start], bytearray(raw[start + 1:start + 1 + width * step])
        if way == 2:
            row = bytearray((a + b) & 255 for a, b in zip(row, before))
        elif way:
            for i in range(len(row)):
                left = row[i - step] if i >= step else 0
                up, corner = before[i], before[i - step] if i >= step else 0
                row[i] = (row[i] + (left if way == 1 else (left + up) // 2 if way == 3 else paeth(left, up, corner))) & 255
        before = row
        if step == 3:
            full = bytearray(b"\xff" * (width * 4))
            full[0::4], full[1::4], full[2::4] = row[0::3], row[1::3], row[2::3]
            row = full
        rows.append(bytes(row))
    return width, height, rows


def paste(folder, zoom, tile):
    rows = []
    for y in range(2 ** zoom):
        strip = [b""] * tile
        for x in range(2 ** zoom):
            width, height, part = read_png("%s/%d/%d/%d.png" % (folder, zoom, x, y))
            assert (width, height) == (tile, tile)
            strip = [a + b for a, b in zip(strip, part)]
        rows += strip
    return rows


def compare_picture(folder, zoom, tile, picture):
    width, height, rows = read_png(picture)
    pasted = paste(folder, zoom, tile)
    if (width, height) != (len(pasted), len(pasted)):
        sys.exit("the picture has %d x %d pixels, the tiles %d a side" % (width, height, len(pasted)))
    wrong = sum(a[4 * x:4 * x + 4] != b[4 * x:4 * x + 4] for a, b in zip(rows, pasted) if a != b for x in range(width))
    if wrong:
        sys.exit("%s: %d pixels of zoom %d differ from %s" % (folder, wrong, zoom, picture))


def files_of(folder):
    found = {}
    for path, _, names in os.walk(folder):
        for name in names:
            full = os.path.join(path, name)
            found[os.path.relpath(full, folder)] = open(full, "rb").read()
    return found


def compare_folders(one, other):
    a, b = files_of(one), files_of(other)
    if a.keys() != b.keys():
        sys.exit("only in one: %s" % sorted(a.keys() ^ b.keys())[:5])
    differ = [name for name in sorted(a) if a[name] != b[name]]
    if differ:
        sys.exit("%d files differ: %s" % (len(differ), differ[:5]))


def compare_packed(path, folder):
    tiles = {name: data for name, data in files_of(folder).items() if name.endswith(".png")}
    base = sqlite3.connect("file:%s?mode=ro" % path, uri=True)
    if base.execute("PRAGMA application_id").fetchone()[0] != 0x4D504258:
        sys.exit("%s: wrong application_id" % path)
    facts = dict(base.execute("SELECT name, value FROM metadata"))
    for name in ("name", "format", "bounds", "minzoom", "maxzoom"):
        if not facts.get(name):
            sys.exit("%s: metadata lacks %s" % (path, name))
    count = 0
    for zoom, column, row, data in base.execute("SELECT * FROM tiles"):
        count += 1
        if tiles.get("%d/%d/%d.png" % (zoom, column, 2 ** zoom - 1 - row)) != data:
            sys.exit("%s: tile %d/%d/%d is another" % (path, zoom, column, row))
    if count != len(tiles):
        sys.exit("%s: %d tiles instead of %d" % (path, count, len(tiles)))


if sys.argv[1] == "same":
    compare_folders(sys.argv[2], sys.argv[3])
elif sys.argv[1] == "packed":
    compare_packed(sys.argv[2], sys.argv[3])
else:
    compare_picture(sys.argv[1], int(sys.argv[2]), int(sys.argv[3]), sys.argv[4])
