# SPDX-License-Identifier: LGPL-2.1-or-later
"""Open the shapes of the features of a job in a document, and create the features."""

from __future__ import annotations

import functools
import os
import re
from collections.abc import Sequence
from dataclasses import replace
from typing import Any

import FreeCAD as App

from freecad_am import api

from ...brep.shapes.chosen import owners_of, solids_of, touching
from ...core.families.family import NONE
from ...core.families.registry import family_of
from ...core.geometry.mesh.file_unit import MESHES
from ...core.issues import NOTE, InputError, Issue, Text
from ...core.parameters.inspection import NONE as AS_MEASURED
from ...core.parameters.process import ProcessParameters
from ...objects.shapes import linked_files
from ...objects.shapes.bodies import snapshot_of
from ...objects.shapes.part_file import add_part, changed_part
from .features import UPRIGHT, about_feature, chosen, leans, planes_of
from .job import Job
from .part_source import PartSource, ScanSource

PATIENCE = 100.0  # times as long as reading a document may take; building a part of other values may be long work
CELL_ADDRESS = re.compile("[A-Z]{1,2}[1-9][0-9]*")  # of a spreadsheet
UNIT_OF_BARE_NUMBERS = {"Length": "mm", "Angle": "deg"}  # in a cell that has a unit


def bring(document: Any, source: PartSource, key: str = "part", meshes: bool = False) -> Any:
    """Open the part, or another source named by the job's section `key`, as an object of the
    document.

    meshes: whether the part may be a mesh. Raises the InputErrors of `api.open_part`, NO_OBJECT and
    BAD_VALUE.
    """
    if key == "part" and not meshes and source.file.lower().endswith(MESHES):
        raise _no_surfaces()
    obj = _opened(document, source, key)
    if key == "part" and not meshes and getattr(obj, "Mesh", None) is not None:
        raise _no_surfaces()
    return _only_solids(obj, source, key)


def _no_surfaces() -> InputError:
    return InputError(
        "UNSUPPORTED_FILE",
        "part.file",
        "a mesh has no exact surfaces; for this strategy use STEP, IGES, BREP or FCStd; a mesh "
        "can serve as substrate or fixture",
    )


def _opened(document: Any, source: PartSource, key: str) -> Any:
    if not source.settings:
        return api.open_part(document, source.file, source.object or "", source.scale)
    shape, label, issues = changed_part(
        source.file,
        source.object or "",
        functools.partial(_change, part=source, section=key),
        f"{key}.set",
        PATIENCE,
    )
    return add_part(document, shape, label, issues)


def _only_solids(obj: Any, source: PartSource, key: str) -> Any:
    """Return the object with only its named solids. Raises InputError BAD_VALUE for a missing
    solid.
    """
    if not source.solids:
        return obj
    if getattr(obj, "Mesh", None) is not None:
        raise InputError(
            "BAD_VALUE",
            f"{key}.solids",
            "{} is a mesh without solids; remove `solids`",
            obj.Label,
        )
    solids = obj.Shape.Solids
    numbers = [int(name.removeprefix("Solid")) for name in source.solids]
    wrong = [name for name, number in zip(source.solids, numbers) if number > len(solids)]
    if wrong:
        raise InputError(
            "BAD_VALUE",
            f"{key}.solids",
            "{} has {} solid(s), but no {}; choose existing solids",
            obj.Label,
            len(solids),
            ", ".join(wrong),
        )
    obj.Shape = solids_of(obj.Shape, numbers)
    obj.Label = f"{obj.Label} {', '.join(source.solids)}"
    obj.purgeTouched()
    return obj


def _change(source: Any, part: PartSource, section: str) -> list[Any]:
    """Set properties of an open document, recompute it, and return the changed objects.

    Raises InputError BAD_PART, BAD_VALUE, NO_OBJECT.
    """
    changed = [_set(source, name, key, text, section) for name, key, text in part.settings]
    failed = {obj for obj in source.Objects if "Invalid" in obj.State}
    for linked_document in linked_files.in_order(source):
        linked_document.recompute()
    invalid = [obj.Label for obj in source.Objects if "Invalid" in obj.State and obj not in failed]
    if invalid:
        names = ", ".join(invalid)
        raise InputError(
            "BAD_PART",
            f"{section}.set",
            "{} cannot be built with these values; correct the values",
            names,
        )
    return changed


