# SPDX-License-Identifier: LGPL-2.1-or-later
"""Every built-in robot: the figures of its file by PyKDL only, its inverse, sources, limits, speeds
and axis names."""

import json
import re

import numpy as np
import pytest

from freecad_am.core.issues import InputError
from freecad_am.core.kinematics.machines import machine

kdl = pytest.importorskip("PyKDL")
FILES = {
    path.stem: json.loads(path.read_text(encoding="utf-8"))
    for path in sorted(machine.BUILT_IN.glob("*.json"))
}
ROBOTS = [
    name for name, file in FILES.items() if not any(joint.get("type") for joint in file["joints"])
]
PINNED = re.compile(r"github:[\w.-]+/[\w.-]+ .* @ [0-9a-f]{40}")
LABELS = {"kuka": ["A1", "A2", "A3", "A4", "A5", "A6"], "motoman": list("SLURBT")}
ASKED_FOR = {
    "ur-ur3e",
    "ur-ur5e",
    "ur-ur10e",
    "ur-ur16e",
    "ur-ur20",
    "ur-ur30",
    "fanuc-crx5ia",
    "fanuc-crx10ia",
    "fanuc-crx20ia-l",
    "fanuc-crx30ia",
    "abb-crb15000-5-95",
    "abb-crb15000-12-127",
    "motoman-hc10",
    "motoman-hc20dtp",
    "kuka-lbr-iisy3-r760",
    "fanuc-m710ic-50",
    "fanuc-r2000ic-210f",
    "abb-irb2600-12-165",
    "abb-irb4600-40-255",
    "abb-irb6700-235-265",
    "kuka-kr120-r2700-2",
    "kuka-kr210-r3100-2",
    "kuka-kr300-r2700-2",
    "motoman-gp25",
    "motoman-gp50",
    "motoman-gp180",
    "motoman-ar1440",
    "motoman-ar2010",
    "staubli-tx2-60",
    "staubli-tx2-90xl",
}


def test_there_are_all_that_were_asked_for():
    assert set(ROBOTS) >= ASKED_FOR and len(ROBOTS) >= 180
    titles = [FILES[name]["title"] for name in ROBOTS]
    assert len(set(titles)) == len(titles)


def segment(frame):
    rpy = np.radians(frame["rpy"]).tolist()
    return kdl.Segment(
        kdl.Joint(), kdl.Frame(kdl.Rotation.RPY(*rpy), kdl.Vector(*map(float, frame["origin"])))
    )


def poses(file, rows):
    """The flange (n, 3, 4) by PyKDL from the figures in the file, deg."""
    chain = kdl.Chain()
    for joint in file["joints"]:
        chain.addSegment(segment(joint))
        axis = kdl.Vector(*map(float, joint["axis"]))
        chain.addSegment(
            kdl.Segment(kdl.Joint("q", kdl.Vector(), axis, kdl.Joint.RotAxis), kdl.Frame())
        )
    chain.addSegment(segment(file["flange"]))
    solver, frame, angles = kdl.ChainFkSolverPos_recursive(chain), kdl.Frame(), kdl.JntArray(6)
    transforms = []
    for row in rows:
        for index, value in enumerate(np.radians(row)):
            angles[index] = float(value)
        solver.JntToCart(angles, frame)
        transforms.append([[*(frame.M[i, k] for k in range(3)), frame.p[i]] for i in range(3)])
    return np.array(transforms)


@pytest.mark.parametrize("name", ROBOTS)
def test_a_file_says_what_it_has_from_where_and_is_right(name):
    """A file states its sources, its check poses are right, and its inverse restores random
    poses."""
    file, arm = FILES[name], machine.load(name)
    check_poses = [
        np.column_stack([pose["rotation"], pose["origin"]]) for pose in file["check_poses"]
    ]
    np.testing.assert_allclose(
        poses(file, [pose["q"] for pose in file["check_poses"]]), check_poses, atol=1e-8, rtol=0
    )
    # the selected inverse restores any pose, and the joint angles are among the solutions
    q = np.random.default_rng(2).uniform(-170.0, 170.0, (2, 6))
    expected = poses(file, q)
    solutions = arm.arm.inverse(
        np.concatenate([expected, np.tile([[[0.0, 0.0, 0.0, 1.0]]], (2, 1, 1))], axis=1)
    )
    assert (
        np.nanmin(
            np.abs(np.exp(1j * solutions) - np.exp(1j * np.radians(q))).max(axis=-1), axis=0
        ).max()
        < 1e-6
    )
    solutions_of_pose = solutions[np.isfinite(solutions[:, 0]).all(axis=1), 0]
    assert np.abs(poses(file, np.degrees(solutions_of_pose)) - expected[0]).max() < 1e-6
    assert all(PINNED.fullmatch(source) or "manual" in source for source in file["sources"])
    assert (arm.limits("maker").upper > arm.limits("maker").lower).all() and file["limits"][
        "maker"
    ]["source"]
    assert all(10.0 < joint["max_speed"] < 1500.0 for joint in file["joints"])
    assert all(key in file["reach"] for key in ("mm", "source"))
    assert "payload" not in file or (file["payload"]["kg"] > 0 and file["payload"]["source"])
    maker = name.split("-")[0]
    assert (
        [joint.get("label") for joint in file["joints"]] == LABELS[maker]
        if maker in LABELS
        else True
    )
    if maker == "fanuc":  # the pendant's J3 is relative to the horizontal
        assert file["controller"]["matrix"][2] == [0, -1, 1, 0, 0, 0]


@pytest.mark.parametrize(
    "name",
    [name for name in ROBOTS if re.search(r"-r\d{3,4}", name) and name.startswith("kuka-kr")],
)
def test_the_reach_of_a_kuka_is_that_of_its_name(name):
    """KUKA's name states payload and reach; here the reach follows from joint frames and limits."""
    file = FILES[name]
    assert file["reach"]["mm"] == pytest.approx(float(re.search(r"-r(\d+)", name)[1]), rel=0.04)
    if "payload" in file:
        assert file["payload"]["kg"] == float(re.match(r"kuka-kr(\d+)", name)[1])


def test_the_catalogue_tells_what_files_tell_and_leaves_out_what_they_do_not(tmp_path):
    """The catalogue shows the values of the files and skips missing ones."""
    content = {
        **FILES["fanuc-m710ic-50"],
        "id": "mine",
        "title": "Mine 1",
        "payload": {"kg": 50, "source": "plate"},
    }
    content["controller"] = {
        key: value for key, value in content["controller"].items() if key != "posts"
    }
    (tmp_path / "mine.json").write_text(json.dumps(content), encoding="utf-8")
    (tmp_path / "broken.json").write_text("{", encoding="utf-8")
    entries = machine.entries([tmp_path])
    assert {entry.id for entry in entries} == {*FILES, "mine"}
    own_entry = next(entry for entry in entries if entry.id == "mine")
    assert (own_entry.reach, own_entry.payload, own_entry.posts) == (2050.0, 50.0, None)
    assert own_entry in machine.select_machines(entries, post="kuka", payload=50.0, reach=2050.0)
    assert own_entry not in machine.select_machines(entries, payload=50.1)
    heavy = machine.select_machines(entries, payload=1e-3)
    assert heavy and all(entry.payload is not None for entry in heavy)
    with pytest.raises(InputError, match="'Acme'"):
        machine.select_machines(entries, maker="Acme")
