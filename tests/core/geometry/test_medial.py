# SPDX-License-Identifier: LGPL-2.1-or-later
"""Centre lines of regions."""

import time

import numpy as np
from scipy.spatial import QhullError

from freecad_am.core.geometry.regions import medial
from freecad_am.core.geometry.regions.medial import spine
from freecad_am.core.geometry.regions.region import regions


def test_the_middle_of_a_strip_is_found_from_very_many_places_too():
    """A gap of 1 % needs samples 0.014 mm apart; on exactly parallel lines they took more than a
    minute."""
    (strip,) = regions([np.array([[0.0, 0.0], [103.0, 0.0], [103.0, 8.0], [0.0, 8.0]])])
    start = time.process_time()
    path, closed = spine(strip, 0.035, 222.0 / 14_400)
    assert (
        time.process_time() - start < 4.0
    )  # it took more than ten times as long without the perturbation
    assert not closed and np.ptp(path[:, 0]) > 103.0 - 8.0 - 0.1
    between = path[(path[:, 0] > 4.0) & (path[:, 0] < 99.0)]
    assert np.abs(between[:, 1] - 4.0).max() < 1e-4


def test_gaps_of_the_same_shape_have_the_same_middle_wherever_they_are(monkeypatch):
    """Layers and islands have thousands of equal gaps, and the Voronoi diagram takes most of the
    time, so it is reused."""
    diagrams, diagram = [], medial.Voronoi
    monkeypatch.setattr(medial, "Voronoi", lambda samples: diagrams.append(1) or diagram(samples))
    gap = np.array([[0.0, 0.0], [9.123, 0.3], [20.0, 0.0], [20.0, 1.1], [8.0, 1.7], [0.0, 0.9]])
    by = np.array([123.456, -78.9])
    (region,), (moved_region,) = regions([gap]), regions([gap + by])
    path, _ = spine(region, 0.2, 0.05)
    moved, _ = spine(moved_region, 0.2, 0.05)
    assert len(diagrams) <= 1 and np.abs(moved - path - by).max() < 1e-8


def test_the_middle_of_walls_with_places_on_circles_has_no_double_points():
    """Four samples on one circle give one vertex, not two that the perturbation separates."""
    (strip,) = regions([np.array([[0.0, 0.0], [24.0, 0.0], [24.0, 2.0], [0.0, 2.0]])])
    path, _ = spine(strip, 0.3, 0.1)
    assert np.hypot(*np.diff(path, axis=0).T).min() > 1e-3


def test_the_middle_is_found_where_places_on_lines_are_too_much_for_the_diagram(monkeypatch):
    """Qhull rejects some exact samples (QH6347), as for a thin slot of a bent sheet; a perturbed
    retry succeeds."""
    diagram, attempts = medial.Voronoi, []

    def picky(samples):
        attempts.append(samples)
        if len(attempts) == 1:
            raise QhullError("QH6347 qhull precision error (qh_mergefacet): wide merge")
        return diagram(samples)

    monkeypatch.setattr(medial, "Voronoi", picky)
    (strip,) = regions([np.array([[0.0, 0.0], [30.0, 0.0], [30.0, 2.0], [0.0, 2.0]])])
    path, closed = spine(strip, 0.3, 0.1)
    assert len(attempts) == 2 and 0.0 < np.abs(attempts[1] - attempts[0]).max() < 1e-8
    between = path[(path[:, 0] > 1.0) & (path[:, 0] < 29.0)]
    assert not closed and np.ptp(path[:, 0]) > 27.5 and np.abs(between[:, 1] - 1.0).max() < 1e-4
