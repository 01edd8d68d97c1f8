# SPDX-License-Identifier: LGPL-2.1-or-later
"""Faces that share a meridian put together around the axis, such as the two halves of a cylinder."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

import numpy as np

from ...core.geometry.curves.contour import Chain, Piece
from ...core.issues import InputError, Text

MERIDIAN_MM = 1e-3  # mm between meridians that are one
SAME_AZIMUTH = 1e-4  # rad

Turn = tuple[float, float]


def merged(pieces: Sequence[Piece], label: str) -> list[Piece]:
    """One piece for all that share a meridian, turned as far as they reach together.

    Raises InputError 'NOT_REVOLUTION' where they leave more than one opening around the axis.
    """
    groups: list[list[Piece]] = []
    ends = np.array([piece.points[[0, -1]] for piece in pieces]).reshape(-1, 2, 2)
    firsts: list[int] = []
    for number, piece in enumerate(pieces):
        known = ends[firsts]
        apart = [
            np.abs(known - way).max(axis=(1, 2), initial=0.0)
            for way in (ends[number], ends[number, ::-1])
        ]
        for k in np.flatnonzero(np.minimum(*apart) <= MERIDIAN_MM).tolist():
            if _same_meridian(groups[k][0], piece):
                groups[k].append(piece)
                break
        else:
            groups.append([piece])
            firsts.append(number)
    return [
        replace(group[0], turn=_union([piece.turn for piece in group], group, label))
        for group in groups
    ]


def _same_meridian(one: Piece, other: Piece) -> bool:
    """Whether pieces with the same ends are one on the way, too."""
    middle = other.points[len(other.points) // 2]
    start, steps = one.points[:-1], np.diff(one.points, axis=0)
    share = np.clip(
        ((middle - start) * steps).sum(1) / np.maximum((steps * steps).sum(1), 1e-30), 0.0, 1.0
    )
    return bool(np.linalg.norm(middle - start - share[:, None] * steps, axis=1).min() < MERIDIAN_MM)


def _union(turns: Sequence[Turn | None], group: Sequence[Piece], label: str) -> Turn | None:
    if any(turn is None for turn in turns):
        return None
    known = sorted(
        (turn[0] % (2.0 * np.pi), turn[1] - turn[0]) for turn in turns if turn is not None
    )
    joined: list[Turn] = []
    for start, span in [*known, *((start + 2.0 * np.pi, span) for start, span in known)]:
        if joined and start <= joined[-1][1] + SAME_AZIMUTH:
            joined[-1] = joined[-1][0], max(joined[-1][1], start + span)
        else:
            joined.append((start, start + span))
    if any(end - start >= 2.0 * np.pi - SAME_AZIMUTH for start, end in joined):
        return None
    # everything was laid down twice, a turn apart: what is one stretch shows up whole once at least
    distinct = {round((start % (2.0 * np.pi)) / SAME_AZIMUTH) for start, _ in joined[1:]}
    if len(distinct) > 1:
        names = ", ".join(piece.name for piece in group)
        text = Text("{} leave more than one opening around the axis; choose one of them", names)
        raise InputError("NOT_REVOLUTION", label, text)
    start, end = max(joined, key=lambda turn: turn[1] - turn[0])
    start_in_turn = start % (2.0 * np.pi)
    return start_in_turn, start_in_turn + end - start


def common_turn(chain: Chain, label: str) -> Turn | None:
    """The turn (start, end) rad that all pieces of a wall make, None for a full one.

    Raises InputError 'NOT_REVOLUTION' naming the faces that turn differently.
    """
    first = chain[0]
    for piece in chain[1:]:
        same = (piece.turn is None) == (first.turn is None)
        if same and piece.turn is not None and first.turn is not None:
            off = abs(np.angle(np.exp(1j * (piece.turn[0] - first.turn[0]))))
            same = (
                max(off, abs((piece.turn[1] - piece.turn[0]) - (first.turn[1] - first.turn[0])))
                < 1e-3
            )
        if not same:
            raise InputError(
                "NOT_REVOLUTION",
                label,
                "{} turns {} and {} {}; choose faces that turn alike",
                first.name,
                _degrees(first.turn),
                piece.name,
                _degrees(piece.turn),
            )
    return first.turn


def _degrees(turn: Turn | None) -> str:
    return (
        "all around"
        if turn is None
        else Text("from {:.4g} to {:.4g} deg", np.degrees(turn[0]), np.degrees(turn[1]))
    )
