# SPDX-License-Identifier: LGPL-2.1-or-later
"""What a slicer's comments say that moves belong to: the part, or its skirt, brim, support, tower and the like.

PrusaSlicer, SuperSlicer, Orca, Cura and ideaMaker write `;TYPE:name`, Bambu Studio `; FEATURE: name`, Simplify3D
`; feature name` (before 4.0 the name alone), FlashPrint `;structure:name`, CraftWare `;segType:name`, KISSlicer `; 'name Path'`.
"""

from __future__ import annotations

import re
from collections.abc import Sequence
from typing import Protocol, TypeVar

from ...issues import NOTE, InputError, Issue, Text

PART, ALL = "part", "all"
LEFT_OUT, NOT_READ = "ROLES_LEFT_OUT", "GCODE_NOT_READ"
BEFORE = "before the first type"  # moves of a file with types that come before these
_MARK = re.compile(
    r"\s*(?:(?:TYPE|FEATURE|structure|segType)\s*:\s*(?P<name>.*?)|feature\s+(?P<feature>[a-z][a-z /-]*?)"
    r"|'(?P<path>[^']+?)(?:\s+Path)?'.*)\s*$",
    re.IGNORECASE,
)
# comments that are a name alone: Simplify3D before 4.0, Slic3r with its comments on
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
# groups that strategy.roles may name, with the words by which names of types belong to them; the first that fits counts
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
    """A run of moves that deposit, with the slicer's type of it, None in a file without types, and its length in mm."""

    @property
    def role(self) -> str | None: ...

    @property
    def length(self) -> float: ...


AnyRun = TypeVar("AnyRun", bound=Run)


def role_in(comment: str) -> str | None:
    """The name of the type that a comment gives; None of other comments."""
    found = _MARK.match(comment)
    if found is None:
        name = comment.strip().lower()
        return name if name in _NAMES else None
    return (found["name"] or found["feature"] or found["path"] or "").strip() or None


def group_of(role: str) -> str:
    """The group of a type, '' of one that is not known."""
    name = re.sub(r"[_\s]+", " ", role.lower())
    return next((group for group, words in GROUPS if any(word in name for word in words)), "")


def wanted(text: str) -> tuple[str, ...]:
    """The entries of strategy.roles."""
    return tuple(word.strip() for word in re.split(r"[,;]", text) if word.strip())


def is_laid(role: str | None, entries: Sequence[str]) -> bool:
    """Whether moves of a type are deposited; role None: of a file without types."""
    if role is None or entries == (ALL,):
        return True
    group = group_of(role)
    known = {_plain(entry) for entry in entries}
    return (PART in known and group not in NOT_PART) or bool(known & {group, _plain(role)})


def unknown_entries(entries: Sequence[str], roles: Sequence[str]) -> list[str]:
    """Entries that are neither a group nor a type of the file."""
    known = {PART, ALL, *(group for group, _ in GROUPS), *map(_plain, roles)}
    return [entry for entry in entries if _plain(entry) not in known]


def _plain(name: str) -> str:
    return re.sub(r"[\s_-]+", " ", name.strip().lower())


def chosen(
    runs: Sequence[AnyRun], roles: str, where: str, code: str
) -> tuple[list[AnyRun], list[Issue]]:
    """Choose the runs of roles, and say what is left out or not known.

    Parameters
    ----------
    runs
        All runs of a file.
    roles
        The text of strategy.roles.
    where
        The name of the file, for messages.
    code
        Of the error where no run is left.

    Raises
    ------
    InputError
        BAD_VALUE for roles that are neither groups nor types of the file; `code` where nothing is left.
    """
    entries = wanted(roles)
    names = list(dict.fromkeys(run.role for run in runs if run.role is not None))
    unknown = unknown_entries(entries, names)
    if unknown:
        raise InputError(
            "BAD_VALUE",
            "strategy.roles",
            "{!r} is neither a group ({}) nor a type of {} ({}); use one of them",
            unknown[0],
            ", ".join((PART, ALL, *(group for group, _ in GROUPS))),
            where,
            ", ".join(names) or "it has no types",
        )
    laid = [run for run in runs if is_laid(run.role, entries)]
    others = [run for run in runs if not is_laid(run.role, entries)]
    lengths = _lengths(others)
    if not laid:
        raise InputError(
            code,
            where,
            "its moves are {}, and strategy.roles is {}: nothing is left to deposit; name other roles",
            lengths,
            roles,
        )
    issues = []
    if others:
        message = Text(
            "{}: {} left out, as strategy.roles is {}; name other roles to deposit more",
            where,
            lengths,
            roles,
        )
        issues.append(Issue(NOTE, LEFT_OUT, message))
    strange = [name for name in names if not group_of(name)]
    if strange and PART in entries:
        message = Text(
            "{}: the types {} are not known and are deposited as the part; name roles in strategy.roles "
            "to leave them out",
            where,
            ", ".join(strange),
        )
        issues.append(Issue(NOTE, NOT_READ, message))
    return laid, issues


def _lengths(runs: Sequence[Run]) -> str:
    """Types with their lengths."""
    lengths: dict[str, float] = {}
    for run in runs:
        lengths[run.role or ""] = lengths.get(run.role or "", 0.0) + run.length
    return Text.joined(
        ", ", (Text("{} {:.5g} mm", role, length) for role, length in lengths.items())
    )
