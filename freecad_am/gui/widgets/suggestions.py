# SPDX-License-Identifier: LGPL-2.1-or-later
"""Texts to choose from for parameters whose words are known only at run time."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace
from typing import Any

from ... import api
from ...core.issues import InputError
from ...core.kinematics.machines import machine
from ...core.parameters.cell import CellParameters
from ...core.parameters.program import ProgramParameters
from ...core.process import wire
from ...objects import user_machines
from ...objects.checks.controllers import post_of, writers, written_by
from ...objects.fields import preferences, saved_cells
from ...posts import catalogue
from ..in_language import tr
from .choices import machines

NO_POST = "none"


def of(section: str, key: str) -> Callable[[], list[tuple[str, str]]] | None:
    """Return a function that lists the texts of a parameter with their labels, None if any text is valid."""
    texts = _texts_of(section, key)
    if (section, key) == ("cell", "machine"):
        return machines
    return None if texts is None else lambda: [(text, text) for text in texts()]


def _texts_of(section: str, key: str) -> Callable[[], list[str]] | None:
    return {
        ("cell", "limits"): lambda: ["maker", "paper"],
        ("cell", "branch"): _branches,
        ("program", "post"): lambda: [*catalogue.NAMES, NO_POST],
        ("process", "bead_model"): lambda: ["none", *wire.BUILT_IN],
    }.get((section, key))


def _branches() -> list[str]:
    sides = [
        (a, b, c) for a in ("front", "back") for b in ("up", "down") for c in ("flip", "noflip")
    ]
    return ["auto", *(" ".join(words) for words in sides)]


def is_robot(name: str) -> bool:
    """Whether a machine may carry part or tool; False for a saved cell or an unreadable machine."""
    try:
        return len(machine.load(name, user_machines.folders()).arrangements) > 1
    except InputError:
        return False


def no_post(name: str, setup: str = "") -> str:
    """Return the note on a machine without a post for a set-up ('' for the default set-up).

    Return '' for other and unreadable machines.
    """
    try:
        loaded = machine.load(name, user_machines.folders())
    except InputError:
        return ""
    posts, setup = written_by(loaded), setup or loaded.arrangements[0].setup
    if posts is None or writers(loaded, posts, setup):
        return ""
    if posts and any(
        writers(loaded, posts, arrangement.setup) for arrangement in loaded.arrangements
    ):
        return tr(
            "Programs for this controller need the tool on the robot. With the part on the robot "
            "the job is planned, checked and simulated, but no program is written."
        )
    if posts:
        return tr(
            "Programs for this controller contain positions, but the names of the wrist "
            "configurations are unknown: the job is planned, checked and simulated, but no "
            "program is written."
        )
    if loaded.posts:
        return tr(
            "Programs for this machine need the pulses per degree, known only to its controller, "
            "in your own machine file. Without this file the job is planned, checked and "
            "simulated; Export Path… writes its points as a table."
        )
    return tr(
        "There is no post for this controller yet: the job is planned, checked and simulated, "
        "but no program is written. Export Path… writes its points as a table."
    )


def post_of_job(name: str, setup: str = "") -> str:
    """Return the post of a new job with a machine in a set-up ('' for the default set-up), or with
    a saved cell.

    Return '' if no post writes its program, or it cannot be read.
    """
    try:
        if saved_cells.is_file_of_cell(name):
            cell = api.read_cell(name)
        else:
            loaded = machine.load(name or CellParameters().machine, user_machines.folders())
            cell = replace(
                CellParameters(machine=loaded.id), setup=setup or loaded.arrangements[0].setup
            )
        return post_of(cell, preferences.post(), user_machines.folders())[0]
    except (InputError, OSError):
        return ""


def setup_for(name: str) -> str:
    """Return the set-up of a new job with a machine.

    This is the default set-up, or one that a post supports if none supports the default. Return ''
    for an unreadable machine.
    """
    try:
        loaded = machine.load(name, user_machines.folders())
    except InputError:
        return ""
    posts = written_by(loaded)
    written = (
        []
        if posts is None
        else [
            arrangement.setup
            for arrangement in loaded.arrangements
            if arrangement.planned and writers(loaded, posts, arrangement.setup)
        ]
    )
    return [*written, loaded.arrangements[0].setup][0]


def usual_post() -> str:
    """Return the default post of new programs."""
    return str(preferences.post() or ProgramParameters().post)


def post_for(path: Any) -> tuple[str, str]:
    """Return post and motion of a new program for the cell of a joint path.

    ('none', '') means that no post writes for its controller. ('', '') means that the defaults
    apply, or the machine does not determine them.
    """
    if path is None or path.Cell is None:
        return "", ""
    usual, default_post = ProgramParameters(), usual_post()
    try:
        post, motion = post_of(
            path.Cell.Proxy.parameters(path.Cell, CellParameters),
            default_post,
            user_machines.folders(),
        )
    except InputError:
        return "", ""
    if not post:
        return NO_POST, ""
    return ("", "") if (post, motion) == (default_post, usual.motion) else (post, motion)
