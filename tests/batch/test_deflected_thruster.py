# SPDX-License-Identifier: LGPL-2.1-or-later
"""The thruster, printed with a torch that leans outwards on the outlines of its blades, from its
job to texts for a five-axis machine."""

import csv
import shutil

import numpy as np

LEAN_DEG, MAX_TURN = 15.0, 3.0  # deg; deg/mm, the default of max_turn on hubs


def normals(x, y, z):
    """Return the outward normals of the cylinders up to 280 mm and of the cone above."""
    rho = np.hypot(x, y)
    tan = np.where(z > 280.0, 60.0 / 200.0, 0.0)
    return np.stack([x / rho, y / rho, tan], axis=1) / np.hypot(1.0, tan)[:, None]


def angle(a, b):
    return np.degrees(np.arctan2(np.linalg.norm(np.cross(a, b), axis=1), (a * b).sum(axis=1)))


def test_the_thruster_is_laid_by_a_deflected_torch(workshop, root):
    for file in (root / "resources" / "examples" / "thruster").iterdir():
        shutil.copy(file, workshop.folder)
    text = (workshop.folder / "thruster.yaml").read_text(encoding="utf-8")
    text = text.replace(
        "layer_height: 2.5 mm", f"layer_height: 70 mm\n  deflection: {LEAN_DEG:g} deg"
    )
    text = text.replace("0.05 mm", "0.2 mm")
    text = text.replace("post: siemens\n  motion: cartesian", "post: linuxcnc\n  motion: joint")
    (workshop.folder / "thruster.yaml").write_text(text, encoding="utf-8")
    command = workshop.run("plan", "thruster.yaml", "-o", "out", "--no-page")
    assert command.status == 0 and "error[" not in command.err and "SLOWED" not in command.err, (
        command.err
    )
    assert "note[TURN_LIMITED]" in command.err
    with open(workshop.folder / "out" / "waypoints.csv", encoding="utf-8", newline="") as stream:
        rows = [row for row in csv.DictReader(stream) if row["kind"] == "deposit"]
    layer, bead = (np.array([int(row[name]) for row in rows]) for name in ("layer", "bead"))
    positions, build, tool = (
        np.array([[float(row[name]) for name in names] for row in rows])
        for names in (("x_mm", "y_mm", "z_mm"), ("bx", "by", "bz"), ("tx", "ty", "tz"))
    )
    starts = np.flatnonzero((np.diff(layer, prepend=-1) != 0) | (np.diff(bead, prepend=-1) != 0))
    leaning = 0
    for start, stop in zip(starts, [*starts[1:], len(rows)]):
        points, up, torch = positions[start:stop], build[start:stop], tool[start:stop]
        assert angle(up, normals(*points.T)).max() < 1e-3
        in_plane = angle(torch, up)
        if in_plane.max() > 0.01:
            leaning += 1
            assert np.abs(in_plane - LEAN_DEG).max() < 0.1
            out = points - points.mean(axis=0)
            assert ((torch - up) * out).sum(axis=1)[np.linalg.norm(out, axis=1) > 10.0].mean() > 0.0
            turn = angle(torch[1:], torch[:-1]) / np.linalg.norm(np.diff(points, axis=0), axis=1)
            assert turn.max() < 1.01 * MAX_TURN
    assert leaning == 6 * len(
        set(layer.tolist())
    )  # one outline for each of six blades in each layer
