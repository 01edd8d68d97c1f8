# SPDX-License-Identifier: LGPL-2.1-or-later
"""The read-back accepts correct programs and catches every single deviation."""

import dataclasses
import re

import numpy as np
import pytest

from freecad_am import verify as verification
from freecad_am.core.geometry import frames
from freecad_am.core.issues import ERROR, InputError
from freecad_am.core.kinematics import cell as cells
from freecad_am.core.kinematics.inverse.spherical_wrist import branch_name
from freecad_am.core.motion import Motion
from freecad_am.core.parameters.cell import CellParameters, NozzleParameters
from freecad_am.core.parameters.process import ProcessParameters
from freecad_am.core.parameters.program import ProgramParameters
from freecad_am.core.program import DepositOff, DepositOn, LayerStart, Moves, Program
from freecad_am.core.read_moves import Event
from freecad_am.posts.fanuc import post as fanuc
from freecad_am.read_back import points, text_path
from freecad_am.read_back.events import _alike
from tests.programs import build

RADIUS, CHORD_ERROR, SPEED, RAPID_SPEED = 45.0, 0.01, 6.0, 100.0
ON_ROBOT = CellParameters(limits="paper")
ON_TABLE = CellParameters(
    limits="paper",
    setup="tool-on-robot",
    deposition_point=(1000.0, 100.0, 0.0, 0.0, 0.0, 0.3),
    branch=("front", "up", "flip"),
    nozzle=NozzleParameters(tool=(20.0, -10.0, 250.0, 0.1, 0.2, 0.3)),
)


def hemisphere(cell, layers=4, step=6.0, offset=0.6):
    """Return the motion of a few layers of a hemisphere with local build directions; axis 6 turns
    several times."""
    columns = {field.name: [] for field in dataclasses.fields(Motion)}
    for layer in range(layers):
        latitude = layer * step / RADIUS
        radius, height = RADIUS * np.cos(latitude), RADIUS * np.sin(latitude)
        count = int(np.ceil(np.pi / np.arccos(1.0 - CHORD_ERROR / radius))) + 1
        theta = np.linspace(0.0, 2.0 * np.pi, count) + 2.0 * np.pi * layer
        around = np.stack((np.cos(theta), np.sin(theta), np.zeros(count)), axis=1)
        points = radius * around + [0.0, 0.0, height]
        tool = -np.sin(latitude) * around + [0.0, 0.0, np.cos(latitude)]
        lifted = points[:1] + 20.0 * tool[:1]
        rows = np.r_[0, 0, np.arange(count)]
        columns["position"].append(np.vstack((lifted, points[:1], points)))
        columns["tool"].append(tool[rows])
        columns["joints"].append(theta[rows])
        columns["deposit"].append(np.r_[False, False, np.ones(count, bool)])
        columns["point"].append(np.r_[0, 0, np.arange(count)])
        columns["layer"].append(np.full(count + 2, layer))
    columns = {name: np.concatenate(blocks) for name, blocks in columns.items() if blocks}
    flange = cell.flange_poses(columns["position"], columns["tool"], offset - columns.pop("joints"))
    joints = np.unwrap(cell.machine.opw.inverse_branch(flange, cell.branch), axis=0)
    assert np.isfinite(joints).all()
    deposit = columns["deposit"]
    speed = np.where(deposit, SPEED, RAPID_SPEED)
    length = np.r_[0.0, np.linalg.norm(np.diff(columns["position"], axis=0), axis=1)]
    return Motion(
        **columns,
        bead=np.zeros_like(columns["layer"]),
        build=columns["tool"].copy(),
        speed=speed,
        width=np.full(len(deposit), np.nan),
        joints=joints,
        duration=length / speed,
    )


