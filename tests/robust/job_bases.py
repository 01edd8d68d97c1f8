# SPDX-License-Identifier: LGPL-2.1-or-later
"""Valid jobs to start from: every shipped example, and every family on every machine, coarse enough
for a second each."""

import copy
import functools
import json
from pathlib import Path

import FreeCAD
import Part
import yaml

from freecad_am.core.kinematics.machines import machine as machines
from freecad_am.objects.checks.controllers import written_by
from freecad_am.posts import catalogue
from tests.core.kinematics.arms import EXAMPLES as MACHINES

ROOT = Path(__file__).resolve().parents[2]
EXAMPLES = ROOT / "resources" / "examples"
MACHINE_FILES = ROOT / "freecad_am" / "machines"
# mm; about eight layers each, and a few of each of FAMILIES: these are most jobs of a round
# fmt: off
LAYERS = {
    "hemisphere": 12, "hemisphere-on-table": 12, "hemisphere-on-positioner": 12, "intake-funnel": 14, "laval-nozzle": 14,
    "tube-on-pipe": 14, "tube-on-pipe-staubli": 14, "thruster": 30, "branched-tube-on-plate": 10, "elbow-on-block": 9,
    "flared-shell-on-dome": 9, "half-shell-on-rod": 10, "skewed-bend": 12, "spatial-pipe-on-cone": 9, "bracket": 15,
    "tube-on-scanned-pipe": 14, "wide-tube-on-pipe": 14, "wye": 9, "finned-hub": 8, "pipe-bend": 8, "rosette": 2,
    "die": 3, "rotor-on-positioner": 16,
}
# fmt: on
FAMILIES = {
    "revolution": {
        "part": {"file": "cup.step"},
        "strategy": {"kind": "revolution", "layer_height": "8 mm"},
    },
    "surface": {
        "part": {"file": "tube.brep"},
        "substrate": {"file": "block.step"},
        "strategy": {"kind": "surface", "layer_height": "10 mm"},
    },
    "developable": {
        "part": {"file": "boxes.brep"},
        "substrate": {"file": "hub.step"},
        "strategy": {"kind": "developable", "layer_height": "4 mm", "bead_spacing": "9 mm"},
    },
    "curves": {
        "part": {"file": "beads.csv"},
        "strategy": {"kind": "curves", "layer_height": "3 mm", "repeat": 2},
    },
    "solid": {
        "part": {"file": "bracket.step"},
        "strategy": {"kind": "solid", "layer_height": "10 mm", "bead_spacing": "10 mm"},
    },
    "cladding": {
        "part": {"file": "hub.step", "faces": ["Face1"]},
        "strategy": {
            "kind": "cladding",
            "layer_height": "3 mm",
            "bead_spacing": "14 mm",
            "layers": 2,
        },
    },
    "features": {
        "strategy": {"layer_height": "10 mm"},
        "features": [
            {
                "name": "bracket",
                "part": {"file": "bracket.step"},
                "strategy": {"kind": "solid", "bead_spacing": "10 mm"},
            },
            {"name": "post", "part": {"file": "post.step"}, "strategy": {"kind": "revolution"}},
        ],
    },
}
CLASSES = {
    "first_layer": {"travel_speed": "4 mm/s", "schedule": 1},
    "fill": {"lead": "3 deg", "lead_on": "0.2 s"},
    "contour": {
        "travel_speed": "8 mm/s",
        "schedule": 3,
        "start": {"length": "2 mm", "travel_speed": "3 mm/s"},
    },
    "wall": {"tilt": "2 deg", "end": {"length": "2 mm", "travel_speed": "9 mm/s"}},
}
ENDS = {
    "start": {"length": "2 mm", "travel_speed": "5 mm/s"},
    "end": {"length": "3 mm", "travel_speed": "8 mm/s"},
}
# options for any family, and the families that accept them
FAMILY_OPTIONS = {
    "classes": (
        {"process": {"schedule": 2, "classes": CLASSES, **ENDS}},
        ("solid", "surface", "features"),
    ),
    "scan": ({"substrate": {"file": "block.step", "scan": "block.csv"}}, ("surface", "post")),
    "place": (
        {"place": {"x": "100 mm", "y": "0 mm", "z": "100 mm", "points": 40, "proven": 1}},
        ("revolution", "curves"),
    ),
}
TOLD_ON = ("abb-irb1600-6-12", "fanuc-arcmate120ic", "table-xyzac", "ur-ur10e")
POST = {
    "part": {"file": "pin.step"},
    "strategy": {"kind": "solid", "layer_height": "5 mm", "bead_spacing": "5 mm"},
}
PULSES = (
    1435.3,
    1308.25,
    -1313.5,
    980.0,
    876.8125,
    454.75,
)  # speed and acceleration of each axis, in the form of a user's machine file
RAIL = {"machine": "kuka-kl100-2", "pose": [0, 0, -356, 0, 0, 90], "carries": "robot"}
TURNS = {"machine": "motoman-motopos-d500", "pose": [850, 60, -300, 0, 0, 20], "carries": "part"}
# machine: where the part is, and its post
TRACKS = {
    "fanuc-arcmate120ic": ([1000, 500, -100, 0, 0, 0], "fanuc"),
    "motoman-ma2010": ([1000, 500, -300, 0, 0, 0], "yaskawa"),
    "kuka-kr16-2": ([1050, 500, 200, 0, 0, 0], "kuka"),
    "abb-irb1600-6-12": ([800, 500, 100, 0, 0, 0], "abb"),
}