def _set(document: Any, name: str, key: str, text: str, section: str) -> Any:
    """Set a property of an object of the document, or of a linked object, and return the object."""
    where = f"{section}.set.{name}.{key}"
    name, constraints, _ = name.partition(".Constraints")
    matches: list[Any] = []
    for linked_document in reversed(linked_files.in_order(document)):
        matches = matches or [obj for obj in linked_document.Objects if obj.Name == name]
        matches = matches or linked_document.getObjectsByLabel(name)
    if len(matches) != 1:
        names = ", ".join(obj.Label for obj in matches or document.Objects) or "none"
        message = "no object is called {!r}; use an object of the document: {}"
        if matches:
            message = (
                "{!r} is the label of several objects ({}); use the name of the object instead"
            )
            names = ", ".join(obj.Name for obj in matches)
        raise InputError("NO_OBJECT", where, message, name, names)
    obj = matches[0]
    try:
        if constraints:
            _set_constraint(obj, key, text, where)
        elif obj.TypeId == "Spreadsheet::Sheet" and key not in ("Label", "Label2"):
            _set_cell(obj, key, text, where)
        elif key not in obj.PropertiesList:
            property_names = ", ".join(sorted(obj.PropertiesList))
            message = "{} has no property {!r}; use one of {}"
            raise InputError("BAD_VALUE", where, message, name, key, property_names)
        else:
            # the given value replaces an expression too
            obj.setExpression(key, None)
            setattr(obj, key, _typed(getattr(obj, key), text))
    except (ValueError, TypeError, ArithmeticError, RuntimeError, IndexError, NameError):
        message = Text(
            "{!r} does not fit the property; give a value of the same type as its current value",
            text,
        )
        raise InputError("BAD_VALUE", where, message) from None
    except AttributeError:
        message = Text("{} is computed and cannot be set here; set its inputs", key)
        raise InputError("BAD_VALUE", where, message) from None
    return obj


def _set_constraint(sketch: Any, name: str, text: str, where: str) -> None:
    """Set a named dimension of a sketch; remove an expression that drives the dimension."""
    constraints = [item for item in getattr(sketch, "Constraints", ()) if item.Name]
    if name not in [item.Name for item in constraints]:
        names = ", ".join(item.Name for item in constraints) or "none"
        message = "{} has no constraint with this name, only {}; name the constraint in the sketch"
        raise InputError("BAD_VALUE", where, message, sketch.Label, names)
    now = sketch.getDatum(name)
    sketch.setExpression(f"Constraints.{name}", None)
    sketch.setDatum(name, _typed(now, text))


def _set_cell(sheet: Any, key: str, text: str, where: str) -> None:
    """Set a cell of a spreadsheet by its alias or address; the unit of the cell stays."""
    address = sheet.getCellFromAlias(key) or key
    if not CELL_ADDRESS.fullmatch(address):
        message = "{} has no cell with the alias or address {!r}; check the spreadsheet"
        raise InputError("BAD_VALUE", where, message, sheet.Label, key)
    if not sheet.getContents(address):
        message = "cell {} of {} is empty; name a cell with a value"
        raise InputError("BAD_VALUE", where, message, address, sheet.Label)
    now = sheet.get(address)
    if isinstance(now, str):
        sheet.set(address, f"'{text}")
        return
    value = _typed(now if isinstance(now, App.Units.Quantity) else float(now), text)
    unit = ""
    if isinstance(value, App.Units.Quantity) and value.Unit != now.Unit:
        if now.Unit.Type not in UNIT_OF_BARE_NUMBERS:
            raise InputError("BAD_VALUE", where, "{!r} has no unit; add a unit", text)
        unit = UNIT_OF_BARE_NUMBERS[now.Unit.Type]
    sheet.set(address, f"={text} {unit}")


def _typed(now: Any, text: str) -> Any:
    """Convert the text to the type of the current value of the property."""
    if "," in text and not isinstance(now, str):
        raise ValueError(text)
    if isinstance(now, App.Units.Quantity):
        quantity = App.Units.Quantity(text)
        if quantity.Unit != now.Unit and quantity.Unit != App.Units.Unit():
            raise ValueError(text)
        return quantity
    if isinstance(now, bool):
        if text not in ("true", "false"):
            raise ValueError(text)
        return text == "true"
    if isinstance(now, int):
        return int(text)
    return float(text) if isinstance(now, float) else text


