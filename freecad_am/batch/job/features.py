# SPDX-License-Identifier: LGPL-2.1-or-later
"""The features of a job: source, substrate and strategy, each merged with the keys of the job."""

from __future__ import annotations

import dataclasses
from dataclasses import dataclass
from typing import Any

import numpy as np

from ...core.families.family import NONE, Family
from ...core.families.registry import AUTO, DEFAULT_KIND, KINDS, family_of, find_family
from ...core.issues import InputError
from ...core.parameters import field as f
from ...core.parameters.build_direction import BuildDirectionParameters
from ...core.parameters.filled import FilledParameters, SolidParameters
from ...core.parameters.process import ProcessParameters
from ...core.parameters.strategy import LayerParameters
from ...core.process import wire
from ...core.process.wire import model_wire_feed
from ...objects.fields import quantities
from ...sections import fields, tree
from .feature_sections import (
    kept_clear,
    process_of,
    refuse_direction,
    settings_of,
    strategy_of,
    substrate_of,
)
from .part_source import (
    PartSource,
    ScanSource,
    faces_of,
    fixtures_of,
    guide_of,
    part_of,
    scan_of,
    split,
)

WORD = "auto"
HEIGHT, SPACING = "layer_height", "bead_spacing"


def asked(section: Any) -> bool:
    """Whether a section `strategy` leaves layer height or spacing to the bead model."""
    return isinstance(section, dict) and WORD in (section.get(HEIGHT), section.get(SPACING))


def resolved(section: dict[str, Any], process: ProcessParameters) -> dict[str, Any]:
    """Return the section with words replaced by numbers.

    The layer height is the height of a straight bead. The spacing is chosen so that spacing times
    layer height equals the wire volume per millimetre of bead, so that the fed wire fills the
    layer. Raises InputError BAD_VALUE without a bead model, or if the spacing would exceed the bead
    width.
    """
    key = HEIGHT if section.get(HEIGHT) == WORD else SPACING
    model = wire.process_model(process)
    if model is None:
        raise InputError(
            "BAD_VALUE",
            f"strategy.{key}",
            "auto needs a bead model, but the job has no bead model; give a length, "
            "process.bead_model, or a process.material with a bead model",
        )
    speed = model.straight_speed(process.bead_width)
    section_with_numbers = dict(section)
    if section_with_numbers.get(HEIGHT) == WORD:
        height = float(model.heights(np.array([speed]), np.array([np.inf]))[0])
        section_with_numbers[HEIGHT] = f"{height!r} mm"
    if section_with_numbers.get(SPACING) == WORD:
        height = quantities.read(
            section_with_numbers.get(HEIGHT, 1.0), f.LENGTH, f"strategy.{HEIGHT}"
        )
        if not height > 0.0:
            raise InputError(
                "BAD_VALUE",
                f"strategy.{HEIGHT}",
                "{:g} mm is out of range; give more than 0 mm",
                height,
            )
        spacing = process.wire.section * model_wire_feed(process, model) / speed / height
        if spacing > process.bead_width:
            raise InputError(
                "BAD_VALUE",
                f"strategy.{SPACING}",
                "layers of {:.4g} mm need beads {:.4g} mm apart to hold the wire fed, but beads "
                "are {:g} mm wide; use higher layers or wider beads",
                height,
                spacing,
                process.bead_width,
            )
        section_with_numbers[SPACING] = f"{spacing!r} mm"
    return section_with_numbers


# what a job calls the links of a feature, which the window picks in a document
_KEYS = {
    "Feature": "substrate",
    "Feature.BaseFaces": "substrate.faces",
    "Feature.Source": "part.faces",
    "Feature.StartEdges": "part.start_edges",
    "Feature.StartFaces": "strategy.start_faces",
}
UPRIGHT = "fixed"  # the mode of one direction
KEYS = ("name", "part", "substrate", "fixtures", "strategy", "build_direction", "process")


