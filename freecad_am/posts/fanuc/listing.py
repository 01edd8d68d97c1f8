# SPDX-License-Identifier: LGPL-2.1-or-later
"""The text of one FANUC listing (.LS): header, instructions, position records, as a controller exports them.

Field widths and line ends follow listings that controllers wrote; docs/posts/fanuc.md says which rules were
confirmed where.
"""

from __future__ import annotations

import re
import textwrap
import unicodedata
from collections.abc import Sequence

import numpy as np

from ...core.types import Array

END_OF_LINE = "\r\n"
REMARK_WIDTH = 32
COMMENT_WIDTH = 16
GROUPS = 5  # that the header has room for

# Same job, same bytes: the controller puts the true date when it loads the file. This one is a valid day both
# for a two-digit year and for the file dates of the controller's memory card, which begin in 1980.
_DATE = "DATE 00-01-01  TIME 00:00:00"

_HEADER = """\
/PROG  {name}
/ATTR
OWNER\t\t= MNEDITOR;
COMMENT\t\t= "{comment}";
PROG_SIZE\t= 0;
CREATE\t\t= {date};
MODIFIED\t= {date};
FILE_NAME\t= ;
VERSION\t\t= 0;
LINE_COUNT\t= {lines};
MEMORY_SIZE\t= 0;
PROTECT\t\t= READ_WRITE;
TCD:  STACK_SIZE\t= 0,
      TASK_PRIORITY\t= 50,
      TIME_SLICE\t= 0,
      BUSY_LAMP_OFF\t= 0,
      ABORT_REQUEST\t= 0,
      PAUSE_REQUEST\t= 0;
DEFAULT_GROUP\t= {groups};
CONTROL_CODE\t= 00000000 00000000;
/MN
"""

# longest single wait written, s; longer ones become several lines
_LONGEST_WAIT = 300.0

_JOINT_RECORD = (
    "P[%d]{\r\n   GP1:\r\n\t<frame>\t\r\n"
    "\tJ1=%s deg,\tJ2=%s deg,\tJ3=%s deg,\r\n"
    "\tJ4=%s deg,\tJ5=%s deg,\tJ6=%s deg\r\n};\r\n"
)
_POSE_RECORD = (
    "P[%d]{\r\n   GP1:\r\n\t<frame>\t\tCONFIG : '%s',\r\n"
    "\tX =%s  mm,\tY =%s  mm,\tZ =%s  mm,\r\n"
    "\tW =%s deg,\tP =%s deg,\tR =%s deg\r\n};\r\n"
)


def listing(
    name: str, comment: str, instructions: Sequence[str], records: str, group: int = 1
) -> bytes:
    """Return a complete file.

    Parameters
    ----------
    name : str
        Name of the program.
    comment : str
        Its comment.
    instructions : sequence of str
        Text after the colon of each line, with its semicolon.
    records : str
        Text of joint_records or pose_records, or ''.
    group : int, optional
        The motion group that moves together with the first one.

    Returns
    -------
    bytes
        The content of the file.
    """
    groups = ",".join("1" if number in (1, group) else "*" for number in range(1, GROUPS + 1))
    comment = plain(comment)[:COMMENT_WIDTH]
    head = _HEADER.format(
        name=name, comment=comment, date=_DATE, lines=len(instructions), groups=groups
    )
    numbered = [f"{number:4d}:{line}" for number, line in enumerate(instructions, 1)]
    text = head.replace("\n", END_OF_LINE) + END_OF_LINE.join(numbered) + END_OF_LINE
    return (text + "/POS" + END_OF_LINE + records + "/END" + END_OF_LINE).encode("ascii")


def plain(text: str) -> str:
    """The text in characters a listing may hold: accents dropped, no semicolon or quote."""
    ascii_text = unicodedata.normalize("NFKD", text).encode("ascii", "ignore").decode("ascii")
    return " ".join(ascii_text.translate(str.maketrans(';"', ",'")).split())


