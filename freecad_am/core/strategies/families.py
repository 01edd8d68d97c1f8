# SPDX-License-Identifier: LGPL-2.1-or-later
"""The families of features that can be planned: their names and options. The one place to register one.

The result of the feature selects the planner (`objects.toolpath`), and its proxy the view.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

from ..parameters.filled import CladdingParameters, DevelopableParameters, SolidParameters
from ..parameters.strategy import (
    CurvesParameters,
    LayerParameters,
    RevolutionParameters,
    SurfaceParameters,
)

NEEDED, OPTIONAL, NONE = "needed", "optional", "none"


@dataclass(frozen=True)
class Family:
    """A family of features.

    kind: `strategy.kind` of a job. parameters: the dataclass of `strategy`. substrate: whether it grows on an existing part:
    NEEDED (or edges to start from, or edges on the platform), OPTIONAL, NONE. meshes: a mesh may be the part. filled: solids are
    filled, so that the width and the speed of beads are separate settings. modes: the supported `build_direction` modes; why: the
    reason against the others. edges, faces: the part may name edges to start from, and faces.
    """

    kind: str
    parameters: type[LayerParameters]
    substrate: str
    meshes: bool
    filled: bool
    modes: tuple[str, ...]
    why: str
    edges: bool = False
    faces: bool = True


FAMILIES = (
    Family(
        "revolution",
        RevolutionParameters,
        NONE,
        False,
        False,
        ("local", "layer", "fixed"),
        "symmetry-plane is not for parts of revolution; use local, layer or fixed",
    ),
    Family(
        "surface",
        SurfaceParameters,
        NEEDED,
        True,
        False,
        ("local", "layer", "symmetry-plane", "fixed"),
        "",
        True,
    ),
    Family(
        "developable",
        DevelopableParameters,
        OPTIONAL,
        True,
        True,
        ("local",),
        "{} does not apply to solids on a hub, which grow along its normals; use local",
    ),
    Family(
        "curves",
        CurvesParameters,
        OPTIONAL,
        False,
        False,
        ("local", "fixed"),
        "{} is for walls; curves are laid along their own directions or one: use local or fixed",
    ),
    Family(
        "solid",
        SolidParameters,
        OPTIONAL,
        True,
        True,
        ("local", "layer", "fixed"),
        "{} is for walls; plane layers grow along their normal: use local or fixed",
        faces=False,
    ),
    Family(
        "cladding",
        CladdingParameters,
        OPTIONAL,
        True,
        True,
        ("local",),
        "{} is for walls; cladding grows along the normals of its faces: use local",
    ),
)
# what `kind: auto` is until its part is known: it may have whatever one of the families takes
AUTO = Family(
    "auto",
    LayerParameters,
    OPTIONAL,
    True,
    False,
    ("local", "layer", "symmetry-plane", "fixed"),
    "",
    True,
)
KINDS = {family.kind: family for family in FAMILIES}


def family_of(parameters: Any) -> Family:
    """The family of parameters of a strategy."""
    return next(family for family in (*FAMILIES, AUTO) if type(parameters) is family.parameters)
