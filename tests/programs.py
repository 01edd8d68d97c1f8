# SPDX-License-Identifier: LGPL-2.1-or-later
"""Programs of motions as the document makes them: what the controller of the post does not take is refused before."""

from freecad_am.core.planning import program as programs
from freecad_am.objects.checks import controllers
from freecad_am.posts import catalogue


def build(motion, cell, process, parameters, name, waits=(), returns=()):
    """The program of a motion for the post that the parameters name. Raises InputError as `objects.program` does."""
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
