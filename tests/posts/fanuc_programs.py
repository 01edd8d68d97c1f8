# SPDX-License-Identifier: LGPL-2.1-or-later
"""Programs of plain numbers for FANUC's post, including those of the golden files, and its
refusals."""

import dataclasses

import numpy as np
import pytest

from freecad_am.core.issues import InputError
from freecad_am.core.program import (
    Call,
    DepositOff,
    DepositOn,
    LayerStart,
    Moves,
    Program,
    Wait,
    WaitInput,
)
from freecad_am.posts.fanuc import post as fanuc

UPRIGHT = ("front", "up", "flip")


def moves(kind, degrees, duration=0.1, layer=0, bead=0, **extra):
    degrees = np.atleast_2d(np.asarray(degrees, float))
    duration = np.broadcast_to(np.asarray(duration, float), len(degrees)).copy()
    return Moves(
        kind, layer, bead, np.radians(degrees), duration, np.full(len(degrees), 6.0), **extra
    )


def program(*blocks, name="part", continuous=(False,) * 6, **options):
    return Program(name, "a machine", blocks, continuous, **options)


def beads(count, points, layers=1, **options):
    """Return beads of `points` points each, each after two rapid moves."""
    blocks = []
    for layer in range(layers):
        blocks.append(LayerStart(layer))
        for bead in range(count):
            value = np.arange(points)[:, None] * 0.1 + np.zeros(6)
            blocks += [moves("rapid", np.zeros((2, 6)), layer=layer, bead=bead), DepositOn()]
            blocks += [moves("deposit", value, layer=layer, bead=bead), DepositOff()]
    return program(*blocks, **options)


def put_tool_on_robot(source, **changes):
    """Return the program with the tool on the robot and a fixed platform."""
    return dataclasses.replace(
        source,
        **{
            "name": "tool",
            "setup": "tool-on-robot",
            "station": (700.0, 10.5, -100.0, 0.1, -0.2, 3.0),
            "carried": (0.0, 0.0, 150.0, 0.0, 0.0, 0.5),
            **changes,
        },
    )


def refusal(program_, *, code, where=None):
    with pytest.raises(InputError) as raised:
        fanuc.write(program_)
    assert raised.value.code == code and where in (None, raised.value.where)
    return raised.value.message


GOLDEN_JOINT = program(
    moves("rapid", [[0.0, -30.0, 30.0, 0.0, -60.0, 170.0], [1.25, -29.5, 30.25, 0.1, -60.5, 175.0]], [1.0, 2.5]),
    DepositOn(0.5),
    moves(
        "deposit",
        [[2.5, -29.0, 30.5, -0.0004, -61.0, 179.9996],
         [2.5, -29.0, 30.5, -0.0006, -61.0, 190.0],
         [-170.0, 1.0, 2.0, 3.0, 4.0, 290.25]],
        [0.3154, 0.3154, 33.04],
    ),
    DepositOff(0.25),
    Wait(700.0), WaitInput(3), Call("clean"),
    LayerStart(1),
    moves("rapid", [[0.0, -30.0, 30.0, 0.0, -60.0, 400.0]], 1.0, layer=1),
    name="Joint", continuous=(False,) * 5 + (True,), remarks=("pendant J3 = q3 - q2: a remark of more than one line",),
)  # fmt: skip

ABOUT_X = np.diag([1.0, -1.0, -1.0])
GOLDEN_TABLE = program(
    moves("rapid", [[0.0, 0.0, 0.0, 0.0, -90.0, 0.0]], position=np.array([[0.0, 0.0, 50.0]]), rotation=ABOUT_X[None],
          configuration=(UPRIGHT,)),
    DepositOn(),
    moves("deposit", [[0.0, 0.0, 0.0, 0.0, -90.0, 180.0], [0.0, 0.0, 0.0, 0.0, 45.0, -200.0]],
          position=np.array([[10.0, 0.25, 5.0], [20.5, -0.5, 5.0]]),
          # Rz(90) Rx(180), and Ry(90) where only R - W counts
          rotation=np.array([[[0.0, 1.0, 0.0], [1.0, 0.0, 0.0], [0.0, 0.0, -1.0]],
                             [[0.0, 0.0, 1.0], [0.0, 1.0, 0.0], [-1.0, 0.0, 0.0]]]),
          configuration=(UPRIGHT, ("front", "down", "noflip")), interpolation="linear"),
    DepositOff(),
    name="TABLE", motion="cartesian", setup="tool-on-robot", user_frame=2, tool_frame=3, deposit_output=7, blend=50,
)  # fmt: skip


def switch_on_moves(source, lead=0.05, **changes):
    """Return the program with the deposit switched on the moves themselves."""
    blocks = [
        dataclasses.replace(block, lead=0.0, ahead=lead)
        if isinstance(block, (DepositOn, DepositOff))
        else block
        for block in source.blocks
    ]
    return dataclasses.replace(source, blocks=tuple(blocks), **{"name": "early", **changes})
