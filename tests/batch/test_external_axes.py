# SPDX-License-Identifier: LGPL-2.1-or-later
"""A job with a positioner, from the file to its rows, and the values of such a file that are
rejected."""

import csv
import json
import math
import re
import shutil
from pathlib import Path

import FreeCAD
import numpy as np
import pytest
import yaml

from freecad_am import api
from freecad_am.batch.job.job import read_job
from freecad_am.core.issues import InputError
from freecad_am.core.kinematics import external
from tests.core.kinematics import urdf_cells

MAX_LEAN_DEG = 10.0  # deg, in the job


@pytest.fixture
def written(workshop, root):
    """Write the example with thick layers and changes in a folder of its own, and return its
    path."""

    def write(change=lambda job: None):
        folder = root / "resources" / "examples"
        shutil.copy(folder / "hemisphere.step", workshop.folder)
        job = yaml.safe_load((folder / "hemisphere-on-positioner.yaml").read_text(encoding="utf-8"))
        job["strategy"].update(layer_height="8 mm", chord_error="0.2 mm")
        change(job)
        path = workshop.folder / "dome.yaml"
        path.write_text(yaml.safe_dump(job), encoding="utf-8")
        return path

    return write


def from_vertical(row):
    """Return the angle of the row's tool axis from the vertical in deg: the D500 tilts about -Y,
    then turns about -Z (its file)."""
    tilt, turn = (-math.radians(float(row[name])) for name in ("e1_deg", "e2_deg"))
    about_y = np.array(
        [[math.cos(tilt), 0, math.sin(tilt)], [0, 1, 0], [-math.sin(tilt), 0, math.cos(tilt)]]
    )
    about_z = np.array(
        [[math.cos(turn), -math.sin(turn), 0], [math.sin(turn), math.cos(turn), 0], [0, 0, 1]]
    )
    x, y, z = about_y @ about_z @ [float(row[name]) for name in ("tx", "ty", "tz")]
    return math.degrees(math.atan2(math.hypot(x, y), z))


def test_rows_and_report_say_where_the_positioner_is(workshop, written):
    written()
    command = workshop.run("plan", "dome.yaml", "-o", "out")
    assert command.status == 0, command.err
    with open(workshop.folder / "out" / "waypoints.csv", encoding="utf-8", newline="") as file:
        rows = list(csv.DictReader(file))
    assert list(rows[0])[-4:] == ["q6_deg", "e1_deg", "e2_deg", "class"]
    leaning = max(from_vertical(row) for row in rows if row["kind"] == "deposit")
    assert leaning <= MAX_LEAN_DEG + 1e-4
    assert all(
        abs(float(row["e1_deg"])) <= 134.9946 and abs(float(row["e2_deg"])) <= 199.9966
        for row in rows
    )

    report_data = json.loads((workshop.folder / "out" / "report.json").read_text(encoding="utf-8"))
    axes = report_data["joints"]["external"]
    assert axes["from_vertical_max_deg"] == pytest.approx(leaning, abs=1e-3)
    turned = sum(
        abs(float(following["e2_deg"]) - float(row["e2_deg"]))
        for row, following in zip(rows, rows[1:])
        if row["kind"] == following["kind"] == "deposit"
        and (row["layer"], row["bead"]) == (following["layer"], following["bead"])
    )
    assert axes["turned_deg"]["e2"] == pytest.approx(turned, abs=1.0)
    assert len(report_data["joints"]["min_deg"]) == 8 and report_data["machine"]["axes"][-2:] == [
        "e1",
        "e2",
    ]


