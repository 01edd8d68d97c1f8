# SPDX-License-Identifier: LGPL-2.1-or-later
"""The same job gives the same bytes for any number of linear algebra threads and any order of sets.
A vase that a KUKA carries is at limits, so its joints are optimised; with an unrestricted number of
threads its waypoints.csv varied. Each run is a separate process, because numpy reads the number
when it is loaded."""

import ctypes
import json
import os
import subprocess
import sys
import threading
from pathlib import Path

import pytest

from freecad_am.core import one_thread

pytestmark = pytest.mark.any_version

ROOT = Path(__file__).resolve().parent.parent.parent
VASE = """
import FreeCAD
import Part
from FreeCAD import Vector
def vase(scale):
    curve = Part.BSplineCurve()
    curve.interpolate([Vector(scale * x, 0, scale * z)
                       for x, z in ((40, 0), (62, 40), (66, 80), (38, 130), (34, 155), (55, 180))])
    return curve.toShape().revolve(Vector(0, 0, 0), Vector(0, 0, 1), 360)
"""
# like a user's macro: numpy is loaded first with all its threads, and used again afterwards
MACRO = (
    """
import sys, hashlib, json, os
sys.path.insert(0, {root!r})
from freecad_am.batch import host
host.find_freecad()
import numpy as np
import FreeCAD as App
from freecad_am.core import one_thread
import freecad_am.api as am
from freecad_am.core.simulation import waypoints
from freecad_am.core.kinematics.proposed_cell import cell_of
"""
    + VASE
    + """
def made(machine, scale, **joints):
    doc = App.newDocument()
    part = doc.addObject("Part::Feature", "Vase")
    part.Shape = vase(scale)
    cell = am.make_cell(doc, parameters=cell_of(machine))
    toolpath = am.make_toolpath(doc, am.make_feature(doc, part, layer_height=20 * scale, chord_error=0.1), cell)
    return doc, am.make_joint_path(doc, toolpath, cell, **joints)

told = [number.get() for number in one_thread._numbers()]
doc, path = made("kuka-kr16-2", 1.0)
axes = tuple(f"q{{k}}" for k in range(1, 7))
texts = {{"waypoints": "".join(waypoints.text(am.result(path).motion, axes))}}
doc, path = made("fanuc-arcmate120ic", 0.3, objective="condition")
texts["path"] = "".join(waypoints.text(am.result(path).motion, axes))
program = am.make_program(doc, path, name="vase", post="fanuc")
texts.update({{name: content.decode("latin-1") for name, content in am.result(program).files.items()}})
after = [number.get() for number in one_thread._numbers()]
print(json.dumps({{"texts": texts, "told": told, "after": after}}))
sys.stdout.flush()
os._exit(0)
"""
)
THREADS = ("1", "4")


def in_process(code, threads, seed):
    environment = {
        key: value for key, value in os.environ.items() if key not in one_thread.ENVIRONMENT
    }
    environment.update(OPENBLAS_NUM_THREADS=threads, PYTHONHASHSEED=seed)
    process = subprocess.run(
        [sys.executable, "-c", code],
        capture_output=True,
        text=True,
        check=False,
        env=environment,
        timeout=300,
    )
    assert process.returncode == 0, process.stderr
    return json.loads(process.stdout.splitlines()[-1])


@pytest.fixture(scope="module")
def runs():
    """Return the results of a macro for several numbers of threads, each with another hash seed."""
    return {
        threads: in_process(MACRO.format(root=str(ROOT)), threads, threads) for threads in THREADS
    }


def test_a_macro_makes_the_same_bytes_with_any_number_of_threads(runs):
    single_thread = runs["1"]["texts"]
    assert len(single_thread) > 2 and single_thread["waypoints"].count("\n") > 300
    for threads in THREADS[1:]:
        assert runs[threads]["texts"] == single_thread


def test_other_users_of_numpy_get_their_threads_back(runs):
    for threads in THREADS:
        assert runs[threads]["after"] == runs[threads]["told"]


def test_a_job_makes_the_same_bytes_with_any_number_of_threads(tmp_path):
    (tmp_path / "vase.py").write_text(
        f"import sys, os\nsys.path.insert(0, {str(ROOT)!r})\nfrom freecad_am.batch import host\nhost.find_freecad()\n"
        + VASE
        + f"vase(1.0).exportStep({str(tmp_path / 'vase.step')!r})\nos._exit(0)\n",
        encoding="utf-8",
    )
    subprocess.run([sys.executable, str(tmp_path / "vase.py")], check=True, capture_output=True)
    (tmp_path / "vase.yaml").write_text(
        "version: 1\nname: vase\npart: {file: vase.step}\n"
        "strategy: {kind: revolution, layer_height: 20 mm, chord_error: 0.1 mm}\n"
        "cell: {machine: kuka-kr16-2, deposition_point: [1321, 0, 1621, 0, 0, 0], branch: [front, down, flip]}\n",
        encoding="utf-8",
    )
    texts = []
    for threads in ("1", "2"):
        environment = {
            key: value for key, value in os.environ.items() if key not in one_thread.ENVIRONMENT
        }
        out = tmp_path / threads
        subprocess.run(
            [
                str(ROOT / "freecad-am"),
                "plan",
                str(tmp_path / "vase.yaml"),
                "-o",
                str(out),
                "--no-page",
            ],
            check=True,
            capture_output=True,
            env={**environment, "OPENBLAS_NUM_THREADS": threads},
            timeout=300,
        )
        texts.append((out / "waypoints.csv").read_bytes())
    assert texts[0] == texts[1]


def test_the_library_below_numpy_is_found():
    """If the library is an OpenBLAS it is found; others may have a single thread."""
    maps = Path("/proc/self/maps")
    if not maps.exists() or "openblas" not in maps.read_text(encoding="utf-8"):
        pytest.skip("no OpenBLAS here")
    file = next(
        line.split()[-1]
        for line in maps.read_text(encoding="utf-8").splitlines()
        if "openblas" in line.split()[-1]
    )
    library = ctypes.CDLL(file)
    with one_thread.one_thread():
        assert library.openblas_get_num_threads() == 1


def test_the_last_one_to_leave_gives_the_threads_back(monkeypatch):
    number = [5]
    fake = one_thread._Number(lambda: number[0], lambda count: number.__setitem__(0, count))
    monkeypatch.setattr(one_thread, "_numbers", lambda: (fake,))
    one_thread.hold()
    worker = threading.Thread(target=lambda: (one_thread.limit_calling_thread(), one_thread.hold()))
    worker.start()
    worker.join()
    one_thread.release()
    assert number == [1]
    one_thread.release()
    assert number == [5]
    with pytest.raises(ValueError, match="ours"), one_thread.one_thread():
        assert number == [1]
        raise ValueError("ours")
    assert number == [5]
