# SPDX-License-Identifier: LGPL-2.1-or-later
"""Kinds of damage to a program's text, each applied once at a random position; each one changes the
meaning. A kind is a pattern with a function that changes a match, or a function of all files. It
never changes the last digit of a number; SMALLEST_REJECTED lists the smallest change of a number that
must be rejected."""

from __future__ import annotations

import re
from collections.abc import Callable

import numpy as np

Files = dict[str, bytes]
Change = str | Callable[[re.Match, np.random.Generator], str]
NUMBER = r"-?\d*\.\d+"


def mutated(files: Files, pattern: str, change: Change, rng: np.random.Generator) -> Files | None:
    """Return the files with one random match of the pattern changed. Return None without a match,
    or if no match changes."""
    matches = [
        (name, match)
        for name in sorted(files)
        for match in re.finditer(pattern, _text(files, name), re.MULTILINE)
    ]
    while matches:
        name, match = matches.pop(int(rng.integers(len(matches))))
        new = match.expand(change) if isinstance(change, str) else change(match, rng)
        if new != match[0]:
            text = _text(files, name)
            return {
                **files,
                name: _numbered(name, text[: match.start()] + new + text[match.end() :]).encode(
                    "utf-8"
                ),
            }
    return None


def _text(files: Files, name: str) -> str:
    return files[name].decode("utf-8")


def _numbered(name: str, text: str) -> str:
    """Return the text with consecutive block numbers, so that a reader can find nothing but the
    damage itself."""
    if not name.endswith((".MPF", ".SPF")):
        return text
    lines, number = [], 0
    for line in text.split("\n"):
        if line and not line.startswith(";"):
            number += 10
            line = f"N{number} {re.sub(r'^N[0-9]+ ', '', line)}"
        lines.append(line)
    return "\n".join(lines)


# ---- how a match changes


def digit(match: re.Match, rng: np.random.Generator) -> str:
    """Change one digit of the first group, but not its last digit."""
    text, start = match[1], match.start(1) - match.start()
    digit_positions = [k for k, letter in enumerate(text[:-1]) if letter.isdigit()]
    where = digit_positions[int(rng.integers(len(digit_positions)))]
    new_digit = str((int(text[where]) + int(rng.integers(1, 10))) % 10)
    changed = text[:where] + new_digit + text[where + 1 :]
    return match[0][:start] + changed + match[0][start + len(text) :]


def shift_number(step: float) -> Change:
    """Shift the number in the first group by a step, with the same digits and width."""

    def change(match: re.Match, rng: np.random.Generator) -> str:
        text, start = match[1], match.start(1) - match.start()
        decimals = len(text.partition(".")[2])
        value = float(text) + step * rng.choice([-1.0, 1.0])
        return (
            match[0][:start]
            + f"{value:.{decimals}f}".rjust(len(text))
            + match[0][start + len(text) :]
        )

    return change


def scale_number(factor: float) -> Change:
    """Scale the number in the first group by a factor, and a whole number by at least 3 units."""

    def change(match: re.Match, rng: np.random.Generator) -> str:
        text, start = match[1], match.start(1) - match.start()
        decimals = len(text.partition(".")[2])
        value = float(text) * factor if decimals else max(float(text) * factor, float(text) + 3.0)
        return match[0][:start] + f"{value:.{decimals}f}" + match[0][start + len(text) :]

    return change


def increment(match: re.Match, rng: np.random.Generator) -> str:
    """Increase the whole number in the first group by one."""
    start = match.start(1) - match.start()
    return match[0][:start] + str(int(match[1]) + 1) + match[0][start + len(match[1]) :]


def other(*words: str) -> Change:
    """Replace the first group by another of the words."""

    def change(match: re.Match, rng: np.random.Generator) -> str:
        start = match.start(1) - match.start()
        alternatives = [word for word in words if word != match[1]]
        return match[0][:start] + str(rng.choice(alternatives)) + match[0][start + len(match[1]) :]

    return change


def negate_number(match: re.Match, rng: np.random.Generator) -> str:
    """Change the sign of the number in the first group; return None for a number near zero."""
    start = match.start(1) - match.start()
    value = match[1].removeprefix("-") if match[1].startswith("-") else f"-{match[1]}"
    return (
        match[0]
        if abs(float(match[1])) < 0.5
        else match[0][:start] + value + match[0][start + len(match[1]) :]
    )


DROP, TWICE, SWAP = "", r"\g<0>\g<0>", r"\2\1"