def test_exports_of_the_saved_document_have_the_positioner(workshop, written):
    written()
    command = workshop.run("plan", "dome.yaml", "-o", "out", "--no-page")
    assert command.status == 0, command.err
    document = FreeCAD.openDocument(str(next((workshop.folder / "out").glob("*.FCStd"))))
    try:
        (path,) = api.stages_of(document, "joint path")
        table = Path(api.export_waypoints(path, str(workshop.folder / "points.csv")))
        file = Path(api.export_joint_trajectory(path, str(workshop.folder / "path.json")))
    finally:
        FreeCAD.closeDocument(document.Name)
    assert table.read_bytes() == (workshop.folder / "out" / "waypoints.csv").read_bytes()
    trajectory = json.loads(file.read_text(encoding="utf-8"))
    assert trajectory["joint_names"][-3:] == ["A6", "e1", "e2"]
    last_row = table.read_text(encoding="ascii").splitlines()[-1].split(",")
    angles = np.radians([float(word) for word in last_row[-9:-1]])
    np.testing.assert_allclose(trajectory["points"][-1]["positions"], angles, rtol=0, atol=1e-8)


def test_the_program_takes_the_positioner_along(workshop, written):
    """The text has the positioner values of the rows, and robot positions relative to its face."""
    written()
    command = workshop.run("plan", "dome.yaml", "-o", "out")
    assert command.status == 0, command.err
    (program,) = (workshop.folder / "out" / "program").iterdir()
    text = program.read_text(encoding="ascii")
    with open(workshop.folder / "out" / "waypoints.csv", encoding="utf-8", newline="") as file:
        rows = list(csv.DictReader(file))
    positions = re.findall(
        r"LIN \{X ([-.\d]+),Y ([-.\d]+),Z ([-.\d]+),.*,E1 ([-.\d]+),E2 ([-.\d]+)\}", text
    )
    # a bead begins where the rapid before it ended
    alike = ("kind", "layer", "bead")
    deposit = [
        row
        for previous, row in zip(rows, rows[1:])
        if row["kind"] == "deposit" and all(previous[k] == row[k] for k in alike)
    ]
    due = np.array(
        [
            [float(row[name]) for name in ("x_mm", "y_mm", "z_mm", "e1_deg", "e2_deg")]
            for row in deposit
        ]
    )
    errors = np.array(positions, dtype=float) - due
    assert np.ptp(errors[:, :3], axis=0).max() <= 1.1e-3  # the part's file may have another origin
    assert np.abs(errors[:, 3:]).max() <= 5.1e-5 and np.ptp(due[:, 4]) > 300.0
    assert text.count("$BASE=EK(MACHINE_DEF[2].ROOT,MACHINE_DEF[2].MECH_TYPE,BASE_DATA[1])") == 1


def columns(workshop, first_name):
    """Return the waypoints of the job as numbers, without the class, from a column on."""
    lines = workshop.files("out")["waypoints.csv"].decode().splitlines()
    index = lines[0].split(",").index(first_name)
    return np.array([[float(word) for word in line.split(",")[index:-1]] for line in lines[1:]])


@pytest.mark.parametrize(
    ("mechanism", "untold"),
    [
        ("motoman-motopos-d500", ""),
        ("kuka-kp2-hv500", "the shape of KUKA KP2-HV500 is unknown"),
    ],
)
def test_a_positioner_that_no_file_tells_the_shape_of_is_told_to_be_passed_over(
    workshop, written, mechanism, untold
):
    def change(job):
        job["strategy"]["layer_height"] = "15 mm"
        job["cell"]["external"][0].update(machine=mechanism, pose=[1400, 0, -500, 0, 0, 0])
        del job["program"]

    written(change)
    command = workshop.run("plan", "dome.yaml", "-o", "out", "--no-page")
    report = json.loads((workshop.folder / "out" / "report.json").read_text(encoding="utf-8"))
    messages = [
        (issue["level"], issue["message"])
        for issue in report["issues"]
        if issue["code"] == "BODIES_NOT_KNOWN"
    ]
    assert len(messages) == command.err.count("note[BODIES_NOT_KNOWN] job: ") == bool(untold), (
        command.err
    )
    assert all(level == "note" and message.startswith(untold) for level, message in messages)
    (line,) = [
        entry["how"]
        for entry in report["preflight"]
        if entry["promise"].startswith("Positioner and track")
    ]
    assert ("not checked: no file describes" in line) == bool(untold)


