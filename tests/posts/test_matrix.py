# SPDX-License-Identifier: LGPL-2.1-or-later
"""Every post for robots x motion x set-up: written, and read back and damaged elsewhere (WAYS), or
rejected with a reason before planning."""

import dataclasses
import itertools

import numpy as np
import pytest

from freecad_am.core.issues import InputError
from freecad_am.core.kinematics import cell as cells
from freecad_am.core.parameters.cell import CellParameters
from freecad_am.core.planning.program import external_kinds
from freecad_am.objects.checks import controllers
from freecad_am.posts import catalogue
from tests.posts.planned_jobs import PULSES, WAYS

pytestmark = pytest.mark.any_version

ROBOTS = {  # a robot for each post
    "fanuc": "fanuc-arcmate120ic",
    "staubli": "staubli-rx60bl",
    "ur": "ur-ur10e",
    "abb": "abb-irb1600-6-12",
    "yaskawa": "motoman-ma2010",
    "kuka": "kuka-kr16-2",
}
POSITIONER = "motoman-motopos-d500 at 1100 60 -600 0 0 20 carries part"
TRACK = "kuka-kl100-2 at 0 0 -356 0 0 90 carries robot"
SETUPS = {
    "part-on-robot": {"setup": "part-on-robot"},
    "tool-on-robot": {"setup": "tool-on-robot"},
    "positioner": {"setup": "tool-on-robot", "external": POSITIONER},
    "track": {"setup": "tool-on-robot", "external": TRACK},
    "track and positioner": {"setup": "tool-on-robot", "external": f"{POSITIONER}; {TRACK}"},
}
ON_TABLES = (
    "siemens",
    "linuxcnc",
)  # posts of five-axis machines, which have a test file of their own
# refused combinations, by code and a word of the reason
NOT_WRITTEN, BOTH = ("UNSUPPORTED_AXES", "not written with a"), "track and positioner"
RAIL = {
    "fanuc": "depending on the setup of the rail",
    "yaskawa": "their speed may include this motion",
}
COUPLED = {"fanuc": "the user frame of its positions is not documented", "yaskawa": "SMOVL"}
REFUSED = (
    {
        ("fanuc", "cartesian", "part-on-robot"): (
            "REMOTE_TCP",
            "whose position records (RX RY RZ RW RP RR) are not documented",
        ),
        ("ur", "cartesian", "part-on-robot"): ("REMOTE_TCP", "no documented instruction"),
        ("yaskawa", "cartesian", "part-on-robot"): ("REMOTE_TCP", "external reference point"),
        ("kuka", "joint", "part-on-robot"): ("REMOTE_TCP", "fixed tool"),
        ("kuka", "cartesian", "part-on-robot"): ("REMOTE_TCP", "fixed tool"),
        ("kuka", "joint", "tool-on-robot"): ("JOINT_DEPOSIT", "whole percents"),
        ("kuka", "joint", "positioner"): ("JOINT_DEPOSIT", "whole percents"),
        ("kuka", "joint", "track"): ("JOINT_DEPOSIT", "whole percents"),
        ("kuka", "joint", BOTH): ("JOINT_DEPOSIT", "whole percents"),
    }
    | {(post, "cartesian", "track"): ("COORDINATED_MOTION", word) for post, word in RAIL.items()}
    | {
        (post, "cartesian", setup): ("COORDINATED_MOTION", word)
        for post, word in COUPLED.items()
        for setup in ("positioner", BOTH)
    }
    | {
        (post, motion, setup): NOT_WRITTEN
        for post in ("staubli", "ur")
        for motion in ("joint", "cartesian")
        for setup in ("positioner", "track", BOTH)
    }
)


def refusal(post, motion, setup):
    """Return the error that a program of this kind ends with before planning, None if it is
    written."""
    assert post in ROBOTS, f"name a robot of {post} in ROBOTS, see docs/contributing/post.md"
    cell = cells.resolve(
        CellParameters(machine=ROBOTS[post], mount="part", **SETUPS[setup]),
        np.eye(4),
        "developable",
    )
    if post == "yaskawa":  # only a user's machine file states it
        cell = dataclasses.replace(
            cell,
            machine=dataclasses.replace(
                cell.machine, pulses_per_degree=PULSES[: cell.machine.chain.axes], speed_unit="mm/s"
            ),
        )
    try:
        controllers.check_controller(cell.robot, post)
        controllers.check_external(cell, post)
        controllers.check_wrist(cell.machine, motion, post)
        controllers.check_pulses(cell.machine, motion, post)
        catalogue.load(post).refuse_setup(motion, cell.setup, external_kinds(cell), None)
    except InputError as error:
        return error
    return None


OF_ROBOTS = [post for post in catalogue.NAMES if post not in ON_TABLES]


def test_every_refusal_is_of_a_cell_that_is_looked_at():
    assert set(REFUSED) <= set(itertools.product(OF_ROBOTS, ("joint", "cartesian"), SETUPS))
    silent = set(catalogue.NAMES) - {variant[0] for variant in WAYS}
    assert not silent, f"{silent} write nothing: add their motions to WAYS of planned_jobs.py"


@pytest.mark.parametrize(
    "cell", itertools.product(OF_ROBOTS, ("joint", "cartesian"), SETUPS), ids=" ".join
)
def test_written_or_refused_with_its_reason(cell):
    post, motion, setup = cell
    error = refusal(*cell)
    if error is None:
        variant = (post, motion, "time", f"{post} {setup}")
        assert variant in WAYS, f"add {variant} to WAYS and its cell to SETUPS of planned_jobs.py"
        assert cell not in REFUSED
        return
    assert (post, motion, "time", f"{post} {setup}") not in WAYS
    code, word = REFUSED[cell]
    assert (
        error.code == code and word in error.message and "; " in error.message
    )  # a reason, and the remedy
