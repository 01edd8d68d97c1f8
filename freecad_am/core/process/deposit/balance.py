# SPDX-License-Identifier: LGPL-2.1-or-later
"""Volume balance of a part and its beads, estimated before planning: missed and stray volume, and issues."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass, replace
from typing import Any

from ...geometry.walls.part_depths import PartDepths
from ...issues import NOTE, WARNING, Issue, Text, Word
from ...toolpath import Toolpath

LEFT_OUT, OUTSIDE, TWICE = "NOT_DEPOSITED", "DEPOSITED_BESIDE", "DEPOSITED_TWICE"
CODES = (LEFT_OUT, OUTSIDE, TWICE)
TWICE_WARNING_SHARE = 0.1  # fraction of a filled part; maximum over-deposition without a warning
SINGLE_BEAD_WIDTHS = 1.25  # bead widths; maximum thickness of a wall that one bead deposits
UNFILLED = 0.03  # fraction of a filled part; volume error above this is reported
NEGLIGIBLE = 0.02  # fraction of a part; missed volume below this counts as 0
SMALL_SHARE = 0.01  # fraction of the area of all faces; smaller omitted faces are ignored
MAX_NAMED = 8  # maximum number of faces and solids named in a message
MM3 = 1000.0  # mm3 per cm3


@dataclass(frozen=True)
class Balance:
    """Volumes of a part and its beads, mm3, None if the part has no volume; estimates except for solids.

    faces: names of omitted faces. solids: names and volumes, mm3, of omitted solids. width: bead width, mm, 0 for filled
    solids. thick: thickness of the part, mm. filled: whether beads fill the part. twice: over-deposition within layers.
    hub: volume of the existing hub, included in left_out and part_volume. lines: whether the part consists of curves,
    which have no volume.
    """

    label: str
    part_volume: float | None
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


def feature_balance(value: Any, width: float) -> Balance | None:
    """Return the balance of a feature's wall or solids with beads of a width, mm; None if unknown."""
    if value.own is not None:  # everything except the hub is deposited
        return Balance(value.label, value.own.volume, value.own.hub, solids=value.own.apart)
    return None if value.depths is None else wall_balance(value.depths, width)


def toolpath_balance(value: Any, toolpath: Toolpath, width: float) -> Balance | None:
    """Return the balance of a planned toolpath.

    For filled parts the beads give the covered volume exactly.

    Parameters
    ----------
    value : Any
        The feature's wall, solids or curves.
    toolpath : Toolpath
        Toolpath of the feature.
    width : float
        Width of beads without a predicted width, mm.

    Returns
    -------
    Balance or None
        The balance; None if unknown.
    """
    if toolpath.checks.volumes is None:
        return _beads_balance(value, toolpath, width)
    part_volume, left_out, outside = toolpath.checks.volumes
    own_hub = value.own
    hub = own_hub.hub if own_hub else 0.0
    if own_hub:  # remainder of the part inside the surface below the solids
        left_out += max(own_hub.volume - hub - part_volume, 0.0)
        part_volume = max(own_hub.volume - hub, part_volume)
    return Balance(
        value.label,
        part_volume + hub,
        left_out + hub,
        part_volume - left_out + outside,
        outside,
        solids=own_hub.apart if own_hub else (),
        width=toolpath.bead_width or 0.0,
        filled=True,
        twice=toolpath.checks.twice,
        hub=hub,
    )


def _beads_balance(value: Any, toolpath: Toolpath, width: float) -> Balance | None:
    """Return the balance of beads without filling, with the over-deposition, the only value for curves."""
    balance = feature_balance(value, width)
    if toolpath.checks.twice is None:
        return balance
    length = math.fsum(bead.length for _, _, bead in toolpath)
    beads = length * (toolpath.bead_width or width) * toolpath.layer_height
    if balance is None:
        return Balance(
            value.label, None, None, beads, width=width, twice=toolpath.checks.twice, lines=True
        )
    return replace(
        balance,
        beads=beads if balance.beads is None else balance.beads,
        twice=toolpath.checks.twice,
    )


