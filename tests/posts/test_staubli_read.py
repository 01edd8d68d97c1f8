# SPDX-License-Identifier: LGPL-2.1-or-later
"""VAL 3 applications come back from the reader to their digits, and statements that it does not
understand are rejected."""

import re

import numpy as np
import pytest
from scipy.spatial.transform import Rotation

from freecad_am.core.issues import InputError
from freecad_am.core.program import DepositOff, DepositOn, Moves
from freecad_am.posts.staubli import post as staubli

pytestmark = pytest.mark.any_version

HEAD = '\ufeff<?xml version="1.0" encoding="utf-8"?>\n'
SPACE = "http://www.staubli.com/robotics/VAL3/"
XSI = 'xmlns:xsi="http://www.w3.org/2001/XMLSchema-instance"'

# an independent application by hand in another style: short numbers, other names, a program of its
# own
PROJECT = f"""{HEAD}<Project xmlns="{SPACE}Project/3">
  <Parameters version="s7.7.2" stackSize="5000" millimeterUnit="true" />
  <Programs>
    <Program file="layer_0001.pgx" />
    <Program file="start.pgx" />
    <Program file="stop.pgx" />
  </Programs>
  <Database>
    <Data file="hand.dtx" />
  </Database>
  <Libraries>
    <Library alias="gripper" path="Disk://gripper/gripper.pjx" />
    <Library alias="prog" path="./two/two.pjx" />
  </Libraries>
</Project>
"""
DATA = f"""{HEAD}<Database {XSI} xmlns="{SPACE}Data/2">
  <Datas>
    <Data name="doExtrude" access="private" xsi:type="array" type="dio" size="1">
      <Value key="0" link="BasicIO-1\\%Q0" />
    </Data>
    <Data name="diReady" access="private" xsi:type="array" type="dio" size="1">
      <Value key="0" link="BasicIO-1\\%I4" />
    </Data>
    <Data name="fPart" access="private" xsi:type="array" type="frame" size="1">
      <Value key="0" x="600" y="0" z="-200" rx="10" ry="20" rz="30" fatherId="world[0]" />
    </Data>
    <Data name="jPath" access="private" xsi:type="array" type="jointRx" size="2">
      <Value key="0" j2="-30" j3="120" j5="90" />
      <Value key="1" j1="1.25" j2="-29.5" j3="119.75" j4="0.1" j5="89.9" j6="-190.5" />
    </Data>
    <Data name="mPrint" access="private" xsi:type="array" type="mdesc" size="2">
      <Value key="0" accel="100" vel="100" decel="100" tmax="30.5" rmax="99999" blend="Cartesian" leave="0.5" reach="0.5" />
      <Value key="1" accel="100" vel="100" decel="100" tmax="6" rmax="99999" blend="off" leave="0" reach="0" />
    </Data>
    <Data name="mTravel" access="private" xsi:type="array" type="mdesc" size="1">
      <Value key="0" accel="100" vel="20" decel="100" tmax="99999" rmax="99999" blend="off" leave="50" reach="50" />
    </Data>
    <Data name="pPath" access="private" xsi:type="array" type="pointRx" size="2">
      <Value key="0" x="10" y="0.25" z="5" rx="180" ry="0" rz="0" fatherId="fPart[0]" />
      <Value key="1" x="20.5" y="0.5" z="5" rx="179" ry="0.5" rz="-33.25" fatherId="fPart[0]" />
    </Data>
    <Data name="tPrint" access="private" xsi:type="array" type="tool" size="1">
      <Value key="0" x="1" y="2" z="250" rx="5" ry="6" rz="7" fatherId="flange[0]" />
    </Data>
  </Datas>
</Database>
"""


def code(name, text):
    return f"""{HEAD}<Programs {XSI} xmlns="{SPACE}Program/2">
  <Program name="{name}" access="public">
    <Code><![CDATA[begin
{text}
end]]></Code>
  </Program>
</Programs>
"""


START = """  // by hand
  movej(jPath[0],tPrint,mTravel)
  waitEndMove()
  call layer_0001()
  doExtrude=false
  wait(diReady==true)
  call gripper:open()
  delay(2)
  movej(jPath[1],tPrint,mTravel)
  waitEndMove()"""
LAYER = """  doExtrude=true
  for l_nI=1 to 2
    movel(pPath[l_nI-1],tPrint[0],mPrint[l_nI-1])
  endFor
  waitEndMove()"""


STOP = """  resetMotion()
  doExtrude=false"""


