# SPDX-License-Identifier: LGPL-2.1-or-later
"""Five-axis programs written by hand are read back, and the reader rejects statements that it does
not understand at their line."""

import numpy as np
import pytest

from freecad_am.core.issues import InputError
from freecad_am.posts import nc_read
from freecad_am.posts.linuxcnc import post as linuxcnc
from freecad_am.posts.siemens import post as siemens

pytestmark = pytest.mark.any_version

# in another style: short numbers, words in another order, lower case, remarks after blocks
MAIN = """; by hand
N10 G17 G40 G710 G90 G54 D2
N20 PART_1 ; the path
N30 CLEANING
N40 M30
"""
PART = """N5 G500
N10 SOFT FFWON G642
N15 FGROUP(X,Y,Z)
N20 G93 G1 x10 Y0.25 Z5 a-12.5 C=45 F6 ; first
N30 G94
N40 G1 X13 Y4.25 Z5 A-12.5 C=DC(50.0) F60
N50 G54
N55 TRAORI
N60 ORIWKS ORIVECT
N70 $A_OUT[2]=1
N75 G4 F.5
N80 COMPCAD
N90 G1 X1.5 Y2 Z-3.125 A3=0 B3=0.6 C3=0.8 F300
N95 COMPOF
N100 $A_OUT[2]=0
N110 TRAFOOF
N120 G500
N130 G93
N140 G9 G1 X14 Y5 Z5 A-10 C=DC(51.25) F120
N145 WHILE $A_IN[4]==0
N146 G4 F0.1
N147 ENDWHILE
N150 M17
"""
NGC = """(by hand)
g21 G90 G17 G40
G64 P0.01
G43 H2
G10 L2 P9 X0 Y0 Z0 A0 C0 R0
M429 (axes)
G59.3
G93 G1 X10 Y0.25 Z5 A-12.5 C45 F6
G94 G1 X13 Y4.25 Z5 A-12.5 C405.5 F60
G1 X13 Y4.25 Z5 A-12.5 C400.5 F10
M428
G54
M62 P3
G1 X1.5 Y2 Z-3.125 A-10 C400 F300
M63 P3
M429
G59.3
o<cleaning> call
G21 G90
G10 L2 P9 X0 Y0 Z0 A0 C0 R0
M66 P2 L3 Q100
G4 P1
G59.3 G93 G1 X14 Y5 Z5 A-10 C401.25 F120
M2
"""


def mpf(old="", new=""):
    files = {"HAND.MPF": MAIN, "PART_1.SPF": PART}
    assert not old or sum(old in text for text in files.values()) == 1
    return {name: text.replace(old, new, 1).encode() for name, text in files.items()}


def ngc(old="", new=""):
    assert old in NGC
    return {"hand.ngc": NGC.replace(old, new, 1).encode()}


def test_a_sinumerik_program_by_hand():
    readback = siemens.read(mpf())
    joints_mm_deg = readback.joints * [1, 1, 1, 180 / np.pi, 180 / np.pi]
    np.testing.assert_allclose(
        joints_mm_deg[[0, 1, 3]],
        [[10, 0.25, 5, -12.5, 45], [13, 4.25, 5, -12.5, 50], [14, 5, 5, -10, 51.25]],
        atol=1e-12,
    )
    assert (
        np.isnan(joints_mm_deg[2]).all()
        and np.isnan(np.hstack([readback.position, readback.direction])[[0, 1, 3]]).all()
    )
    np.testing.assert_allclose(readback.position[2], [1.5, 2.0, -3.125])
    np.testing.assert_allclose(readback.direction[2], [0.0, 0.6, 0.8])
    np.testing.assert_allclose(readback.duration, [10.0, 5.0, np.nan, 0.5])  # 5 mm at 60 mm/min
    np.testing.assert_allclose(readback.speed, [np.nan, np.nan, 5.0, np.nan])
    assert readback.linear.tolist() == [False, False, True, False] and readback.stops.tolist() == [
        False,
        False,
        False,
        True,
    ]
    assert (
        readback.user_frame.tolist()[2] == 1.0
        and np.isnan(readback.user_frame[[0, 1, 3]]).all()
        and readback.rounding is None
    )
    assert set(readback.tool_frame.tolist()) == {2.0}
    assert [(event.row, event.kind, *event.value) for event in readback.events] == [
        (2, "on", 2.0, "$A_OUT[2]=1"), (2, "wait", 0.5), (3, "off", 2.0, "$A_OUT[2]=0"), (4, "input", 4.0),
        (4, "call", "CLEANING"),
    ]  # fmt: skip
    assert readback.deposit.tolist() == [
        False,
        False,
        True,
        False,
    ] and readback.shorter_way.tolist() == [False] * 4 + [True]
    assert (
        readback.linear_digits,
        np.degrees(readback.digits),
        readback.direction_digits,
    ) == pytest.approx((0.5, 0.5, 0.5))