def program_of(path, cell, **options):
    """Return the program of a motion: for each layer, a run of rapids and then a bead."""
    blocks, endless = [], np.array([False] * 5 + [True])
    cartesian = options.get("motion") == "cartesian"
    for layer in np.unique(path.layer):
        blocks.append(LayerStart(int(layer)))
        for kind in ("rapid", "deposit"):
            rows = (path.layer == layer) & (path.deposit == (kind == "deposit")) & path.moves
            extra = {}
            if cartesian:
                flange = cell.machine.chain.forward(path.joints[rows])
                in_frame = np.linalg.inv(cell.poses.station) @ flange @ cell.poses.carried
                extra = {
                    "position": in_frame[:, :3, 3],
                    "rotation": in_frame[:, :3, :3],
                    "configuration": (branch_name(cell.branch),) * int(rows.sum()),
                    "interpolation": "linear" if kind == "deposit" else "joint",
                }
            controller_joints = cell.machine.to_controller(path.joints[rows])
            moves = Moves(
                kind,
                int(layer),
                0,
                controller_joints,
                path.duration[rows],
                path.speed[rows],
                **extra,
            )
            blocks += [DepositOn(0.5), moves, DepositOff(0.2)] if kind == "deposit" else [moves]
    return Program(
        "hemisphere", cell.machine.title, tuple(blocks), tuple(endless.tolist()), **options
    )


@pytest.fixture(scope="module")
def cell():
    return cells.resolve(ON_ROBOT, np.eye(4))


@pytest.fixture(scope="module")
def motion(cell):
    return hemisphere(cell)


@pytest.fixture(scope="module")
def program(cell, motion):
    return program_of(motion, cell)


@pytest.fixture(scope="module")
def files(program):
    return fanuc.write(program)


def codes(result):
    return {issue.code for issue in result.issues if issue.level == ERROR}


def verify(cell, motion, program, files):
    return verification.verify(cell, motion, program, files, fanuc, CHORD_ERROR)


def edited(files, pattern, replacement, count=1):
    """Return the files with the first matches of a pattern replaced; the pattern must match."""
    (name,) = files
    text, match_count = re.subn(pattern, replacement, files[name].decode("ascii"), count=count)
    assert match_count
    return {name: text.encode("ascii")}


def test_a_correct_program_passes_with_both_solvers(cell, motion, program, files):
    result = verify(cell, motion, program, files)
    assert result.issues == () and result.solvers == ("chain", "pykdl")
    # half a thousandth of a degree in six joints moves the tip by some hundredths of a millimetre
    assert 1e-4 < result.at_points_mm < result.bound_mm < 0.06
    assert 0.5 * CHORD_ERROR < result.between_mm < CHORD_ERROR + result.bound_mm


def test_a_program_in_parts_passes(cell, motion, program):
    files = fanuc.write(dataclasses.replace(program, max_points=150))
    assert len(files) > 2 and verify(cell, motion, program, files).issues == ()


def test_a_dry_run_passes_and_differs_in_the_deposit_alone(cell, motion, program, files):
    dry = dataclasses.replace(program, dry_run=True)
    assert verify(cell, motion, dry, fanuc.write(dry)).issues == ()
    # the lead times shift with it
    assert codes(verify(cell, motion, dry, files)) == {"VERIFY_DEPOSIT", "VERIFY_WAIT"}
    assert codes(verify(cell, motion, program, fanuc.write(dry))) == {
        "VERIFY_DEPOSIT",
        "VERIFY_WAIT",
    }


@pytest.mark.parametrize("axis", range(6))
@pytest.mark.parametrize("change", [0.02, -0.02])
def test_one_joint_moved_is_caught_at_its_point(cell, motion, program, axis, change):
    moves = program.blocks[3]
    joints = moves.joints.copy()
    joints[70, axis] += np.radians(change)
    blocks = (*program.blocks[:3], dataclasses.replace(moves, joints=joints), *program.blocks[4:])
    result = verify(cell, motion, program, fanuc.write(dataclasses.replace(program, blocks=blocks)))
    for code in {
        "VERIFY_JOINT",
        *(["VERIFY_POINT"] if axis < 5 else []),
    }:  # axis 6 may move by what the rounding explains
        first_issue = next(candidate for candidate in result.issues if candidate.code == code)
        assert (first_issue.layer, first_issue.bead, first_issue.point) == (0, 0, 71)


