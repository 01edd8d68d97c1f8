# SPDX-License-Identifier: LGPL-2.1-or-later
"""Listings come back from the reader to half a digit, and statements that it does not understand
are rejected."""

import re

import numpy as np
import pytest

from freecad_am.core.issues import InputError
from freecad_am.core.program import DepositOff, DepositOn, Moves
from freecad_am.posts.fanuc import post as fanuc

pytestmark = pytest.mark.any_version

HALF_DIGIT = 0.0005

# an independent listing by hand, as the pendant would show it
BY_HAND = """\
/PROG  HAND
/ATTR
OWNER		= MNEDITOR;
COMMENT		= "by hand";
DEFAULT_GROUP	= 1,*,*,*,*;
/APPL
/MN
   1:  !a remark; with a semicolon ;
   2:  UFRAME_NUM=3 ;
   3:  UTOOL_NUM=4 ;
   4:J P[2:"home"] 20% FINE    ;
   5:   ;
   6:  DO[5:wire]=ON ;
   7:  WAIT    .50(sec) ;
   8:J P[1] 250msec CNT100    ;
   9:J P[2] 2.5sec CNT0    ;
  10:  CALL SUB    ;
  11:J P[1] .5sec FINE    ;
  12:  CALL ELSEWHERE    ;
  13:  END ;
/POS
P[1]{
   GP1:
	UF : 3, UT : 4,\t
	J1=      .500 deg,	J2=     -.250 deg,	J3=     0.000 deg,
	J4=  -190.125 deg,	J5=    45.000 deg,	J6=   180.000 deg
};
P[2:"home"]{
   GP1:
	UF : F, UT : F,\t
	J1=     0.000 deg,	J2=     0.000 deg,	J3=     0.000 deg,
	J4=     0.000 deg,	J5=   -90.000 deg,	J6=     0.000 deg
};
/END
"""
SUB = """\
/PROG SUB
/ATTR
/MN
    :  DO[5]=OFF ;
    :  WAIT DI[3]=ON    ;
    :J P[7] 1msec FINE ;
/POS
P[7]{
   GP1:
	UF : 3, UT : 4,\t
	J1= 1.00 deg,	J2= 2.00 deg,	J3= 3.00 deg,
	J4= 4.00 deg,	J5= 5.00 deg,	J6= 6.00 deg
};
/END
"""


def by_hand(pattern="", replacement="", sub=SUB):
    text = re.sub(pattern, replacement, BY_HAND, count=1) if pattern else BY_HAND
    assert not pattern or text != BY_HAND
    return {"HAND.LS": text.replace("\n", "\r\n").encode(), "SUB.LS": sub.encode()}


def test_a_listing_by_hand():
    readback = fanuc.read(by_hand())
    first_event, home_event, last_event = (
        [0.5, -0.25, 0.0, -190.125, 45.0, 180.0],
        [0, 0, 0, 0, -90.0, 0],
        [1, 2, 3, 4, 5, 6],
    )
    assert np.degrees(readback.joints) == pytest.approx(
        np.array([home_event, first_event, home_event, last_event, first_event], float), abs=1e-12
    )
    assert readback.duration == pytest.approx([np.nan, 0.25, 2.5, 0.001, 0.5], nan_ok=True)
    assert readback.deposit.tolist() == [False, True, True, False, False]
    assert not readback.linear.any() and readback.stops.tolist() == [True, False, False, True, True]
    assert readback.blend[1:3].tolist() == [100.0, 0.0] and readback.share[0] == 0.2
    assert set(readback.user_frame.tolist()) == {3.0} and set(readback.tool_frame.tolist()) == {4.0}
    assert [(event.row, event.kind, *event.value) for event in readback.events] == [
        (1, "on", 5.0, "DO"),
        (1, "wait", 0.5),
        (3, "off", 5.0, "DO"),
        (3, "input", 3.0),
        (5, "call", "ELSEWHERE"),
    ]
    assert np.degrees(readback.digits) == pytest.approx(0.005)  # one of the files has two decimals
    assert np.isnan(readback.speed).all() and readback.position is None


