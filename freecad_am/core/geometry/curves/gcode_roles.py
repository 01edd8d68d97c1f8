# SPDX-License-Identifier: LGPL-2.1-or-later
"""Roles of moves in slicer comments: part, skirt, brim, support, tower and similar.

PrusaSlicer, SuperSlicer, Orca, Cura and ideaMaker write `;TYPE:name`, Bambu Studio `;
FEATURE: name`, Simplify3D `; feature name` (before 4.0 only the name), FlashPrint
`;structure:name`, CraftWare `;segType:name`, KISSlicer `; 'name Path'`.
"""

from __future__ import annotations

import re
from collections.abc import Sequence
from typing import Protocol, TypeVar

from ...issues import NOTE, InputError, Issue, Text

PART, ALL = "part", "all"
LEFT_OUT, NOT_READ = "ROLES_LEFT_OUT", "GCODE_NOT_READ"
BEFORE = "before the first type"  # role of moves before the first type comment
_MARK = re.compile(
    r"\s*(?:(?:TYPE|FEATURE|structure|segType)\s*:\s*(?P<name>.*?)|feature\s+(?P<feature>[a-z][a-z /-]*?)"
    r"|'(?P<path>[^']+?)(?:\s+Path)?'.*)\s*$",
    re.IGNORECASE,
)
# comments that consist of a name: Simplify3D before 4.0, Slic3r with comments enabled
_NAMES = frozenset(
    {
        "outer perimeter",
        "inner perimeter",
        "external perimeter",
        "perimeter",
        "infill",
        "solid layer",
        "skirt",
        "brim",
    }
    | {
        "raft",
        "support",
        "dense support",
        "prime pillar",
        "ooze shield",
        "gap fill",
        "bridge",
        "support material",
    }
    | {"internal single extrusion", "external single extrusion", "support material interface"}
)
# groups for strategy.roles, with words in the type names; the first match counts
GROUPS = (
    ("support", ("support", "interface")),
    ("tower", ("tower", "pillar", "ooze", "wipe", "prime", "shield")),
    (
        "purge",
        ("custom", "purge", "flush", "pre-extrude", "preextrude", "preheat", "pre extrude", BEFORE),
    ),
    ("skirt", ("skirt",)),
    ("brim", ("brim",)),
    ("raft", ("raft",)),
    ("ironing", ("ironing",)),
    ("milling", ("mill",)),
    ("bridge", ("bridge",)),
    ("wall", ("wall", "perimeter", "shell", "single extrusion", "loop", "overhang")),
    (
        "infill",
        ("infill", "fill", "sparse", "gap", "solid", "skin", "surface", "crown", "top", "bottom"),
    ),
)
NOT_PART = ("support", "tower", "purge", "skirt", "brim", "raft", "ironing", "milling")


class Run(Protocol):
    """A run of deposit moves.

    role: the slicer's type, None in a file without types. length: mm.
    """

    @property
    def role(self) -> str | None: ...

    @property
    def length(self) -> float: ...


AnyRun = TypeVar("AnyRun", bound=Run)


def read_role(comment: str) -> str | None:
    """Return the type name in a comment; None if the comment names no type."""
    match = _MARK.match(comment)
    if match is None:
        name = comment.strip().lower()
        return name if name in _NAMES else None
    return (match["name"] or match["feature"] or match["path"] or "").strip() or None


def group_of(role: str) -> str:
    """Return the group of a type; '' for an unknown type."""
    name = re.sub(r"[_\s]+", " ", role.lower())
    return next((group for group, words in GROUPS if any(word in name for word in words)), "")


def split_entries(text: str) -> tuple[str, ...]:
    """Split the text of strategy.roles into entries."""
    return tuple(word.strip() for word in re.split(r"[,;]", text) if word.strip())


def is_deposited(role: str | None, entries: Sequence[str]) -> bool:
    """Return whether moves of a type are deposited.

    role: type name; None in a file without types.
    """
    if role is None or entries == (ALL,):
        return True
    group = group_of(role)
    names = {_plain(entry) for entry in entries}
    return (PART in names and group not in NOT_PART) or bool(names & {group, _plain(role)})


def unknown_entries(entries: Sequence[str], roles: Sequence[str]) -> list[str]:
    """Return the entries that are neither groups nor types of the file."""
    names = {PART, ALL, *(group for group, _ in GROUPS), *map(_plain, roles)}
    return [entry for entry in entries if _plain(entry) not in names]


def _plain(name: str) -> str:
    return re.sub(r"[\s_-]+", " ", name.strip().lower())


def choose_runs(
    runs: Sequence[AnyRun], roles: str, where: str, code: str
) -> tuple[list[AnyRun], list[Issue]]:
    """Select the runs with given roles, and report omitted and unknown roles.

    Parameters
    ----------
    runs
        All runs of a file.
    roles
        Text of strategy.roles.
    where
        Name of the file, for messages.
    code
        Code of the error if no run remains.

    Raises
    ------
    InputError
        BAD_VALUE for roles that are neither groups nor types of the file; `code` if nothing
        remains.
    """
    entries = split_entries(roles)
    names = list(dict.fromkeys(run.role for run in runs if run.role is not None))
    unknown = unknown_entries(entries, names)
    if unknown:
        raise InputError(
            "BAD_VALUE",
            "strategy.roles",
            "{!r} is neither a group ({}) nor a type of {} ({}); choose a group or a type",
            unknown[0],
            ", ".join((PART, ALL, *(group for group, _ in GROUPS))),
            where,
            ", ".join(names) or "the file names no types",
        )
    deposited = [run for run in runs if is_deposited(run.role, entries)]
    omitted = [run for run in runs if not is_deposited(run.role, entries)]
    lengths = _lengths(omitted)
    if not deposited:
        raise InputError(
            code,
            where,
            "the moves of the file are {}, but strategy.roles is {}, so nothing remains to "
            "deposit; choose other roles",
            lengths,
            roles,
        )
    issues = []
    if omitted:
        message = Text(
            "{}: {} ignored because of strategy.roles = {}; add roles to deposit more",
            where,
            lengths,
            roles,
        )
        issues.append(Issue(NOTE, LEFT_OUT, message))
    strange = [name for name in names if not group_of(name)]
    if strange and PART in entries:
        message = Text(
            "{}: the unknown types {} are deposited as the part; list roles in strategy.roles to "
            "exclude them",
            where,
            ", ".join(strange),
        )
        issues.append(Issue(NOTE, NOT_READ, message))
    return deposited, issues


def _lengths(runs: Sequence[Run]) -> str:
    """List types with their total lengths."""
    lengths: dict[str, float] = {}
    for run in runs:
        lengths[run.role or ""] = lengths.get(run.role or "", 0.0) + run.length
    return Text.joined(
        ", ", (Text("{} {:.5g} mm", role, length) for role, length in lengths.items())
    )
