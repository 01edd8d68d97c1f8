# SPDX-License-Identifier: LGPL-2.1-or-later
"""The family-specific part of the window: tool, panel, view and entry in New Job."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any, ClassVar

from ...core.families.family import Family
from ...core.families.registry import KINDS
from ...core.parameters.filled import GEODESIC
from ...objects.shapes.bodies import Taken
from .. import picking, recorded
from ..in_language import tr
from ..picking import Pick

if TYPE_CHECKING:
    from ...core.process.deposit.balance import Balance
    from ..tools.tool import Tool


@dataclass(frozen=True)
class JobProposal:
    """A family with its reason, the deposited parts and their ground.

    missing: inputs still to be selected, '' for none. layers: for solids. mend: mm, size of the
    largest hole to close, 0 for the default.
    """

    kind: str
    reason: str
    parts: tuple[Pick, ...] = ()
    ground: Pick | None = None
    missing: str = ""
    layers: str = ""
    mend: float = 0.0

    @property
    def choice(self) -> str:
        """The entry in the list of kinds."""
        return self.layers if self.layers == GEODESIC else self.kind

    @property
    def family(self) -> Family | None:
        """The family; None before anything is selected."""
        return KINDS.get(self.kind)


class FeatureWindow:
    """The window functions of a family of `core.families`; the file is named after the kind.

    rank: position among the tools. job_rank: position among the entries in New Job. page: page in
    docs/tools. face_is_base: whether a clicked face is the base of the rest of the part.
    """

    rank: ClassVar[int]
    job_rank: ClassVar[int]
    page: ClassVar[str]
    face_is_base: ClassVar[bool] = False

    def tools(self) -> dict[str, Tool]:
        """Return the command that creates a feature, by its name."""
        raise NotImplementedError

    def open_panel(self) -> None:
        """Open the panel of a new feature."""
        from ..panels.stage import show

        show(self.panel()())

    def panel(self) -> type[Any]:
        """Return the class of the panel, imported at first use."""
        raise NotImplementedError

    def view(self) -> type[Any]:
        """Return the class of the view provider."""
        from ..views.feature import FeatureView

        return FeatureView

    def entries(self) -> dict[str, str]:
        """Return the texts of New Job by choice: the kind, or a kind of layers."""
        raise NotImplementedError

    def assign_roles(self, picks: Sequence[Pick], reason: str, layers: str) -> JobProposal:
        """Return the roles of picks if the user chose the family, and layers or ''."""
        raise NotImplementedError

    def arguments(self, job: JobProposal) -> dict[str, str]:
        """Return the part of a job and its ground as keywords of `make_all` with values as text."""
        keywords = {"faces": repr(list(job.parts[0].names))}
        if job.ground is not None:
            keywords["substrate"] = recorded.reference(job.ground.obj)
        return keywords

    def balance(
        self, job: JobProposal, snapshots: Sequence[Taken], under: Taken | None, width: float
    ) -> Balance | None:
        """Return the regions of a proposed job that beads of a width, mm, miss; None if unknown."""
        return None


def second_ground(picks: Sequence[Pick]) -> Pick | None:
    """Return the second picked object as the ground of the first."""
    return next((Pick(pick.obj) for pick in picks[1:]), None)


def ground_missing(wall: Pick, ground: Pick | None) -> str:
    """Return the missing input of a wall; a mesh may start on the platform."""
    if ground is not None or picking.is_mesh(wall.obj):
        return ""
    return tr("Also Ctrl+click the substrate, the part below.")


def several_elements(pick: Pick) -> Pick:
    """Return the pick with its elements; a single element selects the whole object."""
    return pick if len(pick.names) > 1 else Pick(pick.obj)


def solid_arguments(job: JobProposal) -> dict[str, str]:
    """Return the solids and their base, which may be the same object, as macro arguments."""
    source, *further = (pick.obj for pick in job.parts)
    keywords, ground = {}, job.ground
    if further:
        keywords["further"] = f"[{', '.join(recorded.reference(obj) for obj in further)}]"
    if ground is not None and ground.obj == source:
        keywords["faces"] = repr(list(ground.names))
    elif ground is not None:
        keywords["substrate"] = recorded.reference(ground.obj)
        if ground.names:
            keywords["base_faces"] = repr(list(ground.names))
    return keywords