def by_hand(old="", new="", **options):
    files = {
        "hand/hand.pjx": PROJECT, "hand/hand.dtx": DATA, "hand/start.pgx": code("start", START),
        "hand/layer_0001.pgx": code("layer_0001", LAYER), "hand/stop.pgx": code("stop", STOP),
    }  # fmt: skip
    assert not old or sum(old in text for text in files.values())
    return {file: text.replace(old, new).encode() for file, text in {**files, **options}.items()}


def test_an_application_by_hand():
    readback = staubli.read(by_hand())
    joints_deg = np.degrees(readback.joints)
    np.testing.assert_allclose(
        joints_deg[[0, 3]],
        [[0, -30, 120, 0, 90, 0], [1.25, -29.5, 119.75, 0.1, 89.9, -190.5]],
        atol=1e-12,
    )
    assert np.isnan(joints_deg[1:3]).all() and np.isnan(readback.position[[0, 3]]).all()
    np.testing.assert_array_equal(readback.position[1:3], [[10, 0.25, 5], [20.5, 0.5, 5]])
    turned = Rotation.from_euler("XYZ", [[180, 0, 0], [179, 0.5, -33.25]], degrees=True).as_matrix()
    np.testing.assert_allclose(readback.rotation[1:3], turned, atol=1e-15)
    np.testing.assert_allclose(
        readback.frame[:3, :3],
        Rotation.from_euler("XYZ", [10, 20, 30], degrees=True).as_matrix(),
        atol=1e-15,
    )
    np.testing.assert_allclose(
        readback.tool[1, :3, :3],
        Rotation.from_euler("XYZ", [5, 6, 7], degrees=True).as_matrix(),
        atol=1e-15,
    )
    assert readback.frame[:3, 3].tolist() == [600, 0, -200] and readback.tool[
        2, :3, 3
    ].tolist() == [
        1,
        2,
        250,
    ]
    assert readback.deposit.tolist() == readback.linear.tolist() == [False, True, True, False]
    assert readback.stops.tolist() == [True, False, True, True] and readback.rounding[1] == 0.5
    assert [(event.row, event.kind, *event.value) for event in readback.events] == [
        (1, "on", 1.0, "doExtrude"), (3, "off", 1.0, "doExtrude"), (3, "input", 5.0), (3, "call", "gripper:open"),
        (3, "wait", 2.0),
    ]  # fmt: skip
    np.testing.assert_array_equal(readback.speed, [np.nan, 30.5, 6.0, np.nan])
    np.testing.assert_array_equal(readback.share, [0.2, np.nan, np.nan, 0.2])
    assert np.degrees(readback.digits) == pytest.approx(
        0.005
    ) and readback.position_digits == pytest.approx(0.005)
    assert np.isnan(readback.duration).all() and readback.speed_digits == pytest.approx(0.05)


@pytest.mark.parametrize("seed", range(12))
@pytest.mark.parametrize(("motion", "setup"), [
    ("joint", "part-on-robot"), ("joint", "tool-on-robot"), ("cartesian", "part-on-robot"), ("cartesian", "tool-on-robot"),
])  # fmt: skip
def test_random_programs_come_back(random_application, seed, motion, setup):
    program = random_application(seed, motion, setup, max_points=50 + 40 * (seed % 4))
    readback = staubli.read(staubli.write(program))
    deposit, on = [], False
    for block in program.blocks:
        on = isinstance(block, DepositOn) or (on and not isinstance(block, DepositOff))
        deposit += [on] * len(block) if isinstance(block, Moves) else []
    assert readback.deposit.tolist() == deposit
    linear = np.array(deposit) & (motion == "cartesian")
    joints, duration, speed = (
        np.concatenate([getattr(run, name) for run in program.moves])
        for name in ("joints", "duration", "speed")
    )
    assert (np.isfinite(readback.speed) == linear).all() and (
        np.isfinite(readback.share) == ~linear
    ).all()
    assert np.abs(np.degrees(readback.joints - joints))[~linear].max() <= 5e-6 + 1e-9
    assert np.degrees(readback.digits) == pytest.approx(5e-6)
    # the time of a move: its fastest axis at that share of its largest speed
    ends = np.flatnonzero(~linear[1:]) + 1
    start = np.where(
        linear[ends - 1, None],
        np.radians(np.round(np.degrees(joints[ends - 1]), 5)),
        readback.joints[ends - 1],
    )
    time = (np.abs(readback.joints[ends] - start) / np.array(program.max_speed)).max(
        axis=1
    ) / readback.share[ends]
    # rapids that hardly move would be slower than the smallest written speed
    slow = readback.share[ends] > 1.01e-5
    assert (
        np.abs(time / duration[ends] - 1.0)[slow].max()
        <= (5e-8 / readback.share[ends][slow]).max() + 1e-9
    )
    assert slow.mean() > 0.5
    if motion == "joint":
        assert readback.position is None and readback.tool is None and readback.frame is None
        return
    assert np.abs(readback.speed - speed)[linear].max() <= 5e-4 + 1e-9
    position, rotation = (
        np.concatenate([getattr(run, name) for run in program.moves])
        for name in ("position", "rotation")
    )
    carried = np.eye(4)
    carried[:3, :3], carried[:3, 3] = (
        Rotation.from_euler(
            "XYZ", np.round(np.degrees([0.3, 0.2, 0.1]), 5), degrees=True
        ).as_matrix(),
        [1.0, 2.0, 105.0],
    )
    gauge = np.linalg.inv(carried) @ readback.tool[linear]
    positions, turned, flange = gauge[:, :3, 3], gauge[:, :3, :3], readback.position[linear]
    if setup == "tool-on-robot":
        positions, turned, flange = (
            readback.position[linear],
            readback.rotation[linear],
            readback.tool[linear][:, :3, 3] - [1.0, 2.0, 105.0],
        )
    assert np.abs(positions - position[linear]).max() <= 5e-5 + 1e-9 and np.abs(flange).max() == 0.0
    angle = np.linalg.norm(
        np.swapaxes(turned, 1, 2) @ rotation[linear] - np.eye(3), axis=(1, 2)
    ) / np.sqrt(2.0)
    assert np.degrees(angle).max() <= 3.0 * 5e-6 + 1e-9
    assert readback.position_digits == pytest.approx(5e-5) and np.degrees(
        readback.rotation_digits
    ) == pytest.approx(5e-6)
    np.testing.assert_allclose(readback.frame[:3, 3], [300.25, -20.5, 310.125], atol=1e-12)
    expected = Rotation.from_euler("XYZ", [0.1, -0.2, 3.0]).as_matrix()
    np.testing.assert_allclose(readback.frame[:3, :3], expected, atol=3e-7)