def test_a_point_left_out_is_caught(cell, motion, program, files):
    assert codes(verify(cell, motion, program, edited(files, r" *\d+:J P\[80\][^\n]*\n", ""))) == {
        "VERIFY_COUNT"
    }


def test_a_point_left_out_with_another_one_repeated_is_caught(cell, motion, program, files):
    assert "VERIFY_POINT" in codes(
        verify(cell, motion, program, edited(files, r"J P\[80\]", "J P[81]"))
    )


def test_the_deposit_switched_at_the_wrong_place_is_caught(cell, motion, program, files):
    swapped = edited(files, r"DO\[1\]=ON", "DO[1]=OFF")
    result = verify(cell, motion, program, swapped)
    assert codes(result) == {"VERIFY_DEPOSIT"}
    assert [(i.layer, i.bead, i.point) for i in result.issues] == [(0, 0, 1)]


def test_the_deposit_switched_one_move_late_is_caught(cell, motion, program, files):
    late = edited(
        files, r"(  DO\[1\]=ON ;\r\n)( *\d+:  WAIT[^\n]*\n)( *\d+:)(J [^\n]*\n)", r"\4\2\3\1"
    )
    result = verify(cell, motion, program, late)
    assert [(i.code, i.layer, i.bead, i.point) for i in result.issues] == [
        ("VERIFY_DEPOSIT", 0, 0, 1), ("VERIFY_WAIT", 0, 0, 1),
    ]  # fmt: skip


def test_a_time_halved_is_caught(cell, motion, program, files):
    milliseconds = int(re.search(r"J P\[90\] (\d+)msec", files["HEMISPHERE.LS"].decode())[1])
    halved = edited(files, r"J P\[90\] \d+msec", f"J P[90] {milliseconds // 2}msec")
    assert codes(verify(cell, motion, program, halved)) == {"VERIFY_TIME"}
    percent = edited(files, r"J P\[90\] \d+msec", "J P[90] 50%")
    assert codes(verify(cell, motion, program, percent)) == {"VERIFY_TIME"}


def test_times_that_are_off_by_a_millisecond_each_are_caught_in_the_bead(
    cell, motion, program, files
):
    text = files["HEMISPHERE.LS"].decode()
    slowed = re.sub(r"(\d+)msec CNT", lambda m: f"{int(m[1]) + 1}msec CNT", text)
    assert codes(verify(cell, motion, program, {"HEMISPHERE.LS": slowed.encode()})) == {
        "VERIFY_TIME"
    }


def test_times_that_are_each_within_a_millisecond_are_caught_where_they_add_up(
    cell, motion, program, files
):
    """Millisecond rounding forgives every move of a bead, but 200 moves that are all too long add
    up to a tenth of a second and are caught."""
    text = files["HEMISPHERE.LS"].decode()
    laid = [
        block for block in program.blocks if isinstance(block, Moves) and block.kind == "deposit"
    ]
    planned = iter(np.concatenate([moves.duration for moves in laid]))

    def longer(slowed):
        return f"{int(np.ceil(1000.0 * next(planned) - 1e-6))}msec"

    slowed = re.sub(r"(\d+)msec(?= CNT)|(\d+)msec(?= FINE    ;\r\n *\d+:  WAIT)", longer, text)
    assert next(planned, None) is None and slowed != text
    result = verify(cell, motion, program, {"HEMISPHERE.LS": slowed.encode()})
    assert codes(result) == {"VERIFY_TIME"} and "do not add up" in result.issues[0].message


def test_layers_in_the_wrong_order_are_caught(cell, motion, program):
    files = fanuc.write(dataclasses.replace(program, max_points=150))
    swaps = {b"CALL HEMISPHERE01": b"CALL HEMISPHERE02", b"CALL HEMISPHERE02": b"CALL HEMISPHERE01"}
    files["HEMISPHERE.LS"] = re.sub(
        rb"CALL HEMISPHERE0[12]", lambda m: swaps[m[0]], files["HEMISPHERE.LS"]
    )
    assert "VERIFY_POINT" in codes(verify(cell, motion, program, files))