# FANUC
_FN = r"^ *\d+:"
_MOVE = _FN + r"[JL] P\[\d+\][^\n]*\n"
_DO, _WAIT, _IN, _CLEAN = (
    _FN + r"  " + word + r"[^\n]*\n"
    for word in (r"DO\[", r"WAIT +[.\d]+\(sec\)", r"WAIT DI\[", "CALL CLEAN")
)
_AHEAD = r" TB +\d?\.\d\dsec,DO\[\d+\]=O(?:N|FF)"
_VALUE = r"(?:J[1-6]|[XYZWPR] )=( *-?\d*\.\d{3})"
_GROUPED = r"(?:GP2:\r\n[^\n]*\n\tJ1=|(?<=deg,)\tJ2=)( *-?\d*\.\d{3})(?=[^\n]*\r\n\};)"
_RECORD = r"(P\[\d+\]\{)([^}]*)(\};\s*P\[\d+\]\{)([^}]*)"
FANUC: dict[str, tuple[str, Change]] = {
    "a point moved": (_VALUE, shift_number(0.05)),
    "a digit changed": (_VALUE, digit),
    "a sign changed": (r"(?:J[1-6]|[XYZ] )= *(-?\d*\.\d{3})", negate_number),
    "a turn more": (r"J[1-5]=( *-?\d*\.\d{3})", shift_number(360.0)),
    "two points exchanged": (_RECORD, r"\1\4\3\2"),
    "another group": (r"^   GP(2):", increment),
    "another group moved": (r"^(DEFAULT_GROUP\t= 1,)1,\*", r"\1*,1"),
    "a group that stands": (r"^(DEFAULT_GROUP\t= 1,)1,", r"\1*,"),
    "a group left out": (r"   GP2:\r\n[^\n]*\n[^\n]*\n", DROP),
    "an axis of a group moved": (_GROUPED, shift_number(0.05)),
    "an axis of a group a turn on": (_GROUPED, shift_number(360.0)),
    "an axis of a group left out": (r"(?<=deg),\tJ2=[^\n]*deg(?=\r\n\};)", DROP),
    "the track moved": (r"\tE1=( *-?\d*\.\d{3})", shift_number(0.05)),
    "the track left out": (r",\r\n\tE1=[^\n]*mm", DROP),
    "the track in degrees": (r"(\tE1=[^\n]*) mm", r"\1deg"),
    "another axis called the track": (r"!E1 is the track e(\d)", increment),
    "no axis called the track": (r"^ *\d+:  !E1 is the track[^\n]*\n", DROP),
    "another frame of a group": (r"GP2:\r\n\tUF : (\d+)", increment),
    "another point named": (_FN + r"[JL] P\[(\d+)\]", increment),
    "a blend added": (r"FINE(?=    ;)", "CNT100"),
    "a blend of nothing added": (r"FINE(?=    ;)", "CNT0"),
    "a stop added": (r"CNT\d+(?=    ;)", "FINE"),
    "a blend changed": (r"CNT(\d+)(?=    ;)", lambda match, rng: "CNT70"),
    "another acceleration": (r"(?<=FINE|T100)(?=    ;)", " ACC150"),
    "a move's kind changed": (_FN + r"([JL])(?= P)", other("J", "L")),
    "a rapid made linear": (_FN + r"(J)(?= P\[\d+\] \d+msec FINE)", other("L")),
    "an output dropped": (_DO, DROP),
    "an output switched the other way": (r"DO\[1\]=(ON|OFF)", other("ON", "OFF")),
    "another output": (r"DO\[(1)\]", increment),
    "an output doubled": (_DO, TWICE),
    "two moves swapped": (rf"({_MOVE})({_MOVE})", SWAP),
    "a move and an output swapped": (rf"({_DO})({_MOVE})", SWAP),
    "an output and a wait swapped": (rf"({_DO})({_WAIT})", SWAP),
    "a move dropped": (_MOVE, DROP),
    "a move doubled": (_MOVE, TWICE),
    "an approach dropped": (rf"{_MOVE}(?={_DO})", DROP),
    "a retract dropped": (rf"({_FN}  DO\[1\]=OFF ;\r\n){_MOVE}", r"\1"),
    "a speed changed": (r"(\d+(?:\.\d)?)(?=mm/sec)", scale_number(1.1)),
    "a time changed": (r"(\d+)(?=msec)", scale_number(1.1)),
    "a unit of time changed": (r"(msec)", other("sec")),
    "the first move faster": (r"(10)%", other("100", "50")),
    "a wait dropped": (_WAIT, DROP),
    "a wait changed": (r"WAIT +([.\d]+)\(sec\)", shift_number(0.2)),
    "an input dropped": (_IN, DROP),
    "another input": (r"WAIT DI\[(\d+)\]", increment),
    "an input the other way": (r"(?<=DI\[3\]=)ON", "OFF"),
    "a call dropped": (_CLEAN, DROP),
    "another call": (r"CALL CLEAN\b", "CALL CLEAN2"),
    "a call doubled": (_CLEAN, TWICE),
    "a wait and a call swapped": (rf"({_WAIT})({_IN})({_CLEAN})", r"\3\2\1"),
    "another CONFIG": (r"CONFIG : '[NF] ([UD]) [TB]", other("U", "D")),
    "another wrist": (r"CONFIG : '([NF]) ", other("N", "F")),
    "another shoulder": (r"CONFIG : '[NF] [UD] ([TB])", other("T", "B")),
    "a turn number changed": (r"T, 0, 0, (-?\d)'", other("-2", "-1", "0", "1", "2")),
    "another turn number changed": (r"T, (0), 0, -?\d'", other("-1", "1")),
    "another frame selected": (r"UFRAME_NUM=(\d+)", increment),
    "another tool selected": (r"UTOOL_NUM=(\d+)", increment),
    "another frame recorded": (r"UF : (\d+)", increment),
    "another tool recorded": (r"UT : (\d+)", increment),
    "another layer": (r"!layer (\d+)", increment),
    "a part dropped": (r"^ *\d+:  CALL JOB\d+[^\n]*\n", DROP),
    "a part doubled": (r"^ *\d+:  CALL JOB\d+[^\n]*\n", TWICE),
    "parts in another order": (
        r"^( *\d+:  CALL JOB\d+[^\n]*\n)( *\d+:  CALL JOB\d+[^\n]*\n)",
        SWAP,
    ),
}
# for texts that switch the deposit on the move itself
TRIGGERS: dict[str, dict[str, tuple[str, Change]]] = {
    "fanuc": {
        "a trigger dropped": (_AHEAD, DROP),
        "a trigger doubled": (_AHEAD, TWICE),
        "a trigger at another time": (r" TB( +\d?\.\d\d)sec", shift_number(0.05)),
        "a trigger behind the end": (r" (TB) ", other("TA", "DB")),
        "a trigger on the next move": (
            rf"({_AHEAD})(    ;\r\n {{0,3}}\d+:[JL] [^\n;]*?)(?=    ;)",
            SWAP,
        ),
        "a trigger of its own": (rf"({_AHEAD})    ;", r"    ;\r\n   0:  \1 ;"),
    },
    "abb": {
        "a trigger dropped": (r"TriggL (\[[^\n]*),v_am\d+,g_o[nf]+\d", r"MoveL \1,v_am\\V:=5.000"),
        "a trigger doubled": (r",(g_o[nf]+\d)(?=,fine)", r",\1\\T2:=\1"),
        "a trigger at another place": (rf"TriggIO \w+,({NUMBER})", shift_number(0.05)),
        "a trigger at a time": (rf"(TriggIO \w+,{NUMBER})", r"\1\\Time"),
        "a trigger from the start": (rf"(TriggIO \w+,{NUMBER})", r"\1\\Start"),
        "a trigger of another output": (r"TriggIO[^\n]*do(1)", increment),
        "a trigger the other way": (r"TriggIO[^\n]*,([01]);", other("0", "1")),
        "another trigger": (r"(g_o[nf]+1)(?=,fine)", other("g_on1", "g_off1")),
        "a trigger that is not set": (r"^    TriggIO[^\n]*\n", DROP),
    },
}

