# SPDX-License-Identifier: LGPL-2.1-or-later
"""Golden programs by post, motion and set-up: each supported combination has golden files that
equal the written ones, read back to the source numbers, and with any damage read as something else
or not at all. Other combinations are rejected with a reason (test_matrix.py); test_mutations.py
damages texts of planned jobs."""

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
GROUPED = test_fanuc.add_second_group(beads(1, 12, layers=2, max_points=20))
FANUC, ABB, KUKA, YASKAWA, STAUBLI, UR = (
    module.GOLDENS
    for module in (test_fanuc, test_abb, test_kuka, test_yaskawa, test_staubli, test_ur)
)
# for each supported combination, a program and the names of its golden files in a folder of
# tests/golden
GOLDENS = {
    ("fanuc", "joint", PART): (FANUC["joint"], "", "JOINT*.LS"),
    ("fanuc", "joint", TOOL): (FANUC["tool"], "", "TOOL*.LS"),
    ("fanuc", "cartesian", TOOL): (FANUC["table"], "", "TABLE*.LS"),
    ("fanuc", "joint", "positioner"): (GROUPED, "fanuc", "GROUPS*.LS"),
    ("fanuc", "joint", "track"): (test_fanuc.put_on_track(GOLDEN_JOINT), "fanuc", "RAIL.LS"),
    ("fanuc", "joint", BOTH): (test_fanuc.put_on_track(GROUPED, axis_index=2, name="railgrp"), "fanuc", "RAILGRP*.LS"),
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
MIN_DAMAGE_KINDS = 10  # each text has matches for at least this many kinds of damage
# at the only match in the text, where the next part states the same again
NO_DAMAGE = {("linuxcnc", "cartesian", TABLE): "the kinematics kept"}


def golden_files(root, folder, names):
    golden_folder = root / "tests/golden" / folder
    return {
        path.relative_to(golden_folder).as_posix(): path.read_bytes()
        for path in golden_folder.glob(names)
        if path.is_file()
    }


def column(source, name):
    return np.concatenate([getattr(run, name) for run in source.moves])


def test_all_that_is_written_has_golden_files_and_the_rest_is_refused():
    cells = set(itertools.product(OF_ROBOTS, ("joint", "cartesian"), SETUPS))
    cells |= set(itertools.product(ON_TABLES, ("joint", "cartesian"), (TABLE,)))
    missing = cells - set(GOLDENS) - set(REFUSED)
    assert not missing, f"{missing} are neither in GOLDENS nor in REFUSED of test_matrix.py"
    assert set(GOLDENS) | set(REFUSED) == cells and not set(GOLDENS) & set(REFUSED)


@pytest.mark.parametrize("cell", ALL, ids=IDS)
def test_golden_files_are_what_is_written_and_come_back_as_its_numbers(root, cell):
    post, motion, setup = cell[:3]
    source, folder, names = ALL[cell]
    assert (source.motion, set(source.external_kinds)) == (motion, EXTERNAL.get(setup, set()))
    assert setup == TABLE or (source.setup == PART) == (setup == PART)
    files = golden_files(root, folder, names)
    assert files and files == catalogue.load(post).write(source)
    readback, joints = catalogue.load(post).read(files), column(source, "joints")
    deposit = np.repeat(
        [run.kind == "deposit" for run in source.moves], [len(run) for run in source.moves]
    )
    assert readback.deposit.tolist() == deposit.tolist()
    # an ABB also approaches beads linearly if it switches the deposit on these moves
    straight = np.repeat(
        [run.interpolation == "linear" for run in source.moves], [len(run) for run in source.moves]
    )
    linear = (deposit | straight) & (motion == "cartesian")
    assert readback.linear.tolist() == linear.tolist()
    slides = np.array(
        [
            *(False,) * (joints.shape[1] - len(source.external_kinds)),
            *(kind == "linear" for kind in source.external_kinds),
        ]
    )
    if setup == TABLE:
        slides[:3] = True
    by_joints = (
        ~linear if motion == "cartesian" and post != "yaskawa" else np.ones(len(joints), bool)
    )
    if readback.joints is None:
        assert (post, motion) == ("fanuc", "cartesian") or post == "ur"
    else:
        errors = readback.joints - joints
        continuous = np.array(source.continuous)
        errors[:, continuous] -= 2.0 * np.pi * np.rint(errors[:, continuous] / (2.0 * np.pi))
        assert np.isfinite(errors[by_joints]).all()
        allowed = np.where(slides, readback.linear_digits, readback.digits) + 1e-9
        assert (np.nan_to_num(np.abs(errors)) <= allowed).all()
        is_stated = np.isfinite(readback.joints[:, len(slides) - len(source.external_kinds) :])
        assert is_stated.all()  # every move states the external axes
    # URScript, VAL 3, and ABB with the part on the robot state positions in frames of their own
    if motion == "cartesian" and post != "yaskawa" and (post, setup) not in OWN_FRAMES:
        errors = readback.position[deposit] - np.concatenate(
            [run.position for run in source.moves if run.kind == "deposit"]
        )
        assert np.abs(errors).max() <= readback.position_digits + 1e-9


def motion_of(readback):
    """Return all that a reader gets of the motion, for comparison; damage that only moves lines
    does not change it."""

    def plain(value):
        if dataclasses.is_dataclass(value):
            return tuple(plain(getattr(value, field.name)) for field in dataclasses.fields(value))
        if isinstance(value, np.ndarray):
            return value.shape, np.nan_to_num(value.astype(float), nan=1e99).tobytes()
        return tuple(map(plain, value)) if isinstance(value, (tuple, list)) else value

    return plain(dataclasses.replace(readback, lines=None))


@pytest.mark.parametrize("cell", ALL, ids=IDS)
def test_damaged_golden_files_are_not_read_as_the_same(root, cell):
    post = catalogue.load(cell[0])
    files = golden_files(root, *ALL[cell][1:])
    intact, passed, kinds_done = motion_of(post.read(files)), [], set()
    trigger_kinds = TRIGGERS.get(cell[0], {}) if cell in OPTIONAL else {}
    for kind, (pattern, change) in (KINDS[cell[0]] | trigger_kinds).items():
        damaged = mutated(
            files, pattern, change, np.random.default_rng(zlib.crc32(repr((cell, kind)).encode()))
        )
        if damaged is None or NO_DAMAGE.get(cell) == kind:
            continue
        kinds_done.add(kind)
        try:
            same = motion_of(post.read(damaged)) == intact
        except InputError:
            continue
        passed += [kind] if same else []
    assert not passed
    assert len(kinds_done) >= MIN_DAMAGE_KINDS and kinds_done >= set(trigger_kinds)
