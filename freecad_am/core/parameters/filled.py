# SPDX-License-Identifier: LGPL-2.1-or-later
"""How features that are filled are cut into layers, solids on cylinders and cones, in any layers,
and cladding; the list of fills."""

from __future__ import annotations

import math
from dataclasses import dataclass

from ..issues import InputError, Text
from . import field as f
from .records import Point, convert_texts
from .strategy import LAYER_TIME, MEND, LayerParameters
from .vectors import Axis, axis_text, direction_text


@dataclass(frozen=True)
class Fill:
    """A pattern of beads.

    follows_border: beads run along the border everywhere, so that there are no contours around
    them. can_be_sparse: it can fill a share of the area. all_round: the fill in its place in a
    layer all around a hub, where its beads would have no ends; '' for none. adapts_widths: the
    widths of its beads may follow the thickness of a region where it fills everything. is_linked:
    links along the walls join its lines.
    """

    follows_border: bool = False
    adapts_widths: bool = False
    can_be_sparse: bool = True
    all_round: str = ""
    is_linked: bool = False


FILLS = {
    "contours": Fill(follows_border=True, adapts_widths=True),
    "connected": Fill(follows_border=True, can_be_sparse=False, all_round="contours"),
    "lines": Fill(adapts_widths=True),
    "spiral": Fill(follows_border=True, can_be_sparse=False, all_round="contours"),
    "zigzag": Fill(adapts_widths=True, all_round="lines", is_linked=True),
    "grid": Fill(adapts_widths=True, all_round="lines"),
    "triangles": Fill(adapts_widths=True, all_round="lines"),
    "honeycomb": Fill(adapts_widths=True, all_round="lines"),
    "gyroid": Fill(adapts_widths=True, all_round="lines"),
}


LEAST_BEAD = 2.0  # mm, as short as a bead of usual width is worth a start
PLANES, GEODESIC = "planes", "geodesic"  # layers proposed automatically
OFFSET, ALONG = "offset", "along"


@dataclass(frozen=True)
class BaseParameters:
    """The cylinder or cone that solids grow on, where it is not found on a face. mm."""

    radius: float | str = f.parameter(
        "auto",
        f.LENGTH,
        "Radius of the base circle; auto: from the chosen face, or the face below the solids.",
        low=0.0,
        open_low=True,
        words=("auto",),
    )
    height: float | str = f.parameter(
        "inf",
        f.LENGTH,
        "Distance along the axis from the base circle to the apex of the cone; inf: a cylinder.",
        low=0.0,
        open_low=True,
        words=("inf",),
    )
    axis: Axis = f.parameter(
        Axis((0.0, 0.0, 0.0), (0.0, 0.0, 1.0)),
        f.VECTOR,
        "Centre x y z of the base circle and direction i j k of the axis, towards the apex, in "
        "part coordinates.",
        records=axis_text("strategy.base.axis"),
    )

    def __post_init__(self) -> None:
        if self.height == math.inf:
            object.__setattr__(self, "height", "inf")
        convert_texts(self)
        f.check(self, "strategy.base")
        if self.radius == "auto" and self.height != "inf":
            raise InputError(
                "BAD_VALUE",
                "strategy.base.radius",
                "a height without a radius does not define a cone; give the radius of the base "
                "circle too, or base: auto",
            )


