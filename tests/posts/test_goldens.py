# SPDX-License-Identifier: LGPL-2.1-or-later
"""Golden programs by post, motion and what moves part and robot: for each of these that is written there are golden files,
which are what is written, read back as the numbers that they are of, and with any damage are read as something else or not
at all. The rest is refused with its reason (test_matrix.py). Damaged texts of planned jobs are refused: test_mutations.py.
"""

import dataclasses
import itertools
import zlib

import numpy as np
import pytest

from freecad_am.core.issues import InputError
from freecad_am.posts import catalogue
from tests.posts import (
    test_abb,
    test_abb_process,
    test_fanuc,
    test_fanuc_trigger,
    test_kuka,
    test_nc_posts,
    test_staubli,
    test_ur,
    test_yaskawa,
)
from tests.posts.fanuc_programs import GOLDEN_JOINT, beads
from tests.posts.mutations import KINDS, TRIGGERS, mutated
from tests.posts.test_matrix import OF_ROBOTS, ON_TABLES, REFUSED, SETUPS

PART, TOOL, BOTH, TABLE = "part-on-robot", "tool-on-robot", "track and positioner", "rotary-table"
GROUPED = test_fanuc.two_groups(beads(1, 12, layers=2, max_points=20))
FANUC, ABB, KUKA, YASKAWA, STAUBLI, UR = (
    module.GOLDENS
    for module in (test_fanuc, test_abb, test_kuka, test_yaskawa, test_staubli, test_ur)
)
# of what is written: a program and its golden files, by their names in a folder of tests/golden
GOLDENS = {
    ("fanuc", "joint", PART): (FANUC["joint"], "", "JOINT*.LS"),
    ("fanuc", "joint", TOOL): (FANUC["tool"], "", "TOOL*.LS"),
    ("fanuc", "cartesian", TOOL): (FANUC["table"], "", "TABLE*.LS"),
    ("fanuc", "joint", "positioner"): (GROUPED, "fanuc", "GROUPS*.LS"),
    ("fanuc", "joint", "track"): (test_fanuc.along(GOLDEN_JOINT), "fanuc", "RAIL.LS"),
    ("fanuc", "joint", BOTH): (test_fanuc.along(GROUPED, at=2, name="railgrp"), "fanuc", "RAILGRP*.LS"),
    ("staubli", "joint", PART): (STAUBLI["joint"], "val3/joint", "**/*"),
    ("staubli", "joint", TOOL): (STAUBLI["tool-joint"], "val3/tool-joint", "**/*"),
    ("staubli", "cartesian", PART): (STAUBLI["gauge"], "val3/gauge", "**/*"),
    ("staubli", "cartesian", TOOL): (STAUBLI["tool"], "val3/tool", "**/*"),
    ("ur", "joint", PART): (UR["carried"], "ur", "carried.script"),
    ("ur", "joint", TOOL): (UR["joint"], "ur", "Joint.script"),
    ("ur", "cartesian", TOOL): (UR["table"], "ur", "TABLE.script"),
    ("abb", "joint", PART): (ABB["joint"], "abb/joint", "*"),
    ("abb", "joint", TOOL): (ABB["tool-joint"], "abb/tool-joint", "*"),
    ("abb", "joint", "positioner"): (ABB["positioner-joint"], "abb/positioner-joint", "*"),
    ("abb", "joint", "track"): (ABB["track-joint"], "abb/track-joint", "*"),
    ("abb", "joint", BOTH): (ABB["both-joint"], "abb/both-joint", "*"),
    ("abb", "cartesian", PART): (ABB["held"], "abb/held", "*"),
    ("abb", "cartesian", TOOL): (ABB["tool"], "abb/tool", "*"),
    ("abb", "cartesian", "positioner"): (ABB["positioner"], "abb/positioner", "*"),
    ("abb", "cartesian", "track"): (ABB["track"], "abb/track", "*"),
    ("abb", "cartesian", BOTH): (ABB["both"], "abb/both", "*"),
    ("yaskawa", "joint", PART): (YASKAWA["joint"], "yaskawa", "JOINT*.JBI"),
    ("yaskawa", "joint", TOOL): (YASKAWA["tool"], "yaskawa", "TOOL*.JBI"),
    ("yaskawa", "cartesian", TOOL): (YASKAWA["linear"], "yaskawa", "LINEAR*.JBI"),
    ("yaskawa", "joint", "positioner"): (YASKAWA["station"], "yaskawa", "STATION*.JBI"),
    ("yaskawa", "joint", "track"): (YASKAWA["rail"], "yaskawa", "RAIL*.JBI"),
    ("yaskawa", "joint", BOTH): (YASKAWA["both"], "yaskawa", "BOTH*.JBI"),
    ("kuka", "cartesian", TOOL): (KUKA["whole"], "kuka/whole", "*"),
    ("kuka", "cartesian", "positioner"): (KUKA["positioner"], "kuka/positioner", "*"),
    ("kuka", "cartesian", "track"): (KUKA["track"], "kuka/track", "*"),
    ("kuka", "cartesian", BOTH): (KUKA["both"], "kuka/both", "*"),
    **{(post, motion, TABLE): (test_nc_posts.GOLDENS[name], f"{post}/{name}", "*")
       for post in ON_TABLES for motion, name in (("joint", "joint"), ("cartesian", "tip"))},
}  # fmt: skip
EARLY = test_fanuc_trigger.GOLDENS
# the same with an option
OPTIONAL = {
    **{
        ("fanuc", motion, setup, "trigger"): (EARLY[names], "fanuc", names)
        for motion, setup, names in (
            ("joint", TOOL, "EARLY.LS"),
            ("cartesian", TOOL, "EARLYTAB.LS"),
            ("joint", "positioner", "EARLYGRP*.LS"),
        )
    },
    ("kuka", "cartesian", TOOL, "trigger"): (KUKA["trigger"], "kuka/trigger", "*"),
    ("abb", "cartesian", TOOL, "trigger"): (test_abb_process.GOLDENS["ahead"], "abb/ahead", "*"),
}
ALL = GOLDENS | OPTIONAL
EXTERNAL = {"positioner": {"rotary"}, "track": {"linear"}, BOTH: {"rotary", "linear"}}
IDS = [" ".join(cell) for cell in ALL]
OWN_FRAMES = {("ur", TOOL), ("staubli", PART), ("staubli", TOOL), ("abb", PART)}
LEAST = 10  # kinds of damage that each text has a place for
# of the only place in the text, where the next part says the same again
NO_DAMAGE = {("linuxcnc", "cartesian", TABLE): "the kinematics kept"}