def write_parts(folder):
    """Write the small parts of FAMILIES, a mesh of each, scans of the block, machine files of a
    user, and a document."""
    up = FreeCAD.Vector(0, 0, 1)
    cup = Part.makeSphere(30.0, FreeCAD.Vector(), up, 0, 60, 360)
    cup.exportStep(str(folder / "cup.step"))
    cup.exportIges(str(folder / "cup.igs"))
    tube = Part.makeCylinder(12.0, 40.0).Faces[0]
    tube.exportBrep(str(folder / "tube.brep"))
    Part.makeBox(40, 40, 10, FreeCAD.Vector(-20, -20, -10)).exportStep(str(folder / "block.step"))
    angle = Part.makeBox(50, 40, 15).fuse(Part.makeBox(15, 40, 40))
    angle.cut(Part.makeCylinder(8, 60, FreeCAD.Vector(32, 20, -5))).exportStep(
        str(folder / "bracket.step")
    )
    Part.makeCylinder(6, 20, FreeCAD.Vector(7.5, 20, 40)).exportStep(str(folder / "post.step"))
    Part.makeCylinder(9, 25).exportStep(str(folder / "pin.step"))
    scan = [(x, y, 0.01 * x) for x in range(-20, 21) for y in range(-20, 21)]
    scan += [(side, y, z) for side in (-20, 20) for y in range(-20, 21) for z in range(-10, 0)]
    scan += [(x, side, z) for side in (-20, 20) for x in range(-20, 21) for z in range(-10, 0)]
    lines = [" ".join(f"{number:.6g}" for number in point) for point in scan]
    (folder / "block.xyz").write_text("\n".join([*lines, ""]), encoding="utf-8")
    rows = ["x,y,z", *(line.replace(" ", ",") for line in lines), ""]
    (folder / "block.csv").write_text("\n".join(rows), encoding="utf-8")
    head = (
        "ply",
        "format ascii 1.0",
        f"element vertex {len(lines)}",
        *(f"property float {axis}" for axis in "xyz"),
    )
    (folder / "block.ply").write_text(
        "\n".join([*head, "end_header", *lines, ""]), encoding="utf-8"
    )
    Part.makeBox(40, 40, 10, FreeCAD.Vector(-20, -20, -10)).exportStl(str(folder / "block.stl"))
    (folder / "beads.csv").write_text(
        "x,y,z,bead\n0,0,0,1\n30,0,0,1\n30,20,0,1\n0,6,0,2\n20,6,0,2\n", encoding="utf-8"
    )
    hub = Part.makeCylinder(25.0, 80.0)
    hub.exportStep(str(folder / "hub.step"))
    hub.exportStl(str(folder / "hub.stl"))
    boxes = [Part.makeBox(24, 30, 30, FreeCAD.Vector(10, -15, 20)).cut(hub)]
    boxes.append(boxes[0].rotated(FreeCAD.Vector(), up, 180.0))
    Part.Compound(boxes).exportBrep(str(folder / "boxes.brep"))
    Part.Compound(boxes).exportStl(str(folder / "boxes.stl"))
    for name in ("motoman-ma2010", "mechanisms/kuka-kl100-2", "mechanisms/motoman-motopos-d500"):
        machine = json.loads((MACHINE_FILES / f"{name}.json").read_text(encoding="utf-8"))
        machine["controller"] |= {
            "pulses_per_degree": PULSES[: len(machine["joints"])],
            "speed_unit": "mm/s",
        }
        machine["id"] += "-of-a-user"
        (folder / f"{Path(name).name}.json").write_text(json.dumps(machine), encoding="utf-8")
    document = FreeCAD.newDocument("Parts")
    document.addObject("Part::Cylinder", "Cylinder").Radius = 25
    document.addObject("Part::Feature", "Cup").Shape = cup
    document.recompute()
    document.saveAs(str(folder / "parts.FCStd"))
    FreeCAD.closeDocument(document.Name)


