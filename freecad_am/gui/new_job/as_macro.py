# SPDX-License-Identifier: LGPL-2.1-or-later
"""A new job as a macro says it: the arguments of `make_all`."""

from __future__ import annotations

from ...core.parameters.cell import CellParameters
from ...core.parameters.filled import GEODESIC, PLANES
from ...objects.fields import preferences, saved_cells
from .. import recorded
from .proposal import DEVELOPABLE, REVOLUTION, SOLID, JobProposal


def arguments(found: JobProposal, machine: str, asked: bool) -> dict[str, str]:
    """Keywords and their values as text, of what was proposed, or asked for, for a machine or a saved cell. Where curved
    layers that were proposed cannot be carried out planes are laid, as in jobs with `kind: auto`."""
    first = found.parts[0]
    given = {"source": recorded.reference(first.obj)}
    if found.kind != REVOLUTION:
        given["kind"] = repr(found.kind)
    if found.layers == GEODESIC:
        given["layers"] = repr(found.layers)
        if not asked:
            given["layers_otherwise"] = repr(PLANES)
    if found.mend:
        given["mend"] = repr(found.mend)
    if found.kind in (DEVELOPABLE, SOLID):
        given.update(_of_solids(found))
    else:
        given["faces"] = repr(list(first.names))
        if found.ground is not None:
            given["substrate"] = recorded.reference(found.ground.obj)
    if saved_cells.is_file_of_cell(machine):
        given["cell"] = repr(machine)
    elif machine != CellParameters().machine:
        given["machine"] = repr(machine)
    if preferences.post():
        given["post"] = repr(preferences.post())
    if preferences.process():
        given["process"] = repr(preferences.process())
    return given


def _of_solids(found: JobProposal) -> dict[str, str]:
    """Solids and what they stand on, which may be one with them, as a macro says it."""
    first, *further = (pick.obj for pick in found.parts)
    given, ground = {}, found.ground
    if further:
        given["further"] = f"[{', '.join(recorded.reference(obj) for obj in further)}]"
    if ground is not None and ground.obj == first:
        given["faces"] = repr(list(ground.names))
    elif ground is not None:
        given["substrate"] = recorded.reference(ground.obj)
        if ground.names:
            given["base_faces"] = repr(list(ground.names))
    return given
