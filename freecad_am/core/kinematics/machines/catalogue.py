# SPDX-License-Identifier: LGPL-2.1-or-later
"""The known machines with figures for choosing one: manufacturer, reach, payload, posts.
Their geometry is not read.
"""

from __future__ import annotations

import unicodedata
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path

from ...issues import InputError
from . import machine
from .file import Node, read


@dataclass(frozen=True)
class Entry:
    """A machine file's figures. reach: mm, payload: kg, None if the file does not state them.
    posts: None for any.
    """

    id: str
    title: str
    reach: float | None
    payload: float | None
    posts: tuple[str, ...] | None

    def is_of(self, maker: str) -> bool:
        """Return whether title or id begin with the words of a manufacturer, as 'Yaskawa' and
        'motoman' for a Yaskawa.

        Accents and capitals do not count.
        """
        maker_name = _plain(maker)
        return any(
            _plain(name).startswith(f"{maker_name} ")
            for name in (self.title, self.id.replace("-", " "))
        )


def entries(folders: Sequence[Path | str] = ()) -> list[Entry]:
    """All machines, built in and in the user's `folders`, in order of id; files that are not machine files are left out.

    Raises InputError BAD_MACHINE for reach or payload that are not figures.
    """
    names = [
        name for name, title in machine.known(folders) if not title.startswith(machine.REFUSED)
    ]
    return [_entry(name, read(machine.file_of(name, folders))) for name in names]


def select_machines(
    entries: Sequence[Entry],
    maker: str | None = None,
    reach: float = 0.0,
    payload: float = 0.0,
    post: str | None = None,
) -> list[Entry]:
    """Return the machines that meet requirements.

    A machine whose file does not state a required figure is left out.

    Parameters
    ----------
    entries : sequence of Entry
        The known machines.
    maker : str or None, optional
        Manufacturer; None for any.
    reach : float, optional
        Smallest reach, mm; 0 for any.
    payload : float, optional
        Smallest payload, kg; 0 for any.
    post : str or None, optional
        Post that the controller has to read; None for any.

    Returns
    -------
    list of Entry
        The machines in the same order.

    Raises
    ------
    InputError
        USAGE for an unknown manufacturer.
    """
    if maker is not None and not any(entry.is_of(maker) for entry in entries):
        makers = ", ".join(sorted({entry.title.split()[0] for entry in entries}))
        raise InputError(
            "USAGE",
            "freecad-am machines",
            "no known machine is from {!r}; use one of {}",
            maker,
            makers,
        )
    return [
        entry
        for entry in entries
        if (maker is None or entry.is_of(maker))
        and (reach <= 0.0 or (entry.reach is not None and entry.reach >= reach))
        and (payload <= 0.0 or (entry.payload is not None and entry.payload >= payload))
        and (post is None or entry.posts is None or post in entry.posts)
    ]


def _entry(name: str, top: Node) -> Entry:
    controller = top["controller"] if top.has("controller") else top
    return Entry(
        name,
        top["title"].text(),
        _figure(top, "reach", "mm"),
        _figure(top, "payload", "kg"),
        controller["posts"].texts() if controller.has("posts") else None,
    )


def _figure(top: Node, key: str, unit: str) -> float | None:
    return top[key][unit].number() if top.has(key) and top[key].has(unit) else None


def _plain(text: str) -> str:
    letters = unicodedata.normalize("NFKD", text)
    return (
        "".join(letter for letter in letters if not unicodedata.combining(letter))
        .casefold()
        .strip()
    )