TOUCHING = 0.01  # mm
INSTEAD = "; but curved layers end with {}, so planar layers are used"
FIXED = "; but tool directions that follow the wall end with {}, so all directions are the same (build_direction.mode: fixed)"


class Shapes:
    """The part, substrate and fixtures of a feature as objects of a document."""

    def __init__(self, document: Any, job: Job, number: int, fails: str = "") -> None:
        """Open the shapes of feature `number`.

        fails: code of the error of curved layers, or of directions that follow a wall, which are
        then not chosen.
        """
        self.document, self.job, self.number, self.fails = document, job, number, fails
        self.of = job.features[number]
        self.scan: Any = (
            None  # the inspection of the substrate by its scan, once the feature is made
        )
        try:
            self.part = bring(
                document, self.of.part, meshes=family_of(self.of.strategy).takes_meshes
            )
            self.substrate = (
                None
                if self.of.substrate is None
                else bring(document, self.of.substrate, "substrate")
            )
            self.guide = None if self.of.guide is None else self._guide(self.of.guide)
            self.faces = (*self.of.part.edges, *self.of.part.faces)
            if len(job.features) > 1:
                self._set_apart()
            self.fixtures = [
                bring(document, fixture, f"fixtures[{k}]")
                for k, fixture in enumerate(self.of.fixtures)
            ]
        except InputError as error:
            raise self.name_feature(error) from None

    def name_feature(self, error: InputError) -> InputError:
        """Return the error, with the name of the feature if the job has several."""
        if len(self.job.features) == 1:
            return error
        return about_feature(error, self.number, self.of.name, self.job.tree)

    def choose(self, earlier: Sequence[Any]) -> Issue | None:
        """Choose the family if the job leaves it open, and return a note with the reason.

        Raises InputError.
        """
        if self.of.sections is None:
            return None
        from freecad_am.core.parameters.filled import GEODESIC, PLANES
        from freecad_am.objects.families.recognition import SelectedPart  # its imports take long
        from freecad_am.objects.families.registry import propose_family

        ground = (
            next(iter(self._touching_parts(earlier)), None)
            if self.substrate is None
            else self.substrate
        )
        try:
            planes = planes_of(self.of)
            part = SelectedPart(
                snapshot_of(self.part),
                self.faces,
                None if ground is None else snapshot_of(ground),
                bool(self.of.part.start_edges),
                self.of.process.bead_width,
                self.job.cell is not None,
                base=() if self.of.substrate is None else self.of.substrate.faces,
                direction=planes.direction,
                layer_height=planes.layer_height,
            )
            proposal = propose_family(part)
            if proposal.layers == GEODESIC and self.fails:
                proposal = replace(
                    proposal, layers=PLANES, reason=proposal.reason + INSTEAD.format(self.fails)
                )
            chosen_feature = chosen(self.of, proposal.kind, proposal.layers, proposal.mend)
            if self.fails and leans(self.of, chosen_feature.strategy):
                proposal = replace(proposal, reason=proposal.reason + FIXED.format(self.fails))
                chosen_feature = chosen(
                    self.of, proposal.kind, proposal.layers, proposal.mend, UPRIGHT
                )
            self.of = chosen_feature
        except InputError as error:
            raise self.name_feature(error) from None
        return Issue(NOTE, "PROPOSED", proposal.text())

    def make_feature(self, earlier: Sequence[Any]) -> Any:
        """Create the feature of the strategy's family.

        earlier: parts that are deposited before; parts that touch the feature are added to the
        substrate. Raises InputError.
        """
        several = len(self.job.features) > 1
        substrate = self._standing(earlier)
        bases = () if self.of.substrate is None else self.of.substrate.faces
        links = {
            "Substrate": substrate,
            "Fixtures": self.fixtures,
            "StartEdges": self.of.part.start_edges,
            "BaseFaces": bases,
            "Guide": self.guide,
            "StartFaces": list(self.of.start_faces),
        }
        try:
            feature = api.make_feature_of(
                self.document,
                family_of(self.of.strategy).kind,
                self.part,
                self.faces,
                label=self.of.name if several else "Feature",
                links=links,
                parameters=[self.of.strategy, self.of.build_direction],
            )
            chord_error = float(feature.ChordError)
            if chord_error != self.of.strategy.chord_error:
                self.of = replace(
                    self.of, strategy=replace(self.of.strategy, chord_error=chord_error)
                )
            self.scan = None if self.of.scan is None else self._scan(self.of.scan)
            return feature
        except InputError as error:
            raise self.name_feature(error) from None

    def _scan(self, source: ScanSource) -> Any:
        """Create the inspection of the substrate by its scan.

        A scan after a layer is not fitted, because the deposit is not modelled.
        """
        if source.parameters.after_layer is not None:
            return api.inspect(
                self.document, self.part, source.file, "Scan", unit=source.unit, fit=AS_MEASURED
            )
        return api.make_scan(
            self.document,
            self.substrate,
            source.file,
            fit=source.fit,
            unit=source.unit,
            pairs=source.pairs,
            within=source.parameters.scan_within,
        )

    def _guide(self, source: PartSource) -> tuple[Any, list[str]]:
        """Return the guide object, which is the part or an opened file, and its edges."""
        is_of_part = replace(source, edges=()) == replace(self.of.part, scale=1.0, solids=())
        owner = self.part if is_of_part else bring(self.document, source, "strategy.guide")
        return owner, list(source.edges) or [""]

    def _set_apart(self) -> None:
        """Copy the shape of the feature out of the file, so that other features can use the file
        too.

        Only the feature gets the name of the file.
        """
        self.part.Label = os.path.basename(self.of.part.file)
        if self.faces and _has_shape(self.part):
            self.part.Shape, self.faces = owners_of(self.part.Shape, self.faces)
            if not self.part.Shape.Solids and len(self.faces) == len(self.part.Shape.Faces):
                self.faces = ()
        self.part.purgeTouched()

    @property
    def solid(self) -> bool:
        """Whether the deposit is a known solid that can support other features; False if faces are
        selected.
        """
        return _has_shape(self.part) and bool(self.part.Shape.Solids) and not self.faces

    def _touching_parts(self, earlier: Sequence[Any]) -> list[Any]:
        if not _has_shape(self.part):
            return []
        return [
            earlier_part
            for earlier_part in earlier
            if touching(self.part.Shape, earlier_part.Shape, TOUCHING)
        ]

    def _standing(self, earlier: Sequence[Any]) -> Any:
        """Return the support of the feature: its substrate and the touching earlier parts as one
        object.

        None without a support.
        """
        substrates = [] if self.substrate is None else [self.substrate]
        if not earlier or family_of(self.of.strategy).substrate == NONE:
            return self.substrate
        touched = self._touching_parts(earlier)
        if len(substrates + touched) < 2:
            return next(iter(substrates + touched), None)
        compound = self.document.addObject("Part::Compound", "Standing")
        compound.Label, compound.Links = f"Support of {self.of.name}", substrates + touched
        compound.recompute()
        compound.purgeTouched()
        return compound