@dataclass(frozen=True)
class FilledParameters(LayerParameters):
    """How the layers of solids are filled with beads (Dai 2020, section 2). mm and rad."""

    bead_spacing: float = f.parameter(
        5.0, f.LENGTH, "Distance between neighbouring beads of a layer.", low=0.0, open_low=True
    )
    bead_overlap: float | None = f.parameter(
        None,
        f.RATIO,
        "Overlap of neighbouring beads as a share of the bead width; replaces the bead spacing.",
        low=0.0,
        high=0.9,
        optional=True,
    )
    fill: str = f.parameter(
        "contours",
        f.CHOICE,
        "Parallel contours, parallel lines, or linked patterns: connected, spiral, zigzag; below "
        "100 % also grid, triangles, honeycomb, gyroid.",
        choices=tuple(FILLS),
    )
    spacing_range: tuple[float, float] = f.parameter(
        (1.0, 1.0),
        f.RATIO_RANGE,
        "Range of bead widths, as a share of the usual width and spacing, so that contours fill "
        "a region evenly and beads in thin places match its width.",
        low=0.3,
        high=2.0,
    )
    starts: str = f.parameter(
        "aligned",
        f.CHOICE,
        "Start of beads: at the seam (aligned), or away from the starts of neighbouring contours "
        "and layers, with every second layer of lines reversed (spread).",
        choices=("aligned", "spread"),
    )
    fill_density: float = f.parameter(
        1.0,
        f.RATIO,
        "Share of the area inside the walls that beads fill: their length times their spacing.",
        low=0.01,
        high=1.0,
    )
    solid_layers: int = f.parameter(
        0,
        f.COUNT,
        "Number of layers below tops and above bottoms that are filled at 100 %.",
        low=0,
        high=1000,
    )
    fill_angle: float = f.parameter(
        0.0, f.ANGLE, "Direction of lines and zigzags; 0 runs around the hub, 90 deg along it."
    )
    fill_angle_step: float = f.parameter(
        math.pi / 2.0,
        f.ANGLE,
        "Rotation of lines and zigzags from layer to layer.",
    )
    contour: bool = f.parameter(True, f.FLAG, "Contours around lines and similar patterns.")
    walls: int | str = f.parameter(
        1,
        f.COUNT,
        "Number of contours around lines and similar patterns; inf: contours only.",
        low=0,
        words=("inf",),
    )
    margin: float = f.parameter(
        0.0,
        f.LENGTH,
        "Machining allowance on the sides of the part; on top, further layers are added if they "
        "begin within this height above the last layer.",
        low=0.0,
    )
    order: str = f.parameter(
        "around-axis",
        f.CHOICE,
        "Order of several solids on a base: layer by layer around the axis, where each layer "
        "goes from the inner rings of all solids to the outer rings; or solid by solid (feature).",
        choices=("around-axis", "feature"),
    )
    wait: float = f.parameter(
        0.0,
        f.TIME,
        "Minimum time between the end of a layer of a solid and the start of its next layer.",
        low=0.0,
    )
    min_layer_time: float = f.parameter(
        0.0,
        f.TIME,
        f"{LAYER_TIME}, and islands keep the same order in every layer, so that each cools while "
        "others are printed.",
        low=0.0,
    )
    deflection: float = f.parameter(
        0.0,
        f.ANGLE,
        "Outward tilt of the torch about the bead on outer contours.",
        low=-math.pi / 3.0,
        high=math.pi / 3.0,
    )
    thin: str = f.parameter(
        "single",
        f.CHOICE,
        "A region narrower than a bead gets a single bead, or the job is rejected.",
        choices=("single", "refuse"),
    )
    gap: float = f.parameter(
        0.2,
        f.RATIO,
        "Widest gap allowed between beads, as a share of the bead spacing.",
        low=0.01,
        high=1.0,
        advanced=True,
    )
    longest_link: float = f.parameter(
        3.0,
        f.RATIO,
        "Longest link from one line of a zigzag to the next, as a share of the bead spacing; a "
        "longer link starts a new zigzag.",
        low=1.0,
        high=100.0,
        advanced=True,
    )
    shortest: float | str = f.parameter(
        "auto",
        f.LENGTH,
        "Minimum length of beads that close gaps; shorter beads are otherwise omitted. auto: 2 "
        "mm, or the bead spacing if that is less.",
        low=0.0,
        words=("auto",),
        advanced=True,
    )
    infill_overlap: float | str = f.parameter(
        "auto",
        f.RATIO,
        "Overlap of lines and other patterns with the surrounding contours, as a share of the "
        "bead width; auto: the overlap of neighbouring beads.",
        low=0.0,
        high=0.5,
        words=("auto",),
        advanced=True,
    )
    mend: float = f.parameter(5.0, f.LENGTH, MEND, low=0.0, high=10000.0, advanced=True)
    narrowest: float = f.parameter(
        0.3,
        f.RATIO,
        "Smallest width of beads in planes where neighbours leave less space, as a share of "
        "their usual width; 100 %: beads are never narrowed, and layers get higher there.",
        low=0.1,
        high=1.0,
        advanced=True,
    )
    widths: str = f.parameter(
        "adaptive",
        f.CHOICE,
        "Width of contours, and of lines inside contours, in planes: adaptive beads follow the "
        "thickness of a region if this covers the region better; fixed ones have the usual width.",
        choices=("adaptive", "fixed"),
        advanced=True,
    )
    widest: float = f.parameter(
        1.5,
        f.RATIO,
        "Greatest width of adaptive beads, as a share of their usual width.",
        low=1.0,
        high=2.0,
        advanced=True,
    )

    def __post_init__(self) -> None:
        if self.walls == math.inf:
            object.__setattr__(self, "walls", "inf")
        f.check(self, "strategy")
        object.__setattr__(self, "spacing_range", tuple(self.spacing_range))
        if not self.spacing_range[0] <= 1.0 <= self.spacing_range[1]:
            ends = Text.joined(" to ", (f"{100.0 * end:g} %" for end in self.spacing_range))
            raise InputError(
                "BAD_VALUE",
                "strategy.spacing_range",
                "{} excludes 100 %, the usual width; extend the range to include 100 %",
                ends,
            )
        if self.fill_density < 1.0 and not FILLS[self.fill].can_be_sparse:
            raise InputError(
                "BAD_VALUE",
                "strategy.fill_density",
                "{} always fills the whole region, not {:g} %; use 100 %, or fill: contours, "
                "lines, zigzag, grid, triangles, honeycomb or gyroid",
                self.fill,
                100.0 * self.fill_density,
            )

    @property
    def rounds(self) -> float:
        """Return how many contours surround lines and similar fills; infinity for contours only."""
        return 0 if not self.contour else math.inf if self.walls == "inf" else float(self.walls)

    @property
    def least_bead(self) -> float:
        """Mm: beads are no shorter than this."""
        return (
            min(LEAST_BEAD, self.bead_spacing) if self.shortest == "auto" else float(self.shortest)
        )

    @property
    def overlap_share(self) -> float | None:
        """Share of the bead width by which patterns reach into walls; None: as neighbours overlap."""
        return None if self.infill_overlap == "auto" else float(self.infill_overlap)

    @property
    def rounds_alone(self) -> bool:
        """Whether contours, of whatever kind, are all there is."""
        return FILLS[self.fill].follows_border or self.rounds == math.inf

    @property
    def share_of_cut(self) -> float:
        """How many layer heights above the surface of a layer the part is cut."""
        return 0.0

    @property
    def has_direction(self) -> bool:
        """Whether the fill depends on an angle."""
        return not self.rounds_alone or self.fill_density < 1.0

    @property
    def adapts_widths(self) -> bool:
        """Whether the widths of beads may follow the thickness of a region."""
        return (
            self.widths == "adaptive"
            and self.narrowest < 1.0
            and self.spacing_range == (1.0, 1.0)
            and self.thin == "single"
            and self.fill_density == 1.0
            and (FILLS[self.fill].adapts_widths or self.rounds == math.inf)
            and (FILLS[self.fill].follows_border or self.rounds >= 1)
        )

    @property
    def is_sparse(self) -> bool:
        """Whether beads leave a part of the regions open on purpose."""
        only_contours = not FILLS[self.fill].follows_border and self.rounds == math.inf
        return self.fill_density < 1.0 and not only_contours

    @property
    def thick(self) -> int:
        """Return how many layers above and below decide which regions count as solid; 0 to fill all
        regions.
        """
        return self.solid_layers if self.fill_density < 1.0 else 0