# machines with rotary axes: first what both controllers share, then what each adds
_AXIS = rf"(?: [XYZABC]=?(?:DC\()?)({NUMBER})"
_SIEMENS_MOVE = r"^N\d+ (?:G9 )?(?:G9[34] )?G1 [^\n]*\n"
_SIEMENS_RAPID = r"^N\d+ G9 (?:G9[34] )?G1 [^\n]*\n"
_N = r"^N\d+ "
_SWITCH, _DWELL, _LOOP, _CLEANING = (
    _N + word
    for word in (
        r"H1=[01]\n",
        r"G4 F[.\d]+\n(?!N\d+ ENDWHILE)",
        r"WHILE[^\n]*\nN\d+ G4[^\n]*\nN\d+ ENDWHILE\n",
        r"CLEAN\n",
    )
)
SIEMENS: dict[str, tuple[str, Change]] = {
    "a point moved": (_AXIS, shift_number(0.05)),
    "a digit changed": (_AXIS, digit),
    "a sign changed": (rf" [XYZAB]({NUMBER})", negate_number),
    "a turn more": (rf" [AB]({NUMBER})", shift_number(360.0)),
    "a rapid's point moved": (rf"^N\d+ G9 G1 X({NUMBER})", shift_number(1.0)),
    "a direction changed": (rf" [ABC]3=({NUMBER})", shift_number(0.02)),
    "two values exchanged": (rf" X({NUMBER}) Y({NUMBER})", r" X\2 Y\1"),
    "a blend added": (r"G9 (?=(?:G9[34] )?G1)", ""),
    "a stop added": (r"^(N\d+ (?:G9[34] )?)(?=G1 )", r"\1G9 "),
    "another smoothing": (r"G642", "G64"),
    "no jerk limit": (r"SOFT", "BRISK"),
    "a move's kind changed": (r"\bG1\b", "G0"),
    "another feed": (r"\b(G9[34])\b(?= G1|$)", other("G93", "G94")),
    "incremental": (r"\bG90\b", "G91"),
    "in inches": (r"\bG710\b", "G700"),
    "an output dropped": (_SWITCH, DROP),
    "an output switched the other way": (r"H1=([01])", other("0", "1")),
    "another output": (r"H(1)=", increment),
    "an output doubled": (_SWITCH, TWICE),
    "two moves swapped": (rf"({_SIEMENS_MOVE})({_SIEMENS_MOVE})", SWAP),
    "a move and an output swapped": (rf"({_SIEMENS_MOVE})({_SWITCH})", SWAP),
    "an output and a wait swapped": (rf"({_SWITCH})({_DWELL})", SWAP),
    "a move dropped": (_SIEMENS_MOVE, DROP),
    "a move doubled": (_SIEMENS_MOVE, TWICE),
    "an approach dropped": (rf"{_SIEMENS_RAPID}(?={_SWITCH}|N\d+ G54)", DROP),
    "a retract dropped": (rf"({_N}H1=0\n(?:N\d+ (?:TRAFOOF|G500|G93)\n)*){_SIEMENS_RAPID}", r"\1"),
    "a feed changed": (r" F(\d+\.\d+)$", scale_number(1.02)),
    "a wait dropped": (_DWELL, DROP),
    "a wait changed": (r"G4 F([.\d]+)\n(?!N\d+ ENDWHILE)", shift_number(0.2)),
    "an input dropped": (_LOOP, DROP),
    "another input": (r"\$A_IN\[(\d+)\]", increment),
    "an input the other way": (r"(?<=\$A_IN\[3\]==)0", "1"),
    "a call dropped": (_CLEANING, DROP),
    "another call": (r"CLEAN$", "CLEAN_2"),
    "a call doubled": (_CLEANING, TWICE),
    "another frame selected": (r"^N\d+ G(54)$", increment),
    "a frame for axes": (r"\bG500(?= D1)", "G54"),
    "another tool selected": (r" D(\d+)$", increment),
    "a frame dropped": (_N + r"G54\n", DROP),
    "the transformation dropped": (_N + r"TRAORI\n", DROP),
    "the transformation kept": (_N + r"TRAFOOF\n", DROP),
    "directions in another frame": (r"ORIWKS", "ORIMKS"),
    "another layer": (r"^; layer (\d+)", increment),
    "a part dropped": (_N + r"JOB\d+\n", DROP),
    "a part doubled": (_N + r"JOB\d+\n", TWICE),
    "parts in another order": (rf"({_N}JOB\d+\n)({_N}JOB\d+\n)", SWAP),
}

# a word that is stated again before the next move, at the latest in the next file, has no effect
_USED = r"(?:\n(?!o<|G61|G64)[^\n]*)*?\n(?:G9[34] )?G1 "
_LINUX_MOVE = r"^(?:G9[34] )?G1 [^\n]*\n"
_PIN, _G4, _M66, _SUB = (
    r"^M6[45] P0\n",
    r"^G4 P[.\d]+\n",
    r"^M66 P\d+ L3[^\n]*\n",
    r"^o<clean> call\n",
)
LINUXCNC: dict[str, tuple[str, Change]] = {
    "a point moved": (_AXIS, shift_number(0.05)),
    "a digit changed": (_AXIS, digit),
    "a sign changed": (rf" [XYZAB]({NUMBER})", negate_number),
    "a turn more": (rf" [ABC]({NUMBER})", shift_number(360.0)),
    "two values exchanged": (rf" X({NUMBER}) Y({NUMBER})", r" X\2 Y\1"),
    "a blend added": (rf"^G61\.1$(?={_USED})", "G64 P0.05000 Q0.05000"),
    "a blend without bounds": (r"^G64 P[.\d]+ Q[.\d]+$", "G64"),
    "a stop added": (r"^G64 P[.\d]+ Q[.\d]+$", "G61.1"),
    "a blend changed": (r"^G64 P([.\d]+) Q", shift_number(0.02)),
    "another blend changed": (r"^G64 P[.\d]+ Q([.\d]+)$", shift_number(0.02)),
    "a blend dropped": (r"^G64 P[.\d]+ Q[.\d]+\n", DROP),
    "a move's kind changed": (r"\bG1\b", "G0"),
    "another feed": (r"\b(G9[34])\b(?= G1|$)", other("G93", "G94")),
    "incremental": (r"\bG90\b", "G91"),
    "in inches": (r"\bG21\b", "G20"),
    "an output dropped": (_PIN, DROP),
    "an output switched the other way": (r"^M6([45]) P0", other("4", "5")),
    "another output": (r"^M6[45] P(0)", increment),
    "an output doubled": (_PIN, TWICE),
    "two moves swapped": (rf"({_LINUX_MOVE})({_LINUX_MOVE})", SWAP),
    "a move and an output swapped": (
        rf"({_LINUX_MOVE})((?:M428\nG54\n)?G64[^\n]*\n{_PIN[1:]})",
        SWAP,
    ),
    "an output and a wait swapped": (rf"({_PIN})({_G4})", SWAP),
    "a move dropped": (_LINUX_MOVE, DROP),
    "a move doubled": (_LINUX_MOVE, TWICE),
    "an approach dropped": (rf"{_LINUX_MOVE}(?=(?:M428\nG54\n)?G64)", DROP),
    "a retract dropped": (rf"(^G61\.1\n(?:M429\nG59\.3\n)?(?:G93\n)?){_LINUX_MOVE}", r"\1"),
    "a feed changed": (r" F(\d+\.\d+)$", scale_number(1.02)),
    "a wait dropped": (_G4, DROP),
    "a wait changed": (r"^G4 P([.\d]+)", shift_number(0.2)),
    "an input dropped": (_M66, DROP),
    "another input": (r"^M66 P(\d+)", increment),
    "an input the other way": (r"^(M66 P\d+) L3", r"\1 L4"),
    "a call dropped": (_SUB, DROP),
    "another call": (r"^o<clean> call", "o<clean2> call"),
    "a call doubled": (_SUB, TWICE),
    "another frame selected": (r"^G(54)$", increment),
    "a frame for axes": (rf"^G59\.3$(?={_USED})", "G54"),
    "another tool selected": (rf"^G43 H(\d+)(?={_USED})", increment),
    "another kinematics": (r"^M42([89])$", other("8", "9")),
    "the kinematics dropped": (r"^M428\n", DROP),
    "the kinematics kept": (r"(?<=^G61\.1\n)M429\n", DROP),
    "zeros that are none": (r"^(G10 L2 P9) X0", r"\1 X5"),
    "another layer": (r"^\(layer (\d+)\)", increment),
    "a part dropped": (r"^o<job\d+> call\n", DROP),
    "a part doubled": (r"^o<job\d+> call\n", TWICE),
    "parts in another order": (r"^(o<job\d+> call\n)(o<job\d+> call\n)", SWAP),
}

