# SPDX-License-Identifier: LGPL-2.1-or-later
"""Pages of jobs whose names, labels and remarks contain markup, script and the ends of both have
the elements of the same job in plain words, and show the texts in full."""

import html.parser
import json
import re

import FreeCAD
import Part
import pytest

from freecad_am.core.kinematics.machines import machine
from tests.batch.conftest import Workshop

# for names of files, jobs and features: no slash, no control characters
NAME = "<img src=x onerror=alert(1)>\"'&lt;<!--]]>${%s#"
# for all other texts
TEXT = (
    f"</script></style></title></svg><script>alert(2)</script>\u2028\u202e{{{{7*7}}}}$\\frac{NAME}"
)


class Elements(html.parser.HTMLParser):
    """The elements of a page with the names of their attributes, those of pictures separately, the
    values that a browser acts on, and its texts."""

    def __init__(self, page):
        super().__init__(convert_charrefs=True)
        self.found, self.drawn, self.acts, self.texts = [], set(), [], []
        self.pictures = 0
        self.feed(page)
        self.close()

    def handle_starttag(self, tag, attributes):
        self.pictures += tag == "svg"
        kind = tag, tuple(name for name, _ in attributes)
        self.drawn.add(kind) if self.pictures else self.found.append(kind)
        self.acts += [
            value
            for name, value in attributes
            if name.startswith("on") or name in ("href", "src", "action")
        ]
        self.texts += [value for name, value in attributes if name in ("aria-label", "title")]

    def handle_endtag(self, tag):
        self.pictures -= tag == "svg"

    def handle_data(self, data):
        self.texts.append(data)


def machine_file(folder, name, plain, text):
    """Write a machine as a user's file with these texts as title and names of axes and limits."""
    machine_data = json.loads((machine.BUILT_IN / f"{name}.json").read_text(encoding="utf-8"))
    machine_data["id"], machine_data["title"] = "own", f"title {text}"
    for number, joint in enumerate(machine_data["joints"], 1):
        joint["label"] = f"{number} {text}"
    machine_data["limits"] = {
        **machine_data["limits"],
        f"set {text}": machine_data["limits"][plain],
    }
    (folder / "own.json").write_text(json.dumps(machine_data), encoding="utf-8")


def page_of(shop, command, job, file="report.html"):
    (shop.folder / "job.yaml").write_text(json.dumps(job), encoding="utf-8")
    ended_command = shop.run(command, "job.yaml", "-o", "out")
    assert (
        ended_command.status in (0, 3)
        and "Traceback" not in ended_command.err
        and "INTERNAL" not in ended_command.err
    ), ended_command.err
    assert all(line.isprintable() for line in ended_command.err.split("\n"))
    return (shop.folder / "out" / file).read_text(encoding="utf-8")


def revolution(folder, name, text):
    up = FreeCAD.Vector(0, 0, 1)
    Part.makeSphere(40.0, FreeCAD.Vector(), up, 0, 60, 360).exportStep(str(folder / "cup.step"))
    Part.makeBox(10, 10, 5, FreeCAD.Vector(80, 0, 0)).exportStep(
        str(folder / f"fixture {name}.step")
    )
    machine_file(folder, "fanuc-arcmate120ic", "paper", text)
    return {
        "name": f"job {name}",
        "part": {"file": "cup.step"},
        "fixtures": [{"file": f"fixture {name}.step"}],
        "strategy": {"layer_height": "8 mm", "chord_error": "0.5 mm"},
        "process": {"material": {"name": f"wire {text}", "source": f"source {text}"}},
        "cell": {
            "machine": "own.json",
            "limits": f"set {text}",
            "branch": "auto",
            "obstacles": [
                {
                    "name": f"post {text.replace('=', '').replace(';', '')}",
                    "box": [60, 60, 60],
                    "pose": [0, 1500, 0, 0, 0, 0],
                }
            ],
        },
        "program": {"post": "none"},
        "place": {"x": "100 mm", "y": "0 mm", "z": "0 mm", "points": 20, "proven": 1},
    }


def solids(folder, name, text):
    """Write a job of two features on a scanned plate."""
    Part.makeBox(40, 40, 10, FreeCAD.Vector(0, 0, 0)).exportStep(str(folder / "foot.step"))
    Part.makeBox(60, 60, 10, FreeCAD.Vector(-10, -10, -10)).exportStep(str(folder / "plate.step"))
    rows = [f"{x},{y},{0.01 * x}" for x in range(-10, 51, 2) for y in range(-10, 51, 2)]
    (folder / f"scan {name}.csv").write_text("\n".join(["x,y,z", *rows, ""]), encoding="utf-8")
    return {
        "name": f"job {name}",
        "part": {"file": "foot.step"},
        "substrate": {"file": "plate.step", "scan": f"scan {name}.csv", "scan_fit": "none"},
        "strategy": {
            "kind": "solid",
            "layer_height": "5 mm",
            "bead_spacing": "8 mm",
            "chord_error": "0.5 mm",
        },
    }


def several(folder, name, text):
    for x, high in ((0, 10), (60, 20)):
        Part.makeBox(30, 30, high, FreeCAD.Vector(x, 0, 0)).exportStep(str(folder / f"box{x}.step"))
    return {
        "name": f"job {name}",
        "strategy": {"kind": "solid", "layer_height": "5 mm", "bead_spacing": "8 mm"},
        "features": [
            {"name": f"feature {x} {name}", "part": {"file": f"box{x}.step"}} for x in (0, 60)
        ],
    }


def pages(folder, root, job, command, file, name, text):
    folder.mkdir()
    shop = Workshop(folder, root / "freecad-am")
    return page_of(shop, command, job(folder, name, text), file)


@pytest.mark.parametrize(("job", "command", "file", "shown"), [
    (revolution, "plan", "report.html", ["job {name}", "title {text}", "1 {text}", "wire {text}", "set {text}"]),
    (solids, "plan", "report.html", ["job {name}", "scan {name}.csv"]),
    (several, "plan", "report.html", ["job {name}", "feature 60 {name}"]),
    pytest.param(revolution, "place", "place.html", ["job {name}"], marks=pytest.mark.long),
], ids=["revolution", "scan", "features", "place"])  # fmt: skip
def test_a_page_has_the_elements_of_the_same_job_in_plain_words(
    tmp_path, root, job, command, file, shown
):
    plain = Elements(pages(tmp_path / "plain", root, job, command, file, "plain", "words"))
    page = pages(tmp_path / "hostile", root, job, command, file, NAME, TEXT)
    hostile = Elements(page)
    assert (
        hostile.found == plain.found and hostile.drawn <= plain.drawn
    )  # long names leave room for fewer entries in a key
    assert not [act for act in hostile.acts if act not in plain.acts]
    page_texts = "\n".join(hostile.texts)
    for text in shown:
        assert text.format(name=NAME, text=TEXT) in page_texts, text
    facts = re.search(r'id="path-facts">(.*?)</script>', page, re.DOTALL)
    if facts is not None and "1 {text}" in shown:
        assert f"1 {TEXT}" in {
            axis["name"] for axis in json.loads(facts[1])["axes"]
        }  # in full, in the data of the script
