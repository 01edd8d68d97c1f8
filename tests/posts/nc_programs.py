# SPDX-License-Identifier: LGPL-2.1-or-later
"""Programs of five-axis machines for tests: by hand, and random from a seed."""

import dataclasses
import math

import numpy as np

from freecad_am.core.program import (
    Call,
    DepositOff,
    DepositOn,
    LayerStart,
    Moves,
    NcOptions,
    Program,
    Wait,
    WaitBelow,
    WaitInput,
)

NAMES, KINDS = ("X", "Y", "Z", "A", "C"), ("linear",) * 3 + ("rotary",) * 2
CARRIED = (10.0, -20.5, 30.25, 0.0, 0.0, math.radians(15.0))


def moves(kind, axes, duration=0.5, layer=0, bead=0, speed=6.0, **extra):
    """Return moves of axis values in mm and deg."""
    axes = np.atleast_2d(np.asarray(axes, float))
    joints = np.hstack([axes[:, :3], np.radians(axes[:, 3:])])
    duration = np.broadcast_to(np.asarray(duration, float), len(axes)).copy()
    return Moves(kind, layer, bead, joints, duration, np.full(len(axes), speed), **extra)


def program(*blocks, name="part", **options):
    defaults = {
        "continuous": (False,) * 5, "setup": "rotary-table", "axis_names": NAMES, "axis_kinds": KINDS, "carried": CARRIED,
        "max_speed": (200.0,) * 3 + (1.5, 3.0),
    }  # fmt: skip
    return Program(name, "a machine", blocks, **{**defaults, **options})


def random_program(seed, motion="joint", continuous=False, names=NAMES, wire=False, **options):
    """Return a random program with all kinds of blocks, steps of all sizes, and moves that only
    turn or only slide. With `wire`, beads state the wire speed."""
    rng, speeds = np.random.default_rng(seed), np.random.default_rng([seed, 1])
    kinds = tuple("linear" if name in "XYZ" else "rotary" for name in names)
    linear = np.array([kind == "linear" for kind in kinds])
    axis_values = np.where(
        linear, rng.uniform(-200.0, 200.0, len(names)), rng.uniform(-2.0, 2.0, len(names))
    )
    is_last = np.zeros(len(names), bool)
    is_last[-1] = continuous
    blocks = []

    def some(kind, layer, bead, count):
        nonlocal axis_values
        steps = rng.normal(0.0, np.where(linear, 2.0, 0.03), (count, len(names)))
        steps[rng.random(count) < 0.2] *= np.where(linear, 0.0, 1.0)
        steps[rng.random(count) < 0.2] *= np.where(linear, 1.0, 0.0)
        steps[rng.random(count) < 0.1] *= 1e-4
        if continuous:
            steps[:, -1] = rng.uniform(-3.1, 3.1, count)
        joints = axis_values + np.cumsum(steps, axis=0)
        joints[(rng.random(joints.shape) < 0.05) & ~is_last] *= 1e-5  # small values of both signs
        axis_values = joints[-1]
        duration = rng.choice([0.0011, 0.05, 0.3, 4.0, 40.0, 3000.0], count) * rng.uniform(
            1.0, 1.05, count
        )
        extra = {}
        if motion == "cartesian":
            direction = rng.normal(size=(count, 3))
            direction[rng.random(count) < 0.2] = [0.0, 0.0, 1.0]
            direction /= np.linalg.norm(direction, axis=1, keepdims=True)
            extra = {"position": rng.uniform(-400, 400, (count, 3)), "direction": direction}
            extra["interpolation"] = "linear" if kind == "deposit" else "joint"
        return Moves(kind, layer, bead, joints, duration, rng.uniform(0.5, 150.0, count), **extra)

    for layer in range(int(rng.integers(1, 5))):
        blocks.append(LayerStart(layer))
        for bead in range(int(rng.integers(1, 4))):
            blocks.append(some("rapid", layer, bead, int(rng.integers(1, 4))))
            blocks.append(DepositOn(float(rng.choice([0.0, 0.004, 0.5]))))
            blocks.append(some("deposit", layer, bead, int(rng.integers(1, 40))))
            if wire:
                feeds = speeds.uniform(20.0, 300.0, len(blocks[-1]))
                feeds[speeds.random(len(feeds)) < 0.5] = 108.25  # many moves at the same speed
                blocks[-1] = dataclasses.replace(blocks[-1], wire=feeds)
                blocks[-2] = dataclasses.replace(blocks[-2], wire=float(feeds[0]))
            blocks.append(DepositOff(float(rng.choice([0.0, 1.25]))))
        blocks += [Wait(float(rng.choice([0.0, 12.5, 700.0]))), WaitInput(3), Call("clean")][
            : int(rng.integers(0, 4))
        ]
        blocks += [WaitBelow(4, 0.125 * (seed + 1), layer, 0)] * (layer % 2)
    blocks.append(some("rapid", layer, bead, 1))
    options = {
        "max_points": int(rng.integers(45, 120)), "user_frame": int(rng.integers(1, 9)),
        "tool_frame": int(rng.integers(1, 10)), "deposit_output": int(rng.integers(1, 60)),
        "remarks": ('A remark; longer than a line of most controllers ought to be: Größe "1" (in brackets), msg, and more',),
    } | options  # fmt: skip
    return program(
        *blocks,
        name="Random",
        motion=motion,
        continuous=tuple(is_last.tolist()),
        axis_names=tuple(names),
        axis_kinds=kinds,
        **options,
    )


def set_options(program_, **options):
    """Return the program with other options of five-axis machines."""
    return dataclasses.replace(program_, nc=NcOptions(**options))


def deposit_of(program_):
    """Return whether the deposit is on in each move, according to the plan."""
    deposit, on = [], False
    for block in program_.blocks:
        on = isinstance(block, DepositOn) or (on and not isinstance(block, DepositOff))
        deposit += [on and not program_.dry_run] * len(block) if isinstance(block, Moves) else []
    return deposit
