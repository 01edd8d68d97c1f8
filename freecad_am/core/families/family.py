# SPDX-License-Identifier: LGPL-2.1-or-later
"""Facts about a family of features and its toolpaths, independent of part and machine."""

from __future__ import annotations

from typing import Any, ClassVar

from ..parameters.strategy import LayerParameters

NEEDED, OPTIONAL, NONE = "needed", "optional", "none"
ON_FEATURE, ON_PART = "feature", "part"


class Family:
    """A family of features: a subclass in a file of its own, listed in `registry`.

    The attributes are facts that other modules use in place of the kind. Planning is in
    `core.strategies`; `objects.families` and `gui.families` have what concerns documents and the
    window, in files of the same name.
    """

    # ---- what a job may contain

    # the value of `strategy.kind`
    kind: ClassVar[str]
    # the dataclass of `strategy`
    parameters: ClassVar[type[LayerParameters]] = LayerParameters
    # NEEDED (or edges to start from, or edges on the platform), OPTIONAL or NONE
    substrate: ClassVar[str] = OPTIONAL
    # whether the part may be a mesh, or some faces, may name edges to start from, or may be edges or
    # a table of points
    takes_meshes: ClassVar[bool] = False
    takes_faces: ClassVar[bool] = True
    takes_start_edges: ClassVar[bool] = False
    takes_curves: ClassVar[bool] = False
    # keys of `strategy` that select elements of the part
    selections: ClassVar[tuple[str, ...]] = ()
    # whether `part.fuse` joins solids that touch
    fuses_solids: ClassVar[bool] = False
    # whether `strategy.layers` names a kind of layers
    chooses_layers: ClassVar[bool] = False
    # the modes of `build_direction`, and the reason against the others
    modes: ClassVar[tuple[str, ...]] = ("local",)
    mode_refusal: ClassVar[str] = ""

    # ---- what is deposited

    # beads fill solids or layers on faces and have a spacing; otherwise each is a wall of one bead
    is_filled: ClassVar[bool] = False
    # layers, directions and spirals turn about one axis, from the plane z = 0 of the feature's frame
    has_axis: ClassVar[bool] = False
    # the frame on the platform for `cell.mount: auto`
    mount: ClassVar[str] = ON_PART
    # build directions follow a wall and could be a single one
    follows_wall: ClassVar[bool] = False
    # the visible side of a bead is the one away from the middle of its layer
    is_open_wall: ClassVar[bool] = False
    # the report compares the spacings of `strategy.compare`
    compares_spacings: ClassVar[bool] = False
    # the first layer starts on its base by construction
    starts_on_base: ClassVar[bool] = False
    # every layer may start on the ground
    starts_anywhere: ClassVar[bool] = False
    # layers are stacked along the Z of the feature's frame, as planes unless the job names others;
    # what is below the plane of the platform counts as on it
    stacks_layers: ClassVar[bool] = False
    # layers begin at the surface of the part below, so that the parts may overlap
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
