# SPDX-License-Identifier: LGPL-2.1-or-later
"""The robots in manufacturers' public descriptions: with the proposed links, 95 % of those with six
revolute axes are read as machines, and the reasons for rejecting the others are true. The test
reads the trees independently."""

import collections

import pytest

from freecad_am.core.issues import InputError
from freecad_am.core.kinematics.urdf import machine
from freecad_am.core.kinematics.urdf.read import Urdf
from freecad_am.core.kinematics.urdf.reference import Reference
from tests.core.kinematics.urdf_trees import assert_pose, is_six_axis_arm, is_so, moving
from tests.robust import public_urdfs

MIN_SHARE, MANUFACTURER_COUNT = 0.95, 5


@pytest.mark.long
def test_95_of_100_six_axis_arms_are_read_with_the_tip_proposed(tmp_path):
    arms, read_counts, rejected = collections.Counter(), collections.Counter(), []
    for maker, path in public_urdfs.expanded(tmp_path):
        text = path.read_text(encoding="utf-8")
        axes = moving(text)
        six = is_six_axis_arm(axes)
        arms[maker] += six
        try:
            description, arm = machine.describe(Reference(str(path), None, None))
        except InputError as error:
            assert is_so(text, axes, error.message), f"{path.name}: {error.message}"
            rejected.append((six, path.name, error.message))
        else:
            assert six and arm is not None, path.name
            assert_pose(text, Urdf(path), description, arm)
            read_counts[maker] += 1
    print(dict(arms), dict(read_counts), *rejected, sep="\n")
    assert sum(count > 0 for count in arms.values()) >= MANUFACTURER_COUNT
    assert sum(read_counts.values()) >= MIN_SHARE * sum(arms.values()) > 0