@pytest.mark.parametrize("seed", range(25))
@pytest.mark.parametrize("motion", ["joint", "cartesian"])
def test_random_programs_come_back(random_program, seed, motion):
    program = random_program(seed, motion, continuous=bool(seed % 3))
    readback = fanuc.read(fanuc.write(program))
    deposit, on = [], False
    for block in program.blocks:
        on = isinstance(block, DepositOn) or (on and not isinstance(block, DepositOff))
        deposit += [on] * len(block) if isinstance(block, Moves) else []
    assert readback.deposit.tolist() == deposit
    runs = program.moves
    timed = np.concatenate(
        [np.full(len(run), motion == "joint" or run.kind == "rapid") for run in runs]
    )
    timed[0] = False
    assert (np.isfinite(readback.duration) == timed).all()
    assert not np.isfinite(readback.speed[timed]).any() and not np.isfinite(readback.speed[0])
    starts = np.cumsum([0] + [len(run) for run in runs])
    for run, start in list(zip(runs, starts, strict=False))[1:]:
        written = readback.duration[start : start + len(run)]
        if not timed[start]:
            assert np.abs(readback.speed[start : start + len(run)] - run.speed).max() <= 0.05 + 1e-9
            continue
        long = run.duration > 32.0005
        assert np.abs(written - run.duration)[long].max(initial=0.0) <= 0.05 + 1e-9
        assert (
            abs((written - run.duration)[~long].sum()) <= 0.001 * (1 + long.sum())
            and written.min() > 0.0009
        )
    if motion == "joint":
        joint_errors = np.degrees(readback.joints - np.concatenate([run.joints for run in runs]))
        joint_errors[:, np.array(program.continuous)] -= 360.0 * np.rint(
            joint_errors[:, np.array(program.continuous)] / 360.0
        )
        assert np.abs(joint_errors).max() <= HALF_DIGIT + 1e-9 and np.degrees(
            readback.digits
        ) == pytest.approx(HALF_DIGIT)
    else:
        position, rotation = (
            np.concatenate([getattr(run, name) for run in runs])
            for name in ("position", "rotation")
        )
        assert (
            np.abs(readback.position - position).max() <= HALF_DIGIT + 1e-9
            and readback.joints is None
        )
        between = np.swapaxes(readback.rotation, 1, 2) @ rotation
        angle = np.linalg.norm(between - np.eye(3), axis=(1, 2)) / np.sqrt(2.0)
        assert np.degrees(angle).max() <= 3.0 * HALF_DIGIT + 1e-9
        assert readback.position_digits == pytest.approx(HALF_DIGIT)
        assert np.degrees(readback.rotation_digits) == pytest.approx(HALF_DIGIT)


@pytest.mark.parametrize(("pattern", "replacement", "where", "why"), [
    (r"  WAIT    .50\(sec\)", "  OVERRIDE=20%", "HAND.LS line 14", "'OVERRIDE=20%'"),
    (r"CNT100 ", "CNT100 Offset,PR[1] ", "HAND.LS line 15", "Offset"),
    (r"CNT100 ", "CNT100 ACC150 ", "HAND.LS line 15", "ACC150"),
    (r"CNT100 ", "CNT101 ", "HAND.LS line 15", "CNT101"),
    (r"CNT0 ", "CNT0 RTCP", "HAND.LS line 16", "RTCP"),
    (r"J P\[1\] 250msec", "C P[1]", "HAND.LS line 15", "'C P[1]"),
    (r"J P\[1\] 250msec", "J PR[1] 250msec", "HAND.LS line 15", "PR[1]"),
    (r"J P\[1\] 250msec", "L P[1] 6mm/sec", "HAND.LS line 15", "the form in which its position is recorded"),
    (r"250msec", "6mm/sec", "HAND.LS line 15", "mm/sec"),
    (r"250msec", "100cm/min", "HAND.LS line 15", "cm/min"),
    (r"J P\[1\] 250", "J P[3] 250", "HAND.LS line 15", "P[3] is not recorded"),
    (r"  CALL ELSEWHERE    ;", "  CALL HAND    ;", "program", "0 programs are called by no other"),
    (r"  CALL SUB    ;", "  END ;", "program", "2 programs are called by no other"),
    (r"  12:.*\n", "  12:  DO[6]=ON ;\n", "HAND.LS line 19", "second output"),
    (r"  12:.*\n", "  12:  JMP LBL[1] ;\n", "HAND.LS line 19", "JMP"),
    (r"  12:.*\n", "  12:  END ;\n", "HAND.LS line 19", "'END'"),
    (r"  12:.*\n", "  12:  CALL ELSEWHERE\n", "HAND.LS line 19", "not an instruction"),
    (r"UTOOL_NUM=4", "UTOOL_NUM=5", "HAND.LS line 15", "a UTOOL that is not selected"),
    (r"UFRAME_NUM=3", "UFRAME_NUM=0", "HAND.LS line 15", "a UFRAME that is not selected"),
    (r"J5=    45.000 deg", "J5=    45,000 deg", "HAND.LS line 22", "P[1]"),
    (r"J5=    45.000 deg", "J5=  ******** deg", "HAND.LS line 22", "P[1]"),
    (r",\tJ6=     0.000 deg", "", "HAND.LS line 28", "P[2]"),
    (r"P\[1\]\{", "P[2]{", "HAND.LS", "twice"),
    (r"/POS\n", "", "HAND.LS", "/POS"),
    (r"/PROG  HAND", "PROG HAND", "HAND.LS", "/PROG"),
    (r"/PROG  HAND", "/PROG  SUB", "program", "same name"),
])  # fmt: skip
def test_what_is_not_understood_is_refused(pattern, replacement, where, why):
    with pytest.raises(InputError) as raised:
        fanuc.read(by_hand(pattern, replacement))
    assert (raised.value.code, raised.value.where) == ("UNREADABLE_PROGRAM", where)
    assert why in raised.value.message