_PLACE = r"(?<= )(?:j[1-6]|x|y|z|rx|ry|rz)=\"(-?\d+\.\d+)\""
_POINT = rf"(?<=<Value )key=\"\d+\" (?:j1|x)[^\n]*?{_PLACE}(?=[^\n]*(?:fStation|tCarried\[|/>))"
_POINTS = r"(?<=<Value )(key=\"\d+\" )((?:j1|x)[^\n]*)(\n *<Value key=\"\d+\" )((?:j1|x)[^\n]*)"
_LOOP_OF = r"^  for [^\n]*\n[^\n]*\n  endFor\n  waitEndMove\(\)\n"
_DEPOSIT, _DELAY, _READY_WORD, _REMOVED = (
    rf"^  {word}\n"
    for word in (
        r"doDeposit=(?:true|false)",
        r"delay\([.\d]+\)",
        r"wait\(diInput\d+==true\)",
        r"call clean:start\(\)",
    )
)
STAUBLI: dict[str, tuple[str, Change]] = {
    "a point moved": (rf"key=\"\d+\" j1[^\n]*?{_PLACE}", shift_number(0.05)),
    "a position moved": (
        r"key=\"\d+\" x=\"(-?\d+\.\d+)\"[^\n]*(?=fStation|tCarried\[)",
        shift_number(0.05),
    ),
    "an angle of a position moved": (
        r"ry=\"(-?\d+\.\d+)\"(?=[^\n]*(?:fStation|tCarried\[))",
        shift_number(0.05),
    ),
    "a digit changed": (r" j[1-6]=\"(-?\d+\.\d+)\"", digit),
    "a sign changed": (r" j[1-6]=\"(-?\d+\.\d+)\"", negate_number),
    "a turn more": (r" j[1-6]=\"(-?\d+\.\d+)\"", shift_number(360.0)),
    "two points exchanged": (_POINTS, r"\1\4\3\2"),
    "a rapid's point moved": (r" j1=\"(-?\d+\.\d+)\"", shift_number(1.0)),
    "a loop begins later": (r"^  for l_nI=(\d+) to", increment),
    "a loop ends later": (r"^  for l_nI=\d+ to (\d+)", increment),
    "another point named": (r"\[(\d+)\],(?:tCarried|mPath)", increment),
    "another speed named": (r"mPath\[(\d+)\]", increment),
    "a blend added": (
        r"blend=\"off\" leave=\"0.000\" reach=\"0.000\"",
        'blend="joint" leave="5.000" reach="5.000"',
    ),
    "a stop added": (
        r"blend=\"(?:joint|Cartesian)\" leave=\"[.\d]+\" reach=\"[.\d]+\"",
        'blend="off" leave="0.000" reach="0.000"',
    ),
    "a blend changed": (
        r"blend=\"(joint|Cartesian)\" leave=\"[.\d]+\" reach=\"[.\d]+\"",
        r'blend="\1" leave="7.000" reach="7.000"',
    ),
    "a blend that leaves earlier": (r"leave=\"((?!0\.000)[.\d]+)\"", scale_number(1.5)),
    "another acceleration": (r"accel=\"(100)\"", other("150", "50")),
    "another deceleration": (r"decel=\"(100)\"", other("150", "50")),
    "a limit of speed": (
        r"(?<=vel=\")[^\"]*(\" decel=\"100\") tmax=\"99999\"",
        r'50.00000\1 tmax="10"',
    ),
    "a move's kind changed": (r"^ *move([jl])\(", other("j", "l")),
    "an output dropped": (_DEPOSIT, DROP),
    "an output switched the other way": (r"doDeposit=(true|false)", other("true", "false")),
    "another output": (r"%Q(\d+)", increment),
    "an output doubled": (_DEPOSIT, TWICE),
    "two moves swapped": (rf"({_LOOP_OF})({_DEPOSIT})", SWAP),
    "an output and a wait swapped": (rf"({_DEPOSIT})({_DELAY})", SWAP),
    "moves dropped": (_LOOP_OF, DROP),
    "moves doubled": (_LOOP_OF, TWICE),
    "an end of motion dropped": (r"^  waitEndMove\(\)\n(?=  (?:doDeposit|delay))", DROP),
    "a speed changed": (r"tmax=\"((?!99999)[.\d]+)\"", scale_number(1.02)),
    "a share of speed changed": (r"vel=\"(\d+\.\d+)\"", scale_number(0.9)),
    "the first move faster": (r"key=\"0\" accel=\"100\" vel=\"(10\.00000)\"", scale_number(5.0)),
    "a wait dropped": (_DELAY, DROP),
    "a wait changed": (r"delay\(([.\d]+)\)", shift_number(0.2)),
    "an input dropped": (_READY_WORD, DROP),
    "another input": (r"%I(\d+)", increment),
    "an input the other way": (r"(?<=diInput3==)true", "false"),
    "a call dropped": (_REMOVED, DROP),
    "another call": (r"call clean:start", "call clean:stop"),
    "a call doubled": (_REMOVED, TWICE),
    "another frame": (r"x=\"(-?\d+\.\d+)\"(?=[^\n]*world)", shift_number(0.5)),
    "another configuration": (r"wrist=\"wsame\"", 'wrist="wpositive"'),
    "another elbow": (r"elbow=\"esame\"", 'elbow="enegative"'),
    "stopping leaves the deposit on": (r"(resetMotion\(\)\n)  doDeposit=false\n", r"\1"),
    "stopping does not stop": (r"  resetMotion\(\)\n", DROP),
    "in inches": (r"millimeterUnit=\"true\"", 'millimeterUnit="false"'),
    "another layer": (r"^  // layer (\d+)", increment),
    "parts in another order": (r"libLoad\(\"\./job0(\d)\"\)", other("1", "2", "3", "4")),
}

