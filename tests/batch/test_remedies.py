# SPDX-License-Identifier: LGPL-2.1-or-later
"""What an infeasible job is told would make it feasible does so, when it is put into the job as it was told."""

import json
import math
import re

import pytest

PART = "part: {file: cup.step}\nstrategy: {layer_height: 10 mm, chord_error: 0.2 mm}\n"
OF_ANOTHER = "[1045.747, -630.155, 653.167, 0, 0, 0]"
JOBS = {
    # the deposition point is that of another machine
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
    # nothing turns the part so that its walls could be laid upright, nor does one direction for all do, on a slant
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
    # a branch that does not reach round the positioner
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


def written(sections):
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
    workshop.write_job(written(sections))
    done = workshop.run("plan", "cup.yaml", "--no-page")
    assert done.status == 3, done.err
    first = done.err.splitlines()[0]
    assert first.startswith("note[REMEDY] job: the job is feasible with `") and first.endswith(
        "; tested, not applied"
    )
    told = re.findall(r"`(\w+)\.(\w+): ([^`]+)`", first)
    assert told and EXPECTED[name] in first
    report = json.loads(workshop.files()["report.json"])
    assert (
        report["status"] == "infeasible"
        and sum(issue["code"] == "REMEDY" for issue in report["issues"]) == 1
    )
    for section, key, value in told:
        sections.setdefault(section, {})[key] = value
    workshop.write_job(written(sections))
    again = workshop.run("plan", "cup.yaml", "--no-page")
    assert again.status == 0 and "error[" not in again.err and "REMEDY" not in again.err, again.err


def test_what_was_tried_in_vain_is_told(workshop):
    # far out of reach, where no change of the program helps
    workshop.write_job(
        written(
            {
                "cell": {
                    "limits": "paper",
                    "branch": "auto",
                    "deposition_point": "[3000, 0, 3000, 0, 0, 0]",
                },
            }
        )
    )
    done = workshop.run("plan", "cup.yaml", "--no-page")
    assert done.status == 3
    told = "note[NO_REMEDY] job: no tested change makes the job feasible: `"
    assert done.err.startswith((told, "note[REMEDY]"))


def test_a_positioner_out_of_reach_is_called_so_and_told_where_it_could_stand(workshop):
    told = "machine: motoman-motopos-d500, pose: {}, carries: part"
    sections = {**JOBS["leaning"], "cell": {**JOBS["leaning"]["cell"], "branch": "auto"}}
    sections["cell"]["external"] = "[{" + told.format("[200, 3600, -40, 0, 0, 20]") + "}]"
    workshop.write_job(written(sections))
    done = workshop.run("plan", "cup.yaml", "--no-page")
    assert done.status == 3
    found = re.search(
        r"error\[UNREACHABLE\] job: the robot cannot reach the positioner: the nearest point of the part is (\d+) mm from the shoulder, but arm and tool reach only (\d+) mm",
        done.err,
    )
    assert found, done.err
    # the shoulder is above the base's middle at some 0.3 m, ahead of it by less; the part is 40 mm wide
    assert abs(float(found[1]) - math.hypot(200.0, 3600.0)) < 320.0 and 2100.0 < float(
        found[2]
    ) < float(found[1])
    assert "move the positioner, choose another branch" in done.err
    (pose,) = re.findall(
        r"the job is feasible with `cell\.external\[0\]\.pose: (\[[^`]+\])`", done.err
    )
    assert pose.endswith(", -40, 0, 0, 20]")  # on the same floor, turned as it was
    sections["cell"]["external"] = "[{" + told.format(pose) + "}]"
    workshop.write_job(written(sections))
    again = workshop.run("plan", "cup.yaml", "--no-page")
    assert again.status == 0 and "error[" not in again.err, again.err


CELL = """\
cell:
  {machine: abb-irb4600-40-255, setup: tool-on-robot, mount: part, branch: auto, deposition_point: [1400, 0, 600, 0, 0, 0],
   platform_diameter: 0 mm, nozzle: {diameter: 4 mm, half_angle: 3 deg, length: 60 mm, tool: [0, 0, 300, 0, 0, 0]}}
"""


def written_for(kind, more=""):
    return (
        f"part: {{file: skin.step}}\nprocess: {{bead_width: 3 mm}}\n"
        f"strategy: {{kind: {kind}, layer_height: 2 mm, chord_error: 0.1 mm}}\n{CELL}{more}"
    )


def skin(folder, lean, squeezed):
    """A skin of 8 mm that leans out by so many degrees from its edge, 20 mm about Z."""
    import FreeCAD
    import Part

    out, up = 8.0 * math.sin(math.radians(lean)), 8.0 * math.cos(math.radians(lean))
    face = Part.makeCone(20, 20 + out, up).Faces[0]
    if squeezed:  # no longer of revolution
        turned = FreeCAD.Matrix(1, 0, 0, 0, 0, 0.98, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1)
        face = face.toNurbs().transformGeometry(turned).Faces[0]
    Part.Compound([face]).exportStep(str(folder / "skin.step"))


def groove(folder):
    """In which the nozzle of CELL has room upright, and nowhere else."""
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
    """Where the tool meets something, or leans through a singularity, with directions that follow the wall."""
    skin(workshop.folder, lean, squeezed=kind == "surface")
    more = sections(workshop.folder)
    workshop.write_job(written_for(kind, more))
    done = workshop.run("plan", "cup.yaml", "--no-page")
    assert done.status == 3 and f"error[{code}]" in done.err, done.err
    assert done.err.splitlines()[0] == (
        "note[REMEDY] job: the job is feasible with `build_direction.mode: fixed`; tested, not applied"
    ), done.err
    workshop.write_job(written_for(kind, more + "build_direction: {mode: fixed}\n"))
    again = workshop.run("plan", "cup.yaml", "--no-page")
    assert again.status == 0 and "error[" not in again.err and "REMEDY" not in again.err, again.err
    asked = workshop.files()["waypoints.csv"]
    workshop.write_job(written_for("auto", more))
    chosen = workshop.run("plan", "cup.yaml", "--no-page")
    assert chosen.status == 0 and workshop.files()["waypoints.csv"] == asked, chosen.err
    issues = json.loads(workshop.files()["report.json"])["issues"]
    told = [issue["message"] for issue in issues if issue["code"] == "PROPOSED"]
    assert told[0].startswith(f"kind: {kind}: ") and told[0].endswith(
        f"end with {code}, so all directions are the same (build_direction.mode: fixed)"
    )
    workshop.write_job(written_for("auto", more + "build_direction: {mode: local}\n"))
    assert workshop.run("plan", "cup.yaml", "--no-page").status == 3, (
        "what the job says of directions counts"
    )


def test_one_direction_that_does_not_clear_the_nozzle_is_told_to(workshop):
    """Under a lid."""
    import FreeCAD
    import Part

    Part.makeCylinder(200, 4, FreeCAD.Vector(0, 0, 20)).exportStep(
        str(workshop.folder / "groove.step")
    )
    skin(workshop.folder, 30, squeezed=False)
    for kind in ("revolution", "auto"):
        workshop.write_job(written_for(kind, "fixtures: [{file: groove.step}]\n"))
        done = workshop.run("plan", "cup.yaml", "--no-page")
        assert done.status == 3 and "error[CLEARANCE]" in done.err, done.err
        assert (
            "note[NO_REMEDY] job: the nozzle is not clear with `build_direction.mode: fixed` either"
            in done.err
        ), done.err