def test_a_path_that_bulges_between_its_points_is_caught(cell, motion, program):
    """Only every third point of a bead is on the circle, so the path between the points exceeds the
    chord error."""
    selected = ~motion.deposit | (motion.point % 3 == 0)
    thin = Motion(
        **{f.name: np.array(getattr(motion, f.name)[selected]) for f in dataclasses.fields(Motion)}
    )
    length = np.r_[0.0, np.linalg.norm(np.diff(thin.position, axis=0), axis=1)]
    thin = dataclasses.replace(thin, duration=length / thin.speed)
    coarse = program_of(thin, cell)
    result = verify(cell, thin, coarse, fanuc.write(coarse))
    assert codes(result) == {"VERIFY_BETWEEN"} and result.between_mm > 5.0 * CHORD_ERROR


def test_another_cell_than_the_planned_one_is_caught(cell, motion, program, files):
    moved = dataclasses.replace(
        cell,
        poses=dataclasses.replace(cell.poses, carried=cell.poses.carried + np.eye(4, k=3) * 0.1),
    )
    assert "VERIFY_POINT" in codes(verify(moved, motion, program, files))


def test_the_pendant_angle_of_axis_3_counts(cell, motion, program):
    """A program made from serial angles instead of controller angles fails the check."""
    blocks = tuple(
        dataclasses.replace(block, joints=cell.machine.from_controller(block.joints))
        if isinstance(block, Moves)
        else block
        for block in program.blocks
    )
    wrong = fanuc.write(dataclasses.replace(program, blocks=blocks))
    assert "VERIFY_POINT" in codes(verify(cell, motion, program, wrong))


def test_text_that_is_not_understood_is_refused(cell, motion, program, files):
    with pytest.raises(InputError) as raised:
        verify(cell, motion, program, edited(files, r"UTOOL_NUM=1", "OVERRIDE=100%"))
    assert (
        raised.value.code == "UNREADABLE_PROGRAM" and raised.value.where == "HEMISPHERE.LS line 23"
    )


def test_one_solver_alone_is_said(cell, motion, program, files, monkeypatch):
    monkeypatch.setattr(points.kdl_chain, "available", lambda: False)
    result = verify(cell, motion, program, files)
    assert [(i.level, i.code) for i in result.issues] == [("note", "VERIFY_ONE_SOLVER")]
    assert result.solvers == ("chain",)


def test_solvers_that_disagree_are_caught(cell, motion, program, files, monkeypatch):
    class Off(points.kdl_chain.KdlArm):
        def forward(self, q):
            poses = super().forward(q)
            poses[17, 0, 3] += 1e-4
            return poses

    monkeypatch.setattr(points.kdl_chain, "KdlArm", Off)
    result = verify(cell, motion, program, files)
    assert codes(result) == {"VERIFY_SOLVERS"}


def test_the_bound_holds_and_is_tight_for_random_machines():
    """Rounded joint values never move the tip further than the bound, and in the worst case nearly
    as far."""
    rng = np.random.default_rng(11)
    cell = cells.resolve(ON_TABLE, np.eye(4))
    half = np.radians(0.0005)
    corners = np.array(np.meshgrid(*[[-1.0, 1.0]] * 6)).reshape(6, -1).T * half
    for controller_joints in rng.uniform(-2.0, 2.0, (20, 6)):
        path, _ = text_path.joint_path(cell, controller_joints[None], np.full(6, half))
        turned = cell.machine.chain.forward(
            cell.machine.from_controller(controller_joints + corners)
        )
        tips, tools = cell.tip_in_part(turned)
        off = np.linalg.norm(tips - path.position, axis=1).max()
        tilt = np.linalg.norm(tools - path.tool, axis=1).max()
        assert 0.3 * path.bound[0] < off <= path.bound[0]
        assert 0.2 * path.tool_bound[0] < tilt <= path.tool_bound[0]


