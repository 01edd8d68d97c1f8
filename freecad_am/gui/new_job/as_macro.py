# SPDX-License-Identifier: LGPL-2.1-or-later
"""A new job as a macro says it: the arguments of `make_all`."""

from __future__ import annotations

from ...core.parameters.cell import CellParameters
from ...core.parameters.filled import GEODESIC
from ...objects.fields import preferences
from .. import recorded
from .proposal import DEVELOPABLE, REVOLUTION, SOLID, JobProposal


def arguments(found: JobProposal, machine: str) -> dict[str, str]:
    """Keywords and their values as text, of what was proposed for a machine."""
    first = found.parts[0]
    told = {"source": recorded.reference(first.obj)}
    if found.kind != REVOLUTION:
        told["kind"] = repr(found.kind)
    if found.layers == GEODESIC:
        told["layers"] = repr(found.layers)
    if found.mend:
        told["mend"] = repr(found.mend)
    if found.kind in (DEVELOPABLE, SOLID):
        told.update(_of_solids(found))
    else:
        told["faces"] = repr(list(first.names))
        if found.ground is not None:
            told["substrate"] = recorded.reference(found.ground.obj)
    if machine != CellParameters().machine:
        told["machine"] = repr(machine)
    if preferences.post():
        told["post"] = repr(preferences.post())
    if preferences.process():
        told["process"] = repr(preferences.process())
    return told


def _of_solids(found: JobProposal) -> dict[str, str]:
    """Solids and what they stand on, which may be one with them, as a macro says it."""
    first, *further = (pick.obj for pick in found.parts)
    told, ground = {}, found.ground
    if further:
        told["further"] = f"[{', '.join(recorded.reference(obj) for obj in further)}]"
    if ground is not None and ground.obj == first:
        told["faces"] = repr(list(ground.names))
    elif ground is not None:
        told["substrate"] = recorded.reference(ground.obj)
        if ground.names:
            told["base_faces"] = repr(list(ground.names))
    return told