@pytest.mark.parametrize(("old", "new", "where", "why"), [
    ("  // by hand", "  cls()", "hand/start.pgx line 2", "'cls()'"),
    ("delay(2)", "delay(nTime)", "hand/start.pgx line 9", "'delay(nTime)'"),
    ("movej(jPath[1],", "nTraj=movej(jPath[1],", "hand/start.pgx line 10", "nTraj"),
    ("movej(jPath[1],", "movec(jPath[1],jPath[0],", "hand/start.pgx line 10", "movec"),
    ("movej(jPath[1],", "movej(appro(jPath[1],0),", "hand/start.pgx line 10", "appro"),
    ("movej(jPath[1],", "movej(jPath[2],", "hand/start.pgx line 10", "has too few values"),
    ("movej(jPath[1],", "movej(pPath[1],", "hand/start.pgx line 10", "is not jointRx data"),
    ("movej(jPath[1],", "movej(jPath[l_nI],", "hand/start.pgx line 10", "jPath"),
    ("l_nI-1],tPrint", "l_nI],tPrint", "hand/layer_0001.pgx line 3", "has too few values"),
    ("l_nI-1],tPrint", "l_nI-2],tPrint", "hand/layer_0001.pgx line 3", "has too few values"),
    ("for l_nI=1 to 2", "for l_nI=2 to 1", "hand/layer_0001.pgx line 3", "loop"),
    ("  endFor", "    doExtrude=false\n  endFor", "hand/layer_0001.pgx line 3", "loop over a single move"),
    ("mTravel)\n  waitEndMove()\n  call", "mTravel)\n  call", "hand/start.pgx line 4", "does not wait"),
    ("endFor\n  waitEndMove()", "endFor", "hand/start.pgx line 6", "does not wait"),
    ("mTravel)\n  waitEndMove()\nend", "mTravel)\nend", "program", "ends before its last move"),
    ("call layer_0001()", "call layer_0002()", "hand", "layer_0002 is not a program"),
    ("call layer_0001()", "call start()", "hand", "calls itself"),
    ("call gripper:open()", "call other:open()", "hand/start.pgx line 8", "other is not a library"),
    ("call gripper:open()", "call prog:open()", "hand/start.pgx line 8", "called before it is loaded"),
    ("call gripper:open()", 'if prog:libLoad("./two")!=0', "hand/start.pgx line 8", "does not stop if a part cannot be loaded"),
    ("call gripper:open()", 'if prog:libLoad("./two")!=0\npopUpMsg("")\nreturn\nendIf', "hand/start.pgx line 8",
     "is missing"),
    ("doExtrude=false", "diReady=false", "hand/start.pgx line 6", "not a digital output"),
    ("doExtrude=false", "jPath=false", "hand/start.pgx line 6", "not a digital output"),
    ("wait(diReady", "wait(doExtrude", "hand/start.pgx line 7", "not a digital input"),
    ('vel="20"', 'vel="0"', "hand/start.pgx line 3", "speed"),
    ('vel="20"', 'vel="120"', "hand/start.pgx line 3", "speed"),
    ('vel="20" decel="100" tmax="99999"', 'vel="20" decel="100" tmax="250"', "hand/start.pgx line 3", "speed"),
    ('vel="100" decel="100" tmax="6"', 'vel="50" decel="100" tmax="6"', "hand/layer_0001.pgx line 3", "speed"),
    ('tmax="6" rmax="99999"', 'tmax="6" rmax="60"', "hand/layer_0001.pgx line 3", "speed"),
    ('fatherId="world[0]"', 'fatherId="fOther[0]"', "hand/layer_0001.pgx line 3", "placed in the world"),
    ('rz="0" fatherId="fPart[0]"', 'rz="0" fatherId="world[0]"', "hand/layer_0001.pgx line 3", "in more than one frame"),
    ('fatherId="flange[0]"', 'fatherId="tOther[0]"', "hand/start.pgx line 3", "tool"),
    ('j4="0.1"', 'j4="0,1"', "hand: jPath", "plain number"),
    ('j4="0.1"', 'j4="1e-1"', "hand: jPath", "plain number"),
    ('<Value key="1" j1', '<Value key="0" j1', "hand/hand.dtx", "jPath"),
    ('type="jointRx" size="2"', 'type="jointRx" size="3"', "hand/hand.dtx", "jPath"),
    ('millimeterUnit="true"', 'millimeterUnit="false"', "hand/hand.pjx", "millimetres"),
    ("layer_0001.pgx", "layer_2.pgx", "hand/layer_2.pgx", "missing"),
    ('name="start"', 'name="begin"', "hand/start.pgx", "start"),
    ("</Datas>", "", "hand/hand.dtx", "well-formed"),
    ('encoding="utf-8"', 'encoding="utf-9"', "hand/hand.pjx", "UTF-8"),
    ('<Data file="hand.dtx" />', '<Data file="hand.dtx" /><Data file="hand.dtx" />', "hand/hand.pjx", "several data files"),
    ("<Datas>", "<Datas><!-- -->", "", ""),
    ("begin\n  // by", "// by", "hand/start.pgx", "`begin` to `end`"),
])  # fmt: skip
def test_what_is_not_understood_is_refused(old, new, where, why):
    if not why:
        assert len(staubli.read(by_hand(old, new)).deposit) == 4
        return
    with pytest.raises(InputError) as raised:
        staubli.read(by_hand(old, new))
    assert (raised.value.code, raised.value.where) == ("UNREADABLE_PROGRAM", where)
    assert why in raised.value.message


