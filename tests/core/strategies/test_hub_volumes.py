# SPDX-License-Identifier: LGPL-2.1-or-later
"""Missed, stray and double volume of solids on hubs, also for complete rings: against a raster of
each layer by distances on the cylinder or cone, and volumes by integrals."""

import math

import numpy as np
import pytest
from scipy.integrate import quad
from scipy.spatial import cKDTree

from freecad_am.core.geometry.developable import Developable
from freecad_am.core.geometry.on_hub import volume_beyond
from freecad_am.core.process.deposit import balance as deposit_balance
from tests.core.strategies.test_developable import box, collar, distance_from_hub, planned, solids

CYLINDER, CONE = Developable(45.0), Developable(60.0, 200.0)
SPACING, HEIGHT, PITCH, STEP = 6.0, 6.0, 0.25, 0.25


def polar(surface, points):
    """Unrolled coordinates: arc and height on a cylinder, angle about and distance from the apex on
    a cone."""
    rho, theta = np.hypot(points[:, 0], points[:, 1]), np.arctan2(points[:, 1], points[:, 0])
    if math.isinf(surface.height):
        return rho * theta, points[:, 2]
    sine = surface.radius / math.hypot(surface.radius, surface.height)
    return theta * sine, rho / sine


def plane(surface, angle, distance):
    if math.isinf(surface.height):
        return np.stack([angle, distance], axis=-1)
    return np.stack([distance * np.sin(angle), -distance * np.cos(angle)], axis=-1)


def covered(surface, beads, angle, distance, turn):
    """Whether points of a layer are within half a bead width of a bead, including one turn either
    way."""
    dense = []
    for points in beads:
        for a, b in zip(points, points[1:]):
            count = max(2, math.ceil(np.linalg.norm(b - a) / STEP) + 1)
            dense.append(a + np.linspace(0.0, 1.0, count)[:, None] * (b - a))
    arc, along = polar(surface, np.vstack(dense))
    flat = np.vstack([plane(surface, arc + k * turn, along) for k in (-1, 0, 1)])
    return (
        cKDTree(flat).query(plane(surface, angle, distance), distance_upper_bound=SPACING)[0]
        <= 0.5 * SPACING
    )


def raster_volumes(surface, path, inside):
    """mm3 of the part in its layers: total, missed, stray and double."""
    volumes = np.zeros(4)
    for layer in path.layers:
        beads = [bead.points for bead in layer.beads]
        distance = float(np.mean(distance_from_hub(surface, beads[0])))
        layer_surface = surface.offset(distance)
        points = np.vstack(beads)
        low, high = polar(surface, points)[1].min() - 9.0, polar(surface, points)[1].max() + 9.0
        sine = math.sin(surface.taper)
        turn = 2.0 * math.pi * (layer_surface.radius if surface.is_cylinder else sine)
        distances = (np.arange(math.floor(low / PITCH), math.ceil(high / PITCH)) + 0.5) * PITCH
        across = PITCH if surface.is_cylinder else PITCH / distances.mean()
        count = math.ceil(turn / across)
        angle, distance_grid = (
            grid.ravel()
            for grid in np.meshgrid((np.arange(count) + 0.5) / count * turn - 0.5 * turn, distances)
        )
        area = turn / count * PITCH * (1.0 if surface.is_cylinder else distance_grid)
        theta = angle / (layer_surface.radius if surface.is_cylinder else sine)
        rho = (
            np.full(len(distance_grid), layer_surface.radius)
            if surface.is_cylinder
            else distance_grid * sine
        )
        z = (
            distance_grid
            if surface.is_cylinder
            else layer_surface.height - distance_grid * math.cos(surface.taper)
        )
        is_part = inside(np.stack([rho * np.cos(theta), rho * np.sin(theta), z], axis=1))
        is_covered = covered(surface, beads, angle, distance_grid, turn)
        sums = [
            float((area * np.ones(len(distance_grid)))[mask].sum())
            for mask in (is_part, is_part & ~is_covered, is_covered & ~is_part, is_covered)
        ]
        length = sum(float(np.linalg.norm(np.diff(line, axis=0), axis=1).sum()) for line in beads)
        volumes += [*sums[:3], length * SPACING - sums[3]]
    return HEIGHT * volumes


def ring(inner, outer, low, high):
    def inside(points):
        rho = np.hypot(points[:, 0], points[:, 1])
        return (rho > inner) & (rho < outer) & (points[:, 2] > low) & (points[:, 2] < high)

    return collar(inner, outer, low, high, 360), inside


