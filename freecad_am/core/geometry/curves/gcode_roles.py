# SPDX-License-Identifier: LGPL-2.1-or-later
"""What a slicer's comments say that moves belong to: the part, or its skirt, brim, support, tower and the like.

PrusaSlicer, SuperSlicer, Orca, Cura and ideaMaker write `;TYPE:name`, Bambu Studio `; FEATURE: name`, Simplify3D
`; feature name` (before 4.0 the name alone), FlashPrint `;structure:name`, CraftWare `;segType:name`, KISSlicer `; 'name Path'`.
"""

from __future__ import annotations

import re
from collections.abc import Sequence

PART, ALL = "part", "all"
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
    ("purge", ("custom", "purge", "flush", "pre-extrude", "preextrude", "pre extrude", BEFORE)),
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