def test_a_rapid_that_leaves_its_way_is_caught_even_where_coarse_digits_explain_it(
    cell, motion, program, files
):
    """Near a singularity the last digit of an axis turns other axes far, but a rapid that deviates
    by half a millimetre is caught: this would use up clearance."""

    class Coarse:
        @staticmethod
        def read(program_files):
            return dataclasses.replace(fanuc.read(program_files), digits=np.radians(0.1))

    assert verification.verify(cell, motion, program, files, Coarse, CHORD_ERROR).issues == ()
    moves = program.blocks[6]
    assert moves.kind == "rapid"
    joints = moves.joints.copy()
    joints[-1, 0] += np.radians(0.04)
    blocks = (*program.blocks[:6], dataclasses.replace(moves, joints=joints), *program.blocks[7:])
    changed_files = fanuc.write(dataclasses.replace(program, blocks=blocks))
    result = verification.verify(cell, motion, program, changed_files, Coarse, CHORD_ERROR)
    assert codes(result) == {"VERIFY_BETWEEN"} and "between two beads" in result.issues[0].message


def short_of(cell, axis, upper):
    """Return the cell with another upper limit of an axis, in rad."""
    ends = cell.limits.upper.copy()
    ends[axis] = upper
    return dataclasses.replace(cell, limits=dataclasses.replace(cell.limits, upper=ends))


@pytest.mark.parametrize("axis", range(6))
@pytest.mark.parametrize("cartesian", [False, True], ids=["joint", "cartesian"])
def test_a_text_that_leads_beyond_a_limit_is_caught_at_its_point(
    cell, motion, program, files, table, axis, cartesian
):
    """Limits hold for rapids too. The check allows half of the last digit of rounded joint values,
    and for positions the error that their rounding explains."""
    if cartesian:
        cell, motion, program = table
        files = fanuc.write(program)
    rows = np.flatnonzero(motion.moves)
    maximum = motion.joints[rows, axis].max()
    assert verify(short_of(cell, axis, maximum + 1e-6), motion, program, files).issues == ()
    result = verify(short_of(cell, axis, maximum - np.radians(0.01)), motion, program, files)
    assert codes(result) == {"VERIFY_LIMIT"}
    (issue,) = result.issues
    first_row = rows[np.argmax(motion.joints[rows, axis] > maximum - np.radians(0.01))]
    assert (issue.layer, issue.bead) == (motion.layer[first_row], motion.bead[first_row])
    assert issue.message.startswith(f"the program moves {cell.limits.labels[axis]} up to 0.0")


@pytest.fixture(scope="module")
def table():
    cell = cells.resolve(ON_TABLE, np.eye(4))
    motion = hemisphere(cell, layers=2, offset=1.0)
    return cell, motion, program_of(motion, cell, motion="cartesian", setup="tool-on-robot")


def test_cartesian_programs_pass(table):
    cell, motion, program = table
    result = verify(cell, motion, program, fanuc.write(program))
    assert result.issues == () and 0.0 < result.at_points_mm <= result.bound_mm < 0.001


@pytest.mark.parametrize(
    ("word", "code"),
    [
        ("X", "VERIFY_POINT"),
        ("Z", "VERIFY_POINT"),
        ("W", "VERIFY_TOOL"),
        ("P", "VERIFY_TOOL"),
        ("R", "VERIFY_TOOL"),
    ],
)
def test_cartesian_positions_that_are_off_are_caught(table, word, code):
    cell, motion, program = table
    text = fanuc.write(program)["HEMISPHERE.LS"].decode()
    moved = re.sub(
        rf"(?<=\t){word} = *(-?\d*\.\d+)", lambda m: f"{word} ={float(m[1]) + 0.02:10.3f}", text
    )
    # the rapids also deviate, as far as the rounding shows
    issue_codes = codes(verify(cell, motion, program, {"HEMISPHERE.LS": moved.encode()})) - {
        "VERIFY_BETWEEN"
    }
    assert issue_codes == ({code, "VERIFY_ROTATION"} if word in "WPR" else {code})


