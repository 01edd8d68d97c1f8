# SPDX-License-Identifier: LGPL-2.1-or-later
"""A remedy that the message of an infeasible job proposes makes the job feasible when it is entered
as printed."""

import json
import math
import re

import pytest

PART = "part: {file: cup.step}\nstrategy: {layer_height: 10 mm, chord_error: 0.2 mm}\n"
OF_ANOTHER = "[1045.747, -630.155, 653.167, 0, 0, 0]"
JOBS = {
    # the deposition point belongs to another machine
    "machine": {"cell": {"machine": "kuka-kr16-2", "deposition_point": OF_ANOTHER}},
    "speed": {"cell": {"limits": "paper"}, "process": {"travel_speed": "300 mm/s"}},
    "range": {"cell": {}, "joints": {"rotation_range": "[-5 deg, 5 deg]"}},
    "tool": {
        "cell": {
            "machine": "abb-irb2400-12-155",
            "setup": "tool-on-robot",
            "deposition_point": OF_ANOTHER,
        }
    },
    # no mechanism turns the part upright for its walls, and no single slanted direction works
    # either
    "leaning": {
        "cell": {
            "machine": "kuka-kr8-r2100-2-arc-hw",
            "setup": "tool-on-robot",
            "nozzle": "{tool: [0, 0, 300, 0, 0, 0]}",
            "deposition_point": "[1300, 0, 100, 40, 0, 0]",
            "mount": "part",
        },
        "build_direction": {"max_from_vertical": "10 deg"},
    },
    # a configuration that does not reach around the positioner
    "branch": {
        "cell": {
            "machine": "kuka-kr8-r2100-2-arc-hw",
            "setup": "tool-on-robot",
            "nozzle": "{tool: [0, 0, 300, 0, 0, 0]}",
            "branch": "[back, down, noflip]",
            "external": "[{machine: motoman-motopos-d500, pose: [1615, 0, 0, 0, 0, 0], carries: part}]",
        },
        "build_direction": {"max_from_vertical": "10 deg"},
    },
}
EXPECTED = {
    "branch": "cell.branch",
    "machine": "cell.deposition_point",
    "speed": "process.travel_speed",
    "range": "",
    "tool": "",
    "leaning": "cell.external: [{machine: motoman-motopos-d500, pose: ",
}


def write_job_with(sections):
    lines = [PART]
    for section, keys in sections.items():
        lines.append(
            f"{section}:\n" + "".join(f"  {key}: {value}\n" for key, value in keys.items())
        )
    return "".join(lines)


@pytest.mark.parametrize("name", JOBS)
@pytest.mark.always("range", "tool", "branch", "machine", "speed")
def test_a_remedy_that_was_told_makes_the_job_feasible(name, workshop):
    sections = {section: dict(keys) for section, keys in JOBS[name].items()}
    sections["cell"]["platform_diameter"] = "100 mm"
    workshop.write_job(write_job_with(sections))
    command = workshop.run("plan", "cup.yaml", "--no-page")
    assert command.status == 3, command.err
    first_line = command.err.splitlines()[0]
    assert first_line.startswith(
        "note[REMEDY] job: the job is feasible with `"
    ) and first_line.endswith("; tested, not applied")
    remedies_ = re.findall(r"`(\w+)\.(\w+): ([^`]+)`", first_line)
    assert remedies_ and EXPECTED[name] in first_line
    report = json.loads(workshop.files()["report.json"])
    assert (
        report["status"] == "infeasible"
        and sum(issue["code"] == "REMEDY" for issue in report["issues"]) == 1
    )
    for section, key, value in remedies_:
        sections.setdefault(section, {})[key] = value
    workshop.write_job(write_job_with(sections))
    again = workshop.run("plan", "cup.yaml", "--no-page")
    assert again.status == 0 and "error[" not in again.err and "REMEDY" not in again.err, again.err


def test_what_was_tried_in_vain_is_told(workshop):
    # far out of reach, where no change of the program helps
    workshop.write_job(
        write_job_with(
            {
                "cell": {
                    "limits": "paper",
                    "branch": "auto",
                    "deposition_point": "[3000, 0, 3000, 0, 0, 0]",
                },
            }
        )
    )
    command = workshop.run("plan", "cup.yaml", "--no-page")
    assert command.status == 3
    note = "note[NO_REMEDY] job: no tested change makes the job feasible: `"
    assert command.err.startswith((note, "note[REMEDY]"))


def test_a_positioner_out_of_reach_is_called_so_and_told_where_it_could_stand(workshop):
    positioner = "machine: motoman-motopos-d500, pose: {}, carries: part"
    sections = {**JOBS["leaning"], "cell": {**JOBS["leaning"]["cell"], "branch": "auto"}}
    sections["cell"]["external"] = "[{" + positioner.format("[200, 3600, -40, 0, 0, 20]") + "}]"
    workshop.write_job(write_job_with(sections))
    command = workshop.run("plan", "cup.yaml", "--no-page")
    assert command.status == 3
    match = re.search(
        r"error\[UNREACHABLE\] job: the robot cannot reach the positioner: the nearest point of the part is (\d+) mm from the shoulder, but arm and tool reach only (\d+) mm",
        command.err,
    )
    assert match, command.err
    # the shoulder is some 0.3 m above the middle of the base and less in front of it; the part is
    # 40 mm wide
    assert abs(float(match[1]) - math.hypot(200.0, 3600.0)) < 320.0 and 2100.0 < float(
        match[2]
    ) < float(match[1])
    assert "move the positioner, choose another branch" in command.err
    (pose,) = re.findall(
        r"the job is feasible with `cell\.external\[0\]\.pose: (\[[^`]+\])`", command.err
    )
    assert pose.endswith(", -40, 0, 0, 20]")  # on the same floor, with the same orientation
    sections["cell"]["external"] = "[{" + positioner.format(pose) + "}]"
    workshop.write_job(write_job_with(sections))
    again = workshop.run("plan", "cup.yaml", "--no-page")
    assert again.status == 0 and "error[" not in again.err, again.err


