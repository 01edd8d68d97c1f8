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


def merged(segments: Sequence[Piece], label: str) -> list[Piece]:
    """One segment for all segments that share a meridian, over their joint turn.

    Raises InputError 'NOT_REVOLUTION' where they leave more than one opening around the axis.
    """
    groups: list[list[Piece]] = []
    ends = np.array([segment.points[[0, -1]] for segment in segments]).reshape(-1, 2, 2)
    firsts: list[int] = []
    for number, segment in enumerate(segments):
        first_ends = ends[firsts]
        end_gaps = [
            np.abs(first_ends - end_order).max(axis=(1, 2), initial=0.0)
            for end_order in (ends[number], ends[number, ::-1])
        ]
        for k in np.flatnonzero(np.minimum(*end_gaps) <= MERIDIAN_MM).tolist():
            if _same_meridian(groups[k][0], segment):
                groups[k].append(segment)
                break
        else:
            groups.append([segment])
            firsts.append(number)
    return [
        replace(group[0], turn=_union([segment.turn for segment in group], group, label))
        for group in groups
    ]


def _same_meridian(segment: Piece, other_segment: Piece) -> bool:
    """Whether segments with the same ends also coincide between them."""
    middle = other_segment.points[len(other_segment.points) // 2]
    start, steps = segment.points[:-1], np.diff(segment.points, axis=0)
    share = np.clip(
        ((middle - start) * steps).sum(1) / np.maximum((steps * steps).sum(1), 1e-30), 0.0, 1.0
    )
    return bool(np.linalg.norm(middle - start - share[:, None] * steps, axis=1).min() < MERIDIAN_MM)


def _union(turns: Sequence[Turn | None], group: Sequence[Piece], label: str) -> Turn | None:
    if any(turn is None for turn in turns):
        return None
    sorted_turns = sorted(
        (turn[0] % (2.0 * np.pi), turn[1] - turn[0]) for turn in turns if turn is not None
    )
    joined: list[Turn] = []
    for start, span in [
        *sorted_turns,
        *((start + 2.0 * np.pi, span) for start, span in sorted_turns),
    ]:
        if joined and start <= joined[-1][1] + SAME_AZIMUTH:
            joined[-1] = joined[-1][0], max(joined[-1][1], start + span)
        else:
            joined.append((start, start + span))
    if any(end - start >= 2.0 * np.pi - SAME_AZIMUTH for start, end in joined):
        return None
    # each range is listed twice, a turn apart, so that every joined range appears whole at least
    # once
    distinct = {round((start % (2.0 * np.pi)) / SAME_AZIMUTH) for start, _ in joined[1:]}
    if len(distinct) > 1:
        names = ", ".join(segment.name for segment in group)
        text = Text("{} leave more than one opening around the axis; choose one face", names)
        raise InputError("NOT_REVOLUTION", label, text)
    start, end = max(joined, key=lambda turn: turn[1] - turn[0])
    start_in_turn = start % (2.0 * np.pi)
    return start_in_turn, start_in_turn + end - start


def common_turn(chain: Chain, label: str) -> Turn | None:
    """The turn (start, end) rad that all pieces of a wall make, None for a full one.

    Raises InputError 'NOT_REVOLUTION' naming the faces that turn differently.
    """
    first_segment = chain[0]
    for segment in chain[1:]:
        same = (segment.turn is None) == (first_segment.turn is None)
        if same and segment.turn is not None and first_segment.turn is not None:
            off = abs(np.angle(np.exp(1j * (segment.turn[0] - first_segment.turn[0]))))
            same = (
                max(
                    off,
                    abs(
                        (segment.turn[1] - segment.turn[0])
                        - (first_segment.turn[1] - first_segment.turn[0])
                    ),
                )
                < 1e-3
            )
        if not same:
            raise InputError(
                "NOT_REVOLUTION",
                label,
                "{} covers {} and {} {}; choose faces with the same angular range",
                first_segment.name,
                _degrees(first_segment.turn),
                segment.name,
                _degrees(segment.turn),
            )
    return first_segment.turn


def _degrees(turn: Turn | None) -> str:
    return (
        "all around"
        if turn is None
        else Text("from {:.4g} to {:.4g} deg", np.degrees(turn[0]), np.degrees(turn[1]))
    )
