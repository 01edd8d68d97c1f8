# SPDX-License-Identifier: LGPL-2.1-or-later
"""The simulation by clicks: it plays and steps, shows the values of the core, marks faults, and
leaves the view unchanged."""

import dataclasses
import json

import FreeCAD as App
import numpy as np
import pytest

from freecad_am import api
from freecad_am.core.geometry import frames
from freecad_am.core.issues import WARNING, Issue
from freecad_am.core.kinematics import external
from freecad_am.core.planning.beads import steps
from freecad_am.core.simulation.achievable_feed import achievable_feed
from freecad_am.core.simulation.watch import ISSUE, LIMIT, SINGULAR, SLOWED, TOUCHES
from freecad_am.gui.in_language import link_touches
from freecad_am.gui.simulation import dock as docks
from freecad_am.gui.simulation import dock as tool
from freecad_am.gui.simulation import fields
from freecad_am.gui.simulation.dock import SLOW_COLOUR, WRONG_COLOUR
from freecad_am.gui.simulation.player import run_of
from freecad_am.kdl import KdlArm
from freecad_am.objects.joint_path import Planned
from tests.gui.positioner_jobs import make_positioner_job

CELLS = {
    "part-on-robot": {"limits": "paper"},
    "tool-on-robot": {"setup": "tool-on-robot", "deposition_point": (900, 0, -100, 0, 0, 0)},
    "rotary-table": {"machine": "table-xyzac", "setup": "rotary-table"},
}


def job(hemisphere, **cell):
    doc = hemisphere.Document
    feature = api.make_feature(doc, hemisphere, layer_height=15)
    cell_object = api.make_cell(doc, **(cell or CELLS["part-on-robot"]))
    toolpath = api.make_toolpath(doc, feature, cell_object, between_layers_wait=2.0, lead_on=0.5)
    return api.make_joint_path(doc, toolpath, cell_object)


def matrix(transform):
    return np.array(transform.matrix.getValue().getValue()).T


def opened(person, path):
    person.look()
    person.select(path)
    person.click("RoboticAM_Simulate")
    panel = person.panel(docks.NAME)
    person.idle(0.2)  # the camera is turning to show everything
    return panel, docks._open[0]


def camera_state(view):
    """Return the camera without its clipping planes, which follow the visible objects."""
    return [
        line for line in view.getCamera().splitlines() if "Distance" not in line or "focal" in line
    ]


def names_of(graph):
    return [
        graph.getChild(index).getTypeId().getName().getString()
        for index in range(graph.getNumChildren())
    ]


@pytest.mark.parametrize("setup", CELLS)
def test_it_plays_and_everything_is_where_pykdl_puts_it(person, hemisphere, setup):
    path = job(hemisphere, **CELLS[setup])
    panel, simulation = opened(person, path)
    cell, motion, times = simulation.run.cell, simulation.run.motion, simulation.run.times
    arm = KdlArm(cell.machine)
    person.screenshot(f"simulation_{setup}_start")
    person.choose(panel, "factor", "100 ×")
    person.field(panel, "play").click()
    person.until(lambda: simulation.player.time > 0.1 * times.total, "the job to play", 30)
    person.field(panel, "play").click()
    moved = simulation.player.time
    assert moved < times.total
    person.screenshot(f"simulation_{setup}_playing")
    person.idle(0.1)
    assert simulation.player.time == moved  # it pauses
    scene = simulation.scene
    poses = []
    for share in (0.05, 0.2, 0.37, 0.71, 0.93):
        person.field(panel, "time").setValue(round(share * fields.STEPS))
        person.idle(0.05)
        state = times.state_at(simulation.player.time)
        assert simulation.player.time == pytest.approx(share * times.total, rel=1e-3)
        flange = arm.forward([state.joints])[0]
        tip, axis = cell.tip_in_part(flange[None])
        part_pose, nozzle = matrix(scene.part), matrix(scene.nozzle)
        in_part = frames.inverse(part_pose) @ nozzle
        assert (
            np.abs(in_part[:3, 3] - tip[0]).max() < 2e-3
            and np.abs(in_part[:3, 2] - axis[0]).max() < 1e-5
        )
        # in rapid moves the joints determine the path of the tip
        if motion.deposit[int(state.row)]:
            assert np.linalg.norm(tip[0] - state.position) < 0.2
        base, last_link = matrix(scene.machine.transforms[0]), matrix(scene.machine.transforms[-1])
        drawn = frames.inverse(base) @ last_link @ cell.machine.chain.flange
        assert np.abs(drawn - flange).max() < 5e-3
        row = int(state.row)
        deposited = int(motion.deposit[: row if not state.standing else row + 1].sum())
        assert scene.deposit.end == deposited
        bars = person.field(panel, "joints")
        assert all(
            bars.texts(axis)[1].endswith(("°", " mm", "∞")) for axis in range(len(bars.names))
        )
        assert np.abs(bars.values * cell.machine.unit_values - state.joints).max() < 1e-12
        assert np.allclose(
            bars.margins * cell.machine.unit_values,
            cell.limits.margin(state.joints)[: len(bars.margins)],
        )
        poses.append((part_pose, nozzle))
    part_poses, nozzles = (np.array(column) for column in zip(*poses))
    still = {"part-on-robot": nozzles, "tool-on-robot": part_poses}.get(setup)
    if still is not None:
        assert np.ptp(still, axis=0).max() < 1e-6
    assert max(np.ptp(part_poses, axis=0).max(), np.ptp(nozzles, axis=0).max()) > 1.0


