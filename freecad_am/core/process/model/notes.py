# SPDX-License-Identifier: LGPL-2.1-or-later
"""What is said where a bead model sets the speeds: the fit, what lies outside of its table, heights, the wire."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Protocol

import numpy as np

from ...issues import NOTE, WARNING, Issue
from ...parameters.process import ProcessParameters
from ...toolpath import Bead
from ...types import Array, Mask
from .bead_model import MINUTE, BeadModel
from .predicted import with_heights
from .wire import with_model

CLAMPED = 0.05  # of the length


class Held(Protocol):
    """A bead at the speeds of a model, where (n,) the speed is not what the width asks for, and where it bends more than the
    table's beads."""

    @property
    def bead(self) -> Bead: ...

    @property
    def clamped(self) -> Mask | None: ...

    @property
    def tight(self) -> Mask | None: ...


def of_model(made: Sequence[Held], layer_height: float, process: ProcessParameters, model: BeadModel) -> list[Issue]:
    """All of it. layer_height: mm."""
    length = np.concatenate([np.linalg.norm(np.diff(one.bead.points, axis=0), axis=1) for one in made])
    speed = np.concatenate([one.bead.speed[1:] for one in made]) * MINUTE
    fit = model.width
    found = [Issue(
        NOTE, "BEAD_MODEL", f"w = {fit.m:.4g} v^(-1/3) + {fit.p:.4g} / r + {fit.t:.4g} with R2 = {fit.r_squared:.4f} "
        f"and RMSE = {fit.rmse:.3g} mm; a width of {process.bead_width:g} mm takes travel speeds of {speed.min():.4g} to "
        f"{speed.max():.4g} mm/min",
    )]
    found += _outside(made, length, process.bead_width, model)
    found.append(with_heights([one.bead for one in made], layer_height, process, model))
    feed = with_model(process, model)
    if abs(feed - model.wire_feed) > 0.01 * model.wire_feed:
        low, high = model.feeds or (model.wire_feed, model.wire_feed)
        measured = f"{low:.4g}" if low == high else f"{low:.4g} to {high:.4g}"
        found.append(Issue(
            WARNING, "WIRE_FEED", f"the table was measured at a wire feed of {measured} mm/s, the job has "
            f"{feed:.4g} mm/s; set process.wire.feed to auto or to that, or measure a table at it",
        ))
    return found


def _outside(made: Sequence[Held], length: Array, wanted: float, model: BeadModel) -> list[Issue]:
    """Where beads are not such as the table has."""
    clamped = np.concatenate([one.clamped[1:] for one in made if one.clamped is not None])
    tight = np.concatenate([one.tight[1:] for one in made if one.tight is not None])
    low, high = (MINUTE * value for value in model.speeds)
    slow, bent = (float(length[some].sum() / length.sum()) for some in (clamped, tight))
    found = []
    if slow > 0.0:
        beads = sum(bool(one.clamped[1:].any()) for one in made if one.clamped is not None)
        width = np.concatenate([one.bead.width[1:] for one in made if one.bead.width is not None])[clamped]
        worst = float(width[np.abs(width - wanted).argmax()])
        least, most = np.sort(model.widths(np.array(model.speeds), np.full(2, np.inf)))
        found.append(Issue(
            WARNING if slow > CLAMPED else NOTE, "OUTSIDE_TABLE", f"on {100.0 * slow:.3g} % of the length, in {beads} of "
            f"{len(made)} beads and {len(width)} segments, the width asked for takes a speed outside of the table's "
            f"{low:.4g} to {high:.4g} mm/min; it is kept within, and the width is not held: it is {worst:.3g} mm at its "
            f"farthest from the {wanted:g} mm. Straight beads of the table are {least:.4g} to {most:.4g} mm wide: ask for a "
            "process.bead_width among these, or measure beads at other speeds",
        ))
    if bent > 0.0:
        found.append(Issue(
            NOTE, "TIGHT_BENDS", f"{100.0 * bent:.3g} % of the length bends more than the table's beads, of "
            f"{model.radii[0]:.4g} mm or more, and counts as bent like these; widths are only estimated there",
        ))
    return found
