# SPDX-License-Identifier: LGPL-2.1-or-later
"""The toolpath in a document: layers and beads with build directions, made from a feature, or from several in a sequence."""

from __future__ import annotations

import dataclasses
import json
from collections.abc import Callable
from typing import TYPE_CHECKING, Any

from ..core.issues import InputError, Text
from ..core.parameters.build_direction import BuildDirectionParameters
from ..core.parameters.cell import CellParameters
from ..core.parameters.process import OF_FEATURE, ProcessParameters
from ..core.parameters.scan import ScanParameters
from ..core.parameters.strategy import RevolutionParameters, SurfaceParameters
from ..core.process.deposit import balance as deposit_balance
from ..core.process.model import bead_table
from ..core.strategies.sequence import BY_FEATURE, BY_HEIGHT
from ..core.toolpath import Toolpath as CoreToolpath
from .checks.on_its_part import looked_at
from .fields import rows
from .planned.in_sequence import member, planned_in_sequence
from .planned.toolpaths import Given, planned, seen_of
from .planned.upright import in_planes, with_remedy
from .results import keys
from .shapes.bodies import taken
from .stage import Stage, stage_of
from .stage_parts import Link, Outcome, Section, Work

if TYPE_CHECKING:
    from ..core.planning.tried import Fixed
    from .checks.predicted_shape import Target

FIXED = "fixed"
LEANING = (
    RevolutionParameters,
    SurfaceParameters,
)  # whose build directions follow the wall, unless asked to be one