def test_a_tool_turned_about_its_own_axis_is_caught(table):
    cell, motion, program = table
    text = fanuc.write(program)["HEMISPHERE.LS"].decode()
    upright = re.search(
        r"\tR = *(-?\d*\.\d+) deg", text
    )  # the tool is vertical in the first layer, so R turns about the tool
    moved = text[: upright.start(1)] + f"{float(upright[1]) + 1.0:.3f}" + text[upright.end(1) :]
    assert codes(verify(cell, motion, program, {"HEMISPHERE.LS": moved.encode()})) == {
        "VERIFY_ROTATION"
    }


def test_cartesian_speeds_that_are_off_are_caught(table):
    cell, motion, program = table
    files = edited(fanuc.write(program), r"6\.0mm/sec", "6.6mm/sec")
    assert codes(verify(cell, motion, program, files)) == {"VERIFY_SPEED"}


def test_cartesian_rapids_that_are_faster_are_caught(table):
    cell, motion, program = table
    files = edited(fanuc.write(program), r"J P\[2\] \d+msec", "J P[2] 20msec")
    assert codes(verify(cell, motion, program, files)) == {"VERIFY_TIME"}


def test_joint_programs_with_the_tool_on_the_robot_pass(table):
    cell, motion, program = table
    blocks = tuple(
        dataclasses.replace(block, interpolation="joint") if isinstance(block, Moves) else block
        for block in program.blocks
    )
    joint = dataclasses.replace(program, motion="joint", blocks=blocks)
    result = verify(cell, motion, joint, fanuc.write(joint))
    assert codes(result) <= {
        "VERIFY_BETWEEN"
    }  # joint moves are not straight, so the check would need more points
    assert result.at_points_mm <= result.bound_mm


def test_the_program_origin_moves_the_user_frame_and_nothing_else(table):
    """Another origin changes the positions in the text, but not those in space with the user frame
    of the remarks."""
    cell, motion, _ = table
    spots = []
    for origin in ("auto", (10.0, -20.0, 5.0, 0.2, -0.1, 0.4)):
        parameters = ProgramParameters(motion="cartesian", origin=origin)
        program = build(motion, cell, ProcessParameters(), parameters, "origin")
        files = fanuc.write(program)
        assert verify(cell, motion, program, files).issues == ()
        readback = fanuc.read(files)
        user = frames.bryant(program.station)
        spots.append((readback.position, readback.position @ user[:3, :3].T + user[:3, 3]))
        remark = b"User frame" if origin != "auto" else b"Platform"
        assert remark in files["ORIGIN.LS"]
    assert np.abs(spots[0][0] - spots[1][0]).max() > 5.0
    assert np.abs(spots[0][1] - spots[1][1]).max() < 2e-3
    # a user frame other than that in the remarks is caught
    wrong = dataclasses.replace(
        program, station=(*program.station[:2], program.station[2] + 0.1, *program.station[3:])
    )
    assert "VERIFY_POINT" in codes(verify(cell, motion, wrong, files))


@pytest.mark.parametrize(
    ("told", "meant", "alike"),
    [
        ("0.001", 0.0001, True),
        ("0.010", 0.0001, False),
        ("0.500", 0.5004, True),
        ("0.500", 0.52, False),
        ("2.5", 2.5, True),
    ],
)
def test_a_wait_is_told_to_its_last_digit(told, meant, alike):
    """The check compares a wait to its last digit: half a digit is rounding, anything more is an
    error."""
    half = 0.5 * 10.0 ** -len(told.split(".")[1])
    event, expected_event = (Event(3, "wait", (value,), half) for value in (told, meant))
    assert _alike(None, event, expected_event) is alike


