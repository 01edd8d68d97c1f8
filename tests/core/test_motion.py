# SPDX-License-Identifier: LGPL-2.1-or-later
"""Roles of the rows of a motion."""

import numpy as np
import pytest

from freecad_am.core.motion import APPROACH, DEPOSIT, RETRACT, TRAVEL, Motion

LETTERS = {"D": DEPOSIT, "R": RETRACT, "T": TRAVEL, "A": APPROACH}


def motion(letters, **columns):
    """Rows of the roles given by letters; a bead begins at a D after another letter."""
    role = np.array([LETTERS[letter] for letter in letters if letter != "|"])
    deposit, n = role == DEPOSIT, len(role)
    point = np.zeros(n, dtype=int)
    for row in range(1, n):
        point[row] = point[row - 1] + 1 if deposit[row] == deposit[row - 1] else 0
    vectors = np.zeros((n, 3))
    return role, Motion(
        deposit=deposit,
        layer=np.zeros(n, int),
        bead=np.zeros(n, int),
        point=point,
        position=vectors,
        build=vectors,
        tool=vectors,
        speed=np.ones(n),
        width=np.ones(n),
        joints=np.zeros((n, 6)),
        duration=np.ones(n),
        **columns,
    )


@pytest.mark.parametrize(
    "letters",
    ["TADDD", "TADDRTADDR", "TADDRTTTADDRTADDR", "TDDTDD", "TDDTTDD", "DDDD", "DDRTAD", "DRTADR"],
)
def test_a_motion_without_roles_has_those_of_one_retract_and_one_approach_row(letters):
    role, made_motion = motion(letters)
    assert made_motion.role.dtype == np.int64 and made_motion.role.tolist() == role.tolist()


def test_it_stops_at_every_rapid_row_and_at_the_end_of_every_bead():
    _, made_motion = motion("TRADDDRRTADDR")
    assert made_motion.stops.tolist() == [letter != "D" for letter in "TRADD"] + [True] * 5 + [
        False,
        True,
        True,
    ]


def test_roles_must_be_as_long_as_the_rest():
    with pytest.raises(ValueError, match="role"):
        motion("TADD", role=np.zeros(3, int))
