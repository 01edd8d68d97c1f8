# SPDX-License-Identifier: LGPL-2.1-or-later
"""Parameters of the section `joints` of a job."""

from __future__ import annotations

import itertools
import math
from collections.abc import Sequence
from dataclasses import dataclass

from ..issues import InputError
from . import field as f
from .records import RecordTexts, convert_texts

BRANCHES = tuple(
    "-".join(words)
    for words in itertools.product(("front", "back"), ("up", "down"), ("noflip", "flip"))
)
OF_CELL = "cell"
HIGHEST = 6  # degree of a polynomial
ALL_BEADS = "*"
LEVEL_METHOD, OPTIMISED = "level", "optimised"
METHODS = ("layer-by-layer", "point-by-point", "constant")
OBJECTIVES = (
    "displacement",
    "limits-liegeois",
    "limits-fournier",
    "limits-klein",
    "manipulability",
    "condition",
)


@dataclass(frozen=True)
class GivenPolynomial:
    """A given polynomial of the rotation about the tool axis.

    bead: (layer, bead), None for all other beads. coefficients: the constant first, rad and rad per
    power of the bead's parameter; one turn is 2 pi of the parameter. Its text has degrees and turns.
    """

    bead: tuple[int, int] | None
    coefficients: tuple[float, ...]

    def __str__(self) -> str:
        name = ALL_BEADS if self.bead is None else f"{self.bead[0]}/{self.bead[1]}"
        values = [
            math.degrees(value) * (2.0 * math.pi) ** power
            for power, value in enumerate(self.coefficients)
        ]
        return ":".join([name, *(f"{round(value, 9) + 0.0:.12g}" for value in values)])


def parse_given(entry: str) -> GivenPolynomial:
    """Return the polynomial of a text such as 12/0:-35:360. Raises InputError BAD_VALUE."""
    place, *numbers = entry.split(":") if isinstance(entry, str) else ("", "")
    try:
        layer, slash, number = place.strip().partition("/")
        bead = None if place.strip() == ALL_BEADS else (int(layer), int(number) if slash else 0)
        values = [float(number) for number in numbers]
    except ValueError:
        values = []
    if (
        not values
        or len(values) > HIGHEST + 1
        or not all(map(math.isfinite, values))
        or (bead and min(bead) < 0)
    ):
        raise InputError(
            "BAD_VALUE",
            "joints.given",
            "{!r} is not understood; use layer/bead:constant:slope with up to {} "
            "coefficients in deg and deg per turn, such as 12/0:-35:360; * means every other "
            "bead",
            entry,
            HIGHEST + 1,
        )
    return GivenPolynomial(
        bead,
        tuple(math.radians(value) / (2.0 * math.pi) ** power for power, value in enumerate(values)),
    )


def check_given(polynomials: Sequence[GivenPolynomial]) -> None:
    """Raises InputError BAD_VALUE if a bead has two polynomials."""
    beads = [polynomial.bead for polynomial in polynomials]
    for bead in beads:
        if beads.count(bead) > 1:
            raise InputError(
                "BAD_VALUE",
                "joints.given",
                "the bead {} is listed twice; keep one entry per bead",
                ALL_BEADS if bead is None else f"{bead[0]}/{bead[1]}",
            )


GIVEN = RecordTexts(GivenPolynomial, parse_given)