def test_a_linuxcnc_program_by_hand():
    readback = linuxcnc.read(ngc())
    joints_mm_deg = readback.joints * [1, 1, 1, 180 / np.pi, 180 / np.pi]
    np.testing.assert_allclose(joints_mm_deg[:3, 4], [45, 405.5, 400.5])
    np.testing.assert_allclose(joints_mm_deg[3], [np.nan, np.nan, np.nan, -10, 400])
    np.testing.assert_allclose(joints_mm_deg[4], [14, 5, 5, -10, 401.25])
    np.testing.assert_allclose(readback.position[3], [1.5, 2.0, -3.125])
    # 5 mm at 60 mm/min; 5 deg at 10 deg/min while the linear axes do not move
    np.testing.assert_allclose(readback.duration, [10.0, 5.0, 30.0, np.nan, 0.5])
    np.testing.assert_allclose(readback.speed, [np.nan] * 3 + [5.0, np.nan])
    assert readback.deposit.tolist() == [False] * 3 + [True, False] and readback.direction is None
    assert readback.linear.tolist() == [False] * 3 + [True, False]
    # a change of the kinematics waits for the end of the motion, and so does the end
    assert readback.stops.tolist() == [False, False, True, True, False] and set(
        readback.rounding[:2].tolist()
    ) == {np.inf}
    assert (
        readback.user_frame[3] == 1.0
        and readback.tool_frame[:4].tolist() == [2.0] * 4
        and np.isnan(readback.tool_frame[4])
    )
    assert [(event.row, event.kind, *event.value) for event in readback.events] == [
        (3, "on", 4.0, "M62 P3"),
        (4, "off", 4.0, "M63 P3"),
        (4, "call", "CLEANING"),
        (4, "input", 3.0),
        (4, "wait", 1.0),
    ]