def test_it_leaves_the_view_and_the_document_as_they_were(person, hemisphere):
    path = job(hemisphere)
    doc = hemisphere.Document
    person.select(path)  # FreeCAD 1.1 draws a box around a selected object
    person.look()
    view = person.gui.activeDocument().activeView()
    graph = view.getSceneGraph()
    undo, camera, nodes = doc.UndoCount, camera_state(view), names_of(graph)
    visible = {obj.Name: obj.ViewObject.Visibility for obj in doc.Objects}
    switches = {obj.Name: obj.ViewObject.SwitchNode.whichChild.getValue() for obj in doc.Objects}
    doc.saveAs(str(person.folder / "job.FCStd"))
    modified = person.gui.activeDocument().Modified
    picture_before = person.folder / "before.png"
    view.saveImage(str(picture_before), 500, 400, "White")
    panel, _ = opened(person, path)
    assert names_of(graph) != nodes
    person.field(panel, "layer_on").click()
    person.field(panel, "point_on").click()
    person.idle(0.3)
    docks._open[0].dock.close()
    person.idle(0.3)
    assert docks._open == [] and names_of(graph) == nodes
    assert camera_state(view) == camera
    assert {obj.Name: obj.ViewObject.Visibility for obj in doc.Objects} == visible
    assert {
        obj.Name: obj.ViewObject.SwitchNode.whichChild.getValue() for obj in doc.Objects
    } == switches
    assert doc.UndoCount == undo and person.gui.activeDocument().Modified == modified
    picture_after = person.folder / "after.png"
    view.saveImage(str(picture_after), 500, 400, "White")
    assert person.widgets.QImage(str(picture_before)) == person.widgets.QImage(str(picture_after))
    assert [obj.Status for obj in api.stages_of(doc)] == ["up to date"] * 4


def test_steps_go_by_points_and_layers(person, hemisphere):
    path = job(hemisphere)
    panel, simulation = opened(person, path)
    times, motion = simulation.run.times, simulation.run.motion

    def press(name):
        person.field(panel, name).click()
        person.idle(0.02)

    shown_texts = []
    for _ in range(len(times.layer_rows)):
        shown_texts.append(simulation.player.time)
        press("layer_on")
    assert np.allclose(shown_texts, times.arrive[times.layer_rows])
    assert simulation.player.time == times.total
    press("layer_back")
    assert simulation.player.time == pytest.approx(times.arrive[times.layer_rows[-1]])
    for _ in range(4):
        press("point_on")
    row = simulation.player.row
    assert row - times.layer_rows[-1] >= 4 and simulation.player.time == times.arrive[row]
    press("point_back")
    assert simulation.player.time < times.arrive[row]
    place_text = person.field(panel, "place").text()
    layers = simulation.run.times.layers
    assert place_text.startswith(
        f"Layer {motion.layer[simulation.player.row]} (0 to {layers[-1]}), bead "
    )
    texts = [
        label.text() for label in person.field(panel, "totals").findChildren(person.widgets.QLabel)
    ]
    sums = simulation.run.totals
    assert f"{sums.mass:.1f} g" in texts and f"{sums.length / 1000:.3f} m" in texts
    assert sums.time == pytest.approx(times.total) and sums.wait_time > 4.0


