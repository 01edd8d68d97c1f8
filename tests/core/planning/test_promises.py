# SPDX-License-Identifier: LGPL-2.1-or-later
"""Every promise of the preflight is broken once by a single change of the evidence: the preflight
reports the change at its position and nothing else. Issues of planning stay empty."""

import dataclasses

import numpy as np
import pytest
from scipy.spatial import cKDTree

from freecad_am.core.issues import NOTE, WARNING, Issue
from freecad_am.core.parameters.joints import JointParameters
from freecad_am.core.parameters.process import ProcessParameters
from freecad_am.core.planning.motion import assemble
from freecad_am.core.planning.plan import plan_joints
from freecad_am.core.preflight.checks import Evidence, ReadBack, promises
from freecad_am.core.process.deposit.balance import Balance
from freecad_am.core.simulation.rapid_contacts import looked_at
from freecad_am.core.simulation.watch import ArmTouches
from freecad_am.core.strategies.clearance import nozzle_check

WIDTH, HEIGHT = 3.0, 10.0
LINKS = ("base", "q1", "q2", "q3", "q4", "q5", "q6", "part", "nozzle")
ROW = 300  # of the deposit, the changed row


@pytest.fixture(scope="module")
def sound(sliced, cell_of):
    """A cell, joint path, and evidence of a sound job with the whole motion."""
    toolpath = sliced("sphere", HEIGHT)
    toolpath = dataclasses.replace(
        toolpath.add_checks(on_part=(500.0, 0.01, 0.2), unsupported=0.0),
        wire_feed=None,
        bead_width=WIDTH,
    )
    cell = cell_of(toolpath)
    path = plan_joints(toolpath, cell, JointParameters())
    process = dataclasses.replace(ProcessParameters(), bead_width=WIDTH)
    motion, issues = assemble(path, cell, process, (), None, HEIGHT)
    assert not issues and path.feasible
    n = len(motion)
    fed = WIDTH * HEIGHT * process.travel_speed / process.wire.section
    return (
        cell,
        path,
        Evidence(
            dataclasses.replace(toolpath, wire_feed=fed),
            process,
            (),
            cell,
            motion,
            np.full(n, 0.3),
            np.full(n, 0.1),
            ArmTouches(np.full(n, -1), np.full(n, -1), ("platform",), 0.02, LINKS),
            True,
            ReadBack(True, 1e-3, 0.01, 2e-3, 0.05, 2),
            ("UFRAME 1",),
            None,
            Balance("Part", 1e5, 0.0, 1e5, 0.0, twice=0.0),
            nozzle_check.Looked(100, 0, None),
            check_rapids(cell, path, motion),
        ),
    )


def check_rapids(cell, path, motion, up=0.0):
    """Contacts on rapids, with the beads raised."""
    beads = [
        dataclasses.replace(bead_path.bead, points=bead_path.bead.points + [0.0, 0.0, up])
        for bead_path in path.beads
    ]
    return looked_at(motion, beads, cell, (), WIDTH, HEIGHT, 20_000)


def broken(evidence):
    """The promises that are not kept."""
    return {entry.promise: entry for entry in promises(evidence) if entry.ok is False}


def place_of(motion, row):
    return (int(motion.layer[row]), int(motion.bead[row]), int(motion.point[row]))


def changed(motion, row, **columns):
    """The motion with other values in a row."""
    new = {name: getattr(motion, name).copy() for name in columns}
    for name, value in columns.items():
        new[name][row] = value
    return dataclasses.replace(motion, **new)


def test_a_sound_job_keeps_all_promises_and_says_what_was_not_checked(sound):
    entries = promises(sound[2])
    assert not broken(sound[2])
    # the robot's file has no payload
    unchecked = {entry.promise for entry in entries if entry.ok is None}
    assert unchecked == {"UFRAME 1", "Robot or positioner can carry the part"}
    assert all(entry.worst is not None for entry in entries if entry.ok)


