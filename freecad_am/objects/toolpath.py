# SPDX-License-Identifier: LGPL-2.1-or-later
"""Toolpath stage: layers and beads with build directions, from one feature or a sequence."""

from __future__ import annotations

import dataclasses
import json
from collections.abc import Callable
from typing import TYPE_CHECKING, Any

from ..core.issues import InputError, Text
from ..core.parameters.build_direction import BuildDirectionParameters
from ..core.parameters.cell import CellParameters
from ..core.parameters.field import VECTOR, spec_of
from ..core.parameters.process import OF_FEATURE, ProcessParameters
from ..core.parameters.scan import ScanParameters
from ..core.parameters.strategy import RevolutionParameters, SurfaceParameters
from ..core.process import wire
from ..core.process.deposit import balance as deposit_balance
from ..core.strategies.by_place import Zone
from ..core.strategies.sequence import BY_FEATURE, BY_HEIGHT
from ..core.toolpath import Toolpath as CoreToolpath
from .checks.deposit import check_on_part
from .families.given import Given
from .fields import rows
from .planned.in_sequence import member, planned_in_sequence
from .planned.toolpaths import in_planes, planned, seen_of, try_remedy, zones_of
from .results import fingerprints
from .results.fingerprints import fingerprint
from .shapes.bodies import snapshot_of
from .stage import Stage, stage_of
from .stage_parts import Link, Outcome, Section, Work

if TYPE_CHECKING:
    from ..core.planning.other_cells import Fixed
    from .checks.predicted_shape import Target

FIXED = "fixed"
LEANING = (
    RevolutionParameters,
    SurfaceParameters,
)  # strategies whose build directions follow the wall, unless the mode is FIXED