@pytest.mark.parametrize(("old", "new", "where", "why"), [
    ("N30 CLEANING", "N30 G0 X0", "HAND.MPF line 4", "'G0'"),
    ("N30 CLEANING", "N20 CLEANING", "HAND.MPF line 4", "do not increase"),
    ("N30 CLEANING", "N30 R1=5", "HAND.MPF line 4", "'R1=5'"),
    ("N30 CLEANING", "N30 X5", "HAND.MPF line 4", "without setting a feed"),
    ("N40 M30", "N40 M17", "HAND", "M30"),
    ("N150 M17\n", "", "PART_1", "M17"),
    ("N5 G500", "N5 HAND", "HAND", "calls itself"),
    ("G710", "G700", "HAND.MPF line 2", "G700"),
    ("G710", "", "PART_1.SPF line 4", "G710"),
    ("N5 G500\n", "", "PART_1.SPF line 3", "frame other than"),
    ("N15 FGROUP(X,Y,Z)\n", "", "PART_1.SPF line 5", "does not set the axes"),
    ("FGROUP(X,Y,Z)", "FGROUP(X,C)", "PART_1.SPF line 3", "FGROUP"),
    ("G1 x10", "x10", "PART_1.SPF line 4", "before G1"),
    ("G1 x10", "G91 G1 x10", "PART_1.SPF line 4", "'G91'"),
    ("G1 x10", "G1 x10 X11", "PART_1.SPF line 4", "duplicated"),
    ("x10", "x1E1", "PART_1.SPF line 4", "'X1E1'"),
    ("x10", "x=AC(10)", "PART_1.SPF line 4", "'X=AC(10)'"),
    ("F6 ;", "F0 ;", "PART_1.SPF line 4", "without setting a feed"),
    ("F60\n", "\n", "PART_1.SPF line 6", "without setting a feed"),
    ("A-12.5 C=DC(50.0)", "C=DC(50.0)", "PART_1.SPF line 6", "differ from those of the first"),
    ("N55 TRAORI\n", "", "PART_1.SPF line 12", "frame other than"),
    ("N60 ORIWKS ORIVECT\n", "", "PART_1.SPF line 12", "ORIWKS"),
    ("B3=0.6", "", "PART_1.SPF line 13", "A3 B3 C3"),
    ("B3=0.6", "B=0.6", "PART_1.SPF line 13", "A3 B3 C3"),
    ("N80 COMPCAD", "N80 G93", "PART_1.SPF line 13", "G94"),
    ("N95 COMPOF\n", "", "PART_1.SPF line 18", "compressor would merge"),
    ("N95 COMPOF", "N95 CLEANING", "PART_1.SPF line 14", "not understood"),
    ("N100 $A_OUT[2]=0", "N100 $A_OUT[3]=0", "PART_1.SPF line 15", "second output"),
    ("N100 $A_OUT[2]=0", "N100 M9", "PART_1.SPF line 15", "second output"),
    ("N100 $A_OUT[2]=0", "N100 M5", "PART_1.SPF line 15", "'M5'"),
    ("N100 $A_OUT[2]=0\n", "", "PART_1.SPF line 15", "while the deposit is on"),
    ("N110 TRAFOOF\n", "", "PART_1.SPF line 18", "TRAORI"),
    ("N120 G500\n", "", "PART_1.SPF line 18", "frame other than"),
    ("N146 G4 F0.1", "N146 G1 X0", "PART_1.SPF line 21", "loop"),
    ("N147 ENDWHILE\n", "", "PART_1", "within a loop"),
    ("N145 WHILE $A_IN[4]==0", "N145 WHILE R1<5", "PART_1.SPF line 20", "'WHILE R1<5' is not"),
    ("N5 G500", "N5 GOTOF END", "PART_1.SPF line 1", "not understood"),
])  # fmt: skip
def test_what_is_not_understood_of_sinumerik(old, new, where, why):
    with pytest.raises(InputError) as raised:
        siemens.read(mpf(old, new))
    assert (raised.value.code, raised.value.where) == ("UNREADABLE_PROGRAM", where)
    assert why in raised.value.message


@pytest.mark.parametrize(("old", "new", "where", "why"), [
    ("(by hand)", "(msg, by hand)", "hand.ngc line 1", "may be executed"),
    ("(by hand)", "; by hand", "hand.ngc line 1", "may be executed"),
    ("(by hand)", "(by hand", "hand.ngc line 1", "may be executed"),
    ("g21 ", "", "hand.ngc line 8", "G21"),
    ("g21", "G20", "hand.ngc line 2", "'G20'"),
    ("G90", "G91", "hand.ngc line 2", "'G91'"),
    ("G64 P0.01", "G0 X5", "hand.ngc line 3", "'G0'"),
    ("G64 P0.01", "#1=5", "hand.ngc line 3", "'#1=5'"),
    ("G64 P0.01", "o<a> if [1]", "hand.ngc line 3", "'O<A>'"),
    ("G64 P0.01", "o<a> sub", "hand.ngc line 3", "not understood here"),
    ("G64 P0.01", "o<hand> call", "HAND", "calls itself"),
    ("C0 R0\nM429", "R0\nM429", "hand.ngc line 8", "frame other than"),
    ("C0 R0\nM429", "C5 R0\nM429", "hand.ngc line 5", "'G10'"),
    ("G59.3\nG93", "G54\nG93", "hand.ngc line 8", "frame other than"),
    ("F6\n", "F0\n", "hand.ngc line 8", "without setting a feed"),
    ("C405.5", "", "hand.ngc line 9", "differ from those of the first"),
    ("C405.5", "C[400+5]", "hand.ngc line 9", "'C[400+5]'"),
    ("G54\nM62", "M62", "hand.ngc line 13", "work offset for the part"),
    ("M62 P3", "G93", "hand.ngc line 14", "G94"),
    ("-3.125 A-10", "-3.125", "hand.ngc line 14", "all rotary axes"),
    ("M63 P3", "M63 P4", "hand.ngc line 15", "second output"),
    ("M63 P3\n", "", "hand.ngc line 15", "while the deposit is on"),
    ("M429\nG59.3\no", "o", "hand.ngc line 16", "within a bead"),
    ("G21 G90\nG10", "G10", "hand.ngc line 22", "G21"),
    ("M66 P2 L3 Q100", "M66 P2 L0 Q100", "hand.ngc line 21", "M66"),
    ("M2\n", "", "hand.ngc", "M2"),
])  # fmt: skip
def test_what_is_not_understood_of_linuxcnc(old, new, where, why):
    with pytest.raises(InputError) as raised:
        linuxcnc.read(ngc(old, new))
    assert (raised.value.code, raised.value.where) == ("UNREADABLE_PROGRAM", where)
    assert why in raised.value.message


