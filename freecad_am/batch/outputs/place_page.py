# SPDX-License-Identifier: LGPL-2.1-or-later
"""place.html: poses as maps, height by height, and the best ones as a table; one file without scripts or links."""

from __future__ import annotations

from html import escape

import numpy as np

from freecad_am.core.placement.moved import outer
from freecad_am.core.placement.place import Placed, ranked
from freecad_am.core.types import Array
from freecad_am.report.style import STYLE
from freecad_am.report.svg import Plot

_BEST = 20  # poses in the table
_MOST_MAPS = 60
_COLOURS = ("#2b5fb3", "#2f9e8f", "#8bc34a", "#f3d13b")  # of margins from the least to the largest
_BEYOND = "#b9bec8"


def render(name: str, found: Placed) -> str:
    """The page of the poses of a job."""
    title = f"{escape(name)}: where it can stand"
    serve = sum(one.feasible for one in found.judged)
    what = found.moves.replace("-", " ")
    text = (
        f"{serve} of {len(found.poses)} poses of the {what} are feasible, as far as {found.points} of {found.of} points "
        "show. Each square is the best of its rotations; its colour is the least share of a joint's "
        "range that is left to a limit, grey where the pose is not feasible; the number is the share of points served."
    )
    parts = [f'<header><h1>{title}</h1></header><p class="sub">{text}</p>', _table(found)]
    heights = np.unique(found.poses[:, 2])[:_MOST_MAPS]
    low, high = _range(found)
    parts.append(
        f'<p class="sub">margin from {100.0 * low:.3g} % {_key()} to {100.0 * high:.3g} %</p>'
    )
    parts.append('<div class="grid">')
    parts += [f"<figure>{_map(found, height, low, high)}</figure>" for height in heights]
    return (
        f'<!doctype html><html lang="en"><head><meta charset="utf-8"><title>{title}</title>'
        f'<meta name="viewport" content="width=device-width,initial-scale=1"><style>{STYLE}</style></head>'
        f"<body><main>{''.join(parts)}</div></main></body></html>\n"
    )


def _table(found: Placed) -> str:
    heads = (
        "x, mm",
        "y, mm",
        "z, mm",
        "RX, deg",
        "RY, deg",
        "RZ, deg",
        "margin, %",
        "time, s",
        "clearance, mm",
        "planned with",
    )
    rows = ["<tr>" + "".join(f"<th>{head}</th>" for head in heads) + "</tr>"]
    proven = list(found.proven)
    first = [found.best] if found.best is not None else []
    for number in dict.fromkeys([*first, *proven, *ranked(found, "margin")[:_BEST]]):
        one = found.of_pose(number)
        figures = [f"{value:.6g}" for value in outer(found.pose(number))]
        figures += [
            _shown(100.0 * one.margin, ".3g"),
            _shown(one.time, ".0f"),
            _shown(one.clearance, ".3g"),
        ]
        how = "all points" if number in found.proven else f"{found.points} points"
        cells = [*figures, how if one.feasible else f"{how}: {one.code}"]
        rows.append("<tr>" + "".join(f"<td>{escape(cell)}</td>" for cell in cells) + "</tr>")
    return f'<div class="table"><table>{"".join(rows)}</table></div>'


def _shown(value: float, form: str) -> str:
    return format(value, form) if np.isfinite(value) else "–"


def _range(found: Placed) -> tuple[float, float]:
    margins = [one.margin for one in found.judged if one.feasible]
    return (min(margins), max(margins)) if margins else (0.0, 1.0)


def _map(found: Placed, height: float, low: float, high: float) -> str:
    """The poses of one height, seen from above."""
    here = np.flatnonzero(found.poses[:, 2] == height)
    x, y = found.poses[here, 0], found.poses[here, 1]
    across, up = (_step(values) for values in (x, y))
    plot = Plot(
        f"z = {height:g} mm",
        (x.min() - across, x.max() + across),
        (y.min() - up, y.max() + up),
        "x, mm",
        "y, mm",
        height=330,
    )
    shown: dict[tuple[float, float], int] = {}
    for number in sorted(here.tolist(), key=lambda k: _worth(found, k)):
        shown[float(found.poses[number, 0]), float(found.poses[number, 1])] = (
            number  # the best of them stays
        )
    for (place_x, place_y), number in shown.items():
        one = found.of_pose(number)
        left, right = plot.to_x(np.array([place_x - 0.48 * across, place_x + 0.48 * across]))
        top, bottom = plot.to_y(np.array([place_y + 0.48 * up, place_y - 0.48 * up]))
        share = (one.margin - low) / (high - low) if high > low else 1.0
        fill = _COLOURS[min(int(4.0 * max(share, 0.0)), 3)] if one.feasible else _BEYOND
        edge = ' stroke="#c0182b" stroke-width="3"' if number == found.best else ""
        plot.parts.append(
            f'<rect x="{left:.1f}" y="{top:.1f}" width="{right - left:.1f}" height="{bottom - top:.1f}" '
            f'fill="{fill}"{edge}><title>{escape(_pose_text(found, number))}</title></rect>'
            f'<text class="tick" x="{0.5 * (left + right):.1f}" y="{0.5 * (top + bottom) + 4.0:.1f}" '
            f'text-anchor="middle">{100.0 * one.share:.0f} %</text>'
        )
    return plot.text()


def _worth(found: Placed, number: int) -> tuple[float, float, float]:
    one = found.of_pose(number)
    return (float(one.feasible), one.share, float(np.nan_to_num(one.margin, nan=-1.0)))


def _pose_text(found: Placed, number: int) -> str:
    one = found.of_pose(number)
    place = [float(f"{value:.6g}") for value in outer(found.pose(number))]
    return (
        f"{place}: {one.code or 'feasible'}; margin {_shown(100.0 * one.margin, '.3g')} %, {_shown(one.time, '.0f')} s, "
        f"arm {_shown(one.clearance, '.3g')} mm"
    )


def _step(values: Array) -> float:
    apart = np.diff(np.unique(values))
    return float(apart.min()) if len(apart) else 1.0


def _key() -> str:
    return "".join(f'<span style="color:{colour}">&#9632;</span>' for colour in _COLOURS)