CELL = """\
cell:
  {machine: abb-irb4600-40-255, setup: tool-on-robot, mount: part, branch: auto, deposition_point: [1400, 0, 600, 0, 0, 0],
   platform_diameter: 0 mm, nozzle: {diameter: 4 mm, half_angle: 3 deg, length: 60 mm, tool: [0, 0, 300, 0, 0, 0]}}
"""


def written_for(kind, options=""):
    return (
        f"part: {{file: skin.step}}\nprocess: {{bead_width: 3 mm}}\n"
        f"strategy: {{kind: {kind}, layer_height: 2 mm, chord_error: 0.1 mm}}\n{CELL}{options}"
    )


def skin(folder, lean, squeezed):
    """Return a skin of 8 mm that leans out by an angle in degrees from its edge, 20 mm about Z."""
    import FreeCAD
    import Part

    out, up = 8.0 * math.sin(math.radians(lean)), 8.0 * math.cos(math.radians(lean))
    face = Part.makeCone(20, 20 + out, up).Faces[0]
    if squeezed:  # no longer of revolution
        turned = FreeCAD.Matrix(1, 0, 0, 0, 0, 0.98, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1)
        face = face.toNurbs().transformGeometry(turned).Faces[0]
    Part.Compound([face]).exportStep(str(folder / "skin.step"))


def groove(folder):
    """Return a groove in which only the vertical nozzle of CELL fits."""
    import Part

    rings = [Part.makeCylinder(36, 70).cut(Part.makeCylinder(30, 70)), Part.makeCylinder(13.5, 70)]
    Part.Compound(rings).exportStep(str(folder / "groove.step"))
    return "fixtures: [{file: groove.step}]\n"


@pytest.mark.parametrize(
    ("kind", "lean", "sections", "code"),
    [
        ("revolution", 30, groove, "CLEARANCE"),
        ("surface", 42, lambda _: "joints: {min_condition: 0.15}\n", "SINGULAR"),
    ],
)
@pytest.mark.always("revolution-30-groove-CLEARANCE")
def test_one_direction_for_a_wall_that_leans_is_told_and_chosen(
    workshop, kind, lean, sections, code
):
    """With directions that follow the wall, the tool collides or passes a singularity."""
    skin(workshop.folder, lean, squeezed=kind == "surface")
    section_text = sections(workshop.folder)
    workshop.write_job(written_for(kind, section_text))
    command = workshop.run("plan", "cup.yaml", "--no-page")
    assert command.status == 3 and f"error[{code}]" in command.err, command.err
    assert command.err.splitlines()[0] == (
        "note[REMEDY] job: the job is feasible with `build_direction.mode: fixed`; tested, not applied"
    ), command.err
    workshop.write_job(written_for(kind, section_text + "build_direction: {mode: fixed}\n"))
    again = workshop.run("plan", "cup.yaml", "--no-page")
    assert again.status == 0 and "error[" not in again.err and "REMEDY" not in again.err, again.err
    waypoints = workshop.files()["waypoints.csv"]
    workshop.write_job(written_for("auto", section_text))
    second_command = workshop.run("plan", "cup.yaml", "--no-page")
    assert second_command.status == 0 and workshop.files()["waypoints.csv"] == waypoints, (
        second_command.err
    )
    issues = json.loads(workshop.files()["report.json"])["issues"]
    messages = [issue["message"] for issue in issues if issue["code"] == "PROPOSED"]
    assert messages[0].startswith(f"kind: {kind}: ") and messages[0].endswith(
        f"end with {code}, so all directions are the same (build_direction.mode: fixed)"
    )
    workshop.write_job(written_for("auto", section_text + "build_direction: {mode: local}\n"))
    assert workshop.run("plan", "cup.yaml", "--no-page").status == 3, (
        "what the job says of directions counts"
    )


def test_one_direction_that_does_not_clear_the_nozzle_is_told_to(workshop):
    """The wall is under a lid."""
    import FreeCAD
    import Part

    Part.makeCylinder(200, 4, FreeCAD.Vector(0, 0, 20)).exportStep(
        str(workshop.folder / "groove.step")
    )
    skin(workshop.folder, 30, squeezed=False)
    for kind in ("revolution", "auto"):
        workshop.write_job(written_for(kind, "fixtures: [{file: groove.step}]\n"))
        command = workshop.run("plan", "cup.yaml", "--no-page")
        assert command.status == 3 and "error[CLEARANCE]" in command.err, command.err
        assert (
            "note[NO_REMEDY] job: the nozzle is not clear with `build_direction.mode: fixed` either"
            in command.err
        ), command.err