def test_one_urdf_of_a_whole_cell_moves_as_its_mechanisms_named_one_by_one(workshop, written):
    """The tree separates robot on a track and positioner; the cell by hand has the values of the
    manufacturer's files."""
    (workshop.folder / "cell.urdf").write_text(urdf_cells.whole_cell(), encoding="utf-8")

    def name_whole_cell(job):
        job["cell"].update(machine="cell.urdf", external="urdf")
        job["program"] = {"post": "none"}

    def by_hand(job):
        job["cell"]["external"] = [
            {"machine": "kuka-kl100-2", "pose": [0, 0, -356, 0, 0, 90], "carries": "robot"},
            {
                "machine": "motoman-motopos-d500",
                "pose": [1400, 50, -56, 0, 0, "0.4 rad"],
                "carries": "part",
            },
        ]
        job["program"] = {"post": "none"}

    def by_link(job):
        by_hand(job)
        for mechanism, name in zip(job["cell"]["external"], ("track", "positioner"), strict=True):
            tip = "robot_base_link" if name == "track" else f"{name}_tool0"
            mechanism["machine"] = {"file": "cell.urdf", "base": f"{name}_base_link", "tip": tip}

    joint_columns = []
    for change in (by_hand, name_whole_cell, by_link):
        written(change)
        command = workshop.run("plan", "dome.yaml", "--no-page", "-o", "out")
        assert command.status == 0, command.err
        joint_columns.append(columns(workshop, "q1_deg"))
    assert (
        joint_columns[0].shape[0] > 100
        and joint_columns[0].shape[1] == 9
        and np.ptp(joint_columns[0][:, 8]) > 300.0
    )
    # the URDF rounds degrees of the machine files to the last digits of a double
    np.testing.assert_allclose(joint_columns[1], joint_columns[0], atol=2e-5)
    np.testing.assert_allclose(joint_columns[2], joint_columns[0], atol=2e-5)


def test_a_part_too_heavy_for_its_table_gets_no_program(workshop, written):
    report_data = json.loads(
        (external.MECHANISMS / "motoman-motopos-d500.json").read_text(encoding="utf-8")
    )
    report_data["payload"] = {"kg": 0.5, "source": "the plate"}
    (workshop.folder / "light.json").write_text(json.dumps(report_data), encoding="utf-8")
    written(lambda job: job["cell"]["external"][0].update(machine="light.json"))
    command = workshop.run("plan", "dome.yaml", "--no-page", "-o", "out")
    assert (
        command.status == 3
        and "error[PAYLOAD]" in command.err
        and "), the payload of" in command.err
    )
    report = json.loads(workshop.files("out")["report.json"])
    assert report["status"] == "infeasible" and report["programs"] == []
    assert report["totals"]["mass_g"] > 500.0
    written(
        lambda job: (
            job["cell"]["external"][0].update(machine="light.json"),
            job["process"].update(density=2.7),
        )
    )
    command = workshop.run("plan", "dome.yaml", "--no-page", "-o", "out")
    assert (
        command.status == 0
        and json.loads(workshop.files("out")["report.json"])["totals"]["mass_g"] < 500.0
    )


@pytest.mark.parametrize(
    ("change", "code", "where"),
    [
        (lambda job: job.update(program={"post": "fanuc"}), "WRONG_CONTROLLER", "program.post"),
        (
            lambda job: job["cell"]["external"][0].update(machine="kuka-kr8-r2100-2-arc-hw"),
            "BAD_VALUE",
            "cannot carry itself",
        ),
        (
            lambda job: job["cell"]["external"].append(job["cell"]["external"][0]),
            "BAD_VALUE",
            "is listed twice",
        ),
        (
            lambda job: job["cell"]["external"][0].update(carries="robot"),
            "NOT_YET",
            "cell.external",
        ),
        (lambda job: job["cell"].update(setup="part-on-robot"), "WRONG_SETUP", "cell.external"),
    ],
)
def test_refused_when_it_is_planned(workshop, written, change, code, where):
    written(change)
    command = workshop.run("plan", "dome.yaml", "-o", "out")
    assert command.status == 2 and code in command.err and where in command.err
    assert not (workshop.folder / "out").exists()


