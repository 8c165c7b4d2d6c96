#!/usr/bin/env python3
"""Lines of a drawing against those of another program: compare.py DRAWING.svg SCALE LINES.txt [OUT.svg]

The drawing is Limner's, one view at SCALE:1, of which visible lines count; lines are those of hidden_lines. Prints lengths
on paper, and how much of each, in per cent, has no line of the other one within 0.05 mm there. OUT.svg shows both: grey,
red what only the drawing has, blue what only the other one has."""
import math
import re
import sys
import xml.etree.ElementTree as tree

NEAR, STEP = 0.05, 0.05
NUMBER = re.compile(r"[A-Za-z]|-?(?:\d+\.?\d*|\.\d+)(?:e-?\d+)?")


def path_lines(text):
    """Polylines of a path of lines."""
    out, at, start, word, numbers = [], (0.0, 0.0), (0.0, 0.0), "", []

    def go(p):
        nonlocal at
        out[-1].append(p)
        at = p

    for token in NUMBER.findall(text) + ["end"]:
        if not token[0].isalpha():
            numbers.append(float(token))
            need = 1 if word in "HhVv" else 2
            if len(numbers) < need:
                continue
            x, y = (numbers + [0.0])[:2]
            if word in "Mm":
                at = (at[0] + x, at[1] + y) if word == "m" else (x, y)
                start = at
                out.append([at])
                word = "l" if word == "m" else "L"
            elif word == "L":
                go((x, y))
            elif word == "l":
                go((at[0] + x, at[1] + y))
            elif word in "Hh":
                go((x + (at[0] if word == "h" else 0), at[1]))
            elif word in "Vv":
                go((at[0], x + (at[1] if word == "v" else 0)))
            else:
                raise SystemExit(f"the path has {word}; draw with --smooth 0")
            numbers = []
        elif token in "Zz":
            go(start)
        else:
            word = token
    return out


def drawing_lines(name):
    out = []
    for group in tree.parse(name).getroot().iter():
        words = group.get("class", "").split()
        if words[:1] == ["visible"] and len(words) > 1:
            for path in group:
                if path.tag.endswith("path"):
                    out += [[(x, -y) for x, y in line] for line in path_lines(path.get("d"))]
    return out


def other_lines(name, scale):
    out = []
    for row in open(name):
        numbers = [scale * float(n) for n in row.split()[1:]]
        out.append(list(zip(numbers[::2], numbers[1::2])))
    return out


def corner(lines):
    return min(x for line in lines for x, _ in line), min(y for line in lines for _, y in line)


def segments(lines):
    for line in lines:
        yield from zip(line, line[1:])


class Grid:
    """Segments by cells, so that those near a place are found."""

    def __init__(self, lines, cell=0.5):
        self.cell, self.cells = cell, {}
        for a, b in segments(lines):
            steps = max(1, math.ceil(math.dist(a, b) / cell * 2))
            seen = set()
            for i in range(steps + 1):
                x, y = (a[k] + (b[k] - a[k]) * i / steps for k in (0, 1))
                for dx in (-1, 0, 1):
                    for dy in (-1, 0, 1):
                        seen.add((int(x // cell) + dx, int(y // cell) + dy))
            for key in seen:
                self.cells.setdefault(key, []).append((a, b))

    def near(self, p):
        for a, b in self.cells.get((int(p[0] // self.cell), int(p[1] // self.cell)), ()):
            d = (b[0] - a[0], b[1] - a[1])
            length = d[0] ** 2 + d[1] ** 2
            t = min(max(((p[0] - a[0]) * d[0] + (p[1] - a[1]) * d[1]) / length, 0), 1) if length else 0
            if math.hypot(p[0] - a[0] - t * d[0], p[1] - a[1] - t * d[1]) <= NEAR:
                return True
        return False


def alone(lines, grid):
    """Length of the lines, and pieces of them that have no other one."""
    total, pieces = 0.0, []
    for a, b in segments(lines):
        length = math.dist(a, b)
        count = max(1, math.ceil(length / STEP))
        total += length
        for i in range(count):
            p, q = ([a[k] + (b[k] - a[k]) * j / count for k in (0, 1)] for j in (i, i + 1))
            if not grid.near([(p[k] + q[k]) / 2 for k in (0, 1)]):
                pieces.append((p, q))
    return total, pieces


def distinct(lines):
    """Without what lies on what is there already, as lines of several kinds do."""
    out, cells = [], set()
    for a, b in segments(lines):
        count = max(1, math.ceil(math.dist(a, b) / STEP))
        for i in range(count):
            p, q = ([a[k] + (b[k] - a[k]) * j / count for k in (0, 1)] for j in (i, i + 1))
            key = tuple(round((p[k] + q[k]) / 2 / NEAR) for k in (0, 1))
            if key not in cells:
                cells.add(key)
                out.append([p, q])
    return out


def main():
    ours, theirs = drawing_lines(sys.argv[1]), other_lines(sys.argv[3], float(sys.argv[2]))
    a, b = corner(ours), corner(theirs)
    ours = distinct([[(x - a[0] + b[0], y - a[1] + b[1]) for x, y in line] for line in ours])
    theirs = distinct(theirs)
    (mine, extra), (other, missing) = alone(ours, Grid(theirs)), alone(theirs, Grid(ours))
    share = [100 * sum(math.dist(p, q) for p, q in pieces) / max(total, 1e-9)
             for pieces, total in ((extra, mine), (missing, other))]
    print(f"{mine:.1f} {other:.1f} {share[0]:.2f} {share[1]:.2f}")
    if len(sys.argv) > 4:
        every = [p for line in ours + theirs for p in line]
        low = [min(p[k] for p in every) for k in (0, 1)]
        high = [max(p[k] for p in every) for k in (0, 1)]
        size = max(high[0] - low[0], high[1] - low[1])
        with open(sys.argv[4], "w", encoding="utf-8") as out:
            out.write(f'<svg xmlns="http://www.w3.org/2000/svg" viewBox="{low[0]} {-high[1]} {high[0] - low[0]} {high[1] - low[1]}">')
            for lines, colour in ((ours, "#bbb"), (extra, "#d00"), (missing, "#06c")):
                for line in lines:
                    points = " ".join(f"{x:.4f},{-y:.4f}" for x, y in line)
                    out.write(f'<polyline points="{points}" fill="none" stroke="{colour}" stroke-width="{size / 400}"/>')
            out.write("</svg>")


main()