class _Standing:
    """Select the rows of a text that both solvers check."""

    def __init__(self, joints):
        self.joints = joints

    def issue(self, code, wrong, message):
        return [(code, np.flatnonzero(wrong))] if wrong.any() else []


@pytest.fixture(scope="module")
def long_text(cell):
    """Return joint values of more rows than PyKDL checks, in a corner of their ranges with axis 1
    at 0."""
    joints = np.random.default_rng(8).uniform(0.0, 0.1, (points.ROW_STRIDE * 3**6 + 5, 6)) * [
        0.0,
        1.0,
        1.0,
        1.0,
        1.0,
        1.0,
    ]
    return _Standing(joints), cell.machine.to_controller(joints), cell.machine.chain.forward(joints)


def test_of_a_long_text_some_rows_are_driven_by_the_second_solver(cell, long_text, monkeypatch):
    driven = []

    class Counted(points.kdl_chain.KdlArm):
        def forward(self, q):
            driven.append(len(q))
            return super().forward(q)

    monkeypatch.setattr(points.kdl_chain, "KdlArm", Counted)
    assert points.second_opinion(cell, *long_text) == ([], ("chain", "pykdl"))
    assert (
        3**6 + len(long_text[1]) / points.ROW_STRIDE
        <= sum(driven)
        <= 3**6 + len(long_text[1]) / points.ROW_STRIDE + 1
    )


@pytest.mark.parametrize("axis", range(6))
def test_solvers_that_disagree_elsewhere_are_caught_by_any_long_text(
    cell, long_text, monkeypatch, axis
):
    """The solvers differ by at most a tenth of a micrometre, depending on one axis, and not at all
    on a text that keeps this axis at zero."""
    planned, _, _ = long_text
    joints = planned.joints.copy()
    joints[:, axis] = 0.0

    class Off(points.kdl_chain.KdlArm):
        def forward(self, q):
            poses = super().forward(q)
            poses[:, 1, 3] += 1e-4 * np.sin(np.asarray(q)[:, axis])
            return poses

    text = _Standing(joints), cell.machine.to_controller(joints), cell.machine.chain.forward(joints)
    monkeypatch.setattr(points.kdl_chain, "KdlArm", Off)
    monkeypatch.setattr(points, "ROW_STRIDE", 1)
    ((code, wrong),) = points.second_opinion(cell, *text)[0]
    assert code == "VERIFY_SOLVERS" and len(wrong) == len(joints)


def test_a_row_that_is_driven_wrongly_is_caught_in_a_long_text(cell, long_text, monkeypatch):
    planned, controller_joints, flange = long_text
    turned = flange.copy()
    turned[4000, 0, 0] += 1e-8
    ((code, wrong),) = points.second_opinion(cell, planned, controller_joints, turned)[0]
    assert code == "VERIFY_SOLVERS" and wrong.tolist() == [4000]


def test_what_differs_on_the_grid_bounds_what_differs_anywhere(cell):
    """The difference on the grid bounds the difference anywhere, for random sums of constants,
    sines and cosines of degree one in three angles, on a grid of a tenth of a radian."""
    rng, joints = np.random.default_rng(12), np.zeros((1, 6))
    grid = points.grid_of(cell.machine.chain, joints)
    assert len(grid) == 3**6
    fine = np.stack(np.meshgrid(*[np.arange(0.0, 6.3, 0.1)] * 3, indexing="ij"), axis=-1).reshape(
        -1, 3
    )

    def value(q, factors):
        terms = np.stack([np.ones_like(q), np.cos(q), np.sin(q)])
        return np.einsum("an,bn,cn,abc->n", *(terms[:, :, k] for k in range(3)), factors)

    for _ in range(20):
        factors = rng.normal(size=(3, 3, 3))
        largest, on_grid = (np.abs(value(q, factors)).max() for q in (fine, grid[:, :3]))
        assert on_grid <= largest * (1.0 + 1e-2) and largest <= points.GRID_TO_ALL**3 * on_grid
