# SPDX-License-Identifier: LGPL-2.1-or-later
"""Machine files: their contents, and every kind of error in them."""

import copy
import json
import os
import re
import shutil
import subprocess
import sys

import numpy as np
import pytest

from freecad_am.core.issues import InputError
from freecad_am.core.kinematics.machines import machine

GOOD = json.loads((machine.BUILT_IN / "fanuc-arcmate120ic.json").read_text(encoding="utf-8"))


def test_all_built_in_machines_load():
    built_in = machine.known()
    assert len(built_in) == len(list(machine.BUILT_IN.glob("*.json"))) > 0
    for name, title in built_in:
        arm = machine.load(name)
        assert (arm.id, arm.title) == (name, title)
        assert (arm.arm is not None) == (arm.free > 0) and arm.sources and arm.controller_remark
        assert np.isfinite(arm.max_speed).all() and (arm.max_speed > 0).all()
        assert "maker" in arm.limit_sets
        assert all((limits.upper > limits.lower).all() for limits in arm.limit_sets.values())
        assert arm.posts is not None


def test_tables_have_the_kinematics_that_linuxcnc_gives_them():
    # the running controller's inverse, checked at standstill: the point at the tip of the torch
    rng = np.random.default_rng(4)
    point, (tilt, turn) = rng.uniform(-200, 200, (50, 3)), rng.uniform(-2, 2, (2, 50))
    x, y = (
        np.cos(turn) * point[:, 0] - np.sin(turn) * point[:, 1],
        np.sin(turn) * point[:, 0] + np.cos(turn) * point[:, 1],
    )
    c, s, z = np.cos(tilt), np.sin(tilt), point[:, 2] - 10.0
    tips = {
        "table-xyzac": (x, c * (y - 20.0) - s * z + 20.0, s * (y - 20.0) + c * z + 10.0),
        "table-xyzbc": (c * (x - 20.0) + s * z + 20.0, y, -s * (x - 20.0) + c * z + 10.0),
    }
    for name, tip in tips.items():
        table = machine.load(name)
        assert table.units == ("mm", "mm", "mm", "deg", "deg")
        flange = table.chain.forward(np.column_stack((*tip, tilt, turn)))
        at_tip = np.einsum("nij,nj->ni", flange[:, :3, :3], point) + flange[:, :3, 3]
        np.testing.assert_allclose(at_tip, 0.0, atol=1e-10)
        lower, upper = table.limits("maker").lower, table.limits("maker").upper
        assert (
            lower[0] == -500.0
            and upper[3] == pytest.approx(np.radians(120.0))
            and np.isinf(upper[4])
        )


def test_the_arc_mate_is_that_of_the_data():
    arm = machine.load("fanuc-arcmate120ic")
    assert arm.axes == ("q1", "q2", "q3", "q4", "q5", "q6")
    assert machine.load("kuka-kr16-2").axes == ("A1", "A2", "A3", "A4", "A5", "A6")
    assert machine.load("motoman-mh12").axes == ("S", "L", "U", "R", "B", "T")
    assert np.array_equal(arm.base, [[1, 0, 0, 0], [0, 1, 0, 0], [0, 0, 1, 525], [0, 0, 0, 1]])
    assert np.degrees(arm.limits("maker").lower) == pytest.approx(
        (-170, -100, -90, -200, -140, -270)
    )
    assert np.degrees(arm.limits("paper").upper) == pytest.approx((185, 160, 273, 200, 135, np.inf))
    assert np.degrees(arm.max_speed) == pytest.approx((195, 175, 180, 360, 360, 550))
    zero = arm.chain.forward(np.zeros(6))
    assert zero[:3, 3] == pytest.approx((1085.0, 0.0, 1565.0))
    # the flange points ahead, its X up
    assert zero[:3, :3] == pytest.approx(np.array([[0, 0, 1], [0, -1, 0], [1, 0, 0]]), abs=1e-12)


def test_the_pendant_s_third_axis_is_against_the_horizontal():
    arm = machine.load("fanuc-arcmate120ic")
    q = np.random.default_rng(3).uniform(-3, 3, (5, 7, 6))
    controller_values = arm.to_controller(q)
    assert controller_values[..., 2] == pytest.approx(q[..., 2] - q[..., 1])
    assert np.array_equal(np.delete(controller_values, 2, axis=-1), np.delete(q, 2, axis=-1))
    assert np.abs(arm.from_controller(controller_values) - q).max() < 1e-14


def test_other_machines_show_serial_angles_and_say_it_is_unverified():
    for name in ("kuka-kr16-2", "staubli-rx60bl", "motoman-ar2010"):
        arm = machine.load(name)
        assert np.array_equal(arm.to_controller(np.arange(6.0)), np.arange(6.0))
        assert "unverified" in arm.controller_remark