@pytest.mark.parametrize("role", [0, 1, 2, 3])
def test_a_row_beyond_a_limit(sound, role):
    cell, _, evidence = sound
    motion = evidence.motion
    row = int(np.flatnonzero(motion.role == role)[5])
    joints = motion.joints[row].copy()
    joints[1] = cell.limits.upper[1] + np.radians(0.5)
    broken_promises = broken(
        dataclasses.replace(evidence, motion=changed(motion, row, joints=joints))
    )
    entry = broken_promises["Every axis stays within its limits"]
    assert tuple(entry.place) == place_of(motion, row) and entry.worst == pytest.approx(
        -0.5, abs=1e-6
    )


def test_joints_that_lead_elsewhere(sound):
    evidence = sound[2]
    motion = evidence.motion
    row = int(np.flatnonzero(motion.deposit)[ROW])
    joints = motion.joints[row] + np.radians([0.0, 0.0, 0.01, 0.0, 0.0, 0.0])
    broken_promises = broken(
        dataclasses.replace(evidence, motion=changed(motion, row, joints=joints))
    )
    entry = broken_promises["The joint values reach every planned point"]
    assert tuple(entry.place) == place_of(motion, row) and 0.01 < entry.worst < 0.5
    unreachable = broken(dataclasses.replace(evidence, motion=changed(motion, row, joints=np.nan)))
    assert tuple(unreachable["The joint values reach every planned point"].place) == place_of(
        motion, row
    )


@pytest.mark.parametrize("rapid", [False, True])
def test_an_axis_asked_for_too_much(sound, rapid):
    cell, _, evidence = sound
    motion = evidence.motion
    rows = np.flatnonzero(motion.deposit != rapid)
    turned = np.abs(np.diff(motion.joints, axis=0, prepend=motion.joints[:1])).max(axis=1)
    row = int(rows[turned[rows] > 1e-4][2])
    share = (np.abs(motion.joints[row] - motion.joints[row - 1]) / cell.machine.max_speed).max()
    broken_promises = broken(
        dataclasses.replace(evidence, motion=changed(motion, row, duration=share / 1.1))
    )
    assert set(broken_promises) == {"No axis exceeds its maximum speed"}
    (entry,) = broken_promises.values()
    assert tuple(entry.place) == place_of(motion, row) and entry.worst == pytest.approx(110.0)


def test_a_nozzle_that_meets_deposit_on_rapids_though_planning_found_nothing(sound):
    cell, path, evidence = sound
    assert (
        evidence.rapids.moves == int((~evidence.motion.deposit[1:]).sum())
        and evidence.rapids.step <= 2.0
    )
    broken_promises = broken(
        dataclasses.replace(evidence, rapids=check_rapids(cell, path, evidence.motion, 25.0))
    )
    assert set(broken_promises) == {"The nozzle stays clear on rapids"}
    (entry,) = broken_promises.values()
    assert entry.worst >= 5.0 and entry.place is not None


def test_layers_that_are_not_one_layer_height_apart(sound):
    """Families report their own spacing; the worst deviation is computed from the beads only."""
    evidence = sound[2]
    for share in (0.5, -0.4):
        shift = share * HEIGHT * np.array([0.0, 0.0, 1.0])
        layers = tuple(
            dataclasses.replace(
                layer,
                beads=tuple(
                    dataclasses.replace(bead, points=bead.points + shift, tangents=None)
                    for bead in layer.beads
                ),
            )
            if number >= 3
            else layer
            for number, layer in enumerate(evidence.toolpath.layers)
        )
        issue = Issue(WARNING, "SPACING", "layers are not one layer height apart", 3)
        broken_promises = broken(
            dataclasses.replace(
                evidence,
                toolpath=dataclasses.replace(evidence.toolpath, layers=layers),
                issues=(issue,),
            )
        )
        assert set(broken_promises) == {"Layers are one layer height apart"}
        (entry,) = broken_promises.values()
        below, above = (np.vstack([bead.points for bead in layers[k].beads]) for k in (2, 3))
        distances = cKDTree(below).query(above)[0]
        assert entry.place[0] == 3 and entry.unit == "mm"
        assert entry.worst == pytest.approx(
            distances[np.argmax(np.abs(distances - HEIGHT))], rel=0.02
        )
    note = Issue(NOTE, "SPACING", "layers are one layer height apart where the wall allows", 3)
    assert not broken(dataclasses.replace(evidence, issues=(note,)))


