# SPDX-License-Identifier: LGPL-2.1-or-later
"""The shapes of a feature of a job in a document, and the feature made from them."""

from __future__ import annotations

import os
from collections.abc import Sequence
from dataclasses import replace
from typing import Any

from freecad_am import api
from freecad_am.brep.shapes.chosen import owners_of
from freecad_am.brep.shapes.overlap import touching
from freecad_am.core.issues import NOTE, InputError, Issue
from freecad_am.core.parameters.inspection import NONE as AS_MEASURED
from freecad_am.core.strategies.families import NONE, family_of
from freecad_am.objects.shapes.bodies import snapshot_of

from .features import UPRIGHT, about_feature, chosen, leans, planes_of
from .job import Job
from .part import bring
from .part_source import PartSource
from .scan_source import ScanSource

TOUCHING = 0.01  # mm
INSTEAD = "; but these end with {}, so planar layers are used instead"
FIXED = "; but with directions that follow it this ends with {}, so they are one (build_direction.mode: fixed)"


class Shapes:
    """The part of a feature, its substrate and fixtures, as objects of a document."""

    def __init__(self, document: Any, job: Job, number: int, fails: str = "") -> None:
        """fails: code of the error that curved layers, or directions that follow a wall, end with, which then are not
        chosen."""
        self.document, self.job, self.number, self.fails = document, job, number, fails
        self.of = job.features[number]
        self.scan: Any = (
            None  # the inspection of the substrate by its scan, once the feature is made
        )
        try:
            self.part = bring(document, self.of.part, meshes=family_of(self.of.strategy).meshes)
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
        """An error about the feature; it names the feature if the job has several."""
        if len(self.job.features) == 1:
            return error
        return about_feature(error, self.number, self.of.name, self.job.tree)

    def choose(self, earlier: Sequence[Any]) -> Issue | None:
        """Choose the family where the job leaves it open; a note that says what and why. Raises InputError."""
        if self.of.sections is None:
            return None
        from freecad_am.core.parameters.filled import GEODESIC, PLANES
        from freecad_am.objects.planned.proposed_family import (
            proposed,  # its imports take long
        )

        ground = (
            next(iter(self._touching_parts(earlier)), None)
            if self.substrate is None
            else self.substrate
        )
        try:
            planes = planes_of(self.of)
            proposal = proposed(
                snapshot_of(self.part),
                self.faces,
                None if ground is None else snapshot_of(ground),
                bool(self.of.part.start_edges),
                self.of.process.bead_width,
                self.job.cell is not None,
                base=() if self.of.substrate is None else self.of.substrate.faces,
                direction=planes.stacking(),
                layer_height=planes.layer_height,
            )
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
        """The feature, of the family of its strategy. earlier: parts that are deposited before;
        touching ones are substrate too. Raises InputError.
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
        """The points of a scan fitted to the substrate; after a layer not fitted, as the deposit is
        not modelled.
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
        """The object that guides layers, the part itself or one brought into the document, and its
        edges.
        """
        is_of_part = replace(source, edges=()) == replace(self.of.part, scale=1.0, solids=())
        owner = self.part if is_of_part else bring(self.document, source, "strategy.guide")
        return owner, list(source.edges) or [""]

    def _set_apart(self) -> None:
        """Copy the feature's own shape out of the file, so that other features may use the file
        too; only the feature gets its name.
        """
        self.part.Label = os.path.basename(self.of.part.file)
        if self.faces and _has_shape(self.part):
            self.part.Shape, self.faces = owners_of(self.part.Shape, self.faces)
            if not self.part.Shape.Solids and len(self.faces) == len(self.part.Shape.Faces):
                self.faces = ()
        self.part.purgeTouched()

    @property
    def solid(self) -> bool:
        """Whether the deposit is known as a solid that can carry others: not if only faces are
        chosen.
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
        """The carrier of the feature: its substrate and the touching earlier parts, as one object;
        None without any.
        """
        substrates = [] if self.substrate is None else [self.substrate]
        if not earlier or family_of(self.of.strategy).substrate == NONE:
            return self.substrate
        touched = self._touching_parts(earlier)
        if len(substrates + touched) < 2:
            return next(iter(substrates + touched), None)
        compound = self.document.addObject("Part::Compound", "Standing")
        compound.Label, compound.Links = f"What {self.of.name} stands on", substrates + touched
        compound.recompute()
        compound.purgeTouched()
        return compound


def toolpath_of(job: Job, document: Any, features: Sequence[Any], cell: Any, scan: Any) -> Any:
    """The toolpath of the features of a job; for one feature fitted to its scan, if any."""
    if len(features) == 1:
        fitting = (
            None
            if scan is None or job.features[0].scan is None
            else job.features[0].scan.parameters
        )
        return api.make_toolpath(
            document, features[0], cell, process=job.process, scan=scan, fitting=fitting
        )
    return api.make_toolpath(
        document,
        features,
        cell,
        sequence=job.sequence,
        process=job.process,
        processes=[feature.process for feature in job.features],
    )


def _has_shape(obj: Any) -> bool:
    shape = getattr(obj, "Shape", None)
    return shape is not None and not shape.isNull()
