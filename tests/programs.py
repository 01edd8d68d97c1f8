# SPDX-License-Identifier: LGPL-2.1-or-later
"""Build programs of motions as a document does, with the checks of the post's controller."""

from freecad_am.core.planning import program as programs
from freecad_am.objects.checks import controllers
from freecad_am.posts import catalogue


def build(motion, cell, process, parameters, name, waits=(), returns=()):
    """Return the program of a motion for the post that the parameters name. Raise InputError as
    `objects.program` does."""
    controllers.check(cell, parameters)
    return programs.build(
        motion,
        cell,
        process,
        parameters,
        catalogue.controller(parameters.post),
        name,
        waits,
        returns,
    )
