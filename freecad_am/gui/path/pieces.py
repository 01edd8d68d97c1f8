# SPDX-License-Identifier: LGPL-2.1-or-later
"""Coin nodes of a path that can show any stretch quickly.

A path is split into pieces of a few thousand points. Pieces are built when first visible, and then
switched on and off. The piece at the end of a stretch only changes its number of primitives. The
rows before the first piece of a stretch are rebuilt when the start changes.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from functools import cached_property
from typing import Any

import numpy as np
from pivy import coin

from ...core.geometry import tubes
from ...core.toolpath import Bead
from ...core.types import Array, Index
from ..nodes.lines import fill, unshaded

# maximum number of tube sections, and limits for 6 and 8 sides: software rendering draws these
# without stutter
SECTIONS, FINE, FINER = 50_000, 30_000, 12_000
PIECE = 4096  # approximate number of rows in a piece


@dataclass(frozen=True, eq=False)
class Rows:
    """n points (n, 3), mm, of m beads in order.

    starts: (m + 1,) first row of each bead, and n. layers: (m,) layer of each bead, ascending.
    width: (n,) mm. read: returns the beads; called when more than lines is needed. layer_height:
    returns the height, mm, of beads without a height; called for tubes. read_bead: returns a single
    bead, if that is fast.
    """

    points: Array
    starts: Index
    layers: Index
    width: Array
    read: Callable[[], Sequence[Bead]]
    layer_height: Callable[[], float]
    read_bead: Callable[[int], Bead] | None = None

    @classmethod
    def of(
        cls,
        beads: Sequence[Bead],
        layers: Sequence[int],
        width: float,
        layer_height: Callable[[], float],
    ) -> Rows:
        """Collect the rows of beads; `width` (mm) applies to beads without a width."""
        points = np.concatenate([*(bead.points for bead in beads), np.zeros((0, 3))])
        starts = np.concatenate([[0], np.cumsum([len(bead) for bead in beads], dtype=np.intp)])
        columns = [
            np.full(len(bead), width) if bead.width is None else bead.width for bead in beads
        ]
        return cls(
            points,
            starts,
            np.array(layers, dtype=np.intp),
            np.concatenate([*columns, np.zeros(0)]),
            lambda: beads,
            layer_height,
        )

    def __len__(self) -> int:
        return len(self.width)

    @cached_property
    def beads(self) -> tuple[Bead, ...]:
        """The m beads."""
        return tuple(self.read())

    def bead(self, index: int) -> Bead:
        """Return a bead. The first request reads a single bead; a second request reads all beads."""
        if self.read_bead is None or "beads" in vars(self):
            return self.beads[index]
        alone = self._bead_cache
        if not alone:
            alone[index] = self.read_bead(index)
        return alone[index] if index in alone else self.beads[index]

    @cached_property
    def _bead_cache(self) -> dict[int, Bead]:
        return {}

    @cached_property
    def build(self) -> Array:
        """(n, 3) build directions."""
        return np.concatenate([*(bead.build for bead in self.beads), np.zeros((0, 3))])

    @property
    def layer_count(self) -> int:
        """Number of layers, including layers without beads."""
        return int(self.layers[-1]) + 1 if len(self.layers) else 0

    def layer_rows(self, from_layer: int, to_layer: int) -> tuple[int, int]:
        """Return the first row of a layer, and the row after the last row of another layer."""
        low, high = np.searchsorted(self.layers, [from_layer, to_layer + 1])
        return int(self.starts[low]), int(self.starts[high])

    def bead_of(self, row: int) -> int:
        """Return the bead of a row."""
        return min(int(np.searchsorted(self.starts, row, side="right")) - 1, len(self.layers) - 1)

    def counts(self, start: int, end: int) -> Index:
        """Return the number of rows of each bead from `start` to before `end`."""
        low, high = np.searchsorted(self.starts, [start, end], side="right")
        return np.diff(np.unique(np.concatenate([[start], self.starts[low:high], [end]])))

    @cached_property
    def cuts(self) -> Index:
        """Rows at which the path is split into pieces: at bead starts, and within long beads."""
        cuts = [0]
        for start, end in zip(self.starts, self.starts[1:], strict=False):
            if end - cuts[-1] > PIECE and start > cuts[-1]:
                cuts.append(int(start))
            cuts.extend(range(cuts[-1] + PIECE, int(end) - PIECE // 2, PIECE))
        return np.array([*cuts, len(self)] if len(self) > cuts[-1] else cuts, dtype=np.intp)

    # ---- tubes

    @cached_property
    def height(self) -> Array:
        """(n,) mm; the predicted height, or the layer height."""
        height = self.layer_height()
        columns = [
            np.full(len(bead), height) if bead.height is None else bead.height
            for bead in self.beads
        ]
        return np.concatenate([*columns, np.zeros(0)])

    @cached_property
    def frames(self) -> tubes.Frames:
        """Cross-section frames at each point."""
        closed = np.array([bead.closed for bead in self.beads], dtype=bool)
        return tubes.frames(self.points, self.build, self.starts, closed)

    @cached_property
    def sections(self) -> Index:
        """Rows with a tube section."""
        return np.flatnonzero(
            tubes.select_sections(self.frames.turn, self.starts, -(-len(self) // SECTIONS))
        )

    @property
    def sides(self) -> int:
        """Number of sides of the tubes; fewer for long paths."""
        count = len(self.sections)
        return 8 if count <= FINER else 6 if count <= FINE else 4

    def tube(self, start: int, end: int) -> tuple[tubes.Mesh, Index]:
        """Return the tubes from row `start` to before `end`, and the row of each tube section."""
        low, high = np.searchsorted(self.sections, [start, end])
        rows = np.unique(np.concatenate([[start], self.sections[low:high], [end - 1]]))
        bead = np.searchsorted(self.starts, rows, side="right")
        ends = np.append(np.diff(bead) > 0, True)
        across = tubes.Frames(*(column[rows] for column in self.frames))
        return tubes.mesh(
            self.points[rows], across, self.width[rows], self.height[rows], ends, self.sides
        ), rows


BLOCK = (
    128  # sections by which a piece of tubes grows; Coin reads the whole piece again at each step
)
_SHININESS = 0.2
# as text, which Coin parses in a fifth of the time that pivy takes to find a field; pieces are many
ALL, BY_VERTEX = f"whichChild {coin.SO_SWITCH_ALL}", "materialBinding PER_VERTEX"


@dataclass(frozen=True)
class Piece:
    """The node of a stretch of rows.

    cut: draws the rows before a row, and returns the row from which the rest must be drawn
    separately (the row itself if all rows are drawn).
    """

    node: Any
    cut: Callable[[int], int]


Make = Callable[[int, int], Piece]


class Look:
    """A way to draw a path; `style` are the nodes before its pieces."""

    def __init__(self, *style: Any) -> None:
        self.node, self.pieces, self.ends = coin.SoSwitch(), coin.SoSeparator(), coin.SoSeparator()
        group = coin.SoSeparator()
        for child in (*style, self.pieces, self.ends):
            group.addChild(child)
        self.node.addChild(group)
        self.node.whichChild = coin.SO_SWITCH_NONE
        self.seen = False
        self.make: Make | None = None
        self.joined: Callable[[int], int] = lambda row: row
        self.forget(np.zeros(1, dtype=np.intp))

    def forget(self, cuts: Index) -> None:
        """Reset to pieces between these rows, not yet built."""
        self.cuts = cuts
        self.made: dict[int, Piece] = {}
        self.drawn: dict[
            int, tuple[int, int]
        ] = {}  # pieces switched on: the last row, and the row from which the rest is drawn separately
        self.before: tuple[tuple[int, int] | None, Any] = (
            None,
            None,
        )  # the stretch before the first piece, and its node
        self.pieces.removeAllChildren()
        self.ends.removeAllChildren()

    def reset(self, cuts: Index, make: Make, joined: Callable[[int], int]) -> None:
        """Draw another path: split it at `cuts`, and build nodes with `make`.

        `joined` returns the row after the last row that a piece draws.
        """
        self.forget(cuts)
        self.make, self.joined = make, joined
        for _ in range(len(cuts) - 1):
            self.pieces.addChild(coin.SoSwitch())  # shows none of its children by default

    def hide(self) -> None:
        """Draw nothing."""
        self._switch(False)

    def _switch(self, on: bool) -> None:
        if on != self.seen:  # Coin treats setting an equal value as a change
            self.seen = on
            self.node.whichChild = coin.SO_SWITCH_ALL if on else coin.SO_SWITCH_NONE

    def show(self, start: int, end: int) -> None:
        """Draw the rows from `start` to before `end`."""
        self._switch(True)
        indices = np.flatnonzero((self.cuts[:-1] >= start) & (self.cuts[:-1] < end))
        targets = {
            int(index): min(self.joined(int(self.cuts[index + 1])), end) for index in indices
        }
        for index in self.drawn.keys() - targets.keys():
            self.pieces.getChild(index).whichChild = coin.SO_SWITCH_NONE
        self.drawn = {index: self._draw_piece(index, row) for index, row in targets.items()}
        self.ends.removeAllChildren()
        until = self.joined(int(self.cuts[indices[0]])) if len(indices) else end
        if self.before[0] != (start, until):
            self.before = (start, until), self._stretch(start, until)
        rest_start = self.drawn[int(indices[-1])][1] if len(indices) else end
        for node in (self.before[1], self._stretch(rest_start, end)):
            if node is not None:
                self.ends.addChild(node)

    def _draw_piece(self, index: int, row: int) -> tuple[int, int]:
        """Switch a piece on and draw it up to a row. Return the row, and the row from which the
        rest must be drawn separately.
        """
        if self.drawn.get(index, (None,))[0] == row:
            return self.drawn[index]
        switch, end = self.pieces.getChild(index), self.joined(int(self.cuts[index + 1]))
        new = index not in self.made
        if new:
            assert self.make is not None
            self.made[index] = self.make(int(self.cuts[index]), end)
            switch.addChild(self.made[index].node)
        switch.set(ALL)
        return row, row if new and row == end else self.made[index].cut(
            row
        )  # a new piece draws all rows

    def _stretch(self, start: int, end: int) -> Any:
        assert self.make is not None
        return self.make(start, end).node if end - start > 1 else None


class PathNodes:
    """A path as lines or as tubes, and its build directions."""

    def __init__(self) -> None:
        self.style, directions_style, directions_colour = (
            coin.SoDrawStyle(),
            coin.SoDrawStyle(),
            coin.SoMaterial(),
        )
        directions_style.lineWidth = 1.0
        directions_colour.diffuseColor.setValue(0.86, 0.2, 0.55)
        material, hints = coin.SoMaterial(), coin.SoShapeHints()
        material.specularColor.setValue(0.2, 0.2, 0.2)
        material.shininess = _SHININESS
        hints.vertexOrdering, hints.shapeType = (
            coin.SoShapeHints.COUNTERCLOCKWISE,
            coin.SoShapeHints.SOLID,
        )
        self.lines = Look(unshaded(), self.style)
        self.tubes = Look(material, hints)
        self.directions = Look(unshaded(), directions_style, directions_colour)
        self.node = coin.SoSeparator()
        for look in (self.lines, self.tubes, self.directions):
            self.node.addChild(look.node)
        self.rows = Rows.of((), (), 1.0, lambda: 1.0)
        self.colours = np.zeros(0, dtype=np.uint32)
        self.first = self.end = 0
        self.as_tubes = self.painted = False
        self.drawn_directions: tuple[int, float] | None = None

    def set(self, rows: Rows) -> None:
        """Set another path, shown completely once painted."""
        self.rows, self.first, self.end, self.painted = rows, 0, len(rows), False
        self.points = rows.points.astype(np.float32)
        if self.drawn_directions is not None:
            self.draw_directions(*self.drawn_directions)

    def paint(self, colours: Array) -> None:
        """Colour the points with colours (n, 3) in 0..1."""
        channels = np.rint(255.0 * colours).astype(np.uint32)
        self.colours = channels[:, 0] << 24 | channels[:, 1] << 16 | channels[:, 2] << 8 | 255
        self.lines.reset(self.rows.cuts, self._lines, self._join)
        self.tubes.reset(self.rows.cuts, self._tubes, self._join)
        self.painted = True
        self.show(self.first, self.end)

    def show(self, start: int, end: int) -> None:
        """Show the rows from `start` to before `end`."""
        self.first, self.end = start, end
        if not self.painted:
            return
        visible, hidden = (self.tubes, self.lines) if self.as_tubes else (self.lines, self.tubes)
        hidden.hide()
        visible.show(start, end)
        if self.drawn_directions is not None:
            self.directions.show(start, end)

    def look(self, as_tubes: bool) -> None:
        """Switch between tubes and lines."""
        if as_tubes != self.as_tubes:
            self.as_tubes = as_tubes
            self.show(self.first, self.end)
            if self.drawn_directions is not None:
                self.draw_directions(*self.drawn_directions)

    def draw_directions(self, step: int, length: float) -> None:
        """Show the build direction of every `step`-th point as a line of this length, mm."""
        self.drawn_directions = (step, length)
        foot = (
            self.rows.points
            + (self.rows.height[:, None] if self.as_tubes else 0.0) * self.rows.build
        )  # on top of a tube
        tips, feet = (foot + length * self.rows.build).astype(np.float32), foot.astype(np.float32)

        def make(start: int, end: int) -> Piece:
            rows = np.arange(-(-start // step) * step, end, step)
            ends = np.stack([feet[rows], tips[rows]], axis=1).reshape(-1, 3)
            return _line_set(ends, lambda row: np.full(int((rows < row).sum()), 2), end)

        self.directions.reset(self.rows.cuts, make, lambda row: row)
        self.show(self.first, self.end)

    def hide_directions(self) -> None:
        """Hide the build directions."""
        self.drawn_directions = None
        self.directions.hide()

    def _join(self, row: int) -> int:
        """Extend a piece that ends within a bead to the first point of the next piece."""
        within = 0 < row < len(self.rows) and row not in self.rows.starts[[self.rows.bead_of(row)]]
        return row + 1 if within else row

    def _lines(self, start: int, end: int) -> Piece:
        return _line_set(
            self.points[start:end],
            lambda row: self.rows.counts(start, row),
            end,
            self.colours[start:end],
        )

    def _tubes(self, begin: int, end: int) -> Piece:
        mesh, rows = self.rows.tube(begin, end)
        # sort the triangles by their last section, so that a prefix of the triangles is a part of
        # the tubes
        section = mesh.triangles.max(axis=1) // self.rows.sides
        corners = np.full((len(section), 4), -1, dtype=np.int32)
        corners[:, :3] = mesh.triangles[np.argsort(section, kind="stable")]
        count = np.concatenate([[0], np.cumsum(np.bincount(section, minlength=len(rows)))])
        values, shape = coin.SoVertexProperty(), coin.SoIndexedFaceSet()
        fill(values.vertex, mesh.points)
        fill(values.normal, mesh.normals)
        fill(values.orderedRGBA, np.repeat(self.colours[rows], self.rows.sides))
        values.normalBinding = coin.SoVertexProperty.PER_VERTEX_INDEXED
        values.materialBinding = coin.SoVertexProperty.PER_VERTEX_INDEXED
        shape.vertexProperty = values

        filled = 0

        def cut(row: int) -> int:
            nonlocal filled
            sections = (
                len(rows) if row >= end else BLOCK * (int(np.searchsorted(rows, row)) // BLOCK)
            )
            if sections != filled:
                fill(shape.coordIndex, corners[: count[sections]].ravel())
                filled = sections
            if row >= end:
                return row
            # the rows up to `row`, but at least the last segment, which has the end face
            start = int(self.rows.starts[self.rows.bead_of(row - 1)])
            return min(int(rows[max(sections - 1, 0)]), max(start, begin, row - 2))

        cut(end)
        return Piece(_separate(shape), cut)


def _line_set(points: Any, counts: Callable[[int], Any], end: int, colours: Any = None) -> Piece:
    """Build polylines of points; `counts` returns the number of points per line before a row."""
    values, shape = coin.SoVertexProperty(), coin.SoLineSet()
    fill(values.vertex, points)
    if colours is not None:
        fill(values.orderedRGBA, colours)
        values.set(BY_VERTEX)
    shape.vertexProperty = values

    def cut(row: int) -> int:
        fill(shape.numVertices, counts(row))
        return row

    cut(end)
    return Piece(_separate(shape), cut)


def _separate(shape: Any) -> Any:
    """Wrap a shape in its own node, which Coin may cache and cull."""
    node = coin.SoSeparator()
    node.addChild(shape)
    return node