def test_unknown_machine_names_its_neighbours(tmp_path):
    """An unknown machine name gets suggestions: similar names, or examples of each manufacturer."""
    with pytest.raises(InputError) as info:
        machine.load("fanuc_arcmate120ic")
    assert info.value.code == "UNKNOWN_MACHINE"
    assert "fanuc-arcmate120ic" in info.value.message
    with pytest.raises(InputError) as info:
        machine.load("zzz")
    message = info.value.message
    (such_as,) = re.findall("such as (.*), or the path", message)
    makers = {machine.load(example).id.partition("-")[0] for example in such_as.split(", ")}
    assert {"abb", "fanuc", "kuka", "staubli", "ur"} <= makers and len(makers) == such_as.count(
        ","
    ) + 1
    assert len(message) < 500  # a note below a field
    for path in (tmp_path / "none.json", tmp_path / "arm.urdf"):
        with pytest.raises(InputError) as info:
            machine.load(path)
        assert info.value.code == "UNKNOWN_MACHINE"


def test_unknown_limits_names_the_known():
    with pytest.raises(InputError) as info:
        machine.load("fanuc-arcmate120ic").limits("papper")
    assert info.value.code == "UNKNOWN_LIMITS"
    assert "maker, paper" in info.value.message


def test_the_user_s_folder_goes_first(tmp_path):
    content = copy.deepcopy(GOOD)
    content["title"] = "Mine"
    (tmp_path / "fanuc-arcmate120ic.json").write_text(json.dumps(content), encoding="utf-8")
    assert dict(machine.known([tmp_path]))["fanuc-arcmate120ic"] == "Mine"
    assert machine.load("fanuc-arcmate120ic", [tmp_path]).title == "Mine"
    assert machine.load(tmp_path / "fanuc-arcmate120ic.json").title == "Mine"
    assert machine.load("fanuc-arcmate120ic").title != "Mine"
    content["id"] = "other"
    (tmp_path / "fanuc-arcmate120ic.json").write_text(json.dumps(content), encoding="utf-8")
    with pytest.raises(InputError, match="differs from the file name"):
        machine.load("fanuc-arcmate120ic", [tmp_path])


@pytest.mark.parametrize("text", ['{"id": "broken", ', "{}", "[1, 2]", '{"title": 3}', "caf\u00e9"])
def test_a_file_that_is_no_machine_does_not_hide_the_others(tmp_path, text):
    """An invalid file is listed with its error and does not hide the others."""
    (tmp_path / "broken.json").write_text(text, encoding="latin-1")
    (tmp_path / "mine.json").write_text(json.dumps(GOOD), encoding="utf-8")
    titles = dict(machine.known([tmp_path]))
    assert titles["broken"].startswith("BAD_MACHINE: ") and len(titles["broken"]) > 20
    assert (
        titles["mine"] == GOOD["title"]
        and titles["kuka-kr16-2"] == machine.load("kuka-kr16-2").title
    )
    with pytest.raises(InputError) as info:
        machine.load("broken", [tmp_path])
    assert info.value.code == "BAD_MACHINE" and "broken.json" in info.value.where


def changed(*path, value=None, remove=False):
    content = copy.deepcopy(GOOD)
    node = content
    for key in path[:-1]:
        node = node[key]
    if remove:
        del node[path[-1]]
    else:
        node[path[-1]] = value
    return content


