# SPDX-License-Identifier: LGPL-2.1-or-later
"""Meshes as users have them: mended where that is safe, and refused with the place where it is not."""

import numpy as np
import pytest
from scipy.spatial import ConvexHull
from scipy.spatial.transform import Rotation

from freecad_am.core.geometry.mesh.refine import Edges
from freecad_am.core.geometry.mesh.repair import repair_mesh
from freecad_am.core.issues import InputError


def ball(radius=10.0, at=(0.0, 0.0, 0.0), count=150, seed=3):
    """Points and outward triangles of a random polyhedron with its corners on a sphere."""
    points = np.random.default_rng(seed).normal(size=(count, 3))
    points *= radius / np.linalg.norm(points, axis=1)[:, None]
    faces = ConvexHull(points).simplices.copy()
    a, b, c = (points[faces[:, k]] for k in range(3))
    inward = (np.cross(b - a, c - a) * (a + b + c)).sum(axis=1) < 0.0
    faces[inward] = faces[inward][:, ::-1]
    return points + np.array(at), faces.astype(np.intp)


def told(result):
    return " ".join(issue.message for issue in result.issues)


def test_a_sound_mesh_stays_as_it_is():
    points, faces = ball()
    found = repair_mesh(points, faces, "ball")
    assert len(found.solids) == 1 and not found.issues
    assert len(found.solids[0].triangles) == len(faces)
    assert found.solids[0].volume > 0.0


@pytest.mark.parametrize("noise", [0.0, 2e-6, 4e-3])
def test_loose_triangles_are_put_together(noise):
    points, faces = ball()
    loose = points[faces].reshape(-1, 3)
    loose = loose + np.random.default_rng(1).uniform(-0.5, 0.5, loose.shape) * noise
    found = repair_mesh(loose, np.arange(len(loose)).reshape(-1, 3), "ball")
    assert len(found.solids) == 1 and len(found.solids[0].vertices) == len(points)
    assert ("were merged" in told(found)) == (noise > 1e-5)


def test_what_is_there_twice_flat_or_turned_is_mended():
    points, faces = ball()
    volume = repair_mesh(points, faces, "ball").solids[0].volume
    wrong = faces.copy()
    wrong[::7] = wrong[::7, ::-1]
    wrong = np.vstack([wrong, faces[5:8], [[3, 3, 4]]])
    found = repair_mesh(points, wrong, "ball")
    assert found.solids[0].volume == pytest.approx(volume)
    assert len(found.solids[0].triangles) == len(faces)
    for words in ("degenerate", "duplicate", "to match their neighbours"):
        assert words in told(found)


def test_a_missing_triangle_is_put_in():
    points, faces = ball()
    found = repair_mesh(points, np.delete(faces, 11, axis=0), "ball")
    assert found.solids[0].volume == pytest.approx(
        repair_mesh(points, faces, "ball").solids[0].volume
    )
    assert "1 missing triangles" in told(found)


def test_inside_out_solids_are_turned_and_pieces_told_apart():
    points, faces = ball()
    other, more = ball(6.0, (40.0, 0.0, 0.0), seed=5)
    hollow, inner = ball(3.0, (40.0, 0.0, 0.0), seed=6)
    vertices = np.vstack([points, other, hollow])
    triangles = np.vstack(
        [faces[:, ::-1], more + len(points), inner[:, ::-1] + len(points) + len(other)]
    )
    found = repair_mesh(vertices, triangles, "balls")
    volumes = sorted(solid.volume for solid in found.solids)
    whole = [
        repair_mesh(*ball(*args), "one").solids[0].volume
        for args in ((10.0,), (6.0, (40.0, 0.0, 0.0), 150, 5), (3.0, (40.0, 0.0, 0.0), 150, 6))
    ]
    np.testing.assert_allclose(volumes, [whole[1] - whole[2], whole[0]])
    assert "a solid was inside out" in told(found)


