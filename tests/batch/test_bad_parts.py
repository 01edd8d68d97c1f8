# SPDX-License-Identifier: LGPL-2.1-or-later
"""The command reports parts that cannot be deposited as they are, with a message and an exit
status."""

import numpy as np
import pytest

CORNERS = np.array([(x, y, z) for z in (0, 1) for y in (0, 1) for x in (0, 1)], dtype=float)
SIDES = [
    (0, 2, 1),
    (1, 2, 3),
    (4, 5, 6),
    (5, 7, 6),
    (0, 1, 4),
    (1, 5, 4),
    (2, 6, 3),
    (3, 6, 7),
    (0, 4, 2),
    (2, 4, 6),
    (1, 3, 5),
    (3, 7, 5),
]


def box(size, corner=(0.0, 0.0, 0.0)):
    return (CORNERS * size + corner)[np.array(SIDES)]


def stl(path, triangles):
    facets = "".join(
        "facet normal 0 0 0\nouter loop\n"
        + "".join(f"vertex {x!r} {y!r} {z!r}\n" for x, y, z in corner.tolist())
        + "endloop\nendfacet\n"
        for corner in triangles
    )
    path.write_text(f"solid part\n{facets}endsolid part\n", encoding="ascii")


CASES = {  # triangles, keys of the strategy, exit status, messages
    "open": (box((40, 30, 20))[2:], "", 2, ("OPEN_MESH", "(20, 15, 0)")),
    "empty": (np.empty((0, 3, 3)), "", 2, ("EMPTY_FILE",)),
    "flat": (box((40, 30, 0)), "", 2, ("OPEN_MESH",)),
    "not numbers": (
        np.where(np.arange(36).reshape(12, 3, 1) == 4, np.nan, box((40, 30, 20))),
        "",
        2,
        ("BAD_FILE", "a vertex of a triangle is not a number"),
    ),
    "crossing": (
        np.vstack([box((40, 30, 20)), box((40, 30, 20), (7, 11, 5))]),
        "",
        0,
        ("REGION_MENDED",),
    ),
    "crossing, one inside out": (
        np.vstack([box((40, 30, 20)), box((40, 30, 20), (7, 11, 5))[:, ::-1]]),
        "",
        0,
        ("MESH_REPAIRED", "REGION_MENDED"),
    ),
    "0.1 mm": (box((0.1, 0.1, 0.1)), "", 2, ("TOO_LOW", "use at most 0.198 mm")),
    "0.1 mm, fine layers": (
        box((0.1, 0.1, 0.1)),
        ", layer_height: 0.02 mm",
        2,
        ("NOTHING_TO_DEPOSIT",),
    ),
    "10 m": (box((1e4, 1e4, 1e4)), "", 2, ("TOO_MANY",)),
    "layers higher than the part": (
        box((40, 30, 20)),
        ", layer_height: 50 mm",
        2,
        ("TOO_LOW", "20 mm high"),
    ),
    "thinner than a bead": (box((40, 0.8, 20)), "", 0, ("DEPOSITED_BESIDE", "THIN_SINGLE")),
    "density 0": (
        box((40, 30, 20)),
        ", fill: lines, fill_density: 0",
        2,
        ("BAD_VALUE", "fill_density", "at least 1 %"),
    ),
    "direction along no axis": (
        box((40, 30, 20)),
        ", direction: [0, 0, 0]",
        2,
        ("BAD_VALUE", "strategy.direction"),
    ),
    "unit": (box((40, 30, 20)), ", layer_height: 2 kg", 2, ("BAD_UNIT", "strategy.layer_height")),
}


@pytest.mark.parametrize("name", CASES)
def test_what_is_told_of_a_part_and_the_exit_status(workshop, name):
    triangles, keys, status, words = CASES[name]
    stl(workshop.folder / "part.stl", triangles)
    text = "part: {file: part.stl}\nstrategy: {kind: solid, layers: planes%s}\nprocess: {bead_width: 5 mm}\n"
    keys = keys if "layer_height" in keys else f", layer_height: 2 mm{keys}"
    (workshop.folder / "job.yaml").write_text(text % keys, encoding="utf-8")
    command = workshop.run("plan", "job.yaml", "-o", "out", "--no-page")
    assert command.status == status and all(word in command.err for word in words), command.err
    assert "Traceback" not in command.err and (
        workshop.folder / "out" / "report.json"
    ).is_file() == (status == 0)