class Toolpath(Stage):
    """Result: core.toolpath.Toolpath. Without a cell: default nozzle shape and no platform.

    FeatureProcess: for several features, the process differences of each feature, as JSON by row
    key in inner units.
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
            "Further features, deposited after the first feature in this order.",
            required=False,
            type_name="App::PropertyLinkList",
        ),
        Link("Cell", "cell", "The cell, for the clearance of nozzle and platform.", required=False),
        Link(
            "Scan",
            "inspection",
            "An inspection with a scan of the substrate, to which the first layers are fitted.",
            required=False,
        ),
        Link(
            "Zones",
            "",
            "Closed solids and meshes in which settings by place apply.",
            required=False,
            type_name="App::PropertyLinkList",
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
                "Several features: one after the other, or the lowest layer of any feature first.",
            )
            obj.Sequence = [BY_FEATURE, BY_HEIGHT]
            obj.addProperty(
                "App::PropertyStringList",
                "FeatureProcess",
                "Inputs",
                "Several features: process settings that differ for each, as JSON.",
            )
        super().complete(obj)

    def key(self, obj: Any) -> str:
        """Return the fingerprint of the inputs. Of the cell, only the content of `seen_of` counts.

        The cell's position and machine affect joint paths only. An up-to-date result of an earlier
        version keeps the base class key, which covers the whole cell.
        """
        key = fingerprints.key_of_inputs(self, obj, _input_key)
        fits_old_key = obj.Key not in ("", key) and obj.Key == super().key(obj)
        return str(obj.Key) if fits_old_key else key

    def prepare(self, obj: Any) -> Work:
        for following in obj.InList:
            stage = stage_of(following)
            if stage is not None and stage.kind == "joint path":
                following.Proxy.look_ahead(following)
        linked = self.linked(obj)
        features = [linked["Feature"], *linked["Further"]]
        cell = _cell(obj)
        zones = self.zones(obj, self.parameters(obj, ProcessParameters))
        inputs = [
            _feature_inputs(feature, process, cell, zones)
            for feature, process in zip(features, self.processes(obj), strict=True)
        ]
        fixed, look = self.fixed(obj), self._look(obj)
        if len(features) > 1:
            if obj.Scan is not None:
                raise InputError(
                    "NOT_YET",
                    f"{obj.Label}.Scan",
                    "several features together cannot be fitted to a scan yet; remove the scan, "
                    "or deposit the features one by one",
                )
            members = [
                member(feature, entry, features)
                for feature, entry in zip(features, inputs, strict=True)
            ]
            names = [tuple(entry.Name for entry in _sources(feature)) for feature in features]
            order = obj.Sequence
            return lambda: _outcome(
                try_remedy(look(planned_in_sequence(members, order, names)), fixed)
            )
        sources = tuple(snapshot_of(entry) for entry in _sources(features[0]))
        fit = self._fit(obj)

        def work() -> Outcome:
            planned_toolpath = planned(inputs[0]) if fit is None else planned(inputs[0], fit)
            toolpath = check_on_part(planned_toolpath, inputs[0], sources)
            balance_issues = deposit_balance.issues(
                deposit_balance.toolpath_balance(
                    inputs[0].wall, toolpath, inputs[0].process.bead_width
                )
            )
            alternative = in_planes(inputs[0], fit) if fixed is None else fixed
            return _outcome(
                try_remedy(
                    look(dataclasses.replace(toolpath, issues=(*balance_issues, *toolpath.issues))),
                    alternative,
                )
            )

        return work

    def targets(self, obj: Any) -> list[Target]:
        """Return the target of each feature, independent of the document. Raises InputError."""
        features = features_of(obj)
        cell, zones = _cell(obj), self.zones(obj, self.parameters(obj, ProcessParameters))
        from .checks.predicted_shape import Target

        return [
            Target(
                _feature_inputs(feature, process, cell, zones),
                tuple(map(snapshot_of, _sources(feature))),
                tuple(feature.Source[1]),
            )
            for feature, process in zip(features, self.processes(obj), strict=True)
        ]

    def _look(self, obj: Any) -> Callable[[CoreToolpath], CoreToolpath]:
        """Return a function that compares the predicted deposit with the part.

        Without a machining allowance, the function returns the toolpath unchanged.
        """
        allowance = self.parameters(obj, ProcessParameters).machining_allowance
        if allowance is None:
            return lambda toolpath: toolpath
        from .checks import predicted_shape  # only jobs with an allowance need this import

        targets = self.targets(obj)
        return lambda toolpath: predicted_shape.add_shape_issues(toolpath, targets, allowance)

    def _fit(self, obj: Any) -> Callable[[CoreToolpath], CoreToolpath] | None:
        """Return a function that fits the layers to the scan; None without a scan.

        Raises InputError.
        """
        parameters = self.parameters(obj, ScanParameters)
        if obj.Scan is None:
            return None
        from .planned.scan import fit_of  # only jobs with a scan need this import

        return fit_of(obj, parameters)

    def processes(self, obj: Any) -> list[ProcessParameters]:
        """Return the process of each feature.

        Raises InputError for parameters that a feature cannot override.
        """
        process = self.parameters(obj, ProcessParameters)
        texts = [*obj.FeatureProcess, *[""] * (1 + len(obj.Further))][: 1 + len(obj.Further)]
        feature_processes = []
        for text in texts:
            try:
                own_values = json.loads(text) if text else {}
            except (ValueError, RecursionError):
                own_values = None
            if not isinstance(own_values, dict) or not set(own_values) <= set(OF_FEATURE):
                raise InputError(
                    "BAD_VALUE",
                    f"{obj.Label}.FeatureProcess",
                    "{!r} is not understood; give a JSON mapping with keys of {}",
                    text,
                    ", ".join(OF_FEATURE),
                )
            feature_processes.append(
                rows.build(ProcessParameters, {**rows.flat(process), **own_values})
                if own_values
                else process
            )
        return feature_processes

    def fixed(self, obj: Any) -> Fixed | None:
        """Return a function that plans the toolpath with the part axis as the only build direction.

        The function does not use the document. With several features, only walls change. Return
        None without walls, or if the walls already have a fixed build direction.
        """
        from ..core.planning.other_cells import Fixed

        features = features_of(obj)
        shapes = [stage_of(entry) for entry in features]
        if not features or None in shapes:
            return None
        turned = [
            strategy_of(shape) in LEANING
            and shape.parameters(entry, BuildDirectionParameters).mode != FIXED
            for entry, shape in zip(features, shapes, strict=True)
        ]
        if not any(turned):
            return None
        process = self.parameters(obj, ProcessParameters)
        carried, zones = _cell(obj), self.zones(obj, process)
        if len(features) > 1:
            inputs_of_features = [
                _feature_inputs(entry, feature_process, carried, zones)
                for entry, feature_process in zip(features, self.processes(obj), strict=True)
            ]
            inputs_of_features = [
                _upright(entry) if turn else entry
                for entry, turn in zip(inputs_of_features, turned, strict=True)
            ]
            members = [
                member(entry, inputs, features)
                for entry, inputs in zip(features, inputs_of_features, strict=True)
            ]
            names, order = (
                [tuple(entry.Name for entry in _sources(feature)) for feature in features],
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
            inputs = _upright(Given(wall(), strategy, build, process, carried, zones=zones))
            return planned(inputs) if fit is None else planned(inputs, fit)

        return Fixed("`build_direction.mode: fixed`", make)

    def zones(self, obj: Any, process: ProcessParameters) -> tuple[Zone, ...]:
        """Return the geometry of each setting by place of a process; empty without settings.

        Raises InputError NOT_YET for several features, and the InputErrors of `zones_of`.
        """
        if not process.settings:
            return ()
        if obj.Further:
            raise InputError(
                "NOT_YET",
                f"{obj.Label}.Settings",
                "settings by place are for one feature yet; remove them, or put each feature in its "
                "own job",
            )
        return zones_of(process.settings, obj.Zones, obj.Feature.Source[0])

    def own_speeds(self, obj: Any) -> tuple[bool, ...]:
        """Return for each of several features whether its travel speed differs from the job's.

        Empty for one feature.
        """
        if not obj.Further:
            return ()
        speed = self.parameters(obj, ProcessParameters).travel_speed
        return tuple(
            feature_process.travel_speed != speed for feature_process in self.processes(obj)
        )

    def further_inputs(self, obj: Any) -> list[str]:
        processes = self.processes(obj)
        models = [
            wire.load(feature_process.bead_model)
            for feature_process in processes
            if feature_process.bead_model != "none"
        ]
        sequence = [obj.Sequence, *obj.FeatureProcess] if obj.Further else []
        zones = [text for zone in obj.Zones for text in (zone.Name, zone.Label, fingerprint(zone))]
        return [*map(repr, models), *sequence, *zones]


def own_process(process: ProcessParameters, of_job: ProcessParameters) -> str:
    """Return the differences between a feature's process and the job's process, for FeatureProcess.

    Raises InputError for parameters that a feature cannot override.
    """
    job = rows.flat(of_job)
    differences = {key: value for key, value in rows.flat(process).items() if value != job[key]}
    shared = sorted(set(differences) - set(OF_FEATURE))
    if shared:
        raise InputError(
            "NOT_FOR_FEATURE",
            f"process.{shared[0]}",
            "the setting applies to the whole program, not to one feature; move it to the top "
            "level",
        )
    return json.dumps(differences) if differences else ""


def features_of(obj: Any) -> list[Any]:
    """Return the feature objects of a toolpath object, in order."""
    return [feature for feature in (obj.Feature, *obj.Further) if feature is not None]


def strategy_of(feature: Stage) -> type:
    """Return the parameter dataclass of a feature's strategy."""
    return next(section.cls for section in feature.sections if section.prefix == "strategy")