def sum_balances(balances: Sequence[Balance | None]) -> Balance | None:
    """Return the sum of the balances of several features; None if unknown."""
    known_balances = [balance for balance in balances if balance is not None]
    if len(balances) == 1 or not known_balances:
        return balances[0] if balances else None

    def total(name: str) -> float | None:
        values = [
            value for balance in known_balances if (value := getattr(balance, name)) is not None
        ]
        return sum(values) if values else None

    return Balance(
        ", ".join(balance.label for balance in known_balances),
        total("part_volume"),
        total("left_out"),
        total("beads"),
        total("outside"),
        tuple(f"{balance.label} {face}" for balance in known_balances for face in balance.faces),
        tuple(solid for balance in known_balances for solid in balance.solids),
        width=known_balances[0].width,
        thick=known_balances[0].thick,
        filled=all(balance.filled for balance in known_balances),
        twice=total("twice"),
        hub=total("hub") or 0.0,
        lines=all(balance.lines for balance in known_balances),
    )


def wall_balance(depths: PartDepths, width: float) -> Balance:
    """Return the balance of a single-bead wall with beads of a width, mm."""
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
    left_out = depths.volume - depths.volume_within(width)
    unfilled = depths.volume - depths.volume_within(SINGLE_BEAD_WIDTHS * width)
    if not faces and not depths.aside and unfilled < NEGLIGIBLE * depths.volume:
        left_out = 0.0
    if outside < (SINGLE_BEAD_WIDTHS - 1.0) / SINGLE_BEAD_WIDTHS * beads:
        outside = 0.0
    return Balance(
        depths.label, depths.volume, left_out, beads, outside, faces, depths.aside, width, thick
    )