class Toolpath(Stage):
    """Result: core.toolpath.Toolpath. Without a cell the nozzle has its default shape and there is no platform.

    FeatureProcess: of several features, what differs of each one's process, as JSON by row key in inner values.
    """

    kind = "toolpath"
    sections = (
        Section(ProcessParameters, "process", "Process"),
        Section(ScanParameters, "substrate", "Scan"),
    )
    links = (
        Link("Feature", "feature", "The feature to deposit."),
        Link(
            "Further",
            "feature",
            "Further features, deposited after it in this order.",
            required=False,
            type_name="App::PropertyLinkList",
        ),
        Link("Cell", "cell", "The cell, for the clearance of nozzle and platform.", required=False),
        Link(
            "Scan",
            "inspection",
            "An inspection of the substrate by a scan of it, which the first layers are fitted to.",
            required=False,
        ),
    )
    figures = (
        ("Layers", "App::PropertyInteger", "Number of layers."),
        ("Beads", "App::PropertyInteger", "Number of beads."),
        ("Points", "App::PropertyInteger", "Number of points of all beads."),
        ("Length", "App::PropertyLength", "Length of all beads."),
    )

    def complete(self, obj: Any) -> None:
        if "Sequence" not in obj.PropertiesList:
            obj.addProperty(
                "App::PropertyEnumeration",
                "Sequence",
                "Inputs",
                "Several features: one after the other, or the lowest layer of all first.",
            )
            obj.Sequence = [BY_FEATURE, BY_HEIGHT]
            obj.addProperty(
                "App::PropertyStringList",
                "FeatureProcess",
                "Inputs",
                "Several features: what of the process differs for each, as JSON.",
            )
        super().complete(obj)

    def key(self, obj: Any) -> str:
        """As of any stage, but of its cell what `seen_of` leaves is all: where a part stands, and which machine deposits it,
        is for joint paths. In a document from before, which fits yet, as of any stage."""
        key = keys.of_inputs(self, obj, _input_key)
        before = obj.Key not in ("", key) and obj.Key == super().key(obj)
        return str(obj.Key) if before else key

    def prepare(self, obj: Any) -> Work:
        for following in obj.InList:
            stage = stage_of(following)
            if stage is not None and stage.kind == "joint path":
                following.Proxy.look_ahead(following)
        linked = self.linked(obj)
        features = [linked["Feature"], *linked["Further"]]
        cell = _cell(obj)
        given = [
            _given(feature, process, cell)
            for feature, process in zip(features, self.processes(obj), strict=True)
        ]
        fixed, look = self.fixed(obj), self._look(obj)
        if len(features) > 1:
            if obj.Scan is not None:
                raise InputError(
                    "NOT_YET",
                    f"{obj.Label}.Scan",
                    "several features in one go are not fitted to a scan yet; "
                    "leave it out, or deposit them one by one",
                )
            members = [
                member(feature, one, features) for feature, one in zip(features, given, strict=True)
            ]
            names = [tuple(one.Name for one in _sources(feature)) for feature in features]
            order = obj.Sequence
            return lambda: _outcome(
                with_remedy(look(planned_in_sequence(members, order, names)), fixed)
            )
        sources = tuple(taken(one) for one in _sources(features[0]))
        fit = self._fit(obj)

        def work() -> Outcome:
            made = planned(given[0]) if fit is None else planned(given[0], fit)
            toolpath = looked_at(made, given[0], sources)
            more = deposit_balance.issues(
                deposit_balance.toolpath_balance(
                    given[0].wall, toolpath, given[0].process.bead_width
                )
            )
            other = in_planes(given[0], fit) if fixed is None else fixed
            return _outcome(
                with_remedy(
                    look(dataclasses.replace(toolpath, issues=(*more, *toolpath.issues))), other
                )
            )

        return work

    def targets(self, obj: Any) -> list[Target]:
        """What each of its features is to deposit, for work that does not touch the document. InputError."""
        features = features_of(obj)
        cell = _cell(obj)
        from .checks.predicted_shape import Target

        return [
            Target(
                _given(one, process, cell), tuple(map(taken, _sources(one))), tuple(one.Source[1])
            )
            for one, process in zip(features, self.processes(obj), strict=True)
        ]

    def _look(self, obj: Any) -> Callable[[CoreToolpath], CoreToolpath]:
        """What compares the predicted deposit with the part where an allowance is asked for; else nothing."""
        allowance = self.parameters(obj, ProcessParameters).machining_allowance
        if allowance is None:
            return lambda made: made
        from .checks import predicted_shape  # jobs without an allowance need none of it

        targets = self.targets(obj)
        return lambda made: predicted_shape.with_shape_issues(made, targets, allowance)

    def _fit(self, obj: Any) -> Callable[[CoreToolpath], CoreToolpath] | None:
        """What fits the layers to a scan; None without one. InputError."""
        parameters = self.parameters(obj, ScanParameters)
        if obj.Scan is None:
            return None
        from .planned.scan import fit_of  # jobs without a scan need none of it

        return fit_of(obj, parameters)

    def processes(self, obj: Any) -> list[ProcessParameters]:
        """The process of each feature. InputError for what of it no feature has of its own."""
        process = self.parameters(obj, ProcessParameters)
        texts = [*obj.FeatureProcess, *[""] * (1 + len(obj.Further))][: 1 + len(obj.Further)]
        found = []
        for text in texts:
            try:
                own = json.loads(text) if text else {}
            except (ValueError, RecursionError):
                own = None
            if not isinstance(own, dict) or not set(own) <= set(OF_FEATURE):
                raise InputError(
                    "BAD_VALUE",
                    f"{obj.Label}.FeatureProcess",
                    "{!r} is not understood; give a JSON mapping with keys of {}",
                    text,
                    ", ".join(OF_FEATURE),
                )
            found.append(
                rows.build(ProcessParameters, {**rows.flat(process), **own}) if own else process
            )
        return found

    def fixed(self, obj: Any) -> Fixed | None:
        """The toolpath with one build direction, the axis of the part, made anew without the document; None where it has
        that, and without walls. Of several features those alone are changed."""
        from ..core.planning.tried import Fixed

        features = features_of(obj)
        shapes = [stage_of(one) for one in features]
        if not features or None in shapes:
            return None
        turned = [
            strategy_of(shape) in LEANING
            and shape.parameters(one, BuildDirectionParameters).mode != FIXED
            for one, shape in zip(features, shapes, strict=True)
        ]
        if not any(turned):
            return None
        process = self.parameters(obj, ProcessParameters)
        carried = _cell(obj)
        if len(features) > 1:
            made = [
                _given(one, own, carried)
                for one, own in zip(features, self.processes(obj), strict=True)
            ]
            made = [_upright(one) if turn else one for one, turn in zip(made, turned, strict=True)]
            members = [
                member(one, given, features) for one, given in zip(features, made, strict=True)
            ]
            names, order = (
                [tuple(one.Name for one in _sources(feature)) for feature in features],
                obj.Sequence,
            )
            fixed = (
                f"`features[{k}].build_direction.mode: fixed`"
                for k, turn in enumerate(turned)
                if turn
            )
            text = Text.joined(" and ", fixed)
            return Fixed(text, lambda: planned_in_sequence(members, order, names))
        shape, feature = shapes[0], features[0]
        wall, strategy = shape.reader(feature), shape.parameters(feature, strategy_of(shape))
        build, fit = shape.parameters(feature, BuildDirectionParameters), self._fit(obj)

        def make() -> CoreToolpath:
            given = _upright(Given(wall(), strategy, build, process, carried))
            return planned(given) if fit is None else planned(given, fit)

        return Fixed("`build_direction.mode: fixed`", make)

    def own_speeds(self, obj: Any) -> tuple[bool, ...]:
        """Of several features, whether each has a travel speed of its own; of one nothing."""
        if not obj.Further:
            return ()
        speed = self.parameters(obj, ProcessParameters).travel_speed
        return tuple(one.travel_speed != speed for one in self.processes(obj))

    def further_inputs(self, obj: Any) -> list[str]:
        processes = self.processes(obj)
        models = [bead_table.load(one.bead_model) for one in processes if one.bead_model != "none"]
        sequence = [obj.Sequence, *obj.FeatureProcess] if obj.Further else []
        return [*map(repr, models), *sequence]