@pytest.mark.parametrize(
    ("promise", "change"),
    [
        ("The deposit lies on the part", lambda e: {"toolpath": e.toolpath.add_checks(
            on_part=(500.0, 0.21, 0.2))}),
        ("The whole part is deposited", lambda e: {"balance": Balance("Part", 1e5, 3e3, 1e5, 0.0)}),
        ("Nothing is deposited outside the part", lambda e: {"balance": Balance("Part", 1e5, 0.0, 1e5, 3e4)}),
        ("Over-deposition is small", lambda e: {"balance": Balance("Part", 1e5, 0.0, 1e5, 0.0, filled=True, twice=1.1e4)}),
        ("Over-deposition is small", lambda e: {"balance": Balance("Part", None, None, 1e5, twice=1.1e4)}),
        ("Every bead is supported from below", lambda e: {"toolpath": e.toolpath.add_checks(
            unsupported=2.0)}),
        ("The wire feed matches the volume of the beads", lambda e: {"toolpath": dataclasses.replace(
            e.toolpath, wire_feed=1.1 * e.toolpath.wire_feed)}),
        ("The nozzle stays clear of deposit, part and platform while depositing", lambda e: {
            "looked": nozzle_check.Looked(100, 1, (2, 0, 7))}),
        ("The tool stays away from singularities while depositing", lambda e: {"condition": np.where(
            np.arange(len(e.condition)) == 40, 0.05, e.condition)}),
        ("The arm stays clear of part, deposit, platform, nozzle and itself", lambda e: {"arm": ArmTouches(
            np.where(np.arange(len(e.motion)) == 40, 3, -1), np.where(np.arange(len(e.motion)) == 40, 0, -1),
            ("platform",), 0.02, LINKS)}),
        ("The program moves the tool to the planned points", lambda e: {"read": dataclasses.replace(e.read, at_points=3e-3)}),
        ("The program follows the planned path between its points", lambda e: {"read": dataclasses.replace(
            e.read, between=0.06)}),
    ],
)  # fmt: skip
def test_what_is_broken_is_told_and_nothing_else(sound, promise, change):
    evidence = sound[2]
    broken_promises = broken(dataclasses.replace(evidence, **change(evidence)))
    assert set(broken_promises) == {promise}


def test_a_text_that_was_read_back_with_errors_breaks_both_promises_of_it(sound):
    evidence = sound[2]
    broken_promises = broken(
        dataclasses.replace(evidence, read=dataclasses.replace(evidence.read, ok=False))
    )
    assert set(broken_promises) == {
        "The program moves the tool to the planned points",
        "The program follows the planned path between its points",
    }


@pytest.mark.parametrize(
    ("promise", "level", "codes"),
    [
        (
            "The nozzle stays clear on rapids",
            "error",
            ("RAPID_COLLISION", "RAPID_UNREACHABLE", "RAPID_LIMIT", "RAPID_SINGULAR"),
        ),
        (
            "The nozzle stays clear of deposit, part and platform while depositing",
            "error",
            ("CLEARANCE", "OVER_PLATFORM"),
        ),
        ("The whole part is deposited", "warning", ("NOT_DEPOSITED",)),
        ("Nothing is deposited outside the part", "warning", ("DEPOSITED_BESIDE",)),
        ("Over-deposition is small", "warning", ("DEPOSITED_TWICE",)),
        ("Every bead is supported from below", "warning", ("UNSUPPORTED",)),
    ],
)
def test_what_planning_has_found_breaks_its_promise_whatever_the_figures_say(
    sound, promise, level, codes
):
    for code in codes:
        broken_promises = broken(
            dataclasses.replace(sound[2], issues=(Issue(level, code, "as planning says", 3, 0),))
        )
        assert set(broken_promises) == {promise}, code


