# SPDX-License-Identifier: LGPL-2.1-or-later
"""Joints as pendants show them, and what is wrong with a machine that does not give them.

A pendant shows joint values, which may differ from serial ones by signs, zeros and a coupling of axes 2 and 3.
"""

from __future__ import annotations

import itertools
import math
from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np

from ...geometry import frames
from ...types import Array
from ..chain import Chain

NONE, HORIZONTAL = "none", "horizontal"  # what axis 3 is shown against: link 2, or the base
TOLERANCE_MM, TOLERANCE_DEG = (
    0.5,
    0.1,
)  # joints that are shown to 0.01 deg leave so much at the end of a long arm
_QUARTERS = (90.0, -90.0, 180.0)


@dataclass(frozen=True)
class Shown:
    """How a controller shows joint values: +1 or -1 per axis, what it shows at serial zero (deg, or mm), and what axis 3 is
    shown against."""

    signs: tuple[int, ...]
    zeros: tuple[float, ...]
    coupling: str = NONE


@dataclass(frozen=True)
class Deviation:
    """How far a pose is from the machine's: mm, deg."""

    position: float
    angle: float


@dataclass(frozen=True, eq=False)
class Suspect:
    """A change that makes the machine give the poses. axes: those it is about, counted from 0. shown: how the controller
    would show the joints, None where the fault is elsewhere. pose: (4, 4) what the base frame is moved by in base_link, or,
    where `kind` is FLANGE, what follows the flange; None where both are right. left: the largest deviation that remains."""

    kind: str
    axes: tuple[int, ...]
    shown: Shown | None
    pose: Array | None
    left: Deviation


SIGN, ZERO, SIGN_AND_ZERO, COUPLED, BASE, FLANGE = (
    "sign",
    "zero",
    "sign and zero",
    "coupling",
    "base",
    "flange",
)


def matrix(shown: Shown, chain: Chain) -> tuple[Array, Array]:
    """What a machine file tells of it: the matrix (axes, axes) and the offset (axes,), deg or mm, of matrix q + offset."""
    mixed = np.eye(chain.axes)
    if shown.coupling == HORIZONTAL:
        mixed[2, 1] = _sense(chain)
    return np.array(shown.signs, float)[:, None] * mixed + 0.0, np.array(shown.zeros, float)


def serial(shown: Shown, chain: Chain, values: Array) -> Array:
    """The serial joint values (n, axes), rad and mm, of what the controller shows (n, axes), deg and mm."""
    result: Array = _serial([shown], chain, values)[0]
    return result


def _serial(ways: Sequence[Shown], chain: Chain, values: Array) -> Array:
    """The serial values (ways, n, axes) of what is shown (n, axes)."""
    signs, zeros = (
        np.array([way.signs for way in ways], float),
        np.array([way.zeros for way in ways]),
    )
    plain = (np.asarray(values, float) - zeros[:, None]) * signs[:, None]
    coupled = np.array([way.coupling == HORIZONTAL for way in ways])
    if coupled.any():
        plain[coupled, :, 2] -= _sense(chain) * plain[coupled, :, 1]
    result: Array = plain * np.where(chain.sliding, 1.0, math.radians(1.0))
    return result


def _sense(chain: Chain) -> float:
    """Against the horizontal axis 3 shows the sum of the turns of axes 2 and 3, which is a difference, -1, where they turn
    against each other."""
    directions = chain.frames(np.zeros(chain.axes)).directions
    return 1.0 if float(directions[1] @ directions[2]) > 0.0 else -1.0


def deviations(chain: Chain, shown: Shown, values: Array, poses: Array) -> list[Deviation]:
    """How far the flange poses (n, 4, 4) in base_link are from those of the machine at values (n, axes) as shown."""
    return [
        Deviation(*pair)
        for pair in _off(chain.forward(serial(shown, chain, values)), poses).tolist()
    ]


def fits(found: list[Deviation]) -> bool:
    """Whether all deviations are such as the rounding of a display leaves."""
    return all(
        deviation.position <= TOLERANCE_MM and deviation.angle <= TOLERANCE_DEG
        for deviation in found
    )


def suspects(chain: Chain, shown: Shown, values: Array, poses: Array) -> list[Suspect]:
    """What may be wrong, the fewest changes first; all of them make the machine give all poses. Empty where the poses fit,
    or where nothing that is tried explains them.

    Tried are signs, zeros off by right angles, one zero off by anything, the coupling, another base frame, another flange;
    where none of them does, the first of them with another base frame.
    """
    values, poses = np.asarray(values, float), np.asarray(poses, float)
    if not len(poses) or fits(deviations(chain, shown, values, poses)):
        return []
    found = [
        *_of_frames(chain, shown, values, poses),
        *_of_joints(chain, shown, values, poses, False),
    ]
    if not found and len(poses) > 2:
        found = _of_joints(chain, shown, values, poses, True)
    order = (COUPLED, SIGN, ZERO, BASE, FLANGE, SIGN_AND_ZERO)
    ranked = sorted(
        found,
        key=lambda suspect: (len(suspect.axes), order.index(suspect.kind), suspect.left.position),
    )
    fewest = [suspect for suspect in ranked if len(suspect.axes) == len(ranked[0].axes)]
    return fewest[:4]