@dataclass(frozen=True)
class JointParameters:
    """How the rotation about the tool axis is used (Chalvin 2020, section 4). rad, mm."""

    method: str = f.parameter(
        "layer-by-layer",
        f.CHOICE,
        "One polynomial per layer, one value per point, or one value for the whole job.",
        choices=METHODS,
    )
    rz: float | str = f.parameter(
        "auto",
        f.ANGLE,
        "Method constant: RZ for the whole job, or auto to search for it.",
        words=("auto",),
    )
    degree: int = f.parameter(
        1, f.COUNT, "Degree of the polynomial of a layer.", low=0, high=HIGHEST
    )
    given: tuple[GivenPolynomial, ...] = f.parameter(
        (),
        f.RECORDS,
        "Method layer-by-layer: given polynomials instead of a search: "
        "layer/bead:constant:slope, or * for all other beads, in deg and deg per turn.",
        advanced=True,
        records=GIVEN,
    )
    parameter: str = f.parameter(
        "rotation",
        f.CHOICE,
        "Quantity that the polynomial describes: the true rotation about the tool axis, or RZ of "
        "Chalvin 2020.",
        choices=("rotation", "rz"),
        advanced=True,
    )
    rotation_range: tuple[float, float] = f.parameter(
        (-math.pi, math.pi),
        f.ANGLE_RANGE,
        "Allowed rotation about the tool axis: a full turn for a coaxial torch, a narrower range "
        "otherwise.",
    )
    objective: str = f.parameter(
        "displacement", f.CHOICE, "Objective for the joint path.", choices=OBJECTIVES
    )
    min_condition: float | str = f.parameter(
        "auto",
        f.NUMBER,
        "Smallest inverse condition number allowed; auto: at each point a quarter of its value "
        "at RZ = 0, but at least 0.02.",
        low=0.0,
        high=1.0,
        words=("auto",),
    )
    characteristic_length: float = f.parameter(
        1000.0,
        f.LENGTH,
        "Length that divides the translation rows of the Jacobian.",
        low=0.0,
        open_low=True,
        advanced=True,
    )
    tolerance: float = f.parameter(
        1e-8,
        f.NUMBER,
        "Change of objective and coefficients at which the optimiser stops.",
        low=0.0,
        open_low=True,
        high=1.0,
        advanced=True,
    )
    max_iterations: int = f.parameter(
        1000,
        f.COUNT,
        "Iterations after which the optimiser gives up on a layer.",
        low=1,
        high=1_000_000,
        advanced=True,
    )
    lock: str = f.parameter(
        "none",
        f.CHOICE,
        "Five-axis machines only: the revolute axis to lock, counted from the torch (four axes).",
        choices=("none", "first", "second"),
    )
    lock_at: float | str = f.parameter(
        "auto",
        f.ANGLE,
        "Position of the locked axis; auto: the position with the smallest residual angle.",
        words=("auto",),
    )
    max_residual: float = f.parameter(
        math.radians(45.0),
        f.ANGLE,
        "Four axes only: largest deviation of the tool from the requested direction.",
        low=0.0,
        high=math.pi,
    )
    own_branch: str = f.parameter(
        OF_CELL,
        f.CHOICE,
        "Shoulder, elbow and wrist of the joint path; cell: as set in the cell.",
        choices=(OF_CELL, *BRANCHES),
        advanced=True,
    )
    compare: tuple[str, ...] = f.parameter(
        (), f.TEXT, "Further methods to plan for the comparison in the report.", advanced=True
    )
    certificate: bool = f.parameter(
        False,
        f.FLAG,
        "Compare the joint path with a lower bound over all rotations about the tool axis. Takes "
        "up to seconds per bead.",
        advanced=True,
    )
    close_gap: bool = f.parameter(
        False,
        f.FLAG,
        "Let the rotation about the tool axis vary at every point of a bead if this needs less "
        "motion than a polynomial: the best rotation found for the objective displacement. Takes "
        "up to seconds per bead.",
        advanced=True,
    )
    external_axes: str = f.parameter(
        LEVEL_METHOD,
        f.CHOICE,
        "External axes. level: the axes turn only as far as the angle from the vertical "
        "requires; optimised: each axis follows one polynomial per bead, optimised together with "
        "the tool rotation for less motion and larger margins.",
        choices=(LEVEL_METHOD, OPTIMISED),
    )

    def __post_init__(self) -> None:
        convert_texts(self)
        f.check(self, "joints", skip=frozenset({"compare"}))
        object.__setattr__(self, "compare", tuple(self.compare))
        check_given(self.given)
        for method in self.compare:
            if method not in METHODS:
                raise f.unknown_choice("joints.compare", method, METHODS)