def remark(text: str) -> list[str]:
    """A remark, on as many lines as its width needs."""
    return [f"  !{line} ;" for line in textwrap.wrap(plain(text), REMARK_WIDTH)]


def wait(seconds: float) -> list[str]:
    """Standing still for a time, to 0.01 s; nothing for no time."""
    lines = []
    hundredths = max(round(seconds * 100.0), int(seconds > 0.0))
    while hundredths > 0:
        step = min(hundredths, round(_LONGEST_WAIT * 100.0))
        lines.append(f"  WAIT{right_aligned(step / 100.0, 2, 7)}(sec) ;")
        hundredths -= step
    return lines


def call(name: str) -> str:
    """A call of another program."""
    return f"  CALL {name}    ;"


def arc(word: str, schedule: int) -> str:
    """The arc instruction, Start or End, by a schedule."""
    return f"  Arc {word}[{schedule}]    ;"


def weave(number: int) -> str:
    """The sine weave with the schedule `number`; its end for 0."""
    return f"  Weave Sine[{number}] ;" if number else "  Weave End ;"


def joint_records(
    degrees: Array, track: Array, external: Array, user_frame: int, tool_frame: int, group: int = 1
) -> str:
    """Return position records with joint values.

    Parameters
    ----------
    degrees : (n, 6) array
        Values of the robot, degrees, rounded to 3 decimals.
    track : (n, 0) or (n, 1) array
        Values of the track, mm, rounded.
    external : (n, k) array
        Values of another group, degrees, rounded.
    user_frame, tool_frame : int
        Numbers of the frames.
    group : int, optional
        Number of the other group.

    Returns
    -------
    str
        Records P[1], P[2] and on.
    """
    values = ",".join(f"\tJ{axis}=%s deg" for axis in range(1, external.shape[1] + 1))
    second_group = f"   GP{group}:\r\n\t<frame>\t\r\n{values}\r\n}};" if values else "};"
    extended = "deg,\r\n\tE1=%s  mm\r\n};" if track.shape[1] else "deg\r\n};"
    record = _JOINT_RECORD.replace("deg\r\n};", extended).replace("};", second_group)
    return _records(record, user_frame, tool_frame, [], np.hstack([degrees, track, external]))


def pose_records(
    pose: Array, configuration: Sequence[str], user_frame: int, tool_frame: int
) -> str:
    """Return position records with poses.

    Parameters
    ----------
    pose : (n, 6) array
        X Y Z mm, W P R degrees, rounded to 3 decimals.
    configuration : sequence of str
        CONFIG of each position.
    user_frame, tool_frame : int
        Numbers of the frames.

    Returns
    -------
    str
        Records P[1], P[2] and on.
    """
    return _records(_POSE_RECORD, user_frame, tool_frame, [configuration], pose)


def _records(
    template: str, user_frame: int, tool_frame: int, words: Sequence[Sequence[str]], values: Array
) -> str:
    """Positions 1.. by their template: its fields are the number, columns (n,) of words, and values (n, k)."""
    record = template.replace("<frame>", f"UF : {user_frame}, UT : {tool_frame},")
    texts = [[right_aligned(value, 3, 10) for value in row] for row in values.tolist()]
    return "".join(
        record % (number, *row_words, *row)
        for number, (row, *row_words) in enumerate(zip(texts, *words, strict=True), 1)
    )


def right_aligned(value: float, decimals: int, width: int) -> str:
    """Format a number as the controller lists it.

    No 0 before the point, except for 0 itself: .250, -.250, 0.000. -0.0 keeps its sign: -.000.

    Parameters
    ----------
    value : float
        The number.
    decimals : int
        Number of decimals.
    width : int
        Smallest number of characters.

    Returns
    -------
    str
        The text.
    """
    text = f"{value:.{decimals}f}"
    if float(text) != 0.0 or text.startswith("-"):
        text = re.sub(r"^(-?)0\.", r"\1.", text)
    return text.rjust(width)
