# SPDX-License-Identifier: LGPL-2.1-or-later
"""Draws which folder imports which, of the whole and of gui/: docs/images/imports.svg and imports-gui.svg.

python3 docs/make_import_pictures.py [PACKAGE [FOLDER]]: of another checkout of the package, into another folder. A folder
stands above all that it imports; arrows that go up are red, which are circles. Their width tells how many files import.
"""

import ast
import math
import sys
from collections import Counter
from html import escape
from pathlib import Path

DOCS = Path(__file__).resolve().parent
PACKAGE = DOCS.parent / "freecad_am"
WIDE, HIGH, BOX = 150, 74, (128, 26)


def imports(package):
    """(file, imported file) of a package, both as paths in it, without '.py'; those within functions included."""
    files = {path.relative_to(package).with_suffix("").as_posix() for path in package.rglob("*.py")}
    for name in sorted(files):
        for node in ast.walk(ast.parse((package / f"{name}.py").read_text(encoding="utf-8"))):
            if not isinstance(node, ast.ImportFrom):
                continue
            within = name.split("/")[: -node.level] if node.level else []
            base = [*within, *(node.module or "").split(".")] if node.module else within
            if not node.level:
                base = base[1:] if base[0] == package.name else ["?"]
            for alias in node.names:
                found = next(
                    (
                        one
                        for one in ("/".join([*base, alias.name]), "/".join(base))
                        if one in files
                    ),
                    None,
                )
                if found is not None and found != name:
                    yield name, found


def folder_of(name, top):
    """The room a file is in, which for those beside folders is the file itself; '' outside of `top`."""
    words = name[len(top) :].split("/")
    return "/".join(words[: 2 if words[0] == "core" else 1]) if name.startswith(top) else ""


def graph(package, top):
    """How many files of each room import from which other one: {(from, to): files}."""
    pairs = {(folder_of(a, top), folder_of(b, top), a) for a, b in imports(package)}
    return Counter((one, other) for one, other, _ in pairs if one and other and one != other)


def rows_of(edges):
    """The rooms in rows, from those that nobody imports down; circles are cut at the arrows of fewest files."""
    kept = dict(edges)
    while True:
        below = {room: {b for a, b in kept if a == room} for pair in edges for room in pair}
        height, waiting = {}, set(below)
        while ready := {room for room in waiting if below[room] <= height.keys()}:
            height.update(
                {room: 1 + max((height[one] for one in below[room]), default=-1) for room in ready}
            )
            waiting -= ready
        if not waiting:
            break
        del kept[
            min(
                (pair for pair in kept if set(pair) <= waiting), key=lambda pair: (kept[pair], pair)
            )
        ]
    rows = [[] for _ in range(max(height.values(), default=0) + 1)]
    for room in sorted(height):
        rows[-1 - height[room]].append(room)
    return rows


def svg(edges):
    """The picture as text, and how many arrows go up."""
    rows = rows_of(edges)
    width = WIDE * max(map(len, rows)) + 20
    at = {
        room: (width / 2 + WIDE * (column - (len(row) - 1) / 2), 30 + HIGH * number)
        for number, row in enumerate(rows)
        for column, room in enumerate(row)
    }
    up, lines = 0, []
    for (a, b), count in sorted(edges.items()):
        (x, y), (u, v) = at[a], at[b]
        rises = v <= y
        up += rises
        middle, colour = (y + v) / 2, "#c00" if rises else "#789"
        bend = f"M{x:.0f} {y + BOX[1] / 2:.0f} C{x:.0f} {middle:.0f} {u:.0f} {middle:.0f} {u:.0f} {v - BOX[1] / 2:.0f}"
        thick, told = 0.6 + 0.8 * math.log(count), escape(f"{a} - {b}: {count}")
        lines.append(
            f'<path d="{bend}" fill="none" stroke="{colour}" stroke-opacity="0.5" stroke-width="{thick:.1f}">'
            f"<title>{told}</title></path>"
        )
    for room, (x, y) in at.items():
        lines.append(
            f'<rect x="{x - BOX[0] / 2:.0f}" y="{y - BOX[1] / 2:.0f}" width="{BOX[0]}" height="{BOX[1]}" rx="4" '
            'fill="#fff" stroke="#345"/>'
        )
        lines.append(
            f'<text x="{x:.0f}" y="{y + 4:.0f}" font-family="sans-serif" font-size="11" text-anchor="middle">'
            f"{escape(room)}</text>"
        )
    high = 60 + HIGH * (len(rows) - 1)
    head = f'<svg xmlns="http://www.w3.org/2000/svg" width="{width}" height="{high}" viewBox="0 0 {width} {high}">'
    return "\n".join(
        [head, f'<rect width="{width}" height="{high}" fill="#fff"/>', *lines, "</svg>", ""]
    ), up


def main(package=PACKAGE, folder=DOCS / "images"):
    for name, top in (("imports", ""), ("imports-gui", "gui/")):
        edges = graph(Path(package), top)
        text, up = svg(edges)
        (Path(folder) / f"{name}.svg").write_text(text, encoding="utf-8")
        print(
            f"{name}: {len({one for pair in edges for one in pair})} rooms, {len(edges)} arrows, {up} of them up"
        )


if __name__ == "__main__":
    main(*sys.argv[1:])