_UR_N = r"-?\d+\.\d{7}"
_UR_JOINT = rf"(?<![.\d-])({_UR_N})(?=(?:, {_UR_N}){{0,5}}\]\)?, a=1\.4)"
_UR_PLACE, _UR_ANGLE = (
    rf"(?<![.\d-])({_UR_N})(?=(?:, {_UR_N}){{{number_text}}}\]\), (?:a=1\.2|\[))"
    for number_text in ("3,5", "0,2")
)
_UR_MOVE, _UR_OUT, _UR_SLEEP, _UR_WHILE, _UR_CALL = (
    rf"^ +{line}\n"
    for line in (
        r"move[jp]\([^\n]*",
        r"set_standard_digital_out\([^\n]*",
        r"sleep\((?!0\.010)[.\d]+\)",
        r"while [^\n]*\n +sleep\(0\.010\)\n +end",
        r"clean\(\)",
    )
)
_UR_BLEND = r"r=(0\.\d*[1-9]\d*)\)$"
UR: dict[str, tuple[str, Change]] = {
    "a point moved": (_UR_JOINT, shift_number(0.001)),
    "a position moved": (_UR_PLACE, shift_number(0.00005)),
    "an angle of a position moved": (_UR_ANGLE, shift_number(0.001)),
    "a digit changed": (_UR_JOINT, digit),
    "a sign changed": (_UR_JOINT, negate_number),
    "a turn more": (_UR_JOINT, shift_number(6.2831853)),
    "two points exchanged": (r"(movej\(\[)([^\]]*)(\][^\n]*\n +movej\(\[)([^\]]*)", r"\1\4\3\2"),
    "two positions exchanged": (
        r"(movep\([^\[]*\[)([^\]]*)(\][^\n]*\n +movep\([^\[]*\[)([^\]]*)",
        r"\1\4\3\2",
    ),
    "a blend added": (r"r=0\.000000(?=\)$)", "r=0.005000"),
    "a stop added": (_UR_BLEND, "r=0.000000)"),
    "a blend changed": (_UR_BLEND, scale_number(1.5)),
    "a blend that overlaps": (_UR_BLEND, scale_number(3.0)),
    "a move's kind changed": (r"move(?:p|j(?=\(\[))", "movel"),
    "another acceleration": (r"a=(1\.[24])", other("0.1", "2.0")),
    "another speed of joints": (r"v=(1\.05)", other("0.10", "2.00")),
    "a time changed": (r"t=(\d+\.\d+)", scale_number(1.02)),
    "a time dropped": (r" t=\d+\.\d+,", DROP),
    "no time": (r"t=\d+\.\d+", "t=0.000000"),
    "the first move faster": (r"t=(10\.000000)", other("1.000000", "0.500000")),
    "a speed changed": (r"v=(0\.00\d+)", scale_number(1.02)),
    "an output dropped": (_UR_OUT, DROP),
    "an output switched the other way": (r"out\(\d, (True|False)\)", other("True", "False")),
    "another output": (r"out\((0),", increment),
    "an output of another kind": (r"set_(standard)_digital", other("configurable", "tool")),
    "an output doubled": (_UR_OUT, TWICE),
    "two moves swapped": (rf"({_UR_MOVE})({_UR_MOVE})", SWAP),
    "a move and an output swapped": (rf"({_UR_OUT})({_UR_MOVE})", SWAP),
    "an output and a wait swapped": (rf"({_UR_OUT})({_UR_SLEEP})", SWAP),
    "a move dropped": (_UR_MOVE, DROP),
    "a move doubled": (_UR_MOVE, TWICE),
    "an approach dropped": (rf"{_UR_MOVE}(?={_UR_OUT})", DROP),
    "a retract dropped": (rf"(^ +set_[^\n]*False\)\n){_UR_MOVE}", r"\1"),
    "a wait dropped": (_UR_SLEEP, DROP),
    "a wait changed": (r"sleep\(((?!0\.010)[.\d]+)\)", shift_number(0.2)),
    "an input dropped": (_UR_WHILE, DROP),
    "another input": (r"digital_in\((\d)\)", increment),
    "an input the other way": (r"(?<=digital_in\(2\) == )False", "True"),
    "an input that is not waited for": (r"(?<=sleep\()0\.010", "0.000"),
    "a call dropped": (_UR_CALL, DROP),
    "another call": (r"\bclean\(\)", "clean2()"),
    "a call doubled": (_UR_CALL, TWICE),
    "a wait and a call swapped": (rf"({_UR_WHILE})({_UR_CALL})", SWAP),
    "another platform": (rf"(?<![.\d-])({_UR_N})(?=(?:, {_UR_N}){{0,5}}\]\n)", shift_number(0.001)),
    "another tool": (rf"set_tcp\(p\[(?:{_UR_N}, ){{0,2}}({_UR_N})", shift_number(0.05)),
    "no platform": (r"^ +global platform[^\n]*\n", DROP),
    "no tool": (r"^ +set_tcp[^\n]*\n", DROP),
    "another frame named": (r"pose_trans\(platform", "pose_trans(base"),
    "another layer": (r"^ +# layer (\d+)", increment),
    "a part dropped": (r"^  job\d+\(\)\n", DROP),
    "a part doubled": (r"^  job\d+\(\)\n", TWICE),
    "parts in another order": (r"^(  job\d+\(\)\n)(  job\d+\(\)\n)", SWAP),
    "a part of another name": (r"^  def job(0)\d\(\):", increment),
    "no end": (r"^end\n", DROP),
}

_YA_MOVE, _YA_OUT, _YA_TIMER, _YA_IN, _YA_CALL, _YA_PART = (
    rf"^{line}\r\n"
    for line in (
        r"MOV[JL] [^\r]*",
        r"DOUT [^\r]*",
        r"TIMER T=[.\d]+",
        r"WAIT IN#[^\r]*",
        "CALL JOB:CLEAN",
        r"CALL JOB:JOB\d+",
    )
)


def next_position(match: re.Match, rng: np.random.Generator) -> str:
    """Return the position after the named one."""
    return f"{match[1]}{int(match[2]) + 1:05d}"


YASKAWA: dict[str, tuple[str, Change]] = {
    "a point moved": (r"^C\d{5}=[^\r]*,(-?\d+)(?=\r)", shift_number(30.0)),
    "another axis moved": (r"^C\d{5}=-?\d+,(-?\d+)", shift_number(30.0)),
    "a digit changed": (r"^C\d{5}=(?:-?\d+,){2}(-?\d{3,})", digit),
    "a sign changed": (r"^C\d{5}=(?:-?\d+,){4}(-?\d{3,})", negate_number),
    "a turn more": (r"^C\d{5}=(-?\d+)", shift_number(516708.0)),
    "two points exchanged": (r"^(C\d{5}=)([^\r]*)(\r\nC\d{5}=)([^\r]*)", r"\1\4\3\2"),
    "another point named": (r"^(MOV[JL] C)(\d{5})", next_position),
    "a point too many": (r"^///NPOS ([1-9]\d*)", increment),
    "a blend added": (r"PL=0(?=\r)", "PL=8"),
    "a stop added": (r"PL=8(?=\r)", "PL=0"),
    "a blend changed": (r"PL=8(?=\r)", "PL=4"),
    "no blend told": (r" PL=\d(?=\r)", ""),
    "a move's kind changed": (r"^MOV([JL])", other("J", "L", "C", "S")),
    "a rapid made linear": (r"^MOVJ (C\d{5}) VJ=[\d.]+ PL=0", r"MOVL \1 V=8.0 PL=0"),
    "another acceleration": (r"(PL=\d)(?=\r)", r"\1 ACC=20"),
    "a share of speed changed": (r"VJ=(\d+\.\d\d)", scale_number(1.1)),
    "a speed changed": (r"V=(\d+\.\d)", scale_number(1.1)),
    "the first move faster": (r"VJ=(10\.00)", other("50.00", "100.00")),
    "an output dropped": (_YA_OUT, DROP),
    "an output switched the other way": (r"^DOUT OT#\(1\) (ON|OFF)", other("ON", "OFF")),
    "another output": (r"OT#\((1)\)", increment),
    "an output doubled": (_YA_OUT, TWICE),
    "two moves swapped": (rf"({_YA_MOVE})({_YA_MOVE})", SWAP),
    "a move and an output swapped": (rf"({_YA_OUT})({_YA_MOVE})", SWAP),
    "an output and a wait swapped": (rf"({_YA_OUT})({_YA_TIMER})", SWAP),
    "a move dropped": (_YA_MOVE, DROP),
    "a move doubled": (_YA_MOVE, TWICE),
    "an approach dropped": (rf"{_YA_MOVE}(?=DOUT)", DROP),
    "a retract dropped": (rf"(^DOUT OT#\(1\) OFF\r\n){_YA_MOVE}", r"\1"),
    "a wait dropped": (_YA_TIMER, DROP),
    "a wait changed": (r"TIMER T=([.\d]+)", shift_number(0.2)),
    "an input dropped": (_YA_IN, DROP),
    "another input": (r"IN#\((\d+)\)", increment),
    "an input the other way": (r"(?<=IN#\(3\)=)ON", "OFF"),
    "a call dropped": (_YA_CALL, DROP),
    "another call": (r"JOB:CLEAN", "JOB:CLEAN2"),
    "a call doubled": (_YA_CALL, TWICE),
    "a wait and a call swapped": (rf"({_YA_TIMER})({_YA_IN})({_YA_CALL})", r"\3\2\1"),
    "the track moved": (r"^BC\d{5}=(-?\d+)", shift_number(30.0)),
    "another place of the track named": (r"^(MOVJ C\d{5} BC)(\d{5})", next_position),
    "no place of the track named": (r"^(MOVJ C\d{5}) BC\d{5}", r"\1"),
    "the track of no group": (r"RB1,BS1", "RB1"),
    "the track taken for a turning axis": (r"^'pulses/(mm) E\d", other("deg")),
    "another ratio of the track": (r"^'pulses/mm E\d (-?\d+\.\d+)", shift_number(0.5)),
    "no ratio of the track": (r"^'pulses/mm [^\r]*\r\n", DROP),
    "another tool": (r"^///TOOL (\d+)", increment),
    "another ratio": (r"^'pulses/deg [SLURBT] (-?\d+\.\d+)", shift_number(0.5)),
    "a ratio of the other sign": (r"^'pulses/deg [SLURBT] (-?\d+\.\d+)", negate_number),
    "no ratio": (r"^'pulses/deg [SLURBT] [^\r]*\r\n", DROP),
    "another unit": (r"^'V in (mm/s)", other("cm/min", "mm/min")),
    "positions of another kind": (r"^///PULSE", "///RECTAN"),
    "positions in another frame": (r"^///POSTYPE (PULSE)", other("USER", "BASE")),
    "a relative job": (r"SC,RW(?=\r)", "SC,RW,RJ"),
    "another robot": (r"^///GROUP1 RB(1)", increment),
    "another layer": (r"^'layer (\d+)", increment),
    "no end": (r"^END\r\n", DROP),
    "a part dropped": (_YA_PART, DROP),
    "a part doubled": (_YA_PART, TWICE),
    "parts in another order": (rf"({_YA_PART})({_YA_PART})", SWAP),
}