def _of_joints(
    chain: Chain, shown: Shown, values: Array, poses: Array, any_base: bool
) -> list[Suspect]:
    tried: list[tuple[str, tuple[int, ...], Shown]] = []
    couplings = (NONE, HORIZONTAL) if chain.axes == 6 else (shown.coupling,)
    for flips in itertools.product((1, -1), repeat=chain.axes):
        for coupling in couplings:
            signs = tuple(sign * flip for sign, flip in zip(shown.signs, flips, strict=True))
            wrong = tuple(axis for axis, flip in enumerate(flips) if flip < 0)
            plain = Shown(signs, shown.zeros, coupling)
            coupled = coupling != shown.coupling
            tried.append(
                (
                    SIGN if wrong else COUPLED,
                    tuple(sorted({*wrong, 2})) if coupled else wrong,
                    plain,
                )
            )
            if len(wrong) > 1 or coupled:
                continue
            for axis, quarter in itertools.product(range(chain.axes), _QUARTERS):
                if not chain.sliding[axis]:
                    zeros = _changed(shown.zeros, axis, quarter)
                    axes = tuple(sorted({*wrong, axis}))
                    tried.append(
                        (SIGN_AND_ZERO if wrong else ZERO, axes, replace(plain, zeros=zeros))
                    )
    tried = [one for one in tried if one[1]]
    given = _given(chain, [trial for _, _, trial in tried], values)
    # in the base frame by which the first pose is given, or in that there is
    bases = (
        given[:, 0] @ frames.inverse(poses[0])
        if any_base
        else np.broadcast_to(np.eye(4), (len(tried), 4, 4))
    )
    off = _off(given, bases[:, None] @ poses).max(axis=1)
    found = [
        Suspect(kind, axes, trial, base if any_base else None, Deviation(*left))
        for (kind, axes, trial), base, left in zip(tried, bases, off.tolist(), strict=True)
        if fits([Deviation(*left)])
    ]
    if any_base:
        return found
    named = {suspect.axes for suspect in found}
    free = [
        _any_zero(axis, chain, shown, values, poses)
        for axis in range(chain.axes)
        if (axis,) not in named
    ]
    return found + [suspect for suspect in free if fits([suspect.left])]


def _any_zero(axis: int, chain: Chain, shown: Shown, values: Array, poses: Array) -> Suspect:
    """The zero of one axis by which the poses are missed least: Newton's method from the best of a coarse grid."""
    span = np.linspace(-500.0, 500.0, 41) if chain.sliding[axis] else np.linspace(-180.0, 170.0, 36)

    def errors(changes: Array) -> Array:
        trials = [
            replace(shown, zeros=_changed(shown.zeros, axis, float(change))) for change in changes
        ]
        off = (_given(chain, trials, values) - poses).reshape(len(trials), -1, 4, 4)[:, :, :3]
        # an entry of a rotation counts as 500 mm: the size of the arm
        off[..., :3] *= 500.0
        return np.asarray(off.reshape(len(trials), -1))

    best = float(span[np.argmin((errors(span) ** 2).sum(axis=1))])
    for _ in range(8):
        before, here, after = errors(best + np.array([-1e-4, 0.0, 1e-4]))
        slope = (after - before) / 2e-4
        square = float(slope @ slope)
        if square < 1e-12:
            break
        best -= float(slope @ here) / square
    trial = replace(shown, zeros=_changed(shown.zeros, axis, round(best, 2)))
    left = _off(_given(chain, [trial], values)[0], poses).max(axis=0)
    return Suspect(ZERO, (axis,), trial, None, Deviation(*left.tolist()))


def _given(chain: Chain, trials: Sequence[Shown], values: Array) -> Array:
    """The flange poses (trials, n, 4, 4) of values (n, axes) if they are shown in such ways."""
    return chain.forward(_serial(trials, chain, values))


def _of_frames(chain: Chain, shown: Shown, values: Array, poses: Array) -> list[Suspect]:
    """Another base frame or another flange, where one explains all poses; one pose alone would tell nothing."""
    if len(poses) < 2:
        return []
    given = chain.forward(serial(shown, chain, values))
    found = []
    base, flange = given[0] @ frames.inverse(poses[0]), frames.inverse(given[0]) @ poses[0]
    for kind, change, left_of in (
        (BASE, base, (given, base @ poses)),
        (FLANGE, flange, (given @ flange, poses)),
    ):
        left = Deviation(*_off(*left_of).max(axis=0).tolist())
        if fits([left]):
            found.append(Suspect(kind, (0,), None, change, left))
    return found


def _off(given: Array, wanted: Array) -> Array:
    """Distance, mm, and angle, deg, (..., 2) between poses (..., 4, 4)."""
    turned = np.swapaxes(given[..., :3, :3], -1, -2) @ wanted[..., :3, :3]
    across = np.stack(
        [
            turned[..., 2, 1] - turned[..., 1, 2],
            turned[..., 0, 2] - turned[..., 2, 0],
            turned[..., 1, 0] - turned[..., 0, 1],
        ],
        axis=-1,
    )
    sine, cosine = (
        0.5 * np.linalg.norm(across, axis=-1),
        0.5 * (np.trace(turned, axis1=-2, axis2=-1) - 1.0),
    )
    away = np.linalg.norm(given[..., :3, 3] - wanted[..., :3, 3], axis=-1)
    return np.stack((away, np.degrees(np.arctan2(sine, cosine))), axis=-1)


def _changed(zeros: tuple[float, ...], axis: int, change: float) -> tuple[float, ...]:
    return (*zeros[:axis], zeros[axis] + change, *zeros[axis + 1 :])