def toolpath_of(job: Job, document: Any, features: Sequence[Any], cell: Any, scan: Any) -> Any:
    """Create the toolpath of the features of a job; a single feature is fitted to its scan, if any."""
    if len(features) == 1:
        fitting = (
            None
            if scan is None or job.features[0].scan is None
            else job.features[0].scan.parameters
        )
        process, zones = _bring_zones(document, job)
        return api.make_toolpath(
            document,
            features[0],
            cell,
            process=process,
            scan=scan,
            fitting=fitting,
            zones=zones,
        )
    return api.make_toolpath(
        document,
        features,
        cell,
        sequence=job.sequence,
        process=job.process,
        processes=[feature.process for feature in job.features],
    )


def _bring_zones(document: Any, job: Job) -> tuple[ProcessParameters, list[Any]]:
    """The process with settings by place that name objects of the document, and these objects."""
    objects: dict[str, Any] = {}
    for name, source in job.features[0].zones:
        number = next(k for k, setting in enumerate(job.process.settings) if setting.inside == name)
        objects[name] = bring(document, source, f"settings[{number}].where.inside", meshes=True)
        if getattr(objects[name], "ViewObject", None) is not None:
            objects[name].ViewObject.Visibility = False
    settings = tuple(
        replace(setting, inside=objects[setting.inside].Name) if setting.inside else setting
        for setting in job.process.settings
    )
    return replace(job.process, settings=settings), list(objects.values())


def _has_shape(obj: Any) -> bool:
    shape = getattr(obj, "Shape", None)
    return shape is not None and not shape.isNull()