# ABB
_MOVE_ABB = r"^    Move(?:AbsJ|L) [^\n]*\n"
_SETDO, _WAITTIME, _WAITDI, _CLEAN_ABB = (
    rf"^    {word}\n"
    for word in (r"SetDO do\d+,[01];\r", r"WaitTime [.\d]+;\r", r"WaitDI di\d+,1;\r", r"clean;\r")
)
_AXIS_ABB = rf"^    MoveAbsJ \[\[(?:{NUMBER},){{0,5}}?({NUMBER})"
_PLACE_ABB = rf"^    MoveL \[\[(?:{NUMBER},){{0,2}}?({NUMBER})"
_TURN_ABB = rf"^    MoveL \[\[[^]]*\],\[(?:{NUMBER},){{0,3}}?({NUMBER})"
_BESIDE_ABB = rf"\[(?:{NUMBER},)?({NUMBER})(?:,{NUMBER})?,9E9,9E9"
_IN_USE = r"(?=[\s\S]*MoveL )"  # frames: joint moves do not depend on them
_PART_ABB = r"    Load [^\n]*\n    %[^\n]*\n    UnLoad [^\n]*\n"
ABB: dict[str, tuple[str, Change]] = {
    "a point moved": (_AXIS_ABB, shift_number(0.05)),
    "a position moved": (_PLACE_ABB, shift_number(0.05)),
    "an orientation turned": (
        r"^    MoveL \[\[[^]]*\],\[(\S+?),(\S+?),",
        r"    MoveL [[0.000,0.000,0.000],[\2,\1,",
    ),
    "a number of an orientation": (_TURN_ABB, shift_number(0.001)),
    "a digit changed": (_AXIS_ABB, digit),
    "a sign changed": (_AXIS_ABB, negate_number),
    "a turn more": (_AXIS_ABB, shift_number(360.0)),
    "two points exchanged": (rf"({_MOVE_ABB})({_MOVE_ABB})", SWAP),
    "a blend added": (r"(?<=,)fine(?=,)", "z_am1"),
    "a stop added": (r"(?<=,)z_am\d+(?=,t_am)", "fine"),
    "a blend changed": (
        r"(z_am\d+:=\[FALSE,)[.\d]+,[.\d]+,[.\d]+,([.\d]+),[.\d]+,",
        r"\g<1>1.000,1.000,1.000,\2,1.000,",
    ),
    "a blend of another kind": (r"(z_am\d+:=\[FALSE,[.\d]+,)[.\d]+", r"\g<1>25.000"),
    "a blend that stops": (r"(z_am\d+:=\[)FALSE", r"\1TRUE"),
    "another zone": (r"(?<=,)z_am(\d+)(?=,t_am)", lambda match, rng: f"z{match[1]}"),
    "a move's kind changed": (r"^    Move(AbsJ|L) ", other("AbsJ", "L")),
    "external axes": (r"\[9E9,9E9", "[0,9E9"),
    "an external axis moved": (_BESIDE_ABB, shift_number(0.05)),
    "an external axis a turn on": (_BESIDE_ABB, shift_number(360.0)),
    "another axis called the track": (r"! eax_([a-c]) is the track", other("a", "b", "c")),
    "no axis called the track": (r"^  ! eax_[a-f] is the track[^\n]*\n", DROP),
    "an external axis of another letter": (rf"\[({NUMBER},{NUMBER}),9E9", r"[9E9,\1"),
    "an external axis left out": (rf"\[({NUMBER}),{NUMBER},9E9", r"[\1,9E9,9E9"),
    "external axes exchanged": (rf"\[({NUMBER}),({NUMBER}),9E9", r"[\2,\1,9E9"),
    "another unit": (r"FALSE,\"(STN1)\"", other("STN2")),
    "another unit altogether": (r"STN1(\"[\s\S]*ActUnit )STN1", r"STN2\1STN2"),
    "a unit that is not active": (r"^    ActUnit STN1;\r\n", DROP),
    "a frame of the user on a unit": (r"(?<=\"STN1\",)\[\[0,0,0\]", "[[0,0,5]"),
    "a work object on a unit moved": (
        rf"STN1\",\[\[0,0,0\],\[1,0,0,0\]\],\[\[({NUMBER}){_IN_USE}",
        shift_number(0.5),
    ),
    "a work object that no unit moves": (r"FALSE,\"STN1\"", 'TRUE,""'),
    "a configuration": (r"\[0,0,0,0\]", "[-1,0,0,1]"),
    "an offset of axes": (r"\\NoEOffs", ""),
    "configurations supervised": (rf"^    ConfL\\Off;\r\n{_IN_USE}", DROP),
    "configurations supervised by a word": (rf"ConfL\\Off{_IN_USE}", r"ConfL\\On"),
    "an output dropped": (_SETDO, DROP),
    "an output switched the other way": (r"SetDO do1,([01])", other("0", "1")),
    "another output": (r"SetDO do(1)", increment),
    "an output doubled": (_SETDO, TWICE),
    "a move and an output swapped": (rf"({_SETDO})({_MOVE_ABB})", SWAP),
    "an output and a wait swapped": (rf"({_SETDO})({_WAITTIME})", SWAP),
    "a move dropped": (_MOVE_ABB, DROP),
    "a move doubled": (_MOVE_ABB, TWICE),
    "an approach dropped": (rf"{_MOVE_ABB}(?={_SETDO})", DROP),
    "a retract dropped": (rf"(^    SetDO do1,0;\r\n){_MOVE_ABB}", r"\1"),
    "a speed changed": (r"\\V:=([.\d]+)", scale_number(1.02)),
    "a time changed": (r"\\T:=([.\d]+)", scale_number(1.02)),
    "a time for a speed": (r"\\(V):=", other("T")),
    "another speed named": (r"(v_am)\\", other("v100")),
    "a speed that turns slower": (r"(?<=v_am:=\[1000,)500", "5"),
    "the first move faster": (r"\\T:=(10\.00000)", other("1.00000")),
    "a wait dropped": (_WAITTIME, DROP),
    "a wait changed": (r"WaitTime ([.\d]+)", shift_number(0.2)),
    "an input dropped": (_WAITDI, DROP),
    "another input": (r"WaitDI di(\d+)", increment),
    "an input the other way": (r"(?<=WaitDI di3,)1", "0"),
    "a call dropped": (_CLEAN_ABB, DROP),
    "another call": (r"^    clean;", "    clean2;"),
    "a call doubled": (_CLEAN_ABB, TWICE),
    "a wait and a call swapped": (rf"({_WAITTIME})({_WAITDI})({_CLEAN_ABB})", r"\3\2\1"),
    "another tool": (rf"tooldata t_am:=\[\w+,\[\[({NUMBER}){_IN_USE}", shift_number(0.5)),
    "another work object": (
        rf"wobjdata w_am:=\[\w+,TRUE,\"\",\[\[({NUMBER}){_IN_USE}",
        shift_number(0.5),
    ),
    "a work object moved": (
        r"\[\[0,0,0\],\[1,0,0,0\]\](?=\];\r\n[\s\S]*MoveL )",
        "[[0,0,1],[1,0,0,0]]",
    ),
    "a tool turned": (
        rf"(tooldata t_am:=\[\w+,\[\[[^]]*\],\[){NUMBER},{NUMBER}{_IN_USE}",
        r"\g<1>0.0000000,0.0000000",
    ),
    "a tool that is held otherwise": (r"tooldata t_am:=\[(TRUE|FALSE)", other("TRUE", "FALSE")),
    "a work object that is held otherwise": (
        r"wobjdata w_am:=\[(TRUE|FALSE)",
        other("TRUE", "FALSE"),
    ),
    "a work object that a unit moves": (r"(?<=,)TRUE,\"\"", 'FALSE,"STN1"'),
    "another tool named": (r",(t_am)\\WObj", other("tool0")),
    "another work object named": (r"WObj:=(w_am);", other("wobj0")),
    "no work object": (r"\\WObj:=w_am", ""),
    "another layer": (r"! layer (\d+)", increment),
    "a part dropped": (rf"^{_PART_ABB}", DROP),
    "a part doubled": (rf"^{_PART_ABB}", TWICE),
    "parts in another order": (rf"^({_PART_ABB})({_PART_ABB})", SWAP),
    "a part that stays": (r"^    UnLoad [^\n]*\n", DROP),
    "a part that is not run": (r"^    %[^\n]*\n", DROP),
    "another routine": (r"PROC (main|job\d+_p)", other("job_p")),
}