@functools.cache
def bases(folder):
    """Return (name, job) of all bases; a job is a tree of values with absolute paths of its parts,
    and the small parts are in `folder`."""
    jobs = [(path.stem, _example(path)) for path in sorted(EXAMPLES.rglob("*.yaml"))]
    for machine in sorted(MACHINES, key="{}.json".format):
        jobs += [
            (f"{family} on {machine}", _place_on_machine(machine, sections, folder))
            for family, sections in FAMILIES.items()
        ]
    return jobs + [*_add_options(folder), *_put_on_tracks(folder)]


def _add_options(folder):
    """Return jobs of some families and machines with additional sections, those of
    FAMILY_OPTIONS."""
    for machine in TOLD_ON:
        for what, (options, families) in FAMILY_OPTIONS.items():
            for family in families:
                sections = {**(POST if family == "post" else FAMILIES[family]), **options}
                yield (
                    f"{what} of {family} on {machine}",
                    _place_on_machine(machine, sections, folder),
                )


def _put_on_tracks(folder):
    """Return jobs of robots on a track, with and without a positioner."""
    for machine, (point, post) in TRACKS.items():
        for family in ("curves", "solid"):
            for external in ([RAIL], [TURNS], [RAIL, TURNS]):
                job = _place_on_machine(machine, FAMILIES[family], folder)
                cell = {
                    "machine": machine,
                    "setup": "tool-on-robot",
                    "mount": "part",
                    "branch": "auto",
                    "external": copy.deepcopy(external),
                    "platform_diameter": "100 mm",
                    "nozzle": {"tool": [0, 0, 250, 0, 0, 0]},
                }
                if post == "yaskawa":
                    for values in (cell, *cell["external"]):
                        values["machine"] = str(Path(folder) / f"{values['machine']}.json")
                cell.update(
                    {"platform": "10 mm"} if TURNS in external else {"deposition_point": point}
                )
                program = {"post": post, "motion": "cartesian" if post == "kuka" else "joint"}
                yield f"rail of {family} on {machine}", {**job, "cell": cell, "program": program}


def _place_on_machine(name, sections, folder):
    """Return the job of a family on a machine."""
    machine = json.loads((MACHINE_FILES / f"{name}.json").read_text(encoding="utf-8"))
    job = copy.deepcopy(sections)
    for where in (job, *job.get("features", ())):
        for section in (where[key] for key in ("part", "substrate") if key in where):
            section.update(
                {
                    key: str(Path(folder) / section[key])
                    for key in ("file", "scan")
                    if key in section
                }
            )
    job["strategy"]["chord_error"] = "0.5 mm"
    job["cell"] = _cell(machine)
    posts = written_by(machines.load(machine["id"], ())) or ()
    fit = catalogue.fitting(posts, "joint", job["cell"].get("setup", "part-on-robot"))
    job["program"] = {"post": next(iter(fit), "none")}
    return job


def _example(path):
    job = yaml.safe_load(path.read_text(encoding="utf-8"))
    for key in ("part", "substrate"):
        if key in job:
            job[key]["file"] = str((path.parent / job[key]["file"]).resolve())
    job["strategy"].update(layer_height=f"{LAYERS[path.stem]} mm", chord_error="0.3 mm")
    job.get("joints", {}).pop("compare", None)
    return job


def _cell(machine):
    if any(joint.get("type") == "prismatic" for joint in machine["joints"]):
        return {"machine": machine["id"], "setup": "rotary-table", "platform": "60 mm"}
    reach = max(sum(map(abs, pose["origin"][:2])) for pose in machine["check_poses"])
    point = [round(0.45 * reach), 0, round(0.35 * reach), 0, 0, 0]
    return {"machine": machine["id"], "deposition_point": point, "branch": "auto"}
