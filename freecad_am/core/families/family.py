# SPDX-License-Identifier: LGPL-2.1-or-later
"""What holds for every feature of a family, and for its toolpaths, whatever part and machine."""

from __future__ import annotations

from typing import Any, ClassVar

from ..parameters.strategy import LayerParameters

NEEDED, OPTIONAL, NONE = "needed", "optional", "none"
ON_FEATURE, ON_PART = "feature", "part"


class Family:
    """A family of features: a subclass in a file of its own, listed in `registry`.

    The attributes are facts that other modules use in place of the kind. Planning is in
    `core.strategies`; `objects.families` and `gui.families` have the side of documents and of the
    window, in files of the same name.

    What a job may contain: `kind`, the value of `strategy.kind`; `parameters`, the dataclass of
    `strategy`; `substrate`: NEEDED (or edges to start from, or edges on the platform), OPTIONAL or
    NONE; `takes_meshes`, `takes_faces`, `takes_start_edges`, `takes_curves`: whether the part may
    be a mesh, some faces, may name edges to start from, may be edges or a table of points;
    `selections`: keys of `strategy` that select elements of the part; `fuses_solids`: whether
    `part.fuse` joins solids that touch; `chooses_layers`: whether `strategy.layers` names a kind of
    layers; `modes`: the `build_direction` modes, and `mode_refusal`, the reason against the others.

    What is deposited: `is_filled`: beads fill solids or layers on faces and have a spacing,
    otherwise each is a wall of one bead; `has_axis`: the part has one axis of revolution, about
    which layers, directions and spirals turn, and grows from the plane z = 0 of its frame;
    `mount`: the frame on the platform for `cell.mount: auto`; `follows_wall`: build directions
    follow a wall and could be a single one; `is_open_wall`: the visible side of a bead is the one
    away from the middle of its layer; `compares_spacings`: the report compares the spacings of
    `strategy.compare`; `starts_on_base`: the first layer starts on its base by construction;
    `starts_anywhere`: every layer may start on the ground; `has_plane_layers`: layers are planes
    square to the Z of the frame, and what is below the plane of the platform counts as on it;
    `cuts_into_substrate`: parts may reach into the part that they grow on.
    """

    kind: ClassVar[str]
    parameters: ClassVar[type[LayerParameters]] = LayerParameters
    substrate: ClassVar[str] = OPTIONAL
    takes_meshes: ClassVar[bool] = False
    takes_faces: ClassVar[bool] = True
    takes_start_edges: ClassVar[bool] = False
    takes_curves: ClassVar[bool] = False
    selections: ClassVar[tuple[str, ...]] = ()
    fuses_solids: ClassVar[bool] = False
    chooses_layers: ClassVar[bool] = False
    modes: ClassVar[tuple[str, ...]] = ("local",)
    mode_refusal: ClassVar[str] = ""

    is_filled: ClassVar[bool] = False
    has_axis: ClassVar[bool] = False
    mount: ClassVar[str] = ON_PART
    follows_wall: ClassVar[bool] = False
    is_open_wall: ClassVar[bool] = False
    compares_spacings: ClassVar[bool] = False
    starts_on_base: ClassVar[bool] = False
    starts_anywhere: ClassVar[bool] = False
    has_plane_layers: ClassVar[bool] = False
    cuts_into_substrate: ClassVar[bool] = False

    def kind_in_layers(self, layers: Any) -> str:
        """Return the kind of a feature whose job names these layers."""
        return self.kind

    def fits_scans(self, layers: str) -> bool:
        """Return whether such layers ('planes' without a choice) can be fitted to a scan."""
        return False

    def describe_layers(self, layers: str) -> str:
        """Return what messages call such layers: their kind, or the family's."""
        return self.kind