FIRST_LINE = {
    siemens: [
        "N1 G17 G40 G710 G90",
        "N2 G500",
        "N3 FGROUP(X,Y,Z)",
        "N4 G93",
        "N5 G1 X1 Y2 Z3 A4 C=DC(5.5) F6",
        "N6 G1 X1.5 Y2 Z3 A4 C=DC(6.25) F6",
    ],
    linuxcnc: [
        "G21 G90 G17 G40",
        "M429",
        "G10 L2 P9 X0 Y0 Z0 A0 C0 R0",
        "G59.3",
        "G93",
        "G1 X1 Y2 Z3 A4 C5.5 F6",
        "G1 X1.5 Y2 Z3 A4 C6.25 F6",
    ],
}


@pytest.mark.parametrize("post", FIRST_LINE, ids=["siemens", "linuxcnc"])
@pytest.mark.parametrize(("old", "new"), [
    ("G1 X", "X"), ("G1 X", "G0 X"), ("G1 X", "G91 G1 X"), ("G1 X", "G1 G1 G0 X"), ("X1.5", "X1,5"), ("X1.5", "X1E5"),
    ("X1.5", "X1.5X2"), ("X1.5", "X1.5 X2"), ("X1.5", "X--1.5"), ("X1.5", "X"), ("X1.5", "X=AC(1.5)"), ("X1.5", "U1.5"),
    ("X1.5 ", ""), ("X1.5 Y2", "Y1.5 Y2"), ("F6", "F0"), ("F6", "F-6"), ("F6", ""), ("F6", "F6 M30"), ("F6", "F6 Z4"),
    ("6.25", "6.25) Z=(3"), ("6.25", "6.2.5"), ("F6", "F6 G9"), ("G1 X", "G9 G1 X"),
])  # fmt: skip
def test_a_block_after_one_alike_is_read_as_strictly(post, old, new, monkeypatch):
    """Blocks of the same shape as the one before are read together, with the same result as one by
    one."""

    def read(*lines):
        end = ["N9 M30"] if post is siemens else ["M2"]
        text = "\n".join([*lines, *end]) + "\n"
        try:
            return post.read({"HAND.MPF" if post is siemens else "hand.ngc": text.encode()})
        except InputError as error:
            return error.code, error.where, error.message

    lines = [*FIRST_LINE[post], FIRST_LINE[post][-1].replace("N6", "N7").replace(old, new, 1)]
    assert lines[-1].replace("N7", "N6") != lines[-2]
    quick = read(*lines)
    monkeypatch.setattr(nc_read.Shape, "of", staticmethod(lambda *arguments: None))
    slow = read(*lines)
    assert isinstance(quick, tuple) == isinstance(slow, tuple)
    if isinstance(slow, tuple):
        assert quick == slow and slow[0] == "UNREADABLE_PROGRAM"
    else:
        for name in ("joints", "duration", "deposit", "duration_digits", "shorter_way"):
            np.testing.assert_array_equal(getattr(quick, name), getattr(slow, name))


def test_files_that_hide_something_are_refused():
    for files in (
        {**mpf(), "OTHER.MPF": b"N10 M30\n"},
        {**mpf(), "data.txt": b""},
        {"HAND.MPF": b"N10 M30\n"},
    ):
        with pytest.raises(InputError, match=r"main programs|no moves"):
            siemens.read(files)
    for files in (
        {**ngc(), "other.ngc": b"M2\n"},
        {**ngc(), "data.txt": b""},
        {"hand.ngc": b"M2\n"},
    ):
        with pytest.raises(InputError):
            linuxcnc.read(files)