BAD = {
    "geometry": (
        changed("joints", 2, "origin", value=[0, 0, 791]),
        "check_poses[0]",
        "the joint frames give a flange pose that deviates by 1 mm",
    ),
    "closed form": (
        changed("opw", "c4", value=101),
        "check_poses[0]",
        "opw gives a flange pose that deviates by 1 mm",
    ),
    "pose": (changed("check_poses", 2, "origin", 1, value=0), "check_poses[2]", "mm"),
    "turned pose": (
        changed("check_poses", 0, "rotation", value=[[1, 0, 0], [0, 1, 0], [0, 0, 1]]),
        "check_poses[0]",
        "rotation",
    ),
    "two poses": (
        changed("check_poses", value=GOOD["check_poses"][:2]),
        "check_poses",
        "at least 3",
    ),
    "no zero pose": (
        changed("check_poses", value=GOOD["check_poses"][1:]),
        "check_poses",
        "all zeros",
    ),
    "no poses": (changed("check_poses", remove=True), "", "'check_poses' is missing"),
    "unknown key": (changed("colour", value="yellow"), "", "'colour' is not known"),
    "unknown joint key": (
        changed("joints", 1, "speed", value=3),
        "joints[1]",
        "'speed' is not known",
    ),
    "missing axis": (changed("joints", 1, "axis", remove=True), "joints[1]", "'axis' is missing"),
    "axis not unit": (
        changed("joints", 1, "axis", value=[0, 2, 0]),
        "joints[1].axis",
        "unit vector",
    ),
    "text for a number": (
        changed("joints", 0, "origin", value=[0, "0", 525]),
        "joints[0].origin[1]",
        '"0" is not a number',
    ),
    "two numbers for three": (changed("flange", "rpy", value=[0, 90]), "flange.rpy", "list of 3"),
    "speed of nought": (
        changed("joints", 5, "max_speed", value=0),
        "joints[5].max_speed",
        "more than 0",
    ),
    "five joints": (changed("joints", value=GOOD["joints"][:5]), "opw", "six joints"),
    "no joints": (changed("joints", value=[]), "joints", "no joint"),
    "sign of two": (changed("opw", "signs", value=[1, 1, -1, -1, -2, -1]), "opw.signs", "1 or -1"),
    "an offset too large": (
        changed("opw", "offsets", value=[0, 0, -90, 0, 190, 180]),
        "opw.offsets",
        "within +-180",
    ),
    "no upper arm": (changed("opw", "c2", value=0), "opw.c2", "more than 0 mm"),
    "limits upside down": (
        changed("limits", "maker", "axes", 1, value=[160, -100]),
        "limits.maker.axes[1]",
        "smaller value first",
    ),
    "no maker limits": (changed("limits", "maker", remove=True), "limits", "'maker' is missing"),
    "coupled without a label": (
        changed("limits", "maker", "coupled", 0, "label", remove=True),
        "limits.maker.coupled[0]",
        "'label'",
    ),
    "matrix without inverse": (
        changed("controller", "matrix", 2, value=[0, 1, 0, 0, 0, 0]),
        "controller.matrix",
        "no inverse",
    ),
    "acceleration of nought": (
        changed("joints", 5, "max_acceleration", value=0),
        "joints[5].max_acceleration",
        "more than 0",
    ),
    "jerk that is not a number": (
        changed("joints", 1, "max_jerk", value="much"),
        "joints[1].max_jerk",
        "much",
    ),
    "shape of no link": (
        changed("shapes", value={"joint_9": {"file": "a.stl"}}),
        "shapes",
        "'joint_9' is not known",
    ),
    "shape without a file": (
        changed("shapes", value={"base": {"scale": 2}}),
        "shapes.base",
        "'file' is missing",
    ),
    "shape of a wrong format": (
        changed("shapes", value={"joint_2": {"file": "a.dae"}}),
        "shapes.joint_2.file",
        "a.dae is not a supported shape format",
    ),
    "shape of no size": (
        changed("shapes", value={"base": {"file": "a.stl", "scale": 0}}),
        "shapes.base.scale",
        "1000 for m",
    ),
    "shape of no colour": (
        changed("shapes", value={"base": {"file": "a.stl", "colour": [255, 0, 0]}}),
        "shapes.base.colour",
        "from 0 to 1",
    ),
    "warning of nothing known": (
        changed("warnings", value=[{"applies_to": "speed", "text": "from memory"}]),
        "warnings[0].applies_to",
        "'speed' is not a valid target of a warning; use base, joint, limits, speeds, limits.maker",
    ),
    "warning of a set that is not there": (
        changed("warnings", value=[{"applies_to": "limits.papper", "text": "from memory"}]),
        "warnings[0].applies_to",
        "'limits.papper'",
    ),
    "warning without words": (
        changed("warnings", value=[{"applies_to": "base"}]),
        "warnings[0]",
        "'text' is missing",
    ),
    "warning with more": (
        changed("warnings", value=[{"applies_to": "base", "text": "a", "level": 3}]),
        "warnings[0]",
        "'level' is not known",
    ),
    "no title": (changed("title", value=""), "title", "not a text"),
    "not an object": ([1, 2], "", "not an object"),
}


@pytest.mark.parametrize("case", BAD)
def test_a_bad_file_is_named_with_key_and_reason(case, tmp_path):
    content, key, reason = BAD[case]
    path = tmp_path / "arm.json"
    path.write_text(json.dumps(content), encoding="utf-8")
    with pytest.raises(InputError) as info:
        machine.load(path)
    assert info.value.code == "BAD_MACHINE"
    assert info.value.where == (f"{path}: {key}" if key else str(path))
    assert reason in info.value.message


def test_a_key_that_stands_twice_is_refused(tmp_path):
    path = tmp_path / "arm.json"
    path.write_text(json.dumps(GOOD)[:-1] + ', "title": "Another"}', encoding="utf-8")
    with pytest.raises(InputError) as info:
        machine.load(path)
    assert info.value.code == "BAD_MACHINE" and "'title' appears twice" in info.value.message


def test_a_mark_of_byte_order_is_passed_over(tmp_path):
    path = tmp_path / "arm.json"
    path.write_bytes(b"\xef\xbb\xbf" + json.dumps(GOOD).encode("utf-8"))
    assert machine.load(path).title == GOOD["title"]


