# SPDX-License-Identifier: LGPL-2.1-or-later
"""The robots that makers describe in public: 95 % of six turning axes are machines with the links that are proposed, and
what the others are refused for is so. The trees are walked here by a reading of their own."""

import collections

import pytest

from freecad_am.core.issues import InputError
from freecad_am.core.kinematics.urdf import machine
from freecad_am.core.kinematics.urdf.read import Urdf
from freecad_am.core.kinematics.urdf.reference import Reference
from tests.core.kinematics.urdf_trees import assert_pose, is_six_axis_arm, is_so, moving
from tests.robust import public_urdfs

LEAST, MAKERS = 0.95, 5


@pytest.mark.long
def test_95_of_100_six_axis_arms_are_read_with_the_tip_proposed(tmp_path):
    arms, read, rest = collections.Counter(), collections.Counter(), []
    for maker, path in public_urdfs.expanded(tmp_path):
        text = path.read_text(encoding="utf-8")
        axes = moving(text)
        six = is_six_axis_arm(axes)
        arms[maker] += six
        try:
            found, arm = machine.describe(Reference(str(path), None, None))
        except InputError as error:
            assert is_so(text, axes, error.message), f"{path.name}: {error.message}"
            rest.append((six, path.name, error.message))
        else:
            assert six and arm is not None, path.name
            assert_pose(text, Urdf(path), found, arm)
            read[maker] += 1
    print(dict(arms), dict(read), *rest, sep="\n")
    assert sum(count > 0 for count in arms.values()) >= MAKERS
    assert sum(read.values()) >= LEAST * sum(arms.values()) > 0