@pytest.mark.parametrize(
    ("surface", "size", "fill"),
    [
        (CYLINDER, (40.0, 56.0, 10.0, 37.0), "contours"),
        (CYLINDER, (40.0, 56.0, 10.0, 13.0), "contours"),
        (CONE, (20.0, 66.0, 30.0, 50.0), "contours"),
        (CONE, (20.0, 66.0, 30.0, 50.0), "lines"),
    ],
    ids=str,
)
def test_what_is_laid_all_the_way_round_a_hub_is_known(surface, size, fill):
    """The volumes of complete rings are known."""
    body, inside = ring(*size)
    path = planned(solids(surface, body), fill=fill)
    raster_volume, missed, stray, twice = raster_volumes(surface, path, inside)
    foot = (
        (lambda z: surface.radius)
        if surface.is_cylinder
        else (lambda z: surface.radius * (1.0 - z / surface.height))
    )
    part_volume = quad(lambda z: math.pi * (size[1] ** 2 - foot(z) ** 2), size[2], size[3])[0]
    volumes, tolerance = path.checks.volumes, 0.012 * max(part_volume, raster_volume)
    assert volumes[0] == pytest.approx(part_volume, rel=1e-3)
    assert volumes[1] == pytest.approx(
        missed + max(part_volume - raster_volume, 0.0), abs=tolerance
    )
    assert volumes[2] == pytest.approx(stray + max(raster_volume - part_volume, 0.0), abs=tolerance)
    assert path.checks.twice == pytest.approx(twice, abs=tolerance)
    thin = size[3] - size[2] < SPACING
    assert (volumes[2] > 0.5 * part_volume) == thin


def test_a_thin_collar_is_told_to_lie_beside_and_a_wide_one_is_no_news():
    """A ring of 3 mm under beads of 6 mm has as much stray as inside deposit, and a warning as for
    any other solid."""

    def check_ring(low, high):
        hub_solids = solids(CYLINDER, ring(40.0, 57.0, low, high)[0])
        balance = deposit_balance.toolpath_balance(hub_solids, planned(hub_solids), 6.0)
        return balance, [issue.code for issue in deposit_balance.issues(balance)]

    balance, codes = check_ring(10.0, 13.0)
    assert codes[-1] == "DEPOSITED_BESIDE" and balance.outside == pytest.approx(
        balance.beads / 2.0, rel=0.02
    )
    assert "DEPOSITED_BESIDE" not in check_ring(10.0, 40.0)[1]


def test_what_layers_reach_beyond_a_solid_lies_beside_it():
    """A box 7 mm high over a cylinder in layers of 6 mm: 5 mm of the second layer are outside the
    part."""
    high = 52.0
    block = box(np.array([20.0, -17.0, 20.0]), np.array([high, 17.0, 95.0]))
    path = planned(solids(CYLINDER, block))
    part_volume = 75.0 * quad(lambda y: high - math.sqrt(45.0**2 - y * y), -17.0, 17.0)[0]
    assert len(path.layers) > 1 and path.checks.volumes[0] == pytest.approx(part_volume, rel=1e-3)
    deposited = (
        HEIGHT
        * 75.0
        * sum(
            2.0 * radius * math.asin(17.0 / radius)
            - (0.0 if radius < high else 2.0 * radius * math.acos(high / radius))
            for radius in 45.0 + HEIGHT * np.arange(len(path.layers))
        )
    )
    assert deposited > 1.1 * part_volume
    assert path.checks.volumes[2] == pytest.approx(deposited - part_volume, rel=0.05)


@pytest.mark.parametrize(
    "surface", [CYLINDER, CONE, Developable(60.0, 20.0)], ids=["cylinder", "cone", "wide cone"]
)
def test_the_volume_outside_of_a_hub(surface):
    low, high = np.array([20.0, -17.0, 5.0]), np.array([84.0, 17.0, 95.0])
    body = box(low, high)

    def span(y, z):
        rho = (
            surface.radius
            if surface.is_cylinder
            else max(surface.radius * (1.0 - z / surface.height), 0.0)
        )
        return high[0] - max(low[0], math.sqrt(max(rho * rho - y * y, 0.0)))

    y, z = (low[k] + (np.arange(600) + 0.5) / 600 * (high[k] - low[k]) for k in (1, 2))
    expected = (
        np.mean([[span(a, b) for a in y] for b in z]) * (high[1] - low[1]) * (high[2] - low[2])
    )
    assert volume_beyond(surface, body.vertices, body.triangles) == pytest.approx(
        expected, rel=2e-4
    )
    assert volume_beyond(Developable(200.0), body.vertices, body.triangles) == 0.0
