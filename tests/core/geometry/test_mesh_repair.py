# SPDX-License-Identifier: LGPL-2.1-or-later
"""Defective meshes of users: repaired where that is safe, otherwise rejected with the position of
the defect."""

import numpy as np
import pytest
from scipy.spatial import ConvexHull
from scipy.spatial.transform import Rotation

from freecad_am.core.geometry.mesh.refine import Edges
from freecad_am.core.geometry.mesh.repair import repair_mesh
from freecad_am.core.issues import InputError


def ball(radius=10.0, centre=(0.0, 0.0, 0.0), count=150, seed=3):
    """Points and outward triangles of a random polyhedron with its corners on a sphere."""
    points = np.random.default_rng(seed).normal(size=(count, 3))
    points *= radius / np.linalg.norm(points, axis=1)[:, None]
    faces = ConvexHull(points).simplices.copy()
    a, b, c = (points[faces[:, k]] for k in range(3))
    inward = (np.cross(b - a, c - a) * (a + b + c)).sum(axis=1) < 0.0
    faces[inward] = faces[inward][:, ::-1]
    return points + np.array(centre), faces.astype(np.intp)


def messages_of(result):
    return " ".join(issue.message for issue in result.issues)


def test_a_sound_mesh_stays_as_it_is():
    points, faces = ball()
    repaired = repair_mesh(points, faces, "ball")
    assert len(repaired.solids) == 1 and not repaired.issues
    assert len(repaired.solids[0].triangles) == len(faces)
    assert repaired.solids[0].volume > 0.0


@pytest.mark.parametrize("noise", [0.0, 2e-6, 4e-3])
def test_loose_triangles_are_put_together(noise):
    """Separate triangles are merged into one solid."""
    points, faces = ball()
    loose = points[faces].reshape(-1, 3)
    loose = loose + np.random.default_rng(1).uniform(-0.5, 0.5, loose.shape) * noise
    repaired = repair_mesh(loose, np.arange(len(loose)).reshape(-1, 3), "ball")
    assert len(repaired.solids) == 1 and len(repaired.solids[0].vertices) == len(points)
    assert ("were merged" in messages_of(repaired)) == (noise > 1e-5)


def test_what_is_there_twice_flat_or_turned_is_mended():
    """Duplicate, degenerate and flipped triangles are repaired."""
    points, faces = ball()
    volume = repair_mesh(points, faces, "ball").solids[0].volume
    wrong = faces.copy()
    wrong[::7] = wrong[::7, ::-1]
    wrong = np.vstack([wrong, faces[5:8], [[3, 3, 4]]])
    repaired = repair_mesh(points, wrong, "ball")
    assert repaired.solids[0].volume == pytest.approx(volume)
    assert len(repaired.solids[0].triangles) == len(faces)
    for words in ("degenerate", "duplicate", "to match their neighbours"):
        assert words in messages_of(repaired)


def test_a_missing_triangle_is_put_in():
    """A missing triangle is added."""
    points, faces = ball()
    repaired = repair_mesh(points, np.delete(faces, 11, axis=0), "ball")
    assert repaired.solids[0].volume == pytest.approx(
        repair_mesh(points, faces, "ball").solids[0].volume
    )
    assert "1 missing triangles" in messages_of(repaired)


def test_inside_out_solids_are_turned_and_pieces_told_apart():
    """Inverted solids are turned over, and separate solids and cavities are distinguished."""
    points, faces = ball()
    second_points, second_faces = ball(6.0, (40.0, 0.0, 0.0), seed=5)
    hollow, inner = ball(3.0, (40.0, 0.0, 0.0), seed=6)
    vertices = np.vstack([points, second_points, hollow])
    triangles = np.vstack(
        [
            faces[:, ::-1],
            second_faces + len(points),
            inner[:, ::-1] + len(points) + len(second_points),
        ]
    )
    repaired = repair_mesh(vertices, triangles, "balls")
    volumes = sorted(solid.volume for solid in repaired.solids)
    volumes_alone = [
        repair_mesh(*ball(*args), "one").solids[0].volume
        for args in ((10.0,), (6.0, (40.0, 0.0, 0.0), 150, 5), (3.0, (40.0, 0.0, 0.0), 150, 6))
    ]
    np.testing.assert_allclose(volumes, [volumes_alone[1] - volumes_alone[2], volumes_alone[0]])
    assert "an inside-out solid was reversed" in messages_of(repaired)


def test_what_is_not_safe_is_refused_with_its_place():
    """An unsafe repair is rejected with the position of the defect."""
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


def box(size=10.0, corner=(0.0, 0.0, 0.0)):
    """Points and outward triangles of a cube."""
    points = np.array([[x, y, z] for x in (0, 1) for y in (0, 1) for z in (0, 1)], dtype=float)
    faces = ConvexHull(points).simplices.copy()
    a, b, c = (points[faces[:, k]] for k in range(3))
    inward = (np.cross(b - a, c - a) * (a + b + c - 1.5)).sum(axis=1) < 0.0
    faces[inward] = faces[inward][:, ::-1]
    return size * points + np.array(corner), faces.astype(np.intp)


def concatenate(*meshes):
    """Concatenate meshes."""
    begin = np.cumsum([0, *(len(points) for points, _ in meshes)])
    return np.vstack([points for points, _ in meshes]), np.vstack(
        [faces + offset for (_, faces), offset in zip(meshes, begin)]
    )