def without(evidence, **changes):
    """The evidence with parts of its toolpath, or of its cell, replaced."""
    return {
        name: dataclasses.replace(getattr(evidence, name), **values)
        for name, values in changes.items()
    }


@pytest.mark.parametrize(
    ("promise", "change"),
    [
        (
            "The deposit lies on the part",
            lambda e: {"toolpath": e.toolpath.add_checks(on_part=None)},
        ),
        ("The whole part is deposited", lambda e: {"balance": None}),
        ("Nothing is deposited outside the part", lambda e: {"balance": None}),
        ("Nothing is deposited outside the part", lambda e: without(e, balance={"outside": None})),
        (
            "The whole part is deposited",
            lambda e: {"balance": Balance("Part", None, None, 1e5, twice=0.0, lines=True)},
        ),
        ("Over-deposition is small", lambda e: without(e, balance={"twice": None})),
        (
            "Every bead is supported from below",
            lambda e: {"toolpath": e.toolpath.add_checks(unsupported=None)},
        ),
        (
            "The wire feed matches the volume of the beads",
            lambda e: without(e, toolpath={"wire_feed": None}),
        ),
        (
            "The wire feed matches the volume of the beads",
            lambda e: without(e, process={"bead_model": "csw"}),
        ),
        (
            "The nozzle stays clear of deposit, part and platform while depositing",
            lambda e: {"looked": None},
        ),
        ("Every axis stays within its limits", lambda e: {"cell": None}),
        ("The joint values reach every planned point", lambda e: {"motion": None}),
        ("No axis exceeds its maximum speed", lambda e: {"motion": None}),
        ("The tool stays away from singularities while depositing", lambda e: {"condition": None}),
        ("The nozzle stays clear on rapids", lambda e: {"rapids": None}),
        (
            "The arm stays clear of part, deposit, platform, nozzle and itself",
            lambda e: {"arm": None},
        ),
        (
            "The arm stays clear of part, deposit, platform, nozzle and itself",
            lambda e: {"true_shapes": False},
        ),
        ("The program moves the tool to the planned points", lambda e: {"read": None}),
        ("The program follows the planned path between its points", lambda e: {"read": None}),
    ],
)
def test_what_nobody_has_looked_at_is_neither_kept_nor_broken_and_says_so(sound, promise, change):
    entries = {
        entry.promise: entry
        for entry in promises(dataclasses.replace(sound[2], **change(sound[2])))
    }
    assert entries[promise].ok is None and entries[promise].how.startswith("not checked")
    assert entries["UFRAME 1"].ok is None


def test_what_a_machine_file_does_not_tell_is_not_kept(sound):
    evidence = sound[2]
    cell = evidence.cell
    n = cell.machine.chain.axes
    bare = dataclasses.replace(
        cell,
        machine=dataclasses.replace(cell.machine, max_speed=np.full(n, np.inf)),
        limits=dataclasses.replace(
            cell.limits,
            lower=np.full(n, -np.inf),
            upper=np.full(n, np.inf),
            coefficients=np.zeros((0, n)),
            coupled_lower=np.zeros(0),
            coupled_upper=np.zeros(0),
            labels=cell.limits.labels[:n],
        ),
    )
    unknown = np.full(len(evidence.motion), np.nan)
    changed_ = dataclasses.replace(evidence, cell=bare, condition=unknown)
    entries = {entry.promise: entry.ok for entry in promises(changed_)}
    for name in (
        "Every axis stays within its limits",
        "No axis exceeds its maximum speed",
        "The tool stays away from singularities while depositing",
    ):
        assert entries[name] is None, name
