# SPDX-License-Identifier: LGPL-2.1-or-later
"""The same job gives the same bytes, wherever its arrays are in memory and whatever the last bit of
a tie."""

import dataclasses

import numpy as np
import pytest

from freecad_am.core.kinematics import cell as cells
from freecad_am.core.parameters.cell import CellParameters
from freecad_am.core.parameters.joints import JointParameters
from freecad_am.core.parameters.process import ProcessParameters
from freecad_am.core.planning.motion import assemble
from freecad_am.core.planning.plan import plan_joints
from freecad_am.core.slicing import wall_directions as wall_direction
from freecad_am.core.strategies.clearance.tilt_search import least_cost_states
from freecad_am.core.toolpath import Bead, Layer, Toolpath

TURN = 2.0 * np.pi
COLUMNS = ("points", "build", "tool", "parameter", "speed")
# numpy computes these in two ways, vectorised and one by one, which differ in the last bit
TWO_WAYS = ("sin", "cos", "tan", "arcsin", "arccos", "arctan", "arctan2", "exp", "log", "power")


def wall(lean=0.9):
    """Mirror-symmetric rings, leaning so far that not all limits can be kept."""
    angle = np.linspace(0.0, TURN, 61)
    layers = []
    for k in range(4):
        points = np.c_[
            (30.0 + 2.0 * k) * np.cos(angle), 24.0 * np.sin(angle), np.full(61, 40.0 + 5.0 * k)
        ]
        tool = np.c_[
            np.cos(angle) * np.sin(lean), np.sin(angle) * np.sin(lean), np.full(61, np.cos(lean))
        ]
        points[-1], tool[-1] = points[0], tool[0]
        layers.append(Layer((Bead(points, tool, tool, angle.copy(), np.full(61, 6.0), True),)))
    return Toolpath(tuple(layers), np.eye(4), 5.0, 1.0, family="surface")


def changed(toolpath, change):
    def bead(original):
        columns = {name: change(getattr(original, name)) for name in COLUMNS}
        for name in ("points", "build", "tool"):
            columns[name][-1] = columns[name][0]
        for name in ("build", "tool"):
            columns[name] /= np.linalg.norm(columns[name], axis=1, keepdims=True)
        columns["parameter"] = original.parameter.copy()
        return dataclasses.replace(original, **columns)

    layers = (
        dataclasses.replace(layer, beads=tuple(map(bead, layer.beads))) for layer in toolpath.layers
    )
    return dataclasses.replace(toolpath, layers=tuple(layers))


def copy_at_offset(array, offset):
    """A copy at an offset in bytes from a multiple of 64."""
    room = np.empty(array.nbytes + 128, dtype=np.uint8)
    start = -room.ctypes.data % 64 + offset
    copy = room[start : start + array.nbytes].view(array.dtype).reshape(array.shape)
    copy[...] = array
    return copy


def cell_of(toolpath):
    parameters = CellParameters(limits="paper", platform=(0.0, 0.0, 40.0, 0.0, 0.0, 0.0))
    return cells.resolve(parameters, toolpath.frame, toolpath.family)


def motion_of(toolpath, degree=1):
    cell = cell_of(toolpath)
    path = plan_joints(toolpath, cell, JointParameters(degree=degree))
    return path, assemble(path, cell, ProcessParameters())[0]


def bytes_of(motion):
    return [getattr(motion, field.name).tobytes() for field in dataclasses.fields(motion)]


@pytest.mark.parametrize(("lean", "degree"), [(0.9, 1), (0.3, 3)])
def test_copies_elsewhere_in_memory_give_the_same_bytes(lean, degree):
    """Copies elsewhere in memory give the same bytes."""
    rng = np.random.default_rng(7)
    toolpath = wall(lean)
    expected = bytes_of(motion_of(toolpath, degree)[1])
    for _ in range(3):
        clutter = [np.empty(size) for size in rng.integers(1, 4000, size=80)]
        del clutter[::2]
        copy = changed(toolpath, lambda array: copy_at_offset(array, 8 * int(rng.integers(0, 8))))
        assert bytes_of(motion_of(copy, degree)[1]) == bytes_of(
            motion_of(changed(toolpath, np.copy), degree)[1]
        )
        assert bytes_of(motion_of(toolpath, degree)[1]) == expected


@pytest.mark.parametrize("lean", [0.3, 0.9])
def test_the_last_bits_decide_nothing(lean):
    """The last bits of the input do not affect the result."""
    rng = np.random.default_rng(11)
    path, motion = motion_of(wall(lean))
    for _ in range(3):
        noisy = changed(
            wall(lean), lambda array: array * (1.0 + 1e-15 * rng.uniform(-1, 1, array.shape))
        )
        noisy_path, shifted = motion_of(noisy)
        assert noisy_path.branch == path.branch and len(shifted) == len(motion)
        assert np.abs(np.nan_to_num(shifted.joints - motion.joints)).max() < 1e-6
        assert (np.isnan(shifted.joints) == np.isnan(motion.joints)).all()


def test_functions_worked_out_in_two_ways_are_given_arrays_in_one_piece(monkeypatch):
    """A column of a table extends beyond the table: with the result just behind it, numpy takes the
    other code path."""
    strided = []

    def watched(function):
        def call(*args, **options):
            for array in args:
                strides, shape = np.asarray(array).strides, np.shape(array)
                steps = [
                    abs(step)
                    for step, count in zip(strides, shape, strict=True)
                    if count > 1 and step
                ]
                if steps and min(steps) > np.asarray(array).itemsize:
                    strided.append(function.__name__)
            return function(*args, **options)

        return call

    for name in TWO_WAYS:
        monkeypatch.setattr(np, name, watched(getattr(np, name)))
    for parameter in ("rotation", "rz"):
        toolpath = wall(0.3)
        plan_joints(toolpath, cell_of(toolpath), JointParameters(parameter=parameter))
    wall_direction.cap_lean(wall().layers[0].beads[0].tool, 0.5)
    assert not strided


def test_of_two_ways_round_alike_the_first_is_taken():
    """Of two equivalent directions the first is taken."""
    rng = np.random.default_rng(3)
    ring = np.array([[0.0, 0.0], [0.1, 0.0], [0.0, 0.1], [-0.1, 0.0], [0.0, -0.1]])
    allowed = np.ones((1, 30, 5), dtype=bool)
    allowed[:, 10:20, 0] = False
    weight, change = np.ones((1, 30)), np.full((1, 29), 3.0)
    for _ in range(20):
        states = (ring * (1.0 + 1e-15 * rng.uniform(-1, 1, ring.shape)))[None, None]
        states_chosen = least_cost_states(
            np.broadcast_to(states, (1, 1, 5, 2)), allowed, weight, change
        )[0]
        assert set(states_chosen[10:20]) == {1} and set(states_chosen[:5]) == {0}