@dataclass(frozen=True)
class BasedParameters(LayerParameters):
    """The substrate of solids."""

    base: BaseParameters = f.group(BaseParameters, "The cylinder or cone that the solids grow on.")


@dataclass(frozen=True)
class DevelopableParameters(FilledParameters, BasedParameters):
    """How to slice solids on a cylinder or cone into equidistant layers and fill them (Dai 2020,
    section 2).

    The substrate comes first, as in documents. mm and rad.
    """


@dataclass(frozen=True)
class SolidParameters(FilledParameters):
    """How any solid is cut by planes and filled. mm and rad."""

    layers: str = f.parameter(
        PLANES,
        f.CHOICE,
        "Shape of the layers: parallel planes; surfaces at equal distances from the support, "
        "measured through the part, so that no support material is needed (geodesic); surfaces "
        "at equal straight distances from the support (offset); or planes normal to a guide "
        "curve (along).",
        choices=(PLANES, GEODESIC, OFFSET, ALONG),
    )
    direction: Point | None = f.parameter(
        (0.0, 0.0, 1.0),
        f.VECTOR,
        "Stacking direction x y z in part coordinates, from the first layer to the last; auto: "
        "the direction with the least overhanging area, then the least height.",
        records=direction_text("strategy.direction", "auto"),
    )
    cut_at: str = f.parameter(
        "middle",
        f.CHOICE,
        "Height within a layer at which the part is cut for its outline.",
        choices=("middle", "bottom", "top"),
    )
    max_overhang: float = f.parameter(
        math.radians(45.0),
        f.ANGLE,
        "Largest overhang angle between the stacking direction and a wall without a warning; 90 "
        "deg: no warning.",
        low=0.0,
        high=math.pi / 2.0,
    )
    band: float = f.parameter(
        0.2,
        f.RATIO,
        "Share of the layer height by which the local height of layers along a guide may differ.",
        low=0.0,
        high=0.9,
    )
    max_void: float = f.parameter(
        0.03,
        f.RATIO,
        "Largest void in the section of a planar layer without a warning, as a share of the "
        "section; 100 %: no warning.",
        low=0.0,
        high=1.0,
        advanced=True,
    )
    fuse: str = f.parameter(
        "auto",
        f.CHOICE,
        "Solids that touch or overlap are deposited as one (auto), or separately (none).",
        choices=("auto", "none"),
        advanced=True,
    )

    def __post_init__(self) -> None:
        convert_texts(self)
        super().__post_init__()

    @property
    def has_plane_layers(self) -> bool:
        """Return whether layers are parallel planes."""
        return self.layers == PLANES

    @property
    def has_curved_layers(self) -> bool:
        """Return whether layers are surfaces at equal distances from the support or from faces."""
        return self.layers in (GEODESIC, OFFSET)

    @property
    def follows_guide(self) -> bool:
        """Return whether layers are planes normal to a guide curve."""
        return self.layers == ALONG

    @property
    def share_of_cut(self) -> float:
        """How many layer heights above the plane of a layer the part is cut."""
        return {"middle": 0.5, "bottom": 0.0, "top": 1.0}[self.cut_at]