def test_what_is_not_safe_is_refused_with_its_place():
    points, faces = ball()
    around = np.flatnonzero((faces == 20).any(axis=1))
    with pytest.raises(InputError) as caught:
        repair_mesh(points, np.delete(faces, around, axis=0), "ball.stl")
    assert (caught.value.code, caught.value.where) == ("OPEN_MESH", "ball.stl")
    assert (
        f"{len(around)} edges" in caught.value.message and "close" in caught.value.message.lower()
    )
    fin = np.vstack([points, points[0] * 2.0])
    apex = len(points)
    with pytest.raises(InputError) as caught:
        repair_mesh(fin, np.vstack([faces, [[faces[0, 0], faces[0, 1], apex]]]), "fin.stl")
    assert caught.value.code in ("OPEN_MESH", "NON_MANIFOLD")
    shared = np.vstack([points, points[faces[0]].mean(axis=0) * 3.0])
    a, b, c = faces[0]
    tent = [[a, b, apex], [b, c, apex], [c, a, apex]]
    with pytest.raises(InputError) as caught:
        repair_mesh(shared, np.vstack([faces, tent]), "tent.stl")
    assert caught.value.code == "NON_MANIFOLD" and "(" in caught.value.message
    with pytest.raises(InputError) as caught:
        repair_mesh(np.full((3, 3), np.nan), np.array([[0, 1, 2]]), "nothing.stl")
    assert caught.value.code == "BAD_FILE"


def box(size=10.0, at=(0.0, 0.0, 0.0)):
    """Points and outward triangles of a cube."""
    points = np.array([[x, y, z] for x in (0, 1) for y in (0, 1) for z in (0, 1)], dtype=float)
    faces = ConvexHull(points).simplices.copy()
    a, b, c = (points[faces[:, k]] for k in range(3))
    inward = (np.cross(b - a, c - a) * (a + b + c - 1.5)).sum(axis=1) < 0.0
    faces[inward] = faces[inward][:, ::-1]
    return size * points + np.array(at), faces.astype(np.intp)


def both(*meshes):
    """Meshes as one."""
    begin = np.cumsum([0, *(len(points) for points, _ in meshes)])
    return np.vstack([points for points, _ in meshes]), np.vstack(
        [faces + at for (_, faces), at in zip(meshes, begin)]
    )


@pytest.mark.parametrize(
    "turn", [np.eye(3), Rotation.from_euler("xyz", [0.4, 1.2, -0.3]).as_matrix()]
)
def test_boxes_that_touch_along_an_edge_are_told_apart(turn):
    points, faces = both(
        box(), box(at=(10.0, 10.0, 0.0)), box(at=(20.0, 0.0, 0.0))
    )  # each beside the next
    found = repair_mesh(points @ turn, faces, "boxes")
    assert sorted(solid.volume for solid in found.solids) == pytest.approx([1000.0] * 3)
    for solid in found.solids:
        assert (Edges(solid.triangles).count == 2).all()
    assert [issue.code for issue in found.issues] == [
        "MENDED"
    ] and "2 edges of more than two" in told(found)
    where = [float(number) for number in told(found).split("(")[1].split(")")[0].split(",")]
    assert (turn @ where)[1] == pytest.approx(10.0, abs=1e-3)


def test_small_holes_are_closed_and_larger_ones_named():
    points, faces = ball(count=600)
    whole = repair_mesh(points, faces, "ball").solids[0].volume
    gone = np.zeros(len(faces), dtype=bool)
    for vertex in (20, 200):
        gone |= (faces == vertex).any(axis=1)
    widest = max(
        np.linalg.norm(np.ptp(points[faces[(faces == vertex).any(axis=1)]].reshape(-1, 3), axis=0))
        for vertex in (20, 200)
    )
    found = repair_mesh(points, faces[~gone], "ball", hole=widest + 1e-6)
    assert len(found.solids) == 1 and found.solids[0].volume == pytest.approx(whole, rel=2e-3)
    assert found.issues[0].code == "MENDED" and "2 holes were closed" in told(found)
    with pytest.raises(InputError) as caught:
        repair_mesh(points, faces[~gone], "ball", hole=0.5)
    assert caught.value.code == "OPEN_MESH" and f"{widest:.4g} mm across" in caught.value.message
    assert "and 1 more" in caught.value.message and "strategy.mend = 0.5 mm" in caught.value.message


