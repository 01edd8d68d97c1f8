# SPDX-License-Identifier: LGPL-2.1-or-later
"""What is said where a bead model sets the speeds: the fit, what lies outside of its table, heights, the wire."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Protocol

import numpy as np

from ...issues import NOTE, WARNING, Issue, Text, Word
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


def of_model(
    made: Sequence[Held], layer_height: float, process: ProcessParameters, model: BeadModel
) -> list[Issue]:
    """All of it. layer_height: mm."""
    length = np.concatenate(
        [np.linalg.norm(np.diff(one.bead.points, axis=0), axis=1) for one in made]
    )
    speed = np.concatenate([one.bead.speed[1:] for one in made]) * MINUTE
    fit = model.width
    found = [
        Issue(
            NOTE,
            "BEAD_MODEL",
            Text(
                "w = {:.4g} v^(-1/3) + {:.4g} / r + {:.4g} with R2 = {:.4f} and RMSE = {:.3g} mm; a width "
                "of {:g} mm takes travel speeds of {:.4g} to {:.4g} mm/min",
                fit.m,
                fit.p,
                fit.t,
                fit.r_squared,
                fit.rmse,
                process.bead_width,
                speed.min(),
                speed.max(),
            ),
        )
    ]
    if model.contradictions:
        found.append(
            Issue(
                WARNING,
                "TABLE_CONTRADICTS",
                Text(
                    "rows of the bead table were laid alike and measured differently: {}; measure these beads again, or "
                    "leave one of each pair out",
                    Text.joined(", ", model.contradictions),
                ),
            )
        )
    found += _outside(made, length, process.bead_width, model)
    found.append(with_heights([one.bead for one in made], layer_height, process, model))
    feed = with_model(process, model)
    if abs(feed - model.wire_feed) > 0.01 * model.wire_feed:
        low, high = model.feeds or (model.wire_feed, model.wire_feed)
        measured = Text("{:.4g}", low) if low == high else Text("{:.4g} to {:.4g}", low, high)
        found.append(
            Issue(
                WARNING,
                "WIRE_FEED",
                Text(
                    "the table was measured at a wire feed of {} mm/s, the job has {:.4g} mm/s; set "
                    "process.wire.feed to auto or to that, or measure a table at it",
                    Word(measured),
                    feed,
                ),
            )
        )
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
        width = np.concatenate([one.bead.width[1:] for one in made if one.bead.width is not None])[
            clamped
        ]
        worst = float(width[np.abs(width - wanted).argmax()])
        least, most = np.sort(model.widths(np.array(model.speeds), np.full(2, np.inf)))
        found.append(
            Issue(
                WARNING if slow > CLAMPED else NOTE,
                "OUTSIDE_TABLE",
                Text(
                    "on {:.3g} % of the length, in {} of {} beads and {} "
                    "segments, the width asked for takes a speed outside of the table's {:.4g} to {:.4g} mm/min; it is kept "
                    "within, and the width is not held: it is {:.3g} mm at its farthest from the {:g} mm. Straight beads of the "
                    "table are {:.4g} to {:.4g} mm wide: ask for a process.bead_width among these, or measure beads at other "
                    "speeds",
                    100.0 * slow,
                    beads,
                    len(made),
                    len(width),
                    low,
                    high,
                    worst,
                    wanted,
                    least,
                    most,
                ),
            )
        )
    if bent > 0.0:
        found.append(
            Issue(
                NOTE,
                "TIGHT_BENDS",
                Text(
                    "{:.3g} % of the length bends more than the table's beads, of {:.4g} mm or more, and "
                    "counts as bent like these; widths are only estimated there",
                    100.0 * bent,
                    model.radii[0],
                ),
            )
        )
    return found
