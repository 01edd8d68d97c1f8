# SPDX-License-Identifier: LGPL-2.1-or-later
"""What is said about the beads on a hub: speeds, widths, heights against the layer height, waits, what was mended."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from ...issues import NOTE, WARNING, Issue
from ...parameters.filled import FilledParameters
from ...parameters.process import ProcessParameters
from ...process.bead_model import MINUTE, BeadModel
from ...process.predicted import heights_told
from ...process.wire import with_model
from ...toolpath import Array, Layer
from .beads import Rolled

CLAMPED = 0.05  # of the length


def notes(
    made: Sequence[Rolled], layers: Sequence[Layer], mended: Sequence[Issue], strategy: FilledParameters,
    process: ProcessParameters, model: BeadModel | None,
) -> list[Issue]:
    """All of them."""
    found = _mended(mended)
    if model is not None:
        found += _of_model(made, strategy, process, model)
    found += _single_layers(layers, strategy)
    waits = [layer.wait for layer in layers if layer.wait > 0.0]
    if waits and strategy.min_layer_time > 0.0:
        found.append(Issue(
            NOTE, "WAITS", f"the machine waits before {len(waits)} of {len(layers)} layers, up to {max(waits):.4g} s and "
            f"{sum(waits):.5g} s in all, so that no layer takes less than {strategy.min_layer_time:g} s and no solid is "
            f"returned to sooner than after {strategy.wait:g} s",
        ))
    elif waits:
        found.append(Issue(
            NOTE, "WAITS", f"the machine waits before {len(waits)} of {len(layers)} layers, up to {max(waits):.4g} s and "
            f"{sum(waits):.5g} s in all, so that no solid is returned to sooner than after {strategy.wait:g} s",
        ))
    return found


def _single_layers(layers: Sequence[Layer], strategy: FilledParameters) -> list[Issue]:
    """Solids, or groups of them laid in turn, that get one layer alone."""
    starts = [*(index for index, layer in enumerate(layers) if layer.first), len(layers)]
    single = [start for start, end in zip(starts, starts[1:]) if end - start == 1]
    if not single:
        return []
    return [Issue(
        NOTE, "SINGLE_LAYER",
        f"{len(single)} of {len(starts) - 1} solids or groups of solids get one layer alone, on the hub: "
        f"they are no higher than strategy.layer_height, {strategy.layer_height:g} mm", single[0],
    )]


def _mended(issues: Sequence[Issue]) -> list[Issue]:
    """One of each kind, with how many layers of solids there are like it."""
    found = []
    for code in sorted({issue.code for issue in issues}):
        alike = [issue for issue in issues if issue.code == code]
        more = f" (and {len(alike) - 1} layers of solids more)" if len(alike) > 1 else ""
        found.append(Issue(alike[0].level, code, alike[0].message + more, alike[0].layer))
    return found


def _of_model(
    made: Sequence[Rolled], strategy: FilledParameters, process: ProcessParameters, model: BeadModel
) -> list[Issue]:
    length = np.concatenate([np.linalg.norm(np.diff(one.bead.points, axis=0), axis=1) for one in made])
    speed = np.concatenate([one.bead.speed[1:] for one in made]) * MINUTE
    fit = model.width
    found = [Issue(
        NOTE, "BEAD_MODEL", f"w = {fit.m:.4g} v^(-1/3) + {fit.p:.4g} / r + {fit.t:.4g} with R2 = {fit.r_squared:.4f} "
        f"and RMSE = {fit.rmse:.3g} mm; a width of {process.bead_width:g} mm takes travel speeds of {speed.min():.4g} to "
        f"{speed.max():.4g} mm/min",
    )]
    found += _outside(made, length, process.bead_width, model)
    found.append(heights_told([one.bead for one in made], strategy.layer_height, process, model))
    feed = with_model(process, model)
    if abs(feed - model.wire_feed) > 0.01 * model.wire_feed:
        found.append(Issue(
            WARNING, "WIRE_FEED", f"the table was measured at a wire feed of {model.wire_feed:.4g} mm/s, the job has "
            f"{feed:.4g} mm/s; set process.wire.feed to auto or to that, or measure a table at it",
        ))
    return found


def _outside(made: Sequence[Rolled], length: Array, wanted: float, model: BeadModel) -> list[Issue]:
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
        found.append(Issue(
            WARNING if slow > CLAMPED else NOTE, "OUTSIDE_TABLE", f"on {100.0 * slow:.3g} % of the length, in {beads} of "
            f"{len(made)} beads and {len(width)} segments, the width asked for takes a speed outside of the table's "
            f"{low:.4g} to {high:.4g} mm/min; it is kept within, and the width is not held: it is {worst:.3g} mm at its "
            f"farthest from the {wanted:g} mm",
        ))
    if bent > 0.0:
        found.append(Issue(
            NOTE, "TIGHT_BENDS", f"{100.0 * bent:.3g} % of the length bends more than the table's beads, of "
            f"{model.radii[0]:.4g} mm or more, and counts as bent like these; widths are only estimated there",
        ))
    return found