def test_a_fin_and_triangles_that_cross_change_no_volume():
    points, faces = ball()
    whole = repair_mesh(points, faces, "ball").solids[0].volume
    a, b = faces[0, :2]
    fin = np.vstack([points, 0.6 * (points[a] + points[b])])
    found = repair_mesh(fin, np.vstack([faces, [[a, b, len(points)]]]), "fin", hole=30.0)
    assert [solid.volume for solid in found.solids] == pytest.approx([whole])
    assert "enclose no volume" in told(found)
    pushed = points.copy()
    pushed[0] *= -1.2  # through the other side
    with pytest.raises(InputError) as caught:
        repair_mesh(pushed, faces, "pushed")
    assert caught.value.code == "SELF_CROSSING"
    found = repair_mesh(pushed, faces, "pushed", crossing=True)
    assert "pairs of triangles intersect" in told(found) and found.issues[-1].level == "warning"


def test_what_stands_in_the_box_of_another_is_no_cavity():
    """A ball, inside out, between the arms of a U: in its box, not in it."""
    outline = np.array(
        [[0, 0], [30, 0], [30, 30], [20, 30], [20, 10], [10, 10], [10, 30], [0, 30]], dtype=float
    )
    low = np.column_stack([outline, np.zeros(8)])
    points = np.vstack([low, low + [0.0, 0.0, 20.0]])
    cap = [(0, 1, 4), (0, 4, 5), (1, 2, 4), (2, 3, 4), (0, 5, 7), (5, 6, 7)]
    faces = [(a, c, b) for a, b, c in cap] + [(a + 8, b + 8, c + 8) for a, b, c in cap]
    for k in range(8):
        after = (k + 1) % 8
        faces += [(k, after, after + 8), (k, after + 8, k + 8)]
    inner, turned = ball(3.0, (15.0, 20.0, 10.0))
    found = repair_mesh(*both((points, np.array(faces)), (inner, turned[:, ::-1])), "both")
    volumes = sorted(solid.volume for solid in found.solids)
    assert volumes == pytest.approx(
        [repair_mesh(inner, turned, "ball").solids[0].volume, 700.0 * 20.0]
    )


def test_a_mesh_with_every_triangle_from_both_sides_is_one_solid():
    points, faces = ball()
    found = repair_mesh(points, np.vstack([faces, faces[:, ::-1]]), "ball")
    assert [solid.volume for solid in found.solids] == pytest.approx(
        [repair_mesh(points, faces, "ball").solids[0].volume]
    )


def test_a_surface_without_inside_is_refused():
    """A Klein bottle: closed, two triangles at every edge, and no side that is the inside."""
    n = 12
    number = np.arange(n * n).reshape(n, n)
    u, v = (grid.ravel() for grid in np.meshgrid(np.arange(n), np.arange(n), indexing="ij"))
    angle, other = 2.0 * np.pi * u / n, 2.0 * np.pi * (v + 0.5) / n
    across = 3.0 + np.cos(angle / 2.0) * np.sin(other) - np.sin(angle / 2.0) * np.sin(2.0 * other)
    points = np.stack(
        [
            across * np.cos(angle),
            across * np.sin(angle),
            np.sin(angle / 2.0) * np.sin(other) + np.cos(angle / 2.0) * np.sin(2.0 * other),
        ],
        axis=1,
    )
    faces = []
    for i in range(n):
        for j in range(n):
            a, b = number[i, j], number[i, (j + 1) % n]
            row = number[(i + 1) % n]
            c, d = (
                (row[j], row[(j + 1) % n]) if i < n - 1 else (row[n - 1 - j], row[(n - 2 - j) % n])
            )
            faces += [(a, c, b), (b, c, d)]
    with pytest.raises(InputError) as caught:
        repair_mesh(points, np.array(faces, dtype=np.intp), "bottle")
    assert caught.value.code == "NOT_ORIENTABLE"
