# SPDX-License-Identifier: LGPL-2.1-or-later
"""The text of the files of a VAL 3 application: project (.pjx), data (.dtx) and programs (.pgx), UTF-8 with BOM."""

from __future__ import annotations

import textwrap
import unicodedata
from collections.abc import Iterable, Sequence

from ...core.types import Array
from .numbers import ANGLE_DECIMALS, LENGTH_DECIMALS

_HEAD = '<?xml version="1.0" encoding="utf-8"?>\n'
_XSI = 'xmlns:xsi="http://www.w3.org/2001/XMLSchema-instance"'
_PROJECT = """\
<Project xmlns="http://www.staubli.com/robotics/VAL3/Project/3">
  <Parameters version="s7.7.2" stackSize="5000" millimeterUnit="true" />
  <Programs>
{programs}  </Programs>
  <Database>
    <Data file="{name}.dtx" />
  </Database>
  <Libraries>
{libraries}  </Libraries>
</Project>
"""
_DATA = f"""\
<Database {_XSI} xmlns="http://www.staubli.com/robotics/VAL3/Data/2">
  <Datas>
{{data}}  </Datas>
</Database>
"""
_PROGRAM = f"""\
<Programs {_XSI} xmlns="http://www.staubli.com/robotics/VAL3/Program/2">
  <Program name="{{name}}" access="public">
{{locals}}    <Code><![CDATA[begin
{{code}}end]]></Code>
  </Program>
</Programs>
"""
_LOCALS = """\
    <Locals>
      <Local name="l_nI" type="num" xsi:type="array" size="1" />
    </Locals>
"""

_JOINTS = " ".join(f'j{axis}="%.{ANGLE_DECIMALS}f"' for axis in range(1, 7))
_FRAME = " ".join(
    [f'{axis}="%.{LENGTH_DECIMALS}f"' for axis in ("x", "y", "z")]
    + [f'{axis}="%.{ANGLE_DECIMALS}f"' for axis in ("rx", "ry", "rz")]
)


def project(name: str, programs: Sequence[str], libraries: dict[str, str]) -> bytes:
    """Return the project of an application.

    Parameters
    ----------
    name : str
        Name of the application.
    programs : sequence of str
        Names of its programs.
    libraries : dict[str, str]
        Path of each library by alias.

    Returns
    -------
    bytes
        The content of the file.
    """
    files = "".join(f'    <Program file="{program}.pgx" />\n' for program in programs)
    library_files = "".join(
        f'    <Library alias="{alias}" path="{path}" />\n' for alias, path in libraries.items()
    )
    return _file(_PROJECT.format(programs=files, name=name, libraries=library_files))


def database(arrays: dict[str, tuple[str, list[str]]]) -> bytes:
    """The data of an application: type and the attributes of each value, by name."""
    return _file(
        _DATA.format(data="".join(_data_element(name, *arrays[name]) for name in sorted(arrays)))
    )


def _data_element(name: str, kind: str, values: list[str]) -> str:
    head = f'    <Data name="{name}" access="private" xsi:type="array" type="{kind}" size="{len(values)}">\n'
    return (
        head
        + "".join(f'      <Value key="{key}" {value} />\n' for key, value in enumerate(values))
        + "    </Data>\n"
    )


def code(name: str, lines: Iterable[str]) -> bytes:
    """A program with the given lines."""
    lines = [f"  {line}\n" for line in lines]
    variables = _LOCALS if any("l_nI" in line for line in lines) else ""
    return _file(_PROGRAM.format(name=name, locals=variables, code="".join(lines)))


def _file(body: str) -> bytes:
    return (_HEAD + body).encode("utf-8-sig")


def joints(values: Array) -> list[str]:
    """Return the attributes of joint values.

    Parameters
    ----------
    values : (n, 6) array
        Joint values, degrees.

    Returns
    -------
    list of str
        n texts.
    """
    return _rows(_JOINTS, values)


def frames(values: Array, attributes: str) -> list[str]:
    """Return the attributes of points, frames or tools.

    Parameters
    ----------
    values : (n, 6) array
        Coordinates, mm, and angles, degrees.
    attributes : str
        Further attributes to add to each.

    Returns
    -------
    list of str
        n texts.
    """
    return _rows(f"{_FRAME} {attributes}", values)


def _rows(template: str, values: Array) -> list[str]:
    return [template % row for row in zip(*values.T.tolist())]


def remark(text: str) -> list[str]:
    """A comment on as many lines as it needs, in plain characters."""
    decomposed = unicodedata.normalize("NFKD", text.replace("ß", "ss"))
    plain = decomposed.encode("ascii", "ignore").decode("ascii").replace("]]>", "")
    return [f"// {line}" for line in textwrap.wrap(plain, 80)]


def delay(seconds: float) -> list[str]:
    """Standing still for a time, to 0.001 s; nothing for no time."""
    return [f"delay({max(seconds, 0.001):.3f})"] if seconds > 0.0 else []