@dataclass(frozen=True)
class JobFeature:
    """A deposit and its parameters.

    `substrate` is set if the family of the strategy uses one (`core.families`), or if an earlier
    deposit may serve as substrate. `guide`: guide of layers along a curve, None for the centre
    line. `start_faces`: faces of the part on which curved layers start. `scan`: scan of the
    substrate to which layers are fitted.
    """

    name: str
    part: PartSource
    substrate: PartSource | None
    fixtures: tuple[PartSource, ...]
    strategy: LayerParameters
    build_direction: BuildDirectionParameters
    process: ProcessParameters
    guide: PartSource | None = None
    # sections of the job, if it leaves the choice of the family to us
    sections: Any = dataclasses.field(default=None, repr=False, compare=False)
    start_faces: tuple[str, ...] = ()
    scan: ScanSource | None = None
    # solids that settings by place name
    zones: tuple[tuple[str, PartSource], ...] = ()


def one_feature(values: dict[str, Any], name: str) -> JobFeature:
    """Convert the sections of a job, or of one of its features, to a feature.

    Files have absolute names. Raises InputError with key and remedy.
    """
    if values.get("part") is None:
        raise InputError("NO_PART", "part", "the job has no part; write part: {file: shape.step}")
    part_section = fields.mapping(values["part"], "part")
    if asked(values.get("strategy")):
        process = process_of(values.get("process") or {})
        values = {**values, "strategy": resolved(values["strategy"], process)}
    section = values.get("strategy")
    if isinstance(section, dict) and section.get("kind") == AUTO.kind:
        return _left_open(values, section, name)
    strategy = strategy_of(_add_fuse(values.get("strategy") or {}, part_section))
    by_place = settings_of(values.get("settings"), part_section)
    process = dataclasses.replace(
        process_of(values.get("process") or {}, strategy), settings=by_place.settings
    )
    if SPACING not in (values.get("strategy") or {}):
        strategy = _narrow_spacing(strategy, process)
    build_direction = fields.build(
        BuildDirectionParameters, values.get("build_direction") or {}, "build_direction"
    )
    refuse_direction(strategy, build_direction)
    source = part_of({key: value for key, value in part_section.items() if key != "fuse"})
    guide = guide_of((values.get("strategy") or {}).get("guide"), part_section)
    if guide is not None and not strategy.follows_guide:
        raise InputError(
            "NOT_FOR_FAMILY",
            "strategy.guide",
            "only layers: along uses a guide; remove the guide, or use layers: along",
        )
    start_faces = faces_of(
        (values.get("strategy") or {}).get("start_faces"), "strategy.start_faces"
    )
    if start_faces and not strategy.has_curved_layers:
        raise InputError(
            "NOT_FOR_FAMILY",
            "strategy.start_faces",
            "only layers: geodesic and layers: offset start from faces; remove the faces, or use "
            "geodesic or offset",
        )
    ground, scanned = split(values.get("substrate"))
    return JobFeature(
        name,
        source,
        substrate_of(ground, strategy, source),
        fixtures_of(values.get("fixtures")),
        strategy,
        build_direction,
        process,
        guide,
        start_faces=start_faces,
        scan=scan_of(scanned, strategy),
        zones=by_place.solids,
    )


def _narrow_spacing(strategy: LayerParameters, process: ProcessParameters) -> LayerParameters:
    """Return the strategy with a default bead spacing of at most the bead width.

    With `process.fill_width: spacing` the spacing is the width of the beads, and stays.
    """
    if not isinstance(strategy, FilledParameters) or process.fill_width == "spacing":
        return strategy
    spacing = min(strategy.bead_spacing, process.bead_width)
    return dataclasses.replace(strategy, bead_spacing=spacing)