@pytest.mark.parametrize(
    "turn", [np.eye(3), Rotation.from_euler("xyz", [0.4, 1.2, -0.3]).as_matrix()]
)
def test_boxes_that_touch_along_an_edge_are_told_apart(turn):
    points, faces = concatenate(
        box(), box(corner=(10.0, 10.0, 0.0)), box(corner=(20.0, 0.0, 0.0))
    )  # each next to the following one
    repaired = repair_mesh(points @ turn, faces, "boxes")
    assert sorted(solid.volume for solid in repaired.solids) == pytest.approx([1000.0] * 3)
    for solid in repaired.solids:
        assert (Edges(solid.triangles).count == 2).all()
    assert [issue.code for issue in repaired.issues] == [
        "MENDED"
    ] and "2 edges of more than two" in messages_of(repaired)
    where = [
        float(number) for number in messages_of(repaired).split("(")[1].split(")")[0].split(",")
    ]
    assert (turn @ where)[1] == pytest.approx(10.0, abs=1e-3)


def test_small_holes_are_closed_and_larger_ones_named():
    """Small holes are closed, larger ones are reported with their size."""
    points, faces = ball(count=600)
    volume = repair_mesh(points, faces, "ball").solids[0].volume
    removed = np.zeros(len(faces), dtype=bool)
    for vertex in (20, 200):
        removed |= (faces == vertex).any(axis=1)
    widest = max(
        np.linalg.norm(np.ptp(points[faces[(faces == vertex).any(axis=1)]].reshape(-1, 3), axis=0))
        for vertex in (20, 200)
    )
    repaired = repair_mesh(points, faces[~removed], "ball", hole=widest + 1e-6)
    assert len(repaired.solids) == 1 and repaired.solids[0].volume == pytest.approx(
        volume, rel=2e-3
    )
    assert repaired.issues[0].code == "MENDED" and "2 holes were closed" in messages_of(repaired)
    with pytest.raises(InputError) as caught:
        repair_mesh(points, faces[~removed], "ball", hole=0.5)
    assert caught.value.code == "OPEN_MESH" and f"{widest:.4g} mm across" in caught.value.message
    assert "and 1 more" in caught.value.message and "strategy.mend = 0.5 mm" in caught.value.message


def test_a_fin_and_triangles_that_cross_change_no_volume():
    """A fin without volume and intersecting triangles do not change the volume."""
    points, faces = ball()
    volume = repair_mesh(points, faces, "ball").solids[0].volume
    a, b = faces[0, :2]
    fin = np.vstack([points, 0.6 * (points[a] + points[b])])
    repaired = repair_mesh(fin, np.vstack([faces, [[a, b, len(points)]]]), "fin", hole=30.0)
    assert [solid.volume for solid in repaired.solids] == pytest.approx([volume])
    assert "enclose no volume" in messages_of(repaired)
    pushed = points.copy()
    pushed[0] *= -1.2  # through the other side
    with pytest.raises(InputError) as caught:
        repair_mesh(pushed, faces, "pushed")
    assert caught.value.code == "SELF_CROSSING"
    repaired = repair_mesh(pushed, faces, "pushed", crossing=True)
    assert (
        "pairs of triangles intersect" in messages_of(repaired)
        and repaired.issues[-1].level == "warning"
    )


def test_what_stands_in_the_box_of_another_is_no_cavity():
    """An inverted ball between the arms of a U is in its bounding box but not inside it, so it is
    no cavity."""
    outline = np.array(
        [[0, 0], [30, 0], [30, 30], [20, 30], [20, 10], [10, 10], [10, 30], [0, 30]], dtype=float
    )
    low = np.column_stack([outline, np.zeros(8)])
    points = np.vstack([low, low + [0.0, 0.0, 20.0]])
    cap = [(0, 1, 4), (0, 4, 5), (1, 2, 4), (2, 3, 4), (0, 5, 7), (5, 6, 7)]
    faces = [(a, c, b) for a, b, c in cap] + [(a + 8, b + 8, c + 8) for a, b, c in cap]
    for k in range(8):
        following = (k + 1) % 8
        faces += [(k, following, following + 8), (k, following + 8, k + 8)]
    inner, turned = ball(3.0, (15.0, 20.0, 10.0))
    repaired = repair_mesh(
        *concatenate((points, np.array(faces)), (inner, turned[:, ::-1])), "both"
    )
    volumes = sorted(solid.volume for solid in repaired.solids)
    assert volumes == pytest.approx(
        [repair_mesh(inner, turned, "ball").solids[0].volume, 700.0 * 20.0]
    )


def test_a_mesh_with_every_triangle_from_both_sides_is_one_solid():
    """A mesh with every triangle from both sides is one solid."""
    points, faces = ball()
    repaired = repair_mesh(points, np.vstack([faces, faces[:, ::-1]]), "ball")
    assert [solid.volume for solid in repaired.solids] == pytest.approx(
        [repair_mesh(points, faces, "ball").solids[0].volume]
    )


def test_a_surface_without_inside_is_refused():
    """A Klein bottle is closed with two triangles at every edge, but has no inside."""
    n = 12
    number = np.arange(n * n).reshape(n, n)
    u, v = (grid.ravel() for grid in np.meshgrid(np.arange(n), np.arange(n), indexing="ij"))
    angle, second_angle = 2.0 * np.pi * u / n, 2.0 * np.pi * (v + 0.5) / n
    across = (
        3.0
        + np.cos(angle / 2.0) * np.sin(second_angle)
        - np.sin(angle / 2.0) * np.sin(2.0 * second_angle)
    )
    points = np.stack(
        [
            across * np.cos(angle),
            across * np.sin(angle),
            np.sin(angle / 2.0) * np.sin(second_angle)
            + np.cos(angle / 2.0) * np.sin(2.0 * second_angle),
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