def _sources(feature: Any) -> tuple[Any, ...]:
    """Return the source objects of a feature."""
    return (feature.Source[0], *getattr(feature, "Further", ()))


def _input_key(link: str, linked: Any) -> str:
    return (
        _key_of_cell(seen_of(linked.Proxy.value(linked)))
        if link == "Cell"
        else fingerprints.key_of_stage(link, linked)
    )


def _key_of_cell(cell: CellParameters) -> str:
    """Return the representation of a cell with vectors as text, the same for all versions."""
    values = []
    for field in dataclasses.fields(cell):
        value, spec = getattr(cell, field.name), spec_of(field)
        if spec.kind == VECTOR and spec.records is not None:
            value = spec.records.text(value)
        values.append(f"{field.name}={value!r}")
    return f"{type(cell).__name__}({', '.join(values)})"


def _cell(obj: Any) -> CellParameters | None:
    """Return the part of the cell that affects toolpath planning; None without a cell."""
    return None if obj.Cell is None else seen_of(obj.Cell.Proxy.value(obj.Cell))


def _feature_inputs(
    feature: Any,
    process: ProcessParameters,
    cell: CellParameters | None,
    zones: tuple[Zone, ...],
) -> Given:
    shape = stage_of(feature)
    assert shape is not None
    strategy, build = (
        shape.parameters(feature, strategy_of(shape)),
        shape.parameters(feature, BuildDirectionParameters),
    )
    return Given(shape.value(feature), strategy, build, process, cell, zones=zones)


def _upright(inputs: Given) -> Given:
    """Return the inputs with the part axis as the only build direction."""
    return dataclasses.replace(inputs, build=dataclasses.replace(inputs.build, mode=FIXED))


def _outcome(toolpath: CoreToolpath) -> Outcome:
    figures = (
        ("Layers", len(toolpath.layers)),
        ("Beads", toolpath.bead_count),
        ("Points", toolpath.point_count),
        ("Length", toolpath.length),
    )
    return Outcome(toolpath, toolpath.issues, figures)
