# SPDX-License-Identifier: LGPL-2.1-or-later
"""Displayed joint values, and possible errors of a machine that does not match its poses.

The joint values on a pendant may differ from serial values by signs, zeros and a coupling of axes 2
and 3.
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

NONE, HORIZONTAL = "none", "horizontal"  # reference of the displayed axis 3: link 2, or the base
TOLERANCE_MM, TOLERANCE_DEG = (
    0.5,
    0.1,
)  # error at the end of a long arm whose joints are displayed to 0.01 deg
_QUARTERS = (90.0, -90.0, 180.0)


@dataclass(frozen=True)
class Shown:
    """How a controller displays joint values.

    signs: +1 or -1 per axis. zeros: display at serial zero, deg or mm. coupling: reference of
    axis 3.
    """

    signs: tuple[int, ...]
    zeros: tuple[float, ...]
    coupling: str = NONE


@dataclass(frozen=True)
class Deviation:
    """Deviation between two poses: position, mm, and angle, deg."""

    position: float
    angle: float


@dataclass(frozen=True, eq=False)
class Suspect:
    """A change that makes the machine match the poses.

    axes: affected axes, from 0. shown: changed display of the joints; None if the error is
    elsewhere. pose: (4, 4) motion of the base frame in base_link or, if `kind` is FLANGE, pose
    after the flange; None if both are correct. remaining: maximum remaining deviation.
    """

    kind: str
    axes: tuple[int, ...]
    shown: Shown | None
    pose: Array | None
    remaining: Deviation


SIGN, ZERO, SIGN_AND_ZERO, COUPLED, BASE, FLANGE = (
    "sign",
    "zero",
    "sign and zero",
    "coupling",
    "base",
    "flange",
)


def matrix(display: Shown, chain: Chain) -> tuple[Array, Array]:
    """Return controller matrix and offset for a machine file.

    Parameters
    ----------
    display : Shown
        Signs, zeros and coupling.
    chain : Chain
        The chain.

    Returns
    -------
    matrix : (axes, axes) array
        Factor of serial joint values.
    offset : (axes,) array
        Display at serial zero, degrees or mm.
    """
    mixed = np.eye(chain.axes)
    if display.coupling == HORIZONTAL:
        mixed[2, 1] = _sense(chain)
    return np.array(display.signs, float)[:, None] * mixed + 0.0, np.array(display.zeros, float)


def serial(display: Shown, chain: Chain, values: Array) -> Array:
    """Convert displayed joint values to serial joint values.

    Parameters
    ----------
    display : Shown
        How the controller displays joint values.
    chain : Chain
        The chain.
    values : (n, axes) array
        Displayed values, degrees and mm.

    Returns
    -------
    (n, axes) array
        Serial values, rad and mm.
    """
    result: Array = _serial([display], chain, values)[0]
    return result


def _serial(displays: Sequence[Shown], chain: Chain, values: Array) -> Array:
    """Return serial values (displays, n, axes) for displayed values (n, axes)."""
    signs = np.array([display.signs for display in displays], float)
    zeros = np.array([display.zeros for display in displays])
    plain = (np.asarray(values, float) - zeros[:, None]) * signs[:, None]
    coupled = np.array([display.coupling == HORIZONTAL for display in displays])
    if coupled.any():
        plain[coupled, :, 2] -= _sense(chain) * plain[coupled, :, 1]
    result: Array = plain * np.where(chain.sliding, 1.0, math.radians(1.0))
    return result


def _sense(chain: Chain) -> float:
    """Return the sense of axis 3 relative to axis 2.

    Relative to the horizontal, axis 3 displays the sum of the angles of axes 2 and 3, or their
    difference (-1) if the axes rotate in opposite senses.
    """
    directions = chain.frames(np.zeros(chain.axes)).directions
    return 1.0 if float(directions[1] @ directions[2]) > 0.0 else -1.0


def deviations(chain: Chain, display: Shown, values: Array, poses: Array) -> list[Deviation]:
    """Return the deviations of flange poses from the poses of the machine at displayed values.

    Parameters
    ----------
    chain : Chain
        The chain.
    display : Shown
        How the controller displays joint values.
    values : (n, axes) array
        Displayed values, degrees and mm.
    poses : (n, 4, 4) array
        Flange poses in base_link, mm.

    Returns
    -------
    list of Deviation
        One deviation per pose.
    """
    return [
        Deviation(*pair)
        for pair in _pose_distances(chain.forward(serial(display, chain, values)), poses).tolist()
    ]


def fits(all_deviations: list[Deviation]) -> bool:
    """Whether all deviations are within the rounding of a display."""
    return all(
        deviation.position <= TOLERANCE_MM and deviation.angle <= TOLERANCE_DEG
        for deviation in all_deviations
    )


def suspects(chain: Chain, display: Shown, values: Array, poses: Array) -> list[Suspect]:
    """Return possible errors that explain all poses, the fewest changes first.

    Tested changes are signs, zeros off by right angles, one zero off by any value, the coupling, a
    different base frame and a different flange. If none explains the poses, changes of signs, zeros
    and coupling are combined with a different base frame.

    Parameters
    ----------
    chain : Chain
        The chain.
    display : Shown
        How the controller displays joint values.
    values : (n, axes) array
        Displayed values, degrees and mm.
    poses : (n, 4, 4) array
        Flange poses in base_link, mm.

    Returns
    -------
    list of Suspect
        At most four; empty if the poses match, or if no tested change explains them.
    """
    values, poses = np.asarray(values, float), np.asarray(poses, float)
    if not len(poses) or fits(deviations(chain, display, values, poses)):
        return []
    candidates = [
        *_suspect_frames(chain, display, values, poses),
        *_suspect_joints(chain, display, values, poses, False),
    ]
    if not candidates and len(poses) > 2:
        candidates = _suspect_joints(chain, display, values, poses, True)
    order = (COUPLED, SIGN, ZERO, BASE, FLANGE, SIGN_AND_ZERO)
    ranked = sorted(
        candidates,
        key=lambda suspect: (
            len(suspect.axes),
            order.index(suspect.kind),
            suspect.remaining.position,
        ),
    )
    fewest = [suspect for suspect in ranked if len(suspect.axes) == len(ranked[0].axes)]
    return fewest[:4]


def _suspect_joints(
    chain: Chain, display: Shown, values: Array, poses: Array, any_base: bool
) -> list[Suspect]:
    trials: list[tuple[str, tuple[int, ...], Shown]] = []
    couplings = (NONE, HORIZONTAL) if chain.axes == 6 else (display.coupling,)
    for flips in itertools.product((1, -1), repeat=chain.axes):
        for coupling in couplings:
            signs = tuple(sign * flip for sign, flip in zip(display.signs, flips, strict=True))
            wrong = tuple(axis for axis, flip in enumerate(flips) if flip < 0)
            plain = Shown(signs, display.zeros, coupling)
            coupled = coupling != display.coupling
            trials.append(
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
                    zeros = _changed(display.zeros, axis, quarter)
                    axes = tuple(sorted({*wrong, axis}))
                    trials.append(
                        (SIGN_AND_ZERO if wrong else ZERO, axes, replace(plain, zeros=zeros))
                    )
    trials = [trial_entry for trial_entry in trials if trial_entry[1]]
    trial_poses = _poses_of_trials(chain, [trial for _, _, trial in trials], values)
    # with the base frame that reproduces the first pose, or with the existing base frame
    bases = (
        trial_poses[:, 0] @ frames.inverse(poses[0])
        if any_base
        else np.broadcast_to(np.eye(4), (len(trials), 4, 4))
    )
    off = _pose_distances(trial_poses, bases[:, None] @ poses).max(axis=1)
    suspects_found = [
        Suspect(kind, axes, trial, base if any_base else None, Deviation(*deviation))
        for (kind, axes, trial), base, deviation in zip(trials, bases, off.tolist(), strict=True)
        if fits([Deviation(*deviation)])
    ]
    if any_base:
        return suspects_found
    named = {suspect.axes for suspect in suspects_found}
    free = [
        _any_zero(axis, chain, display, values, poses)
        for axis in range(chain.axes)
        if (axis,) not in named
    ]
    return suspects_found + [suspect for suspect in free if fits([suspect.remaining])]


def _any_zero(axis: int, chain: Chain, display: Shown, values: Array, poses: Array) -> Suspect:
    """Return the zero of one axis that minimises the deviation from the poses.

    Newton's method starts from the best value of a coarse grid.
    """
    span = np.linspace(-500.0, 500.0, 41) if chain.sliding[axis] else np.linspace(-180.0, 170.0, 36)

    def errors(changes: Array) -> Array:
        trials = [
            replace(display, zeros=_changed(display.zeros, axis, float(change)))
            for change in changes
        ]
        off = (_poses_of_trials(chain, trials, values) - poses).reshape(len(trials), -1, 4, 4)[
            :, :, :3
        ]
        # rotation matrix entries count as 500 mm, the size of the arm
        off[..., :3] *= 500.0
        return np.asarray(off.reshape(len(trials), -1))

    best = float(span[np.argmin((errors(span) ** 2).sum(axis=1))])
    for _ in range(8):
        error_before, error_now, error_after = errors(best + np.array([-1e-4, 0.0, 1e-4]))
        slope = (error_after - error_before) / 2e-4
        square = float(slope @ slope)
        if square < 1e-12:
            break
        best -= float(slope @ error_now) / square
    trial = replace(display, zeros=_changed(display.zeros, axis, round(best, 2)))
    deviation = _pose_distances(_poses_of_trials(chain, [trial], values)[0], poses).max(axis=0)
    return Suspect(ZERO, (axis,), trial, None, Deviation(*deviation.tolist()))


def _poses_of_trials(chain: Chain, trials: Sequence[Shown], values: Array) -> Array:
    """Return flange poses (trials, n, 4, 4) for values (n, axes) displayed as in each trial."""
    return chain.forward(_serial(trials, chain, values))


def _suspect_frames(chain: Chain, display: Shown, values: Array, poses: Array) -> list[Suspect]:
    """Return a different base frame or flange if it explains all poses.

    A single pose would prove nothing.
    """
    if len(poses) < 2:
        return []
    model_poses = chain.forward(serial(display, chain, values))
    frame_suspects = []
    base = model_poses[0] @ frames.inverse(poses[0])
    flange = frames.inverse(model_poses[0]) @ poses[0]
    for kind, change, pose_pairs in (
        (BASE, base, (model_poses, base @ poses)),
        (FLANGE, flange, (model_poses @ flange, poses)),
    ):
        remaining = Deviation(*_pose_distances(*pose_pairs).max(axis=0).tolist())
        if fits([remaining]):
            frame_suspects.append(Suspect(kind, (0,), None, change, remaining))
    return frame_suspects


def _pose_distances(actual: Array, expected: Array) -> Array:
    """Return distance, mm, and angle, deg, (..., 2) between poses (..., 4, 4)."""
    turned = np.swapaxes(actual[..., :3, :3], -1, -2) @ expected[..., :3, :3]
    across = np.stack(
        [
            turned[..., 2, 1] - turned[..., 1, 2],
            turned[..., 0, 2] - turned[..., 2, 0],
            turned[..., 1, 0] - turned[..., 0, 1],
        ],
        axis=-1,
    )
    sine = 0.5 * np.linalg.norm(across, axis=-1)
    cosine = 0.5 * (np.trace(turned, axis1=-2, axis2=-1) - 1.0)
    distance = np.linalg.norm(actual[..., :3, 3] - expected[..., :3, 3], axis=-1)
    return np.stack((distance, np.degrees(np.arctan2(sine, cosine))), axis=-1)


def _changed(zeros: tuple[float, ...], axis: int, change: float) -> tuple[float, ...]:
    return (*zeros[:axis], zeros[axis] + change, *zeros[axis + 1 :])