def issues(balance: Balance | None) -> tuple[Issue, ...]:
    """Return the issues of a balance, at most one of each kind.

    Parameters
    ----------
    balance : Balance or None
        The balance; None if unknown.

    Returns
    -------
    tuple of Issue
        Issues of missed volume, stray volume and over-deposition.
    """
    if balance is None:
        return ()
    if balance.filled:
        return _filling_issues(balance)
    issues_ = []
    left_out = balance.left_out or 0.0
    share = left_out > NEGLIGIBLE * (balance.part_volume or 0.0) and left_out > 0.0
    if balance.solids or balance.faces or share:
        why = (
            Text("the wall is planned as one bead, {:.4g} mm wide", balance.width)
            if balance.width
            else ("solids are built on the hub, which must exist already")
        )
        issues_.append(
            Issue(WARNING, LEFT_OUT, Text("{}: {}", _left_out(balance, share), Word(why)))
        )
    if balance.outside:
        assert balance.beads is not None
        issues_.append(
            Issue(
                WARNING,
                OUTSIDE,
                Text(
                    "about {:.3g} of {:.3g} cm3 of beads are outside {}, which is {:.2g} mm "
                    "thick, while beads are {:.4g} mm wide; set process.bead_width, or machine "
                    "off the excess",
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
        issues_.append(
            Issue(
                _much(twice, beads),
                TWICE,
                Text(
                    "over-deposition of about {:.3g} cm3, {:.2g} % of the beads of {}: beads "
                    "cross, or are closer to each other than their width, and layers get higher "
                    "there; use narrower beads, or remove duplicates",
                    twice / MM3,
                    100.0 * twice / beads,
                    balance.label,
                ),
            )
        )
    return tuple(issues_)


def _much(twice: float, total: float) -> str:
    return WARNING if twice > TWICE_WARNING_SHARE * total else NOTE


def _filling_issues(balance: Balance) -> tuple[Issue, ...]:
    filling_issues: list[Issue] = []
    part_volume = (balance.part_volume or 0.0) - balance.hub
    if balance.hub > NEGLIGIBLE * (balance.part_volume or 0.0):
        filling_issues += issues(
            replace(
                balance, left_out=balance.hub, outside=None, twice=None, width=0.0, filled=False
            )
        )
    balance = replace(
        balance, part_volume=part_volume, left_out=(balance.left_out or 0.0) - balance.hub
    )
    if (balance.left_out or 0.0) > UNFILLED * part_volume:
        filling_issues.append(
            Issue(
                WARNING,
                LEFT_OUT,
                Text(
                    "{}: beads of {:.4g} mm do not fit into narrower regions, layers end at the "
                    "last cut, and the inside of a hub is not filled; use narrower beads, or "
                    "lower layers",
                    _left_out(balance, True),
                    balance.width,
                ),
            )
        )
    if (balance.outside or 0.0) > UNFILLED * part_volume:
        filling_issues.append(
            Issue(
                WARNING,
                OUTSIDE,
                Text(
                    "about {:.3g} cm3 of beads are outside the {:.3g} cm3 of {}: beads of {:.4g} "
                    "mm exceed narrow regions; use narrower beads, or machine off the excess",
                    (balance.outside or 0.0) / MM3,
                    part_volume / MM3,
                    balance.label,
                    balance.width,
                ),
            )
        )
    twice = balance.twice or 0.0
    if twice > UNFILLED * part_volume:
        filling_issues.append(
            Issue(
                _much(twice, part_volume),
                TWICE,
                Text(
                    "over-deposition of about {:.3g} cm3, {:.2g} % of {}: beads overlap where "
                    "lines and links meet contours, and in spaces narrower than a bead, and "
                    "layers get higher there; use fill: contours, narrower beads, or a wider "
                    "strategy.gap",
                    twice / MM3,
                    100.0 * twice / part_volume,
                    balance.label,
                ),
            )
        )
    return tuple(filling_issues)


def as_dict(balance: Balance | None) -> dict[str, Any] | None:
    """Return the value of the key `deposit` in report.json: volumes in cm3, None for a part without volume."""
    if balance is None:
        return None
    deposited = (
        None
        if balance.part_volume is None or balance.left_out is None
        else balance.part_volume - balance.left_out
    )
    volumes = {
        "part_cm3": balance.part_volume,
        "deposited_cm3": deposited,
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


def _left_out(balance: Balance, share: bool) -> str:
    """Format the missed volume as the beginning of a sentence."""
    left_cm3, part_cm3 = (balance.left_out or 0.0) / MM3, (balance.part_volume or 0.0) / MM3
    if balance.filled:
        return Text(
            "about {:.3g} of the {:.3g} cm3 of {} are not deposited",
            left_cm3,
            part_cm3,
            balance.label,
        )
    if not balance.width and not balance.solids:
        return Text(
            "about {:.3g} of the {:.3g} cm3 of {}, the volume inside its hub, are not deposited",
            left_cm3,
            part_cm3,
            balance.label,
        )
    if not balance.width:
        return Text(
            "{}, {:.4g} of {:.4g} cm3 of {}, are not deposited",
            _names([name for name, _ in balance.solids]),
            left_cm3,
            part_cm3,
            balance.label,
        )
    if balance.solids:
        what = Text(
            "{} solid(s) ({})", len(balance.solids), _names([name for name, _ in balance.solids])
        )
    else:
        what = Text("{} face(s) ({})", len(balance.faces), _names(balance.faces))
    if not share:
        return Text("{} of {} are not deposited", Word(what), balance.label)
    if balance.solids or balance.faces:
        return Text(
            "{}, about {:.3g} cm3 of the {:.3g} cm3 of {}, are not deposited",
            Word(what),
            left_cm3,
            part_cm3,
            balance.label,
        )
    return Text(
        "about {:.3g} cm3 of the {:.3g} cm3 of {} are not deposited",
        left_cm3,
        part_cm3,
        balance.label,
    )


def _names(names: Sequence[str]) -> str:
    return ", ".join(names[:MAX_NAMED]) + (", ..." if len(names) > MAX_NAMED else "")
