# SPDX-License-Identifier: LGPL-2.1-or-later
"""Poses as pendants show them, compared with scipy's rotations and values computed by hand."""

import math

import numpy as np
import pytest
from scipy.spatial.transform import Rotation

from freecad_am.core.geometry import frames
from freecad_am.core.issues import InputError
from freecad_am.core.parameters.cell import CellParameters
from freecad_am.core.parameters.cell_records import EXTERNAL
from freecad_am.objects.fields import pendants
from freecad_am.objects.fields.rows import rows
from freecad_am.posts.fanuc import records as tp
from freecad_am.posts.kuka import text as krl


def of(turn, controller):
    """Return the pendant values of a rotation, by scipy."""
    return {
        "kuka": lambda: turn.as_euler("ZYX", degrees=True),
        "fanuc": lambda: turn.as_euler("xyz", degrees=True),
        "yaskawa": lambda: turn.as_euler("xyz", degrees=True),
        "staubli": lambda: turn.as_euler("XYZ", degrees=True),
        "abb": lambda: np.roll(turn.as_quat(), 1),
        "ur": turn.as_rotvec,
    }[controller]()


@pytest.mark.parametrize("controller", pendants.pendants())
def test_what_scipy_says_is_read_and_shown(controller):
    turns = Rotation.random(200, random_state=3)
    for turn in [*turns, *Rotation.from_euler("x", [0.0, 180.0, 90.0], degrees=True)]:
        numbers = of(turn, controller)
        values = pendants.six(
            [controller, "10.5", "-20", "300", *(f"{number:.17g}" for number in numbers)], "here"
        )
        assert values[:3] == (10.5, -20.0, 300.0)
        assert np.abs(frames.bryant(values)[:3, :3] - turn.as_matrix()).max() < 1e-12
        again = pendants.pendant_values(controller, values)
        assert again[:3] == values[:3]
        back = pendants.six([controller, *(f"{number:.17g}" for number in again)], "here")
        assert np.abs(frames.bryant(back)[:3, :3] - turn.as_matrix()).max() < 1e-9
        if controller == "abb":
            positive = numbers if numbers[0] >= 0.0 else -numbers
            assert positive[0] < 1e-9 or np.abs(np.array(again[3:]) - positive).max() < 1e-9


@pytest.mark.parametrize(
    ("text", "z"),
    [
        # the direction of the tool's Z, by hand: a quarter turn about Y
        ("kuka 0 0 0 0 90 0", [1, 0, 0]),
        ("fanuc 0 0 0 0 90 0", [1, 0, 0]),
        ("yaskawa 0 0 0 0 90 0", [1, 0, 0]),
        ("staubli 0 0 0 0 90 0", [1, 0, 0]),
        ("abb 0 0 0 0.70711 0 0.70711 0", [1, 0, 0]),
        (f"ur 0 0 0 0 {math.pi / 2} 0", [1, 0, 0]),
        # then a quarter turn about the fixed Z, which is A of KUKA, R of FANUC, Rz of Yaskawa, and
        # Rx of Staubli about its own X
        ("kuka 0 0 0 90 90 0", [0, 1, 0]),
        ("fanuc 0 0 0 0 90 90", [0, 1, 0]),
        ("yaskawa 0 0 0 0 90 90", [0, 1, 0]),
        ("staubli 0 0 0 90 90 0", [1, 0, 0]),
        ("staubli 0 0 0 90 0 90", [0, -1, 0]),
    ],
)
def test_by_hand(text, z):
    assert np.abs(frames.bryant(pendants.six(text.split(), "here"))[:3, 2] - z).max() < 1e-5


@pytest.mark.parametrize(
    ("text", "words"),
    [
        ("kuka 1 2 3 4 5", "use the form: kuka X Y Z A B C"),
        ("abb 1 2 3 0.7 0 0.7 0.7", "instead of 1"),
        ("abb 1 2 3 90 0 0", "q1 q2 q3 q4"),
        ("ur 0 0 0 90 0 0", "more than a turn"),
        ("fanuc 1 2 3 4 5 nan", "W P R"),
    ],
)
def test_what_is_no_such_pose_is_told(text, words):
    with pytest.raises(InputError, match=words):
        pendants.six(text.split(), "here")


def test_a_positioner_where_its_pendant_says():
    row = next(row for row in rows(CellParameters) if row.name == "External")
    typed = "motoman-motopos-d500 at 1100 60 -100 kuka 30 0 0 carries part; track at abb, 0, 0, 5, 1, 0, 0, 0 carries robot"
    mechanisms = row.inner(typed, "here")
    text = row.outer(mechanisms)
    assert mechanisms == row.inner(text, "here") and "kuka" not in text
    expected_axes = EXTERNAL.read(
        "motoman-motopos-d500 at 1100 60 -100 0 0 30 carries part; track at 0 0 5 0 0 0 carries robot"
    )
    for axis, expected in zip(EXTERNAL.read(text), expected_axes, strict=True):
        assert (axis.machine, axis.carries) == (expected.machine, expected.carries)
        assert np.allclose(axis.pose, expected.pose, atol=1e-12)
    with pytest.raises(InputError, match="A B C") as raised:
        row.inner("motoman-motopos-d500 at kuka 1 2 3 4 5 carries part", "cell.external")
    assert raised.value.where == "cell.external"
    plain = "m at 1 2 3 0 0 30 carries part"
    assert row.outer(row.inner(plain, "here")) == plain


def test_numbers_that_posts_write_and_pendants_show_are_the_same_ones():
    """Even if only the sum of two angles matters, the pendant's values can be compared with the
    text."""
    for angles in ((30, 90, 10), (-20, -90, 70), (10, 20, 30)):
        turn = Rotation.from_euler("ZYX", angles, degrees=True)
        six = (1.0, 2.0, 3.0, *frames.to_bryant(turn.as_matrix()))
        position = np.array([[1.0, 2.0, 3.0]])
        np.testing.assert_allclose(
            pendants.pendant_values("kuka", six),
            krl.frames(position, turn.as_matrix()[None])[0],
            atol=1e-4,
        )
        np.testing.assert_allclose(
            pendants.pendant_values("fanuc", six),
            tp.poses(position, turn.as_matrix()[None])[0],
            atol=1e-3,
        )