def test_programs_that_call_each_other_in_a_ring_are_refused():
    ring = SUB.replace("WAIT DI[3]=ON", "CALL SUB")
    with pytest.raises(InputError, match="calls itself"):
        fanuc.read(by_hand(sub=ring))


def test_programs_without_moves_are_refused():
    with pytest.raises(InputError, match="no moves"):
        fanuc.read({"A.LS": b"/PROG  A\r\n/ATTR\r\n/MN\r\n/POS\r\n/END\r\n"})


def test_joint_and_cartesian_positions_in_one_program_are_refused():
    record = BY_HAND[BY_HAND.index("P[1]{") : BY_HAND.index('P[2:"home"]{')]
    pose = (
        "P[7]{\n   GP1:\n\tUF : 3, UT : 4,\t\tCONFIG : 'N U T, 0, 0, 0',\n"
        "\tX = 1.0 mm,\tY = 2.0 mm,\tZ = 3.0 mm,\n\tW = 1.0 deg,\tP = 2.0 deg,\tR = 3.0 deg\n};\n"
    )
    with pytest.raises(InputError, match="mixes joint and Cartesian"):
        fanuc.read(
            by_hand(
                sub=SUB[: SUB.index("P[7]{")].replace("J P[7] 1msec", "L P[7] 5.0mm/sec")
                + pose
                + "/END\n"
            )
        )
    with pytest.raises(InputError, match=r"P\[7\] is not understood"):
        fanuc.read(by_hand(sub=SUB[: SUB.index("P[7]{")] + pose + record + "/END\n"))


TWO_GROUPS = """\
/PROG  HAND
/ATTR
DEFAULT_GROUP	= 1,1,*,*,*;
/MN
   1:  UFRAME_NUM=3 ;
   2:  UTOOL_NUM=4 ;
   3:J P[1] 20% FINE    ;
   4:J P[2] 20% FINE    ;
/POS
P[1]{
   GP1:
	UF : 3, UT : 4,\t
	J1=      .500 deg,	J2=     -.250 deg,	J3=     0.000 deg,
	J4=  -190.125 deg,	J5=    45.000 deg,	J6=   180.000 deg
   GP2:
	UF : 3, UT : 4,\t
	J1=     1.000 deg,	J2=     2.000 deg
};
P[2]{
   GP1:
	UF : 3, UT : 4,\t
	J1=      .500 deg,	J2=     -.250 deg,	J3=     0.000 deg,
	J4=  -190.125 deg,	J5=    45.000 deg,	J6=   180.000 deg
   GP2:
	UF : 3, UT : 4,\t
	J1=     1.000 deg,	J2=     2.000 deg
};
/END
"""


@pytest.mark.parametrize(
    ("old", "new", "line", "words"),
    [
        (
            "   GP2:\n\tUF : 3, UT : 4,\t\n\tJ1=     1.000 deg,	J2=     2.000 deg\n};\n/END",
            "};\n/END",
            19,
            "P[2]",
        ),
        ("J2=     2.000 deg\n};\n/END", "J2=  ****** deg\n};\n/END", 19, "P[2]"),
        (",	J2=     2.000 deg\n};\nP[2]", "\n};\nP[2]", 19, "and P[1] have"),
        ("1,1,*", "1,*,1", 3, "groups 1, 3"),
    ],
)
def test_mixed_motion_groups_are_refused_with_their_line(old, new, line, words):
    assert old in TWO_GROUPS
    assert len(fanuc.read({"HAND.LS": TWO_GROUPS.encode()}).joints) == 2
    with pytest.raises(InputError) as raised:
        fanuc.read({"HAND.LS": TWO_GROUPS.replace(old, new).encode()})
    assert raised.value.where == f"HAND.LS line {line}" and words in raised.value.message