def own_process(process: ProcessParameters, of_job: ProcessParameters) -> str:
    """What of a feature's process differs from that of the job, as FeatureProcess has it. InputError for what no feature has
    of its own."""
    job = rows.flat(of_job)
    own = {key: value for key, value in rows.flat(process).items() if value != job[key]}
    shared = sorted(set(own) - set(OF_FEATURE))
    if shared:
        raise InputError(
            "NOT_FOR_FEATURE",
            f"process.{shared[0]}",
            "it holds for the whole program, not for one of its features; give it at the top level",
        )
    return json.dumps(own) if own else ""


def features_of(obj: Any) -> list[Any]:
    """The feature objects of a toolpath object, in their order."""
    return [one for one in (obj.Feature, *obj.Further) if one is not None]


def strategy_of(feature: Stage) -> type:
    """The parameters dataclass of a feature's strategy."""
    return next(section.cls for section in feature.sections if section.prefix == "strategy")


def _sources(feature: Any) -> tuple[Any, ...]:
    """The objects that a feature is made of."""
    return (feature.Source[0], *getattr(feature, "Further", ()))


def _input_key(link: str, linked: Any) -> str:
    return (
        repr(seen_of(linked.Proxy.value(linked))) if link == "Cell" else keys.of_all(link, linked)
    )


def _cell(obj: Any) -> CellParameters | None:
    """What a toolpath is planned by of its cell."""
    return None if obj.Cell is None else seen_of(obj.Cell.Proxy.value(obj.Cell))


def _given(feature: Any, process: ProcessParameters, cell: CellParameters | None) -> Given:
    shape = stage_of(feature)
    assert shape is not None
    strategy, build = (
        shape.parameters(feature, strategy_of(shape)),
        shape.parameters(feature, BuildDirectionParameters),
    )
    return Given(shape.value(feature), strategy, build, process, cell)


def _upright(given: Given) -> Given:
    """The same with the axis of the part as its one build direction."""
    return dataclasses.replace(given, build=dataclasses.replace(given.build, mode=FIXED))


def _outcome(toolpath: CoreToolpath) -> Outcome:
    figures = (
        ("Layers", len(toolpath.layers)),
        ("Beads", toolpath.bead_count),
        ("Points", toolpath.point_count),
        ("Length", toolpath.length),
    )
    return Outcome(toolpath, toolpath.issues, figures)