def _left_open(values: dict[str, Any], section: dict[str, Any], name: str) -> JobFeature:
    """Return a feature whose family is chosen when its part is known; keys of any family are
    allowed.
    """
    fields.known_keys(
        section,
        ("kind", *sorted({key for family in KINDS.values() for key in _keys(family)})),
        "strategy",
    )
    common = {key: value for key, value in section.items() if key in _keys(AUTO)}
    part_section = {
        key: value for key, value in fields.mapping(values["part"], "part").items() if key != "fuse"
    }
    ground, _ = split(values.get("substrate"))
    substrate = (
        None if ground is None else part_of(fields.mapping(ground, "substrate"), "substrate")
    )
    return JobFeature(
        name,
        part_of(part_section),
        substrate,
        fixtures_of(values.get("fixtures")),
        fields.build(LayerParameters, common, "strategy"),
        fields.build(
            BuildDirectionParameters, values.get("build_direction") or {}, "build_direction"
        ),
        dataclasses.replace(
            process_of(values.get("process") or {}),
            settings=settings_of(values.get("settings"), part_section).settings,
        ),
        sections=values,
    )


def leans(feature: JobFeature, strategy: LayerParameters) -> bool:
    """Whether the build directions of a feature follow its wall and could be replaced by one
    direction.

    True for directions that follow the wall by the job's setting, or by default if the family is
    chosen automatically.
    """
    if not family_of(strategy).follows_wall:
        return False
    if feature.sections is None:
        return feature.build_direction.mode != UPRIGHT
    return "mode" not in (feature.sections.get("build_direction") or {})


def chosen(feature: JobFeature, kind: str, layers: str, mend: float, mode: str = "") -> JobFeature:
    """Return the feature with its family chosen, and the keys of that family.

    mend: width, mm, of the largest hole that is closed without a job setting, 0 for the default.
    mode: mode of the build direction, if it differs from the job's. Raises InputError like other
    features.
    """
    values, family = dict(feature.sections), KINDS[kind]
    section = {key: value for key, value in values["strategy"].items() if key in _keys(family)}
    proposed = {
        **({"layers": layers} if layers else {}),
        **({"mend": f"{mend!r} mm"} if mend else {}),
    }
    values["strategy"] = {**proposed, **section, "kind": kind}
    if mode:
        values["build_direction"] = {**(values.get("build_direction") or {}), "mode": mode}
    if family.substrate == NONE:
        values.pop("substrate", None)
    if not family.fuses_solids and isinstance(values["part"], dict):
        values["part"] = {key: value for key, value in values["part"].items() if key != "fuse"}
    return one_feature(values, feature.name)


def planes_of(feature: JobFeature) -> SolidParameters:
    """Return the stacking direction and the layer height of a feature whose family is not chosen
    yet.
    """
    section = feature.sections["strategy"]
    plane_keys = {key: section[key] for key in ("direction", "layer_height") if key in section}
    return fields.build(SolidParameters, plane_keys, "strategy")


def _keys(family: Family) -> tuple[str, ...]:
    return tuple(field.name for field in dataclasses.fields(family.parameters))


def several(values: dict[str, Any], lines: tree.Tree) -> tuple[JobFeature, ...]:
    """Convert the features listed in a job file. Raises InputError naming feature and key."""
    if values.get("settings"):
        raise InputError(
            "NOT_YET",
            "settings",
            "settings by place are for one feature yet; remove them, or put each feature in its own "
            "job",
        )
    entries = values["features"]
    if not isinstance(entries, list) or not entries:
        raise InputError(
            "BAD_VALUE",
            "features",
            "features must be a list; write features: [{name: hub, part: {file: hub.step}}, ...]",
        )
    features: list[JobFeature] = []
    for number, entry in enumerate(entries):
        where = f"features[{number}]"
        feature_section = fields.mapping(entry, where)
        fields.known_keys(feature_section, KEYS, where)
        name = (
            fields.text(feature_section["name"], f"{where}.name").strip()
            if feature_section.get("name") is not None
            else f"feature {number + 1}"
        )
        if name in [feature.name for feature in features]:
            raise InputError(
                "BAD_VALUE",
                f"{where}.name",
                "{!r} is the name of another feature; use a unique name",
                name,
            )
        try:
            features.append(one_feature(_merge_defaults(feature_section, values), name))
        except InputError as error:
            raise about_feature(error, number, name, lines) from None
    return tuple(features)


