# SPDX-License-Identifier: LGPL-2.1-or-later
"""Draws rooms.svg: the folders that a part goes through on its way to a program. `python3 docs/images/make_rooms.py`"""

from pathlib import Path

WIDE, HIGH, GAP = 148, 66, 24
COLUMNS = (  # rooms that stand above each other, from left to right: folder, what is in it, colour
    (("gui/", "clicks and fields", "#dbe7f6"), ("batch/", "job files", "#dbe7f6")),
    (("api.py, macro/", "one call per stage", "#dbe7f6"),),
    (("objects/", "stages of a document", "#e7e1f3"),),
    (("brep/", "shapes to arrays", "#e7e1f3"),),
    (
        ("core/strategies/", "what to deposit", "#dff0e3"),
        ("slicing, layers, filling", "levels, regions, beads", "#eef7f0"),
    ),
    (
        ("core/planning/", "how to move", "#dff0e3"),
        ("kinematics, collision", "reach, limits, contact", "#eef7f0"),
    ),
    (("posts/", "how to say it", "#fbe9d7"),),
    (
        ("verify.py, read_back/", "read and driven again", "#f9dedb"),
        ("report/", "figures and page", "#f9dedb"),
    ),
)
BETWEEN = (
    "",
    "",
    "",
    "wall, solids",
    "Toolpath",
    "Motion, Program",
    "text",
)  # what goes on to the next column


def drawn() -> str:
    """The picture."""
    width = len(COLUMNS) * (WIDE + GAP) - GAP + 20
    height = 2 * HIGH + GAP + 60
    shapes = []
    for number, rooms in enumerate(COLUMNS):
        x = 10 + number * (WIDE + GAP)
        top = 30 + (height - 60 - len(rooms) * HIGH - (len(rooms) - 1) * GAP) / 2
        for row, (name, what, colour) in enumerate(rooms):
            y = top + row * (HIGH + GAP)
            shapes.append(
                f'<rect x="{x}" y="{y:g}" width="{WIDE}" height="{HIGH}" rx="8" fill="{colour}" stroke="#8a94a6"/>'
                f'<text x="{x + WIDE / 2:g}" y="{y + 29:g}" font-weight="600">{name}</text>'
                f'<text x="{x + WIDE / 2:g}" y="{y + 48:g}" fill="#566072">{what}</text>'
            )
        if number < len(BETWEEN):
            end, middle = x + WIDE + GAP - 3, height / 2
            shapes.append(
                f'<path d="M{x + WIDE + 3} {middle:g}H{end}m-6 -4 6 4 -6 4" fill="none" stroke="#566072"/>'
            )
            shapes.append(
                f'<text x="{x + WIDE + GAP / 2:g}" y="{height - 12:g}" fill="#8a4b10">{BETWEEN[number]}</text>'
            )
    return (
        f'<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 {width} {height}" font-family="system-ui,sans-serif" '
        f'font-size="11.5" text-anchor="middle" fill="#1d2430"><rect width="100%" height="100%" fill="#fff"/>'
        f"{''.join(shapes)}</svg>\n"
    )


if __name__ == "__main__":
    (Path(__file__).parent / "rooms.svg").write_text(drawn(), encoding="utf-8")
