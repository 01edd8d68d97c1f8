# SPDX-License-Identifier: LGPL-2.1-or-later
"""Jobs whose machine is a URDF."""

import json

import pytest

from freecad_am.core.kinematics.machines import machine
from freecad_am.core.kinematics.urdf import text as urdf_text
from tests.batch.test_plan_command import deposit
from tests.core.kinematics.arms import mount_on_track

JOB = """\
part: {file: cup.step}
strategy: {layer_height: 10 mm, chord_error: 0.1 mm}
cell: {machine: MACHINE, platform_diameter: 100 mm}
program: {post: POST}
"""


@pytest.fixture
def planned(workshop):
    """Return a function that plans the cup on a machine; the robot of the default cell is arm.urdf
    next to the job."""
    text = urdf_text.text(machine.load("fanuc-arcmate120ic"))
    (workshop.folder / "arm.urdf").write_text(text, encoding="utf-8")

    def run(name, post="none"):
        workshop.write_job(JOB.replace("MACHINE", name).replace("POST", post))
        return workshop.run("plan", "cup.yaml", "--no-page")

    return run


def test_a_job_on_a_urdf_moves_as_on_the_machine_file(planned, workshop):
    angles = []
    for name in ("fanuc-arcmate120ic", "{file: arm.urdf, base: base_link, tip: tool0}"):
        command = planned(name)
        assert command.status == 0, command.err
        rows, _ = deposit(workshop.files()["waypoints.csv"].decode())
        angles.append([[float(row[f"q{axis}_deg"]) for axis in range(1, 7)] for row in rows])
    assert len(angles[0]) > 100
    for urdf_angles, file_angles in zip(*angles, strict=True):
        assert file_angles == pytest.approx(urdf_angles, abs=1e-5)
    assert json.loads(workshop.files()["report.json"])["machine"]["title"] == "fanuc-arcmate120ic"


def test_a_robot_with_its_track_is_refused_and_told_where_the_robot_begins(planned, workshop):
    """It was once read as a five-axis machine. The remedy in the message works."""
    (workshop.folder / "rail.urdf").write_text(
        mount_on_track((workshop.folder / "arm.urdf").read_text()), encoding="utf-8"
    )
    for name in ("rail.urdf", "rail.urdf, setup: tool-on-robot"):
        command = planned(name)
        assert (
            command.status == 2
            and "error[NO_CLOSED_FORM] cup.yaml: cell.machine: rail.urdf" in command.err
        )
        assert (
            "rail.urdf from base_link to tool0: the kinematics of the machine is not supported: the first axis is prismatic"
            in command.err
        )
        assert (
            "`cell.external` with `carries: robot`; the robot begins at the link 'carriage'"
            in command.err
        )
    alone = planned("{file: rail.urdf, base: carriage}")
    assert alone.status == 0, alone.err
    rows = workshop.files()["waypoints.csv"]
    assert planned("arm.urdf").status == 0
    assert workshop.files()["waypoints.csv"] == rows


def test_a_mirrored_mesh_is_told_in_the_job_and_changes_no_path(planned, workshop):
    assert planned("arm.urdf").status == 0
    rows = workshop.files()["waypoints.csv"]
    (workshop.folder / "hand.stl").touch()
    mesh = '<visual><geometry><mesh filename="hand.stl" scale="1 1 -1"/></geometry></visual>'
    text = (
        (workshop.folder / "arm.urdf")
        .read_text()
        .replace('<link name="link_6"/>', f'<link name="link_6">{mesh}</link>')
    )
    (workshop.folder / "arm.urdf").write_text(text, encoding="utf-8")
    command = planned("arm.urdf")
    assert command.status == 0 and "note[URDF_LOOKS]" in command.err
    assert (
        "hand.stl is mirrored or flat by its scale 1 1 -1" in command.err
        and "link_6 is drawn plain" in command.err
    )
    assert workshop.files()["waypoints.csv"] == rows


def test_a_program_is_refused_for_a_controller_that_a_urdf_does_not_tell_of(planned):
    command = planned("arm.urdf", "fanuc")
    assert (
        command.status == 2
        and "does not define the display of the controller; plan without a program" in command.err
    )


def test_an_arm_without_a_closed_form_is_refused_with_the_reason(planned, workshop):
    text = (
        (workshop.folder / "arm.urdf")
        .read_text()
        .replace('xyz="0.835 0.0 0.0"', 'xyz="0.835 0.0 0.02"')
    )
    (workshop.folder / "arm.urdf").write_text(text, encoding="utf-8")
    command = planned("arm.urdf")
    assert command.status == 2 and "error[NO_CLOSED_FORM]" in command.err
    assert (
        "arm.urdf from base_link to tool0: the kinematics of the machine is not supported: the wrist is not spherical"
        in command.err
    )
    assert "axes 4 and 5 do not meet" in command.err