def in_words_of_job(error: InputError, label: str = "Feature") -> InputError:
    """Convert an error about a link of the labelled feature to an error about a key of the job."""
    where = (
        f"Feature{error.where.removeprefix(label)}"
        if error.where.startswith(label)
        else error.where
    )
    return InputError(error.code, _KEYS[where], error.message) if where in _KEYS else error


def about_feature(error: InputError, number: int, name: str, lines: tree.Tree) -> InputError:
    """Convert an error about a key of a feature to an error about a key of the job.

    The error names the top-level key if the job gives it there.
    """
    error = in_words_of_job(error, name)
    root = error.where.split(".")[0].split("[")[0]
    if root not in KEYS:
        return InputError(error.code, error.where, "feature {}: {}", name, error.message)
    where = f"features[{number}].{error.where}"
    if error.where in lines.lines and where not in lines.lines:
        where = error.where
    return InputError(error.code, where, "feature {}: {}", name, error.message)


def _merge_defaults(feature_section: dict[str, Any], top: dict[str, Any]) -> dict[str, Any]:
    """Merge the sections of a feature over the top-level sections.

    Top-level keys that the family of the feature does not know are ignored.
    """
    defaults = {key: top[key] for key in KEYS[1:] if top.get(key) is not None}
    if isinstance(feature_section.get("part"), dict) and "file" in feature_section["part"]:
        defaults.pop("part", None)  # faces and objects belong to a file
    if (
        isinstance(feature_section.get("substrate"), dict)
        and "file" in feature_section["substrate"]
    ):
        defaults.pop("substrate", None)
    mixed = {
        **defaults,
        **{
            key: _over(defaults.get(key), feature_section[key])
            for key in KEYS[1:]
            if key in feature_section
        },
    }
    strategy = mixed.get("strategy")
    if not isinstance(strategy, dict):
        return mixed
    family = find_family(strategy.get("kind", DEFAULT_KIND), strategy.get("layers"))
    if family is None:
        return mixed
    own_strategy = (
        feature_section.get("strategy") if isinstance(feature_section.get("strategy"), dict) else {}
    )
    allowed_keys = (*kept_clear(family), *_keys(family))
    mixed["strategy"] = {
        key: value for key, value in strategy.items() if key in allowed_keys or key in own_strategy
    }
    if "substrate" not in feature_section and family.substrate == NONE:
        mixed.pop("substrate", None)
    direction = mixed.get("build_direction")
    if (
        isinstance(direction, dict)
        and "mode" not in (feature_section.get("build_direction") or {})
        and (direction.get("mode") not in family.modes)
    ):
        mixed["build_direction"] = {key: value for key, value in direction.items() if key != "mode"}
    process = mixed.get("process")
    if (
        isinstance(process, dict)
        and not family.is_filled
        and "bead_model" not in (feature_section.get("process") or {})
    ):
        mixed["process"] = {key: value for key, value in process.items() if key != "bead_model"}
    return mixed


def _over(base: Any, override: Any) -> Any:
    """Merge a section over another, key by key."""
    if not isinstance(base, dict) or not isinstance(override, dict):
        return override
    return {**base, **{key: _over(base.get(key), value) for key, value in override.items()}}


def _add_fuse(section: Any, part_section: dict[str, Any]) -> Any:
    """Return the section of the strategy with the part's setting for touching solids."""
    if "fuse" not in part_section:
        return section
    family = find_family(fields.mapping(section, "strategy").get("kind"))
    if family is None or not family.fuses_solids:
        raise InputError(
            "NOT_FOR_FAMILY", "part.fuse", "only strategy.kind solid fuses solids; remove the key"
        )
    return {**section, "fuse": part_section["fuse"]}
