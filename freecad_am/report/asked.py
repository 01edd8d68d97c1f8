# SPDX-License-Identifier: LGPL-2.1-or-later
"""What a report is about: a job, whether a file or a document told it."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

from freecad_am.core.issues import Issue
from freecad_am.core.parameters.build_direction import BuildDirectionParameters
from freecad_am.core.parameters.cell import CellParameters
from freecad_am.core.parameters.joints import JointParameters
from freecad_am.core.parameters.process import ProcessParameters
from freecad_am.core.parameters.strategy import LayerParameters
from freecad_am.core.toolpath import Toolpath
from freecad_am.core.types import Array

if TYPE_CHECKING:  # slow to import, and jobs without a cell have none
    from freecad_am.core.preflight.promise import Promise
    from freecad_am.objects.joint_path import Planned


@dataclass(frozen=True)
class Feature:
    """What is deposited, and how. shape: gives what was found of its part (the result of the stage)."""

    name: str
    strategy: LayerParameters
    build_direction: BuildDirectionParameters
    process: ProcessParameters
    shape: Callable[[], Any]


@dataclass(frozen=True)
class Job:
    """A job. process: of the program; features may differ from it. cell: None where a path alone is planned."""

    name: str
    features: tuple[Feature, ...]
    process: ProcessParameters
    joints: JointParameters
    cell: CellParameters | None


@dataclass(frozen=True)
class Results:
    """What was made of a job. toolpath: as it was cut. planned: None where there is no joint path; seconds: that it took.
    issues: of all stages. programs: names of the files. distances: between the layers as they are run. preflight: its
    promises."""

    toolpath: Toolpath
    planned: Planned | None
    seconds: float
    issues: Sequence[Issue]
    programs: Sequence[str]
    distances: Callable[[], Sequence[Array]]
    preflight: Callable[[], tuple[Promise, ...]]
