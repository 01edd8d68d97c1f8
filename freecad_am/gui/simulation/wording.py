# SPDX-License-Identifier: LGPL-2.1-or-later
"""Texts of a simulation."""

from __future__ import annotations

import math
import re

import numpy as np

from ...core.number_texts import significant
from ...core.simulation import watch
from ...core.simulation.timeline import MM3_PER_CM3
from ...core.simulation.watch import Finding
from ...core.types import Array
from ...objects.fields import preferences
from ...objects.fields.preferences import in_user_units
from ..in_language import link_touches, tr, translated
from .player import Moment, Run

_HOUR = 3600.0  # s


def clock(seconds: float) -> str:
    """Format a time as minutes and seconds, with hours if any."""
    duration = max(0.0, seconds)
    minutes, remainder = divmod(duration, 60.0)
    hours, minutes = divmod(int(minutes), 60)
    return (
        f"{hours}:{minutes:02d}:{int(remainder):02d}" if hours else f"{minutes}:{remainder:04.1f}"
    )


def finding(finding: Finding, unit: str = "deg") -> str:
    """Describe a finding."""
    unit = "°" if unit == "deg" else " mm"
    if finding.kind == watch.TOUCHES:
        text = link_touches(finding.label, finding.other)
        return text[:1].upper() + text[1:]
    texts = {
        watch.UNREACHABLE: tr("Out of reach"),
        watch.LIMIT: tr("{label} is {value:.2f}{unit} past its limit"),
        watch.NEAR_LIMIT: tr("{label} comes within {value:.2f}{unit} of its limit"),
        watch.SINGULAR: tr(
            "Near a singularity: condition {value:.3f}, required at least {than:.3f}"
        ),
        watch.SLOWED: tr("{label} cannot keep the speed: {than} becomes {value}"),
        watch.ISSUE: "{label}",
    }
    value = -finding.value if finding.kind == watch.LIMIT else finding.value
    if finding.kind == watch.SLOWED:
        return texts[finding.kind].format(
            label=finding.label, value=_speed(value), than=_speed(finding.than)
        )
    label = translated(finding.label) if finding.kind == watch.ISSUE else finding.label
    return texts[finding.kind].format(label=label, value=value, than=finding.than, unit=unit)


def count_of_findings(count: int) -> str:
    """Return the number of findings as text."""
    return tr("1 finding") if count == 1 else tr("{count} findings").format(count=count)


def nothing(run: Run) -> str:
    """Return the text for no findings, with the scope of the check."""
    if run.watch.arm_known:
        return tr(
            "No findings: no limit, singularity or speed is near, and no link of the robot "
            "touches an obstacle"
        )
    return tr("No findings: no limit, singularity or speed is near")


def place(run: Run, moment: Moment) -> str:
    """Return layer, bead and point, counted from 0."""
    motion, row = run.motion, moment.row
    return _place(run, int(motion.layer[row]), int(motion.bead[row]), int(motion.point[row]))


def _place(run: Run, layer: int, bead: int, point: int) -> str:
    return tr("Layer {layer} ({first} to {last}), bead {bead}, point {point}").format(
        layer=layer,
        first=int(run.times.layers[0]),
        last=int(run.times.layers[-1]),
        bead=bead,
        point=point,
    )


def doing(run: Run, moment: Moment) -> str:
    """Describe the machine's current action."""
    out_of_reach, waits_lit, waits, deposits, rapid = _doings()
    if not np.isfinite(moment.state.joints).all():
        return out_of_reach
    if moment.state.standing and run.times.waits[moment.row] > 0.0:
        return waits_lit if moment.state.deposit else waits
    return deposits if run.motion.deposit[moment.row] else rapid


def _doings() -> tuple[str, str, str, str, str]:
    return (
        tr("out of reach"),
        tr("waits, deposit on"),
        tr("waits"),
        tr("deposits"),
        tr("rapid move"),
    )


