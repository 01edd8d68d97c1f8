# SPDX-License-Identifier: LGPL-2.1-or-later
"""Bodies prepared for cuts by planes normal to a guide: the end at which it starts, and its
first plane.
"""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from ...geometry.curves.guide import fit_guide
from ...geometry.formatting import place
from ...geometry.obstacles import Body
from ...geometry.on_hub import Base, Group, SolidsOnHub, upright
from ...issues import NOTE, Issue, Text
from ...parameters.filled import SolidParameters
from ...types import Array
from ..planes.stacking import prepare_stack
from .centre_line import centre_line
from .guide_edges import Nodes, chain_edges

MIN_RISE_SHARE = 1e-6  # of its length; a guide whose ends are no farther apart along the direction runs as it was chosen


def prepare_guided(
    bodies: Sequence[Body],
    edges: Sequence[tuple[Array, Array]] | None,
    strategy: SolidParameters,
    label: str,
    issues: tuple[Issue, ...] = (),
) -> SolidsOnHub:
    """Return the bodies along a guide of edges, by default their centre line, which a note then
    reports.

    edges: points and unit tangents (n, 3) of each. The guide begins at the end that is lower
    along `strategy.direction`; the frame has its Z along the guide at the first layer. Raises
    the InputErrors of `chain_edges` and `centre_line`.
    """
    standing = prepare_stack(bodies, strategy, label, issues)
    direction = standing.groups[0].base.frame[:3, 2]
    all_issues = standing.issues
    nodes = None if edges is None else chain_edges([Nodes(*edge) for edge in edges])
    if nodes is None:
        nodes = centre_line(
            bodies, standing.groups[0].base.frame[:3, 3], direction, 0.5 * strategy.layer_height
        )
        all_issues = (*all_issues, _note(nodes, label))
    elif (nodes.points[-1] - nodes.points[0]) @ direction < -MIN_RISE_SHARE * np.linalg.norm(
        nodes.points[-1] - nodes.points[0]
    ):
        nodes = nodes.reversed()
    full_guide = fit_guide(*nodes)
    start = float(min(full_guide.distance(body.vertices).min() for body in bodies))
    origin, z = (rows[0] for rows in full_guide.at(np.array([start])))
    frame = upright(origin, z)
    local = fit_guide(
        (nodes.points - origin) @ frame[:3, :3],
        nodes.tangents @ frame[:3, :3],
        np.array([1.0, 0.0, 0.0]),
        start,
    )
    base = Base("the guide", local, frame)
    return SolidsOnHub(label, (Group(base, tuple(bodies)),), strategy.chord_error, (), all_issues)


def _note(nodes: Nodes, label: str) -> Issue:
    length = float(np.linalg.norm(np.diff(nodes.points, axis=0), axis=1).sum())
    turn = np.degrees(
        np.arccos(np.clip((nodes.tangents[1:] * nodes.tangents[:-1]).sum(axis=1), -1.0, 1.0)).sum()
    )
    return Issue(
        NOTE,
        "GUIDE",
        Text(
            "layers of {} are normal to its centre line, {:.4g} mm from {} to {}, turning by "
            "{:.3g} deg in total",
            label,
            length,
            place(nodes.points[0]),
            place(nodes.points[-1]),
            turn,
        ),
    )