def test_files_that_hide_something_are_refused():
    for extra_files in (
        {"hand/more.pgx": code("more", "")},
        {"other/other.pjx": PROJECT},
        {"hand/two.pjx": PROJECT},
    ):
        with pytest.raises(InputError) as raised:
            staubli.read(by_hand(**extra_files))
        assert raised.value.code == "UNREADABLE_PROGRAM"
    entity = by_hand("<Database", '<!DOCTYPE a [<!ENTITY b "c">]><Database')
    with pytest.raises(InputError, match="document type"):
        staubli.read(entity)
    project = next(name for name in entity if name.endswith(".pjx"))
    with pytest.raises(InputError, match="UTF-8"):  # the same in characters of two bytes
        staubli.read(
            {
                **entity,
                project: entity[project].decode().replace("utf-8", "utf-16").encode("utf-16"),
            }
        )
    with pytest.raises(InputError, match="no moves"):
        staubli.read(by_hand(START, "  delay(1)"))


def test_loading_a_part_while_depositing_is_refused(random_application):
    files = staubli.write(random_application(2, max_points=50))
    name = "Random/Random01/start.pgx"
    text = files[name].decode()
    offset = text.rindex("doDeposit=false")
    files[name] = (
        text[:offset] + "doDeposit=true" + text[offset + len("doDeposit=false") :]
    ).encode()
    with pytest.raises(InputError, match="loaded during the deposit"):
        staubli.read(files)


def test_a_move_that_is_not_waited_for_is_found_in_every_program(random_application):
    files = staubli.write(random_application(4, "cartesian", max_points=10**4))
    name = "Random/start.pgx"
    for wait in re.finditer(r"  waitEndMove\(\)\n", files[name].decode()):
        text = files[name].decode()
        without = {**files, name: (text[: wait.start()] + text[wait.end() :]).encode()}
        follows = text[wait.end() :].lstrip().split("\n")[0]
        if follows.startswith(("move", "for ", "//")):
            continue
        with pytest.raises(InputError, match=r"does not wait|ends before"):
            staubli.read(without)