def violated(path):
    """Change the joint path as no planner would: a joint past its limit in one stretch, and far too
    fast elsewhere."""
    value = api.result(path)
    motion = value.motion
    joints = motion.joints.copy()
    rows = np.flatnonzero(motion.deposit)
    past_limit = rows[60:80]
    joints[past_limit, 4] = np.radians(136.0)
    joints[rows[200:], 5] += 40.0
    path.Proxy._kept = (
        path.Key,
        Planned(value.joint_path, dataclasses.replace(motion, joints=joints)),
    )
    return past_limit, rows[200]


def red_pixels(person):
    path = str(person.folder / "red.png")
    person.gui.activeDocument().activeView().saveImage(path, 700, 500, "White")
    image = person.widgets.QImage(path).convertToFormat(person.widgets.QImage.Format_RGB32)
    rows = np.frombuffer(bytes(image.constBits()), dtype=np.uint8).reshape(image.height(), -1, 4)
    red, green, blue = rows[:, : image.width(), 2::-1].reshape(-1, 3).astype(int).T
    return int(((red > 90) & (red > 3 * green) & (red > 3 * blue)).sum())


def rows_in_colour(simulation, colour):
    """Return whether each deposit row (n,) is drawn in a colour."""
    red, green, blue = (round(255 * share) for share in colour)
    return simulation.scene.deposit.colours == (red << 24 | green << 16 | blue << 8 | 255)


