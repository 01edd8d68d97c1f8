# SPDX-License-Identifier: LGPL-2.1-or-later
"""What of a part its beads do not deposit, and what of them lies beside it: figures and findings, before there is a bead."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass, replace
from typing import Any

from ...geometry.on_hub import SolidsOnHub
from ...geometry.walls.part_depths import PartDepths
from ...issues import NOTE, WARNING, Issue, Text, Word
from ...toolpath import Toolpath

LEFT_OUT, OUTSIDE, TWICE = "NOT_DEPOSITED", "DEPOSITED_BESIDE", "DEPOSITED_TWICE"
CODES = (LEFT_OUT, OUTSIDE, TWICE)
MUCH = 0.1  # of a part that is filled, laid over beads of the same layer
SINGLE_BEAD_WIDTHS = 1.25  # bead widths; a wall about as thick as a bead is deposited by one
UNFILLED = 0.03  # of a part that is filled
NEGLIGIBLE = 0.02  # of a part
SMALL_SHARE = 0.01  # of the area of the faces that beads do not run on
MAX_NAMED = 8  # faces and solids named in a message
MM3 = 1000.0  # in a cm3


@dataclass(frozen=True)
class Balance:
    """Volumes in mm3, estimates but for solids; None where the part has none. faces: those left out; solids: those left out,
    with mm3. width: of a bead, mm, 0 of solids, which are filled. thick: mm, of the part there.
    filled: beads fill the part. twice: of beads laid over others of their layer. hub: of what is left out and of the part,
    the hub that is there before. lines: the part is curves, which have no volume to leave out."""

    label: str
    part: float | None
    left_out: float | None
    beads: float | None = None
    outside: float | None = None
    faces: tuple[str, ...] = ()
    solids: tuple[tuple[str, float], ...] = ()
    width: float = 0.0
    thick: float = 0.0
    filled: bool = False
    twice: float | None = None
    hub: float = 0.0
    lines: bool = False


def of_feature(value: Any, width: float) -> Balance | None:
    """Of what a feature has found, its wall or its solids, with beads of a width, mm; None where nothing is known."""
    if isinstance(value, SolidsOnHub):
        return _of_solids(value)
    return None if value.depths is None else of_wall(value.depths, width)


def of_toolpath(value: Any, toolpath: Toolpath, width: float) -> Balance | None:
    """The same once there are beads, which know better what they cover where they fill a part."""
    if toolpath.volumes is None:
        return _of_beads(value, toolpath, width)
    part, left, outside = toolpath.volumes
    own = value.own if isinstance(value, SolidsOnHub) else None
    hub = own.hub if own else 0.0
    if own:  # what else of the part is within the surface that solids stand on
        left += max(own.volume - hub - part, 0.0)
        part = max(own.volume - hub, part)
    return Balance(
        value.label,
        part + hub,
        left + hub,
        part - left + outside,
        outside,
        solids=own.apart if own else (),
        width=toolpath.bead_width or 0.0,
        filled=True,
        twice=toolpath.twice,
        hub=hub,
    )


def _of_beads(value: Any, toolpath: Toolpath, width: float) -> Balance | None:
    """Of beads that fill nothing, which know what of them is laid twice; of curves they are all that is known."""
    known = of_feature(value, width)
    if toolpath.twice is None:
        return known
    length = math.fsum(bead.length for _, _, bead in toolpath)
    beads = length * (toolpath.bead_width or width) * toolpath.layer_height
    if known is None:
        return Balance(
            value.label, None, None, beads, width=width, twice=toolpath.twice, lines=True
        )
    return replace(known, beads=beads if known.beads is None else known.beads, twice=toolpath.twice)


def together(balances: Sequence[Balance | None]) -> Balance | None:
    """What the balances of several features come to; the one there is of a single feature. None where nothing is known."""
    known = [one for one in balances if one is not None]
    if len(balances) == 1 or not known:
        return balances[0] if balances else None

    def total(name: str) -> float | None:
        values = [value for one in known if (value := getattr(one, name)) is not None]
        return sum(values) if values else None

    return Balance(
        ", ".join(one.label for one in known),
        total("part"),
        total("left_out"),
        total("beads"),
        total("outside"),
        tuple(f"{one.label} {face}" for one in known for face in one.faces),
        tuple(solid for one in known for solid in one.solids),
        width=known[0].width,
        thick=known[0].thick,
        filled=all(one.filled for one in known),
        twice=total("twice"),
        hub=total("hub") or 0.0,
        lines=all(one.lines for one in known),
    )


def of_wall(depths: PartDepths, width: float) -> Balance:
    """Of a wall of one bead of a width, mm."""
    total = sum(depths.face_areas)
    faces = tuple(
        name
        for name, deep, area in zip(
            depths.faces, depths.face_depths, depths.face_areas, strict=True
        )
        if deep > SINGLE_BEAD_WIDTHS * width and area > SMALL_SHARE * total
    )
    if not depths.volume:
        return Balance(depths.label, None, None, faces=faces, solids=depths.aside, width=width)
    outside, beads = depths.outside(width), depths.area * width
    thick = float(depths.thickness[len(depths.thickness) // 2]) if len(depths.thickness) else 0.0
    left = depths.volume - depths.volume_within(width)
    rest = depths.volume - depths.volume_within(SINGLE_BEAD_WIDTHS * width)
    if not faces and not depths.aside and rest < NEGLIGIBLE * depths.volume:
        left = 0.0
    if outside < (SINGLE_BEAD_WIDTHS - 1.0) / SINGLE_BEAD_WIDTHS * beads:
        outside = 0.0
    return Balance(
        depths.label, depths.volume, left, beads, outside, faces, depths.aside, width, thick
    )


def _of_solids(solids: SolidsOnHub) -> Balance | None:
    """Of solids that are filled: all but the hub."""
    if solids.own is None:
        return None
    own = solids.own
    return Balance(solids.label, own.volume, own.hub, solids=own.apart)


def issues(balance: Balance | None) -> tuple[Issue, ...]:
    """What is to be told, at most one finding of each kind."""
    if balance is None:
        return ()
    if balance.filled:
        return _of_filling(balance)
    found = []
    left = balance.left_out or 0.0
    share = left > NEGLIGIBLE * (balance.part or 0.0) and left > 0.0
    if balance.solids or balance.faces or share:
        why = (
            Text("a wall of one bead, {:.4g} mm wide, is planned", balance.width)
            if balance.width
            else ("solids are built up on the hub, which is there before")
        )
        found.append(Issue(WARNING, LEFT_OUT, Text("{}: {}", _left_out(balance, share), Word(why))))
    if balance.outside:
        assert balance.beads is not None
        found.append(
            Issue(
                WARNING,
                OUTSIDE,
                Text(
                    "about {:.3g} of {:.3g} cm3 of beads lie outside {}, which is {:.2g} mm thick there, and "
                    "beads are {:.4g} mm wide; give process.bead_width, or machine it off",
                    balance.outside / MM3,
                    balance.beads / MM3,
                    balance.label,
                    balance.thick,
                    balance.width,
                ),
            )
        )
    twice, beads = balance.twice or 0.0, balance.beads or 0.0
    if twice > UNFILLED * beads:
        found.append(
            Issue(
                _much(twice, beads),
                TWICE,
                Text(
                    "about {:.3g} cm3 of beads are laid over others of their layer, {:.2g} % of "
                    "those of {}: they come nearer to each other than they are wide, or cross; layers get higher there. Use "
                    "narrower beads, or leave out what is there twice",
                    twice / MM3,
                    100.0 * twice / beads,
                    balance.label,
                ),
            )
        )
    return tuple(found)


def _much(twice: float, whole: float) -> str:
    return WARNING if twice > MUCH * whole else NOTE


def _of_filling(of: Balance) -> tuple[Issue, ...]:
    found: list[Issue] = []
    part = (of.part or 0.0) - of.hub
    if of.hub > NEGLIGIBLE * (of.part or 0.0):
        found += issues(
            replace(of, left_out=of.hub, outside=None, twice=None, width=0.0, filled=False)
        )
    of = replace(of, part=part, left_out=(of.left_out or 0.0) - of.hub)
    if (of.left_out or 0.0) > UNFILLED * part:
        found.append(
            Issue(
                WARNING,
                LEFT_OUT,
                Text(
                    "{}: beads of {:.4g} mm do not reach into what is narrower, layers not above the last "
                    "cut, and nothing is laid within a hub; use narrower beads, or lower layers",
                    _left_out(of, True),
                    of.width,
                ),
            )
        )
    if (of.outside or 0.0) > UNFILLED * part:
        found.append(
            Issue(
                WARNING,
                OUTSIDE,
                Text(
                    "about {:.3g} cm3 of beads lie outside the {:.3g} cm3 of {}: beads of {:.4g} mm stand "
                    "out where it is narrower; use narrower beads, or machine it off",
                    (of.outside or 0.0) / MM3,
                    part / MM3,
                    of.label,
                    of.width,
                ),
            )
        )
    twice = of.twice or 0.0
    if twice > UNFILLED * part:
        found.append(
            Issue(
                _much(twice, part),
                TWICE,
                Text(
                    "about {:.3g} cm3 of beads are laid over others of their layer, {:.2g} % of {}: "
                    "where lines and their links meet contours, and where room is left for less than a bead; layers get higher "
                    "there. Use fill: contours, narrower beads, or a wider strategy.gap",
                    twice / MM3,
                    100.0 * twice / part,
                    of.label,
                ),
            )
        )
    return tuple(found)


def as_dict(balance: Balance | None) -> dict[str, Any] | None:
    """The key `deposit` of report.json: volumes in cm3, None where the part has none."""
    if balance is None:
        return None
    left = (
        None
        if balance.part is None or balance.left_out is None
        else balance.part - balance.left_out
    )
    volumes = {
        "part_cm3": balance.part,
        "deposited_cm3": left,
        "left_out_cm3": balance.left_out,
        "beside_cm3": balance.outside,
        "twice_cm3": balance.twice,
    }
    return {
        **{key: None if volume is None else volume / MM3 for key, volume in volumes.items()},
        "faces_left_out": list(balance.faces),
        "solids_left_out": [name for name, _ in balance.solids],
        "estimate": balance.width > 0.0,
    }


def _left_out(of: Balance, share: bool) -> str:
    """What is not deposited, as the beginning of a sentence."""
    left, part = (of.left_out or 0.0) / MM3, (of.part or 0.0) / MM3
    if of.filled:
        return Text("about {:.3g} of the {:.3g} cm3 of {} are not deposited", left, part, of.label)
    if not of.width and not of.solids:
        return Text(
            "about {:.3g} of the {:.3g} cm3 of {}, all that lies within its hub, are not deposited",
            left,
            part,
            of.label,
        )
    if not of.width:
        return Text(
            "{}, {:.4g} of {:.4g} cm3 of {}, are not deposited",
            _names([name for name, _ in of.solids]),
            left,
            part,
            of.label,
        )
    if of.solids:
        what = Text("{} solid(s) ({})", len(of.solids), _names([name for name, _ in of.solids]))
    else:
        what = Text("{} face(s) ({})", len(of.faces), _names(of.faces))
    if not share:
        return Text("{} of {} are not deposited", Word(what), of.label)
    if of.solids or of.faces:
        return Text(
            "{}, about {:.3g} cm3 of the {:.3g} cm3 of {}, are not deposited",
            Word(what),
            left,
            part,
            of.label,
        )
    return Text("about {:.3g} cm3 of the {:.3g} cm3 of {} are not deposited", left, part, of.label)


def _names(names: Sequence[str]) -> str:
    return ", ".join(names[:MAX_NAMED]) + (", ..." if len(names) > MAX_NAMED else "")