def golden_files(root, folder, names):
    at = root / "tests/golden" / folder
    return {
        path.relative_to(at).as_posix(): path.read_bytes()
        for path in at.glob(names)
        if path.is_file()
    }


def column(of, name):
    return np.concatenate([getattr(run, name) for run in of.moves])


def test_all_that_is_written_has_golden_files_and_the_rest_is_refused():
    cells = set(itertools.product(OF_ROBOTS, ("joint", "cartesian"), SETUPS))
    cells |= set(itertools.product(ON_TABLES, ("joint", "cartesian"), (TABLE,)))
    missing = cells - set(GOLDENS) - set(REFUSED)
    assert not missing, f"{missing} are neither in GOLDENS nor in REFUSED of test_matrix.py"
    assert set(GOLDENS) | set(REFUSED) == cells and not set(GOLDENS) & set(REFUSED)


@pytest.mark.parametrize("cell", ALL, ids=IDS)
def test_golden_files_are_what_is_written_and_come_back_as_its_numbers(root, cell):
    post, motion, setup = cell[:3]
    of, folder, names = ALL[cell]
    assert (of.motion, set(of.external_kinds)) == (motion, EXTERNAL.get(setup, set()))
    assert setup == TABLE or (of.setup == PART) == (setup == PART)
    files = golden_files(root, folder, names)
    assert files and files == catalogue.load(post).write(of)
    read, joints = catalogue.load(post).read(files), column(of, "joints")
    deposit = np.repeat([run.kind == "deposit" for run in of.moves], [len(run) for run in of.moves])
    assert read.deposit.tolist() == deposit.tolist()
    # moves onto beads on which an ABB switches the deposit are linear ones too
    straight = np.repeat(
        [run.interpolation == "linear" for run in of.moves], [len(run) for run in of.moves]
    )
    linear = (deposit | straight) & (motion == "cartesian")
    assert read.linear.tolist() == linear.tolist()
    slides = np.array(
        [
            *(False,) * (joints.shape[1] - len(of.external_kinds)),
            *(kind == "linear" for kind in of.external_kinds),
        ]
    )
    if setup == TABLE:
        slides[:3] = True
    by_joints = (
        ~linear if motion == "cartesian" and post != "yaskawa" else np.ones(len(joints), bool)
    )
    if read.joints is None:
        assert (post, motion) == ("fanuc", "cartesian") or post == "ur"
    else:
        apart = read.joints - joints
        continuous = np.array(of.continuous)
        apart[:, continuous] -= 2.0 * np.pi * np.rint(apart[:, continuous] / (2.0 * np.pi))
        assert np.isfinite(apart[by_joints]).all()
        allowed = np.where(slides, read.linear_digits, read.digits) + 1e-9
        assert (np.nan_to_num(np.abs(apart)) <= allowed).all()
        told = np.isfinite(read.joints[:, len(slides) - len(of.external_kinds) :])
        assert told.all()  # external axes at every move
    # texts of URScript and VAL 3, and of ABB with the part on the robot, tell positions in frames of their own
    if motion == "cartesian" and post != "yaskawa" and (post, setup) not in OWN_FRAMES:
        apart = read.position[deposit] - np.concatenate(
            [run.position for run in of.moves if run.kind == "deposit"]
        )
        assert np.abs(apart).max() <= read.position_digits + 1e-9


def told(read):
    """All that a reader found of the motion, to be compared: damage that moves its lines alone changes nothing."""

    def plain(value):
        if dataclasses.is_dataclass(value):
            return tuple(plain(getattr(value, field.name)) for field in dataclasses.fields(value))
        if isinstance(value, np.ndarray):
            return value.shape, np.nan_to_num(value.astype(float), nan=1e99).tobytes()
        return tuple(map(plain, value)) if isinstance(value, (tuple, list)) else value

    return plain(dataclasses.replace(read, lines=None))


@pytest.mark.parametrize("cell", ALL, ids=IDS)
def test_damaged_golden_files_are_not_read_as_the_same(root, cell):
    post = catalogue.load(cell[0])
    files = golden_files(root, *ALL[cell][1:])
    whole, passed, tried = told(post.read(files)), [], set()
    more = TRIGGERS.get(cell[0], {}) if cell in OPTIONAL else {}
    for kind, (pattern, change) in (KINDS[cell[0]] | more).items():
        damaged = mutated(
            files, pattern, change, np.random.default_rng(zlib.crc32(repr((cell, kind)).encode()))
        )
        if damaged is None or NO_DAMAGE.get(cell) == kind:
            continue
        tried.add(kind)
        try:
            same = told(post.read(damaged)) == whole
        except InputError:
            continue
        passed += [kind] if same else []
    assert not passed
    assert len(tried) >= LEAST and tried >= set(more)