def speed(moment: Moment) -> tuple[str, bool]:
    """Return the programmed and achieved speed, and whether the speed is kept."""
    is_kept = moment.achieved >= moment.asked * (1.0 - 1e-6)
    if not math.isfinite(moment.asked):
        return "–", True
    if is_kept:
        return _speed(moment.asked), True
    return _instead(_speed(moment.achieved), _speed(moment.asked)), False


def _instead(achieved: str, requested: str) -> str:
    return tr("{achieved} instead of {asked}").format(achieved=achieved, asked=requested)


def _speed(value: float) -> str:
    """Format a speed, mm/s, in the user's unit."""
    return _in_unit(preferences.speed(value))


def _in_unit(value: float) -> str:
    return f"{significant(value, 3)} {preferences.speed_unit()}"


def condition(moment: Moment) -> str:
    """Return the inverse condition number and its minimum."""
    if not math.isfinite(moment.condition):
        return "–"
    return _condition(moment.condition, moment.threshold)


def _condition(condition: float, threshold: float) -> str:
    return tr("{condition:.3f} (at least {threshold:.3f})").format(
        condition=condition, threshold=threshold
    )


def times(run: Run, time: float) -> str:
    """Format a time of the job, s, and its total time."""
    return f"{clock(time)} / {clock(run.times.total)}"


# ---- widths


def widest(run: Run) -> dict[str, tuple[str, ...]]:
    """Return texts as wide as the texts of a run, by field."""
    motion, feed = run.motion, run.feed
    columns = (_wide(int(column.max())) for column in (motion.layer, motion.bead, motion.point))
    requested, slower = (
        feed.asked,
        ~(feed.achieved >= feed.asked * (1.0 - 1e-6)) & np.isfinite(feed.asked),
    )
    speeds = [_widest_speed(requested)]
    if slower.any():
        speeds.append(
            _instead(_widest_speed(feed.achieved[slower]), _widest_speed(requested[slower]))
        )
    shorter = min(run.times.total, _HOUR - 1.0)  # below an hour, times have tenths of a second
    return {
        "clock": tuple(re.sub(r"\d", "8", times(run, time)) for time in (run.times.total, shorter)),
        "place": (_place(run, *columns),),
        "doing": _doings(),
        "speed": tuple(speeds),
        "condition": (_condition(0.888, 0.888),),
    }


def _wide(number: int) -> int:
    """Return a number with the same count of digits, all wide."""
    return int("8" * len(str(number)))


def _widest_speed(speeds: Array) -> str:
    """Return a text as wide as any of these speeds (n,), mm/s."""
    values = preferences.speed(1.0) * speeds[np.isfinite(speeds) & (speeds > 0.0)]
    if not len(values):
        return "–"
    powers = np.floor(np.log10([values.min(), values.max()]))
    return max((_in_unit(8.88 * 10.0**power) for power in powers), key=len)


def totals(run: Run) -> list[tuple[str, str]]:
    """Return the totals, each with name and value."""
    sums = run.totals
    rows = [
        (tr("Time"), clock(sums.time)),
        (tr("Depositing"), clock(sums.deposit_time)),
        (tr("Rapid moves"), clock(sums.rapid_time)),
        (tr("Waits"), clock(sums.wait_time)),
        (
            tr("Deposit"),
            in_user_units(tr("{metres:.3f} m").format(metres=sums.length / 1000.0)),
        ),
        (
            tr("Volume"),
            in_user_units(tr("{volume:.2f} cm³").format(volume=sums.volume / MM3_PER_CM3)),
        ),
        (tr("Mass"), in_user_units(tr("{mass:.1f} g").format(mass=sums.mass))),
    ]
    if run.feed.lost > 0.05:
        rows.insert(
            1,
            (
                tr("Longer by"),
                tr("{time} at reduced speed").format(time=clock(run.feed.lost)),
            ),
        )
    return rows
