# SPDX-License-Identifier: LGPL-2.1-or-later
"""The families of features that can be planned. The one place to register one."""

from __future__ import annotations

from typing import Any

from ..parameters.strategy import LayerParameters
from .cladding import Cladding
from .curves import Curves
from .developable import Developable
from .family import Family
from .revolution import Revolution
from .solid import Solid
from .surface import Surface


class Auto(Family):
    """The family of `kind: auto` until the part is known; a job may contain what any family takes."""

    kind = "auto"
    takes_meshes = True
    takes_start_edges = True
    modes = Surface.modes


FAMILIES: tuple[Family, ...] = (
    Revolution(),
    Surface(),
    Developable(),
    Curves(),
    Solid(),
    Cladding(),
)
AUTO = Auto()
KINDS = {family.kind: family for family in FAMILIES}
DEFAULT_KIND = Revolution.kind


def family_of(parameters: LayerParameters) -> Family:
    """Return the family of parameters of a strategy."""
    return next(family for family in (*FAMILIES, AUTO) if type(parameters) is family.parameters)


def find_family(kind: Any, layers: Any = None) -> Family | None:
    """Return the family that a job names by its kind and layers; None for an unknown kind."""
    family = KINDS.get(kind) if isinstance(kind, str) else None
    return None if family is None else KINDS[family.kind_in_layers(layers)]