# KUKA
_K_MOVE = r"^(?:PTP|LIN) [^\n]*\n"
_K_OUT, _K_SEC, _K_IN, _K_CLEAN = (
    rf"^{line}\r\n"
    for line in (r"\$OUT\[\d+\]=\w+", r"WAIT SEC \d+\.\d+", r"WAIT FOR [^\r]*", r"clean\(\)")
)
_K_AXIS = rf"(?<=A\d )({NUMBER})"
_K_BESIDE = rf"(?<=E\d )({NUMBER})"
_K_PLACE, _K_ANGLE = (rf"(?<=[{letters}] )({NUMBER})(?=[^\n]*\}})" for letters in ("XYZ", "ABC"))
KUKA: dict[str, tuple[str, Change]] = {
    "a point moved": (_K_AXIS, shift_number(0.05)),
    "a position moved": (_K_PLACE, shift_number(0.05)),
    "an angle of a position moved": (_K_ANGLE, shift_number(0.05)),
    "a digit changed": (_K_AXIS, digit),
    "a sign changed": (_K_AXIS, negate_number),
    "a turn more": (_K_AXIS, shift_number(360.0)),
    "two moves swapped": (rf"({_K_MOVE})({_K_MOVE})", SWAP),
    "a blend added": (r"^(LIN [^\r}]*\})(?=\r)", r"\1 C_DIS"),
    "a blend of joints added": (r"^(PTP [^\r]*)(?=\r)", r"\1 C_PTP"),
    "a stop added": (r" C_DIS", ""),
    "a blend changed": (r"CDIS=([.\d]+)", scale_number(1.5)),
    "a blend dropped": (r"^\$APO[^\n]*\n(?=\$VEL)", DROP),
    "another blend": (r"C_DIS", "C_VEL"),
    "a move's kind changed": (r"^(PTP|LIN)", other("PTP", "LIN", "SLIN", "PTP_REL")),
    "an axis left out": (r",A6 [-.\d]+", DROP),
    "an external axis": (r"(?<=\d)\}", ",E1 5.0}"),
    "an external axis moved": (_K_BESIDE, shift_number(0.05)),
    "an external axis a turn on": (_K_BESIDE, shift_number(360.0)),
    "an external axis left out": (r",E2 [-.\d]+", DROP),
    "another external axis": (r",E(2) ", increment),
    "external axes exchanged": (rf"E1 ({NUMBER}),E2 ({NUMBER})", r"E1 \2,E2 \1"),
    "another axis called the track": (r"^; E(\d) is the track", increment),
    "no axis called the track": (r"^; E\d is the track[^\n]*\n", DROP),
    "another mechanism": (r"^\$BASE[^\n]*MACHINE_DEF\[(2)\]", increment),
    "another mechanism altogether": (
        r"MACHINE_DEF\[2\]([^\n]*)MACHINE_DEF\[2\]",
        r"MACHINE_DEF[3]\1MACHINE_DEF[3]",
    ),
    "another base of the mechanism": (r"MECH_TYPE,BASE_DATA\[(1)\]", increment),
    "no mechanism": (r"^\$BASE=EK[^\n]*\n", DROP),
    "a mechanism that is let go": (r"^(\$BASE=EK[^\n]*\n)", r"\1BAS(#BASE,1)\r\n"),
    "a slower external axis": (r"VEL_EXTAX\[[12]\]=(\d+)", other("1", "50")),
    "an external axis as slow as before": (r"^\$VEL_EXTAX\[2\]=100\r\n", DROP),
    "an output dropped": (_K_OUT, DROP),
    "an output switched the other way": (r"^\$OUT\[1\]=(TRUE|FALSE)", other("TRUE", "FALSE")),
    "another output": (r"^\$OUT\[(1)", increment),
    "an output doubled": (_K_OUT, TWICE),
    "a move and an output swapped": (
        rf"({_K_OUT})((?:WAIT[^\n]*\n|\$[AV][^\n]*\n|BAS[^\n]*\n)*{_K_MOVE[1:]})",
        SWAP,
    ),
    "an output and a wait swapped": (rf"({_K_OUT})({_K_SEC})", SWAP),
    "a standstill dropped": (r"^WAIT SEC 0\r\n(?=\$OUT)", DROP),
    "a move dropped": (_K_MOVE, DROP),
    "a move doubled": (_K_MOVE, TWICE),
    "an approach dropped": (rf"{_K_MOVE}(?=WAIT SEC 0\r\n\$OUT\[1\]=TRUE)", DROP),
    "a retract dropped": (rf"(^\$OUT\[1\]=FALSE\r\n(?:BAS[^\n]*\n)?){_K_MOVE[1:]}", r"\1"),
    "a speed changed": (r"\$VEL\.CP=([.\d]+)", scale_number(1.02)),
    "a speed dropped": (r"^\$VEL\.CP[^\n]*\n", DROP),
    "the first move faster": (r"(?<=VEL_PTP,)(10)\b", other("100", "50")),
    "a wait dropped": (_K_SEC, DROP),
    "a wait changed": (r"WAIT SEC (\d+\.\d+)", shift_number(0.2)),
    "an input dropped": (_K_IN, DROP),
    "another input": (r"\$IN\[(\d+)", increment),
    "an input the other way": (r"(?<=\$IN\[3\]==)TRUE", "FALSE"),
    "a call dropped": (_K_CLEAN, DROP),
    "another call": (r"^clean\(", "clean2("),
    "a call doubled": (_K_CLEAN, TWICE),
    "a wait and a call swapped": (rf"({_K_IN})(WAIT SEC 0\r\n{_K_CLEAN[1:]})", SWAP),
    "another base": (r"#BASE,(\d+)", increment),
    "another tool": (r"#TOOL,(\d+)", increment),
    "no base": (r"^BAS\(#BASE[^\n]*\n", DROP),
    "a tool that is fixed": (r"(?<=IPO_MODE=)#BASE", "#TCP"),
    "another orientation": (r"(?<=ORI_TYPE=)#VAR", "#CONSTANT"),
    "nothing initial": (r"^BAS\(#INITMOV,0\)\r\n", DROP),
    "another layer": (r"^; layer (\d+)", increment),
    "a part dropped": (r"^job\d+\(\)\r\n", DROP),
    "a part doubled": (r"^job\d+\(\)\r\n", TWICE),
    "parts in another order": (r"^(job\d+\(\)\r\n)(job\d+\(\)\r\n)", SWAP),
    "another name": (r"^DEF job(\d*)", r"DEF job1\1"),
}

