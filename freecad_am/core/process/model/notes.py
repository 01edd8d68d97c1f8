# SPDX-License-Identifier: LGPL-2.1-or-later
"""Issues of a bead model that sets the speeds: the fit, speeds outside its table, heights, the wire."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Protocol

import numpy as np

from ...issues import NOTE, WARNING, Issue, Text, Word
from ...parameters.process import ProcessParameters
from ...toolpath import Bead
from ...types import Array, Mask
from .bead_model import MINUTE, BeadModel
from .predicted import height_issue
from .wire import model_wire_feed

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


def model_issues(
    sized: Sequence[Held], layer_height: float, process: ProcessParameters, model: BeadModel
) -> list[Issue]:
    """All issues of beads at the speeds of a model. layer_height: mm."""
    length = np.concatenate(
        [np.linalg.norm(np.diff(sized_bead.bead.points, axis=0), axis=1) for sized_bead in sized]
    )
    speed = np.concatenate([sized_bead.bead.speed[1:] for sized_bead in sized]) * MINUTE
    fit = model.width
    issues = [
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
        issues.append(
            Issue(
                WARNING,
                "TABLE_CONTRADICTS",
                Text(
                    "rows of the bead table have the same settings but different results: {}; "
                    "measure these beads again, or remove one of each pair",
                    Text.joined(", ", model.contradictions),
                ),
            )
        )
    issues += _outside(sized, length, process.bead_width, model)
    issues.append(
        height_issue([sized_bead.bead for sized_bead in sized], layer_height, process, model)
    )
    feed = model_wire_feed(process, model)
    if abs(feed - model.wire_feed) > 0.01 * model.wire_feed:
        low, high = model.feeds or (model.wire_feed, model.wire_feed)
        measured = Text("{:.4g}", low) if low == high else Text("{:.4g} to {:.4g}", low, high)
        issues.append(
            Issue(
                WARNING,
                "WIRE_FEED",
                Text(
                    "the table was measured at a wire feed of {} mm/s, but the job uses {:.4g} "
                    "mm/s; set process.wire.feed to auto or to the measured feed, or measure a "
                    "table at the feed of the job",
                    Word(measured),
                    feed,
                ),
            )
        )
    return issues


def _outside(
    sized: Sequence[Held], length: Array, target_width: float, model: BeadModel
) -> list[Issue]:
    """The issues of beads outside the range of the table."""
    clamped = np.concatenate(
        [sized_bead.clamped[1:] for sized_bead in sized if sized_bead.clamped is not None]
    )
    tight = np.concatenate(
        [sized_bead.tight[1:] for sized_bead in sized if sized_bead.tight is not None]
    )
    low, high = (MINUTE * value for value in model.speeds)
    slow, bent = (float(length[mask].sum() / length.sum()) for mask in (clamped, tight))
    issues = []
    if slow > 0.0:
        beads = sum(
            bool(sized_bead.clamped[1:].any())
            for sized_bead in sized
            if sized_bead.clamped is not None
        )
        width = np.concatenate(
            [sized_bead.bead.width[1:] for sized_bead in sized if sized_bead.bead.width is not None]
        )[clamped]
        worst = float(width[np.abs(width - target_width).argmax()])
        narrowest, widest = np.sort(model.widths(np.array(model.speeds), np.full(2, np.inf)))
        issues.append(
            Issue(
                WARNING if slow > CLAMPED else NOTE,
                "OUTSIDE_TABLE",
                Text(
                    "on {:.3g} % of the length, in {} of {} beads and {} segments, the required "
                    "width needs a speed outside the {:.4g} to {:.4g} mm/min of the table; the "
                    "speed is clamped, and the width deviates: it is {:.3g} mm at worst instead "
                    "of {:g} mm. Straight beads of the table are {:.4g} to {:.4g} mm wide: set "
                    "process.bead_width in this range, or measure beads at other speeds",
                    100.0 * slow,
                    beads,
                    len(sized),
                    len(width),
                    low,
                    high,
                    worst,
                    target_width,
                    narrowest,
                    widest,
                ),
            )
        )
    if bent > 0.0:
        issues.append(
            Issue(
                NOTE,
                "TIGHT_BENDS",
                Text(
                    "{:.3g} % of the length bends more tightly than the beads of the table, of "
                    "{:.4g} mm radius or more, and is treated like these; widths are only "
                    "estimates there",
                    100.0 * bent,
                    model.radii[0],
                ),
            )
        )
    return issues
