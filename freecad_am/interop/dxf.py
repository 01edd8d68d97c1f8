# SPDX-License-Identifier: LGPL-2.1-or-later
"""Lines as a DXF file of AutoCAD release 12, which all read: a 3D POLYLINE each, on a layer per layer of the deposit.

FreeCAD's own writer keeps six digits and makes every segment an entity (docs/decisions/0013-dxf-writer.md).
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence

import numpy as np

from .lines import Line

DECIMALS = 6
RAPID = "RAPID"
_RED, _COLOURS = 1, (3, 4, 5, 6, 30, 140)  # AutoCAD's numbers of colours; layers take turns
_POLYLINE_3D, _VERTEX_3D = 8, 32


def text(lines: Sequence[Line]) -> Iterator[str]:
    """The file in pieces; millimetres, part coordinates, line ends as Windows has them."""
    names = {
        _layer(line): _RED if not line.deposit else _COLOURS[line.layer % len(_COLOURS)]
        for line in lines
    }
    points = np.concatenate([line.points for line in lines])
    corners = [
        _point(name, point)
        for name, point in (("$EXTMIN", points.min(axis=0)), ("$EXTMAX", points.max(axis=0)))
    ]
    yield _pairs([(0, "SECTION"), (2, "HEADER"), (9, "$ACADVER"), (1, "AC1009")]) + "".join(corners)
    yield _pairs(
        [(0, "ENDSEC"), (0, "SECTION"), (2, "TABLES"), (0, "TABLE"), (2, "LAYER"), (70, len(names))]
    )
    for name, colour in names.items():
        yield _pairs([(0, "LAYER"), (2, name), (70, 0), (62, colour), (6, "CONTINUOUS")])
    yield _pairs([(0, "ENDTAB"), (0, "ENDSEC"), (0, "SECTION"), (2, "ENTITIES")])
    for line in lines:
        yield _polyline(line)
    yield _pairs([(0, "ENDSEC"), (0, "EOF")])


def _polyline(line: Line) -> str:
    # closed beads end where they begin: FreeCAD 1.0 leaves out the last side of a polyline that says it is closed
    layer = _layer(line)
    head = _pairs(
        [
            (0, "POLYLINE"),
            (8, layer),
            (66, 1),
            (10, "0.0"),
            (20, "0.0"),
            (30, "0.0"),
            (70, _POLYLINE_3D),
        ]
    )
    points = np.round(line.points, DECIMALS) + 0.0
    row = _pairs([(0, "VERTEX"), (8, layer)]) + "".join(
        f"{code:3d}\r\n%.{DECIMALS}f\r\n" for code in (10, 20, 30)
    )
    row += _pairs([(70, _VERTEX_3D)])
    return (
        head
        + "".join(row % tuple(point) for point in points.tolist())
        + _pairs([(0, "SEQEND"), (8, layer)])
    )


def _layer(line: Line) -> str:
    return f"LAYER_{line.layer:03d}" if line.deposit else RAPID


def _point(name: str, point: object) -> str:
    x, y, z = np.asarray(point).tolist()
    return _pairs(
        [(9, name), (10, f"{x:.{DECIMALS}f}"), (20, f"{y:.{DECIMALS}f}"), (30, f"{z:.{DECIMALS}f}")]
    )


def _pairs(pairs: list[tuple[int, object]]) -> str:
    return "".join(f"{code:3d}\r\n{value}\r\n" for code, value in pairs)