def test_every_doubt_in_a_remark_has_a_warning():
    """Every uncertainty in a remark has a warning."""
    doubts = {
        "base": "base frame is not known",
        "joint": "unverified for LS files",
        "limits": "not settled",
        "speeds": "are from memory",
    }
    for path in sorted(machine.BUILT_IN.glob("*.json")):
        content = json.loads(path.read_text(encoding="utf-8"))
        words = " ".join([*content["remarks"], content["controller"]["remark"]])
        has = {warning["applies_to"] for warning in content.get("warnings", [])}
        if path.stem == "abb-irb1600-6-12":
            continue  # has the values of the other source
        assert {kind for kind, doubt in doubts.items() if doubt in words} <= has, path.name


@pytest.mark.parametrize("content", [b"", b"{", b"\xff\xfe", b"NaN"])
def test_a_file_that_is_no_json_is_refused(content, tmp_path):
    path = tmp_path / "arm.json"
    path.write_bytes(content)
    with pytest.raises(InputError) as info:
        machine.load(path)
    assert (info.value.code, info.value.exit_status) == ("BAD_MACHINE", 2)
    assert str(path) in info.value.where
    assert dict(machine.known([tmp_path]))["arm"].startswith("BAD_MACHINE: ")


def test_numbers_that_are_none_are_refused(tmp_path):
    path = tmp_path / "arm.json"
    path.write_text(json.dumps(GOOD).replace("525", "Infinity", 1), encoding="utf-8")
    with pytest.raises(InputError, match="not a number"):
        machine.load(path)


READS_A_MACHINE = """
import locale
locale.setlocale(locale.LC_ALL, "de_DE.UTF-8")
assert locale.localeconv()["decimal_point"] == ","
from freecad_am.core.kinematics.machines import machine
print(repr(float(machine.load("staubli-tx2-60l").limits("maker").upper[1])))
"""


@pytest.mark.skipif(shutil.which("localedef") is None, reason="localedef is not installed")
def test_decimal_commas_of_a_locale_change_nothing(tmp_path, root):
    """A locale with decimal commas does not change how numbers are read."""
    process = subprocess.run(
        ["localedef", "-i", "de_DE", "-f", "UTF-8", str(tmp_path / "de_DE.UTF-8")],
        capture_output=True,
        check=False,
    )
    if not (tmp_path / "de_DE.UTF-8" / "LC_NUMERIC").is_file():
        pytest.skip(
            f"the sources of de_DE are not installed: {process.stderr.decode(errors='replace')}"
        )
    environment = {**os.environ, "LOCPATH": str(tmp_path), "PYTHONPATH": str(root)}
    run = subprocess.run(
        [sys.executable, "-c", READS_A_MACHINE],
        env=environment,
        capture_output=True,
        text=True,
        check=False,
    )
    assert run.returncode == 0, run.stderr
    assert float(run.stdout.strip()) == np.radians(127.5)


def test_shapes_of_links_and_accelerations_are_read(tmp_path):
    content = copy.deepcopy(GOOD)
    content["shapes"] = {
        "base": {"file": "looks/base.STEP"},
        "joint_3": {
            "file": str(tmp_path / "3.stl"),
            "origin": [1, 2, 3],
            "rpy": [0, 0, 90],
            "scale": 1000,
            "colour": [1, 0, 0.5],
        },
    }
    for joint, limit in zip(content["joints"], (10, 20, None, 40, 50, 60)):
        joint["max_acceleration"], joint["max_jerk"] = limit, None if limit is None else 7 * limit
    path = tmp_path / "mine.json"
    path.write_text(json.dumps(content), encoding="utf-8")
    loaded = machine.load(path)
    base, third = loaded.shapes[0], loaded.shapes[3]
    assert [shape is None for shape in loaded.shapes] == [
        False,
        True,
        True,
        False,
        True,
        True,
        True,
    ]
    assert (
        base.path == tmp_path / "looks" / "base.STEP"
        and (base.pose == np.eye(4)).all()
        and base.colour is None
    )
    assert third.path == tmp_path / "3.stl" and (third.scale, third.colour) == (
        1000.0,
        (1.0, 0.0, 0.5),
    )
    assert np.abs(third.pose @ [1, 0, 0, 1] - [1, 3, 3, 1]).max() < 1e-12
    assert third.where == f"{path}: shapes.joint_3.file"
    assert np.allclose(np.degrees(loaded.max_acceleration), [10, 20, np.inf, 40, 50, 60])
    assert np.allclose(np.degrees(loaded.max_jerk), [70, 140, np.inf, 280, 350, 420])
    plain = machine.load("fanuc-arcmate120ic")
    assert (
        plain.shapes == (None,) * 7
        and np.isinf(plain.max_acceleration).all()
        and np.isinf(plain.max_jerk).all()
    )