KINDS = {
    "fanuc": FANUC,
    "staubli": STAUBLI,
    "siemens": SIEMENS,
    "linuxcnc": LINUXCNC,
    "ur": UR,
    "abb": ABB,
    "yaskawa": YASKAWA,
    "kuka": KUKA,
}

# The smallest change of a number, in units of its last digit, that must be rejected
# (docs/decisions/0005-read-back.md). A written number is itself off by half a unit, and the check
# allows as much: one unit of a single number is rejected, three coordinates that may each be off
# need more, and more again if tool and frames have as few digits.
_BEFORE_FRAMES = r"(?=[^\n]*(?:fStation|tCarried\[))"
_WAIT_NC, _FEED = r"^{}([.\d]+)\n(?!N\d+ ENDWHILE)", r"G1 [^\n]* F(\d+\.\d+)$"
SMALLEST_REJECTED: dict[str, dict[str, tuple[str, int]]] = {
    "fanuc": {
        "axis of a group": (_GROUPED, 1),
        "track": (r"\tE1=( *-?\d*\.\d{3})", 1),
        "joint": (r"J[1-6]=( *-?\d*\.\d{3})", 1),
        "position": (r"[XYZ] =( *-?\d*\.\d{3})", 2),
        "angle": (r"[WPR] =( *-?\d*\.\d{3})", 4),
        "milliseconds": (r"(\d+)msec", 3),
        "wait": (r"WAIT +([.\d]+)\(sec\)", 1),
    },
    "staubli": {
        "joint": (r" j[1-6]=\"(-?\d+\.\d+)\"", 1),
        "position": (rf" [xyz]=\"(-?\d+\.\d+)\"{_BEFORE_FRAMES}", 4),
        "angle": (rf" r[xyz]=\"(-?\d+\.\d+)\"{_BEFORE_FRAMES}", 8),
        "frame": (r" (?:x|y|z|rx|ry|rz)=\"(-?\d+\.\d+)\"(?=[^\n]*world)", 6),
        "speed": (r"tmax=\"((?!99999)[.\d]+)\"", 1),
        "share": (r"vel=\"(\d+\.\d+)\"", 50),
        "blend": (r"leave=\"((?!0\.000)[.\d]+)\"", 1),
        "wait": (r"delay\(([.\d]+)\)", 1),
    },
    "kuka": {
        "joint": (_K_AXIS, 1),
        "external axis": (_K_BESIDE, 1),
        "position": (_K_PLACE, 2),
        "angle": (_K_ANGLE, 4),
        "speed": (r"CP=([.\d]+)", 1),
        "blend": (r"CDIS=([.\d]+)", 2),
        "wait": (r"WAIT SEC (\d+\.\d+)", 1),
    },
    "abb": {
        "external axis": (_BESIDE_ABB, 1),
        "joint": (_AXIS_ABB, 1),
        "position": (_PLACE_ABB, 4),
        "orientation": (_TURN_ABB, 16),
        "time": (r"\\T:=([.\d]+)", 1),
        "frame": (rf"(?:data t_am:=\[\w+|w_am:=\[\w+,TRUE,\"\"),\[\[({NUMBER}){_IN_USE}", 6),
        "speed": (r"\\V:=([.\d]+)", 1),
        "wait": (r"WaitTime ([.\d]+)", 1),
        "blend": (r"z_am\d+:=\[FALSE,([.\d]+)", 1),
    },
    "siemens": {
        "rotary axis": (r" [ABC]=?(?:DC\()?(-?\d+\.\d+)", 1),
        "position": (r" [XYZ](-?\d+\.\d+)", 2),
        # the last digits of a number that is nearly the whole direction only change its length
        "direction": (r" [ABC]3=(-?0\.[0-5]\d+)", 2),
        "feed": (_FEED, 1),
        "wait": (_WAIT_NC.format(r"N\d+ G4 F"), 1),
    },
    "linuxcnc": {
        "rotary axis": (r" [ABC](-?\d+\.\d+)", 1),
        "position": (r" [XYZ](-?\d+\.\d+)", 2),
        "feed": (_FEED, 1),
        "wait": (_WAIT_NC.format("G4 P"), 1),
        "blend": (r"^G64 P([.\d]+) Q", 1),
    },
    "ur": {
        "joint": (_UR_JOINT, 1),
        "position": (_UR_PLACE, 5),
        "angle": (_UR_ANGLE, 10),
        "frame": (rf"(?<![.\d-])({_UR_N})(?=(?:, {_UR_N}){{0,5}}\]\n)", 10),
        "time": (r"t=(\d+\.\d+)", 3),
        "speed": (r"v=(0\.00\d+)", 1),
        "blend": (_UR_BLEND, 3),
        "wait": (r"sleep\(((?!0\.010)[.\d]+)\)", 1),
    },
    "yaskawa": {
        "track": (r"^BC\d{5}=(-?\d+)", 1),
        "first axis": (r"^C\d{5}=(-?\d+)", 1),
        "last axis": (r"^C\d{5}=[^\r]*,(-?\d+)(?=\r)", 1),
        "share": (r"VJ=(\d+\.\d\d)", 4),
        "speed": (r"V=(\d+\.\d)", 1),
        "wait": (r"TIMER T=([.\d]+)", 1),
    },
}


def step_number(steps: int) -> Change:
    """Change the number in the first group by `steps` units of its last digit."""

    def change(match: re.Match, rng: np.random.Generator) -> str:
        return shift_number(steps * 10.0 ** -len(match[1].partition(".")[2]))(match, rng)  # type: ignore[operator]

    return change