@pytest.mark.parametrize(
    ("change", "code", "where"),
    [
        (
            lambda job: job["cell"].update(external="motoman-motopos-d500"),
            "BAD_VALUE",
            "cell.external",
        ),
        (lambda job: job["cell"].update(external="urdf"), "BAD_VALUE", "cell.external"),
        (
            lambda job: job["cell"]["external"][0].update(machine={"base": "here"}),
            "BAD_VALUE",
            "cell.external[0].machine.file",
        ),
        (
            lambda job: job["cell"]["external"][0].update(pose=[1, 2, 3]),
            "BAD_VALUE",
            "cell.external[0].pose",
        ),
        (
            lambda job: job["cell"]["external"][0].update(pose=[1, 2, 3, 4, 5, "6 kg"]),
            "BAD_UNIT",
            "cell.external[0].pose",
        ),
        (
            lambda job: job["cell"]["external"][0].pop("machine"),
            "BAD_VALUE",
            "cell.external[0].machine",
        ),
        (
            lambda job: job["cell"]["external"][0].update(carry="part"),
            "UNKNOWN_KEY",
            "cell.external[0].carry",
        ),
        (lambda job: job["cell"].update(world_up=[0, 0, 0]), "BAD_VALUE", "cell.world_up"),
        (
            lambda job: job["build_direction"].update(max_from_vertical="190 deg"),
            "BAD_VALUE",
            "build_direction.max_from",
        ),
    ],
)
def test_refused_when_it_is_read(written, change, code, where):
    path = written(change)
    with pytest.raises(InputError) as error:
        read_job(str(path))
    assert error.value.code == code and where in error.value.where


def test_the_rotor_moves_less_with_its_axes_optimised(workshop, root):
    """The check uses report and rows of the example with thick layers, with which the program was
    compared."""
    folder = root / "resources" / "examples"
    job = yaml.safe_load((folder / "rotor-on-positioner.yaml").read_text(encoding="utf-8"))
    for key in ("part", "substrate"):
        job[key]["file"] = str(folder / job[key]["file"])
    job["strategy"].update(layer_height="12 mm", bead_spacing="16 mm")
    (workshop.folder / "rotor.yaml").write_text(yaml.safe_dump(job), encoding="utf-8")
    command = workshop.run("plan", "rotor.yaml", "-o", "out", "--no-page")
    assert command.status == 0, command.err
    report_data = json.loads((workshop.folder / "out" / "report.json").read_text(encoding="utf-8"))[
        "joints"
    ]["external"]
    level = report_data["level"]
    assert (
        report_data["rule"] == "optimised"
        and report_data["objective_value"] < 0.7 * level["objective_value"]
    )
    assert report_data["least_margin"] > 1.1 * level["least_margin"] > 0.0
    assert report_data["from_vertical_max_deg"] <= 30.0 + 1e-6
    with open(workshop.folder / "out" / "waypoints.csv", encoding="utf-8", newline="") as file:
        rows = [row for row in csv.DictReader(file) if row["kind"] == "deposit"]
    assert max(map(from_vertical, rows)) <= 30.0 + 1e-4
    machine = json.loads(
        (root / "freecad_am" / "machines" / "kuka-kr8-r2100-2-arc-hw.json").read_text(
            encoding="utf-8"
        )
    )
    stroke = [np.diff(ends)[0] for ends in machine["limits"]["maker"]["axes"]] + [
        2 * 134.9946,
        2 * 199.9966,
    ]
    angles = np.array([[float(row[name]) for name in list(row)[-9:-1]] for row in rows])
    same = np.array(
        [
            (previous["layer"], previous["bead"]) == (row["layer"], row["bead"])
            for previous, row in zip(rows, rows[1:])
        ]
    )
    moved = float(np.radians(np.diff(angles, axis=0)[same] ** 2 / np.array(stroke)).sum())
    assert moved == pytest.approx(
        report_data["objective_value"], rel=0.05
    )  # points added in between reduce it
