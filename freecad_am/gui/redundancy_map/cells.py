# SPDX-License-Identifier: LGPL-2.1-or-later
"""Compute the cells of a map in the background and show them: first without the robot's links, then
with a coarse link check, then with every row checked."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

from ..background.worker import Background, Worker
from .drawn.board import Board
from .drawn.painting import Canvas, painted

ROUGH_STRIDE, FINE_STRIDE = 6, 1  # row stride of the link checks


class Cells:
    """`known` is called when more is known of a board, `drawn` when its cells are shown."""

    def __init__(
        self, form: Any, canvas: Canvas, on_known: Callable[[], None], drawn: Callable[[], None]
    ) -> None:
        self.canvas, self.known, self.drawn = canvas, on_known, drawn
        self.background = Background(form)

    def cancel(self) -> None:
        """Cancel the computation."""
        self.background.cancel()

    def show(self, board: Board, branch: int, kind: str) -> None:
        """Show a branch by margin or condition; its cells are computed first where they are not known."""
        self.board, self.branch, self.kind = board, branch, kind
        if branch in board.pictures:
            self._draw()
            self._go_on()
            return
        self.canvas.set_map(None, board.marks, board.labels)

        def take(worker: Worker) -> None:
            board.take(worker.result())
            self.known()
            self._draw()
            self._go_on()

        self.background.start(lambda: board.compute(branch), take)

    def _go_on(self) -> None:
        """Check the robot's links until every row is checked."""
        board, branch = self.board, self.branch
        previous = board.looked.get(branch)
        if previous == FINE_STRIDE:
            self.background.cancel()
            return
        stride = ROUGH_STRIDE if previous is None else FINE_STRIDE

        def take(worker: Worker) -> None:
            board.take_arm(branch, worker.result(), stride)
            self._draw()
            self._go_on()

        self.background.start(lambda: board.arm(branch, stride), take)

    def _draw(self) -> None:
        board = self.board
        self.canvas.title = board.title
        self.canvas.heights = (
            None if board.pair is None else (board.pair.labels, board.pair.planned)
        )
        self.canvas.set_map(
            painted(board.pictures[self.branch], self.kind), board.marks, board.labels
        )
        self.drawn()