def test_what_is_wrong_turns_red_and_findings_lead_to_it(person, hemisphere):
    path = job(hemisphere)
    past_limit, fast = violated(path)
    panel, simulation = opened(person, path)
    calm = red_pixels(person)
    simulation.player.go_to_row(int(past_limit[5]))
    simulation.show()
    person.idle(0.3)
    person.screenshot("simulation_past_limit")
    # with this bend the forearm is in the way
    touching = int(simulation.run.watch.touching[past_limit[5]])
    assert simulation.scene.machine.bad.tolist() == [
        k in (5, touching) for k in range(7)
    ] and touching in (-1, 4)
    assert person.field(panel, "joints").bad.tolist() == [False] * 4 + [True, False]
    assert person.field(panel, "joints").margins[4] == pytest.approx(-1.0)
    assert red_pixels(person) > calm + 60
    findings = simulation.run.watch.findings
    assert {LIMIT, SLOWED} <= {finding.kind for finding in findings}
    simulation.player.go(0.0)
    visited = []
    for finding in findings:
        person.field(panel, "next_finding").click()
        person.idle(0.02)
        visited.append(person.field(panel, "finding").text())
        assert simulation.player.row == finding.row
    assert len(visited) == len(set(visited)) > 3
    assert any("q5 is 1.00° past its limit" in text for text in visited)
    # the axis cannot reach the requested feed, and the read-out shows the achievable one
    simulation.player.go_to_row(int(fast))
    simulation.show()
    person.screenshot("simulation_too_fast")
    achievable = achievable_feed(simulation.run.motion, simulation.run.cell.machine.max_speed)
    assert achievable.slowed[fast] and achievable.axis[fast] == 5
    assert (
        person.field(panel, "speed").text()
        == f"{achievable.achieved[fast]:.3g} mm/s instead of {achievable.asked[fast]:.3g} mm/s"
    )
    assert simulation.scene.machine.bad[6]
    # on the path, past the limit red, too fast orange
    on_path = np.flatnonzero(simulation.run.motion.deposit)
    for rows, colour in ((past_limit, WRONG_COLOUR), ([fast], SLOW_COLOUR)):
        assert rows_in_colour(simulation, colour)[np.searchsorted(on_path, rows)].all()
    person.field(panel, "next_finding").click()
    simulation.player.go_to_row(len(simulation.run.motion) // 2)
    simulation.show()
    assert not simulation.scene.machine.bad.all()


def test_what_is_near_a_singularity_turns_red(person, hemisphere):
    """A part of the path is near one: the condition limit is within the range of one RZ for all,
    which is not searched."""
    path = job(hemisphere)
    api.change(path, method="constant", rz="20 deg")
    hemisphere.Document.recompute()
    median_condition = float(np.nanmedian(run_of(path).watch.condition))
    api.change(path, min_condition=median_condition)
    hemisphere.Document.recompute()
    panel, simulation = opened(person, path)
    run = simulation.run
    deposit, is_near = run.motion.deposit, run.watch.condition < median_condition * (1.0 - 1e-9)
    else_wrong = (run.watch.margin < -1e-6) | (run.watch.touching != -1)
    assert SINGULAR in {finding.kind for finding in run.watch.findings}
    assert np.array_equal(rows_in_colour(simulation, WRONG_COLOUR), (is_near | else_wrong)[deposit])
    calm = deposit & ~is_near & ~else_wrong & (run.watch.margin > 1.0)
    row, free = (int(np.flatnonzero(rows)[0]) for rows in (is_near & ~else_wrong, calm))
    for row_, red in ((row, True), (free, False)):
        simulation.player.go_to_row(row_)
        simulation.show()
        person.idle(0.2)
        assert simulation.scene.machine.bad.tolist() == [False, *[red] * 6]
        assert ("color" in person.field(panel, "condition").styleSheet()) == red
        person.screenshot(f"simulation_singular_{red}")
    texts = []
    for _ in run.watch.findings:  # each at its worst position
        person.field(panel, "next_finding").click()
        texts.append(
            (
                bool(is_near[simulation.player.row]),
                "Near a singularity" in person.field(panel, "finding").text(),
            )
        )
    assert (True, True) in texts and (False, True) not in texts


def test_a_robot_that_reaches_nothing_stands_in_one_piece(person, hemisphere, no_remedies):
    path = job(hemisphere)
    path.Cell.DepositionPoint = App.Placement(App.Vector(5000, -630, 650), App.Rotation())
    hemisphere.Document.recompute()
    assert path.Status == "infeasible"
    panel, simulation = opened(person, path)
    person.screenshot("simulation_out_of_reach")
    assert person.field(panel, "doing").text() == "out of reach"
    cell, scene = simulation.run.cell, simulation.scene
    base = frames.inverse(matrix(scene.machine.transforms[0]))
    drawn = np.array([base @ matrix(transform) for transform in scene.machine.transforms])
    want = cell.machine.chain.links(np.zeros(6))
    assert np.abs(drawn - frames.inverse(want[0]) @ want).max() < 5e-3


def test_links_that_touch_each_other_are_told_by_both_names():
    assert link_touches("q5", "link q2") == "the link of q5 touches the link of q2"
    assert link_touches("q3", "base") == "the link of q3 touches the base"


def test_a_link_that_touches_turns_red_and_is_told(person, hemisphere):
    # such a wide platform hits the forearm at every strong bend of the wrist
    path = job(hemisphere, limits="paper", platform_diameter=320.0)
    panel, simulation = opened(person, path)
    contacts = [finding for finding in simulation.run.watch.findings if finding.kind == TOUCHES]
    assert contacts and {(finding.label, finding.other) for finding in contacts} == {
        ("q4", "platform")
    }
    person.field(panel, "next_finding").click()
    person.until(lambda: simulation.player.row == contacts[0].row, "the finding")
    assert person.field(panel, "finding").text().endswith("The link of q4 touches the platform")
    assert simulation.scene.machine.bad.tolist() == [k == 4 for k in range(7)]
    person.idle(0.2)
    person.screenshot("simulation_touching")
    touching = simulation.run.watch.touching
    bent = np.abs(simulation.run.motion.joints[:, 4])
    free = int(np.argmin(bent))
    assert touching[free] == -1 and (bent[touching == 4].min() > np.radians(80))
    simulation.player.go_to_row(free)
    simulation.show()
    assert not simulation.scene.machine.bad.any()
    docks._open[0].close()
    # with this platform nothing touches, and the dock says so
    api.change(path.Cell, platform_diameter=113.0)
    hemisphere.Document.recompute()
    panel, simulation = opened(person, path)
    assert simulation.run.watch.arm_known and not (simulation.run.watch.touching != -1).any()


def test_a_program_that_resumes_plays_only_what_it_runs(person, hemisphere):
    path = job(hemisphere)
    program = api.make_program(hemisphere.Document, path, "CUP", start_at_layer=2)
    run = run_of(program)
    assert run.motion.layer.min() == 2 and run.times.layers[0] == 2
    full_run = run_of(path)
    assert run.totals.length == pytest.approx(
        sum(bead.length for layer, _, bead in api.result(path.Toolpath) if layer >= 2)
    )
    assert run.totals.length < full_run.totals.length
    program.ViewObject.Proxy.doubleClicked(
        program.ViewObject
    )  # the text, and below it the time of this section of the job
    window = person.panel("RoboticAM_ProgramText")
    sums = person.field(window, "sums").text()
    assert (
        f"Deposit: {run.totals.length / 1000:.3f} m" in sums
        and f"Mass: {run.totals.mass:.1f} g" in sums
    )
    person.screenshot("program_sums")
    person.field(window, "close").click()
    panel, simulation = opened(person, program)
    assert simulation.run.title == program.Label
    assert (
        person.panel("RoboticAM_Simulation").windowTitle()
        == f"Simulation of {program.Label} ({program.Document.Label})"
    )
    person.field(panel, "layer_on").click()
    person.screenshot("simulation_program")


def test_a_program_of_linear_moves_plays_the_points_they_get(hemisphere):
    doc = hemisphere.Document
    path = job(
        hemisphere,
        machine="staubli-rx60bl",
        deposition_point=(300, 0, 300, 180, 0, 0),
        platform_diameter=60,
        nozzle_length=60,
    )
    run = run_of(api.make_program(doc, path, "LINES", motion="cartesian", post="staubli"))
    planned, toolpath = api.result(path), api.result(path.Toolpath)
    beads = [bead_path.bead for bead_path in planned.joint_path.beads]
    motion = steps.refined_to_chord_error(planned.motion, run.cell, toolpath.chord_error, beads)
    assert len(run.motion) == len(motion) > len(planned.motion)
    assert np.array_equal(run.motion.joints, motion.joints) and np.array_equal(
        run.motion.point, motion.point
    )
    full_run = run_of(path)
    assert run.totals.length > full_run.totals.length  # along the arcs instead of their chords
    same = [
        np.flatnonzero((run.motion.position == position).all(axis=1))[-1]
        for position in full_run.motion.position[200:240]
    ]
    assert np.array_equal(run.watch.condition[same], full_run.watch.condition[200:240])
    issue = Issue(WARNING, "X", "seen", 1, 0, 7)
    path.Issues = json.dumps([issue.as_dict()])
    path_issue, program_issue = (
        next(finding for finding in run_.watch.findings if finding.kind == ISSUE)
        for run_ in (run_of(path), run_of(doc.Program))
    )
    assert program_issue.row > path_issue.row
    assert np.array_equal(
        run.motion.position[program_issue.row], full_run.motion.position[path_issue.row]
    )


@pytest.mark.always("document", "toolpath", "undo")
@pytest.mark.parametrize("what", ["document", "object", "toolpath", "recompute", "undo", "view"])
def test_it_ends_by_itself_when_what_it_plays_goes_or_changes(person, hemisphere, what):
    doc = hemisphere.Document
    path = job(hemisphere)
    panel, simulation = opened(person, path)
    person.field(panel, "play").click()
    person.until(lambda: simulation.player.time > 0.0, "the job to play")
    if what == "document":
        App.closeDocument(doc.Name)
    elif what == "object":
        doc.removeObject(path.Name)
    elif what == "toolpath":
        doc.removeObject(path.Toolpath.Name)
    elif what == "recompute":
        path.Toolpath.TravelSpeed = "7 mm/s"
        doc.recompute()
    elif what == "undo":
        doc.undo()
    else:
        person.gui.runCommand("Std_ViewCreate")
        person.idle(0.3)
        windows = person.present(person.widgets.QMdiSubWindow)
        window = next(window for window in windows if doc.Label in window.windowTitle())
        window.close()
        person.idle(0.3)
    if what != "view":
        person.until(lambda: not docks._open, "the simulation to end", 5)
        person.idle(0.05)
    if what == "view" and docks._open:
        docks._open[0].show()
        person.idle(0.2)
    if what != "view":
        assert docks._open == []
        docs = [
            dock
            for dock in person.present(person.widgets.QDockWidget, docks.NAME)
            if dock.isVisible()
        ]
        assert docs == []
    for open_dock in docks._open:
        open_dock.close()


def test_two_simulations_replace_one_another_and_without_a_path_it_says_so(person, hemisphere):
    path = job(hemisphere)
    _, first_simulation = opened(person, path)
    tool.simulate_object(path)
    person.idle(0.2)
    assert (
        len(docks._open) == 1
        and docks._open[0] is not first_simulation
        and first_simulation.scene is None
    )
    assert docks._open[0].dock.findChildren(person.widgets.QLabel, "stale") == []
    path.Degree = 2  # without a recompute it plays the earlier plan, and says so
    tool.simulate_object(path)
    person.idle(0.2)
    assert "earlier plan" in person.field(docks._open[0].dock, "stale").text()
    docks._open[0].close()
    App.newDocument("Empty")
    person.idle()
    person.gui.Selection.clearSelection()
    person.until(
        lambda: not person.button("RoboticAM_Simulate").isEnabled(), "the tool to be greyed", 5
    )
    assert "make a joint path" in person.button("RoboticAM_Simulate").toolTip()
    tool.simulate()  # as a macro may
    assert docks._open == []
    assert "make a joint path first" in person.window.statusBar().currentMessage()


def test_positioner_and_its_bodies_are_drawn_where_its_axes_are(person, hemisphere):
    """They are at the poses of PyKDL's chain of the positioner, relative to its base, and the part
    moves with the last one."""
    path = make_positioner_job(hemisphere, 15)
    panel, simulation = opened(person, path)
    scene, links, times = simulation.scene, simulation.scene.external_links, simulation.run.times
    numbers = [link.link for link in links.links]
    assert {0, 1, 2} <= set(numbers)
    positioner_solver = KdlArm(
        external.load("motoman-motopos-d500")
    )  # only the positioner, from its own file
    turned, to_face, to_part = [], [], []
    for share in (0.1, 0.3, 0.45, 0.7, 0.9):
        person.field(panel, "time").setValue(round(share * fields.STEPS))
        person.idle(0.05)
        angles = times.state_at(simulation.player.time).joints[6:]
        drawn = [np.array(value.getValue().getValue()).T for value in links.matrices]
        base, table = drawn[numbers.index(0)], drawn[numbers.index(2)]
        turned.append(angles)
        to_face.append(
            frames.inverse(frames.inverse(base) @ table)
            @ positioner_solver.forward(angles[None])[0]
        )
        to_part.append(frames.inverse(table) @ matrix(scene.part))
    assert np.ptp(turned, axis=0).min() > 0.2
    for poses in (to_face, to_part):
        np.testing.assert_allclose(np.array(poses)[:, :3, :3] - poses[0][:3, :3], 0.0, atol=1e-5)
        np.testing.assert_allclose(np.array(poses)[:, :3, 3] - poses[0][:3, 3], 0.0, atol=1e-2)
