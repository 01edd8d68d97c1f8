# SPDX-License-Identifier: LGPL-2.1-or-later
"""Sound jobs to start from: every shipped example, and every family on every machine; coarse, of a second each."""

import copy
import functools
import json
from pathlib import Path

import FreeCAD
import Part
import yaml

from freecad_am.core.kinematics import machine as machines
from freecad_am.objects.controllers import written_by
from freecad_am.posts import catalogue
from tests.core.kinematics.arms import EXAMPLES as MACHINES

ROOT = Path(__file__).resolve().parents[2]
EXAMPLES = ROOT / "resources" / "examples"
# mm; about eight layers each, and a few of each of FAMILIES: most of a round are jobs of these
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
    "revolution": {"part": {"file": "cup.step"}, "strategy": {"kind": "revolution", "layer_height": "8 mm"}},
    "surface": {
        "part": {"file": "tube.brep"}, "substrate": {"file": "block.step"},
        "strategy": {"kind": "surface", "layer_height": "10 mm"},
    },
    "developable": {
        "part": {"file": "boxes.brep"}, "substrate": {"file": "hub.step"},
        "strategy": {"kind": "developable", "layer_height": "4 mm", "bead_spacing": "9 mm"},
    },
    "curves": {
        "part": {"file": "beads.csv"}, "strategy": {"kind": "curves", "layer_height": "3 mm", "repeat": 2},
    },
    "solid": {
        "part": {"file": "bracket.step"}, "strategy": {"kind": "solid", "layer_height": "10 mm", "bead_spacing": "10 mm"},
    },
    "cladding": {
        "part": {"file": "hub.step", "faces": ["Face1"]},
        "strategy": {"kind": "cladding", "layer_height": "3 mm", "bead_spacing": "14 mm", "layers": 2},
    },
    "features": {
        "strategy": {"layer_height": "10 mm"},
        "features": [
            {"name": "bracket", "part": {"file": "bracket.step"}, "strategy": {"kind": "solid", "bead_spacing": "10 mm"}},
            {"name": "post", "part": {"file": "post.step"}, "strategy": {"kind": "revolution"}},
        ],
    },
}


def write_parts(folder):
    """The small parts of FAMILIES, a mesh of each, and a document."""
    up = FreeCAD.Vector(0, 0, 1)
    cup = Part.makeSphere(30.0, FreeCAD.Vector(), up, 0, 60, 360)
    cup.exportStep(str(folder / "cup.step"))
    cup.exportIges(str(folder / "cup.igs"))
    tube = Part.makeCylinder(12.0, 40.0).Faces[0]
    tube.exportBrep(str(folder / "tube.brep"))
    Part.makeBox(40, 40, 10, FreeCAD.Vector(-20, -20, -10)).exportStep(str(folder / "block.step"))
    angle = Part.makeBox(50, 40, 15).fuse(Part.makeBox(15, 40, 40))
    angle.cut(Part.makeCylinder(8, 60, FreeCAD.Vector(32, 20, -5))).exportStep(str(folder / "bracket.step"))
    Part.makeCylinder(6, 20, FreeCAD.Vector(7.5, 20, 40)).exportStep(str(folder / "post.step"))
    (folder / "beads.csv").write_text("x,y,z,bead\n0,0,0,1\n30,0,0,1\n30,20,0,1\n0,6,0,2\n20,6,0,2\n", encoding="utf-8")
    hub = Part.makeCylinder(25.0, 80.0)
    hub.exportStep(str(folder / "hub.step"))
    hub.exportStl(str(folder / "hub.stl"))
    boxes = [Part.makeBox(24, 30, 30, FreeCAD.Vector(10, -15, 20)).cut(hub)]
    boxes.append(boxes[0].rotated(FreeCAD.Vector(), up, 180.0))
    Part.Compound(boxes).exportBrep(str(folder / "boxes.brep"))
    Part.Compound(boxes).exportStl(str(folder / "boxes.stl"))
    document = FreeCAD.newDocument("Parts")
    document.addObject("Part::Cylinder", "Cylinder").Radius = 25
    document.addObject("Part::Feature", "Cup").Shape = cup
    document.recompute()
    document.saveAs(str(folder / "parts.FCStd"))
    FreeCAD.closeDocument(document.Name)


@functools.cache
def bases(folder):
    """(name, job) of all, the job as values with absolute paths of its parts, of which the small ones are in `folder`."""
    found = [(path.stem, _example(path)) for path in sorted(EXAMPLES.rglob("*.yaml"))]
    for path in sorted(ROOT / "freecad_am" / "machines" / f"{name}.json" for name in MACHINES):
        machine = json.loads(path.read_text(encoding="utf-8"))
        for family, sections in FAMILIES.items():
            job = copy.deepcopy(sections)
            for where in (job, *job.get("features", ())):
                for key in ("part", "substrate"):
                    if key in where:
                        where[key]["file"] = str(Path(folder) / where[key]["file"])
            job["strategy"]["chord_error"] = "0.5 mm"
            job["cell"] = _cell(machine)
            posts = written_by(machines.load(machine["id"], ())) or ()
            fit = catalogue.fitting(posts, "joint", job["cell"].get("setup", "part-on-robot"))
            job["program"] = {"post": next(iter(fit), "none")}
            found.append((f"{family} on {machine['id']}", job))
    return found


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