FILL, HELIX = "fill", "helix"


@dataclass(frozen=True)
class CladdingParameters(FilledParameters):
    """How faces are covered with layers of beads. mm and rad."""

    layers: int = f.parameter(
        1,
        f.COUNT,
        "Number of layers on the faces, one layer height apart along their normals.",
        low=1,
        high=1000,
    )
    pattern: str = f.parameter(
        FILL,
        f.CHOICE,
        "Beads by strategy.fill, or one helix around faces of revolution that close around their "
        "axis.",
        choices=(FILL, HELIX),
    )
    side: str = f.parameter(
        "front",
        f.CHOICE,
        "Side of the faces to cover: the side of their normals, the outside of a solid (front), "
        "or the other side of faces without a solid (back).",
        choices=("front", "back"),
    )
    distortion: float = f.parameter(
        0.1,
        f.RATIO,
        "Largest variation of the bead spacing on doubly curved faces, as a share; such faces "
        "are divided into pieces that respect it.",
        low=0.01,
        high=0.3,
        advanced=True,
    )

    def __post_init__(self) -> None:
        super().__post_init__()
        for key, given, instead in (
            ("margin", self.margin, "0 mm"),
            ("solid_layers", self.solid_layers, "0"),
        ):
            if given:
                raise InputError(
                    "NOT_FOR_FAMILY",
                    f"strategy.{key}",
                    "the key is for solids, not for cladding; use {}",
                    instead,
                )
