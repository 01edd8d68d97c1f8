# SPDX-License-Identifier: LGPL-2.1-or-later
"""report.html: the report as one self-contained file. Its only script draws the path."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from html import escape
from typing import Any

from ..core.geometry.on_hub import SolidsOnHub
from ..core.process.deposit.spacing import local_distances
from ..core.strategies.walls.comparison import Compared
from ..core.toolpath import Toolpath
from ..plots.source import Source
from . import places, predicted_figures, scan_figures, units
from .charts import deposit_chart, distance_charts, layer_charts, path_charts, step_chart
from .figures import OfFeature
from .pictures import FULL_WIDTH, HALF, MISSING, TALLEST, Pictures, draw_charts, plotting_modules
from .tables import (
    axis_names,
    classes_of,
    clock,
    figure_text,
    grid_of,
    in_units,
    material_row,
    pairs_of,
    table_of,
)
from .template import fill_page
from .viewer_3d import columns
from .viewer_3d.columns import build_viewer, policy, style

NO_VIEWER = "Open this page in a browser with scripts and WebGL to see the path in 3D."
_PER_METHOD = (
    ("feasible", "feasible"),
    ("objective_value", "objective"),
    ("condition_min", "smallest condition"),
    ("planning_time_s", "planning time, s"),
)
_PER_AXIS = (
    ("range_per_layer_max_deg", "largest range within a layer, deg"),
    ("limit_margin_deg", "margin to the limit, deg"),
    ("speed_max_deg_s", "largest speed, deg/s"),
    ("acceleration_max_deg_s2", "largest acceleration, deg/s\u00b2"),
    ("jerk_max_deg_s3", "largest jerk, deg/s\u00b3"),
    ("speed_ratio_max", "largest share of the speed limit"),
)
_SPACING = (
    ("layers", "layers to the end"),
    ("min_mm", "least distance, mm"),
    ("mean_mm", "mean, mm"),
    ("max_mm", "largest, mm"),
    ("length_mm", "length, mm"),
    ("turn_max_deg_mm", "sharpest turn beside corners, deg/mm"),
    ("cornered_layers", "layers with corners"),
    ("corner_max_deg", "sharpest corner, deg"),
)
_MOTION = (
    ("duration_s", "time of all moves, s"),
    ("deposit_s", "deposit at the travel speed, s"),
    ("axis_limited_s", "deposit as fast as the axes can, s"),
    ("condition_min", "smallest condition"),
)
_MOTION_PER_AXIS = (
    ("speed_ratio_max", "largest share of the speed limit"),
    ("acceleration_max_deg_s2", "largest acceleration, deg/s\u00b2"),
    ("jerk_max_deg_s3", "largest jerk, deg/s\u00b3"),
)


@dataclass(frozen=True)
class Content:
    """Content of the page: the report and its chart data. source: the job."""

    report: dict[str, Any]
    source: Source
    features: Sequence[OfFeature]
    platform_diameter: float | None = None
    solids: SolidsOnHub | None = None

    @property
    def toolpath(self) -> Toolpath:
        """Return the toolpath as executed."""
        return self.source.toolpath


def render(content: Content) -> str:
    """Return the page as HTML."""
    report = content.report
    name, status = escape(report["name"]), report["status"]
    pictures, path_rows = Pictures(content.source), _select_rows(content)
    toolpath = content.toolpath
    width = (
        content.source.process.bead_width if toolpath.bead_width is None else toolpath.bead_width
    )
    path = build_viewer(path_rows, toolpath, width, content.platform_diameter)
    sections = [
        f'<header><h1>{name}</h1><span class="status {status}">{status}</span></header>'
        f'<p class="sub">{escape(_subtitle(content))}</p>{_cards(report)}{places.findings(report["issues"], path_rows)}',
        f"<h2>Path</h2>{path.element}",
        f'<p class="sub" id="path-still">{NO_VIEWER}</p>',
        places.preflight(report["preflight"], path_rows),
        "" if plotting_modules() else f'<p class="sub">{MISSING}</p>',
        *_joints(content, pictures),
        ""
        if content.toolpath.checks.fitted is None
        else scan_figures.section(content.toolpath.checks.fitted, content.toolpath.frame),
        ""
        if content.toolpath.checks.predicted is None
        else predicted_figures.section(
            content.toolpath.checks.predicted, pictures.predicted(), path_rows
        ),
        _process(content, pictures),
        _hub_layers(content, pictures),
        *(_spacings(feature) for feature in content.features if feature.rows),
        _spacing_motion(report),
        _comparison(report),
        _totals(report),
        _criteria(report),
        pairs_of(
            "Time taken",
            {stage: f"{seconds:.3f} s" for stage, seconds in report["timing_s"].items()},
        ),
        _programs(report["programs"]),
    ]
    return fill_page(report["name"], sections, policy(), style(), path.data)


def _select_rows(content: Content) -> columns.Shown:
    """Return the path rows for the 3D viewer, with joint values if the job has a machine."""
    machine = content.report["machine"] if content.source.cell is not None else None
    return (
        columns.select_rows(content.source, machine["labels"], machine["units"])
        if machine
        else columns.select_rows(content.source)
    )


def _subtitle(content: Content) -> str:
    joints = content.report["joints"]
    if joints is None:
        return "toolpath without joint values"
    return f"{content.report['machine']['title']}, limits {content.report['machine']['limits']}, joints {joints['method']}"


def _cards(report: dict[str, Any]) -> str:
    counts, spacing = report["counts"], report["spacing_mm"]
    cards = [
        (f"{counts['layers']:,}", "layers"),
        (f"{counts['beads']:,}", "beads"),
        (f"{counts['points']:,}", "points"),
        (f"{report['length_mm'] / 1000:.3f} m", "length of the beads"),
        (clock(report["duration_s"]), "time of all moves"),
    ]
    cards.append(
        (
            f"{report['totals']['mass_g']:,.1f} g",
            f"deposit, {report['totals']['volume_cm3']:,.2f} cm\u00b3",
        )
    )
    if spacing["mean"] is not None:
        cards.append(
            (
                f"{spacing['mean']:.4f} mm",
                f"spacing, {spacing['min']:.4f} to {spacing['max']:.4f} mm",
            )
        )
    if report["joints"] is not None and report["joints"]["condition_min"] is not None:
        cards.append((figure_text(report["joints"]["condition_min"]), "smallest condition"))
    boxes = "".join(
        f'<div class="card"><b>{escape(units.text(value))}</b><span>{escape(units.text(word))}</span></div>'
        for value, word in cards
    )
    return f'<div class="cards">{boxes}</div>'


def _joints(content: Content, pictures: Pictures) -> list[str]:
    if content.source.cell is None:
        return []
    sections = [
        "<h2>Joints against their limits</h2>",
        grid_of(pictures.angles()),
        _joint_table(content),
    ]
    if content.source.motion.reachable.any():
        plots = "".join(f'<figure class="wide">{plot}</figure>' for plot in pictures.rates())
        sections.append(f"<h2>Speed and condition</h2>{plots}" if plots else "")
    return sections


def _joint_table(content: Content) -> str:
    joints = content.report["joints"]
    rows = [("", axis_names(content.report))] + [
        (in_units(word, content.report), [figure_text(value) for value in joints[key] or ()])
        for key, word in (
            ("min_deg", "smallest, deg"),
            ("max_deg", "largest, deg"),
            _PER_AXIS[0],
            _PER_AXIS[1],
            _PER_AXIS[-1],
        )
    ]
    return table_of(rows)


def _process(content: Content, pictures: Pictures) -> str:
    plots = pictures.process(content.features)
    section = f"<h2>Layers and path</h2>{grid_of(plots)}" if plots else ""
    return section + classes_of(content.report["classes"])


def _hub_layers(content: Content, pictures: Pictures) -> str:
    """Draw the unrolled layers of solids on a hub, and the bead model charts."""
    if content.solids is None:
        return ""
    layers = layer_charts(content.solids, content.toolpath)
    plots = [plot for chart, height in layers for plot in draw_charts([chart], HALF, height)]
    plots += pictures.beads()
    return f"<h2>Flattened layers</h2>{grid_of(plots)}"


def _spacings(wall: OfFeature) -> str:
    """Compare the spacing methods of a wall: the paper's plots and a table."""
    rows, toolpath = wall.rows, wall.toolpath
    compared = [result for result in wall.compared if isinstance(result, Compared)]
    height = toolpath.layer_height
    charts = distance_charts(compared, height) if compared else []
    charts += [
        step_chart(result, height) for result in compared if result.method == "constant-distance"
    ]
    charts.append(deposit_chart(toolpath, local_distances(toolpath)))
    plots = draw_charts(charts, HALF)
    overlay = "".join(
        f'<figure class="wide">{picture}<figcaption>Both paths: along the lines up the wall, and at a '
        "constant distance from the layer below.</figcaption></figure>"
        for picture in draw_charts(path_charts(compared), FULL_WIDTH, TALLEST)
    )
    cut = [row for row in rows if row["layers"] is not None]
    names = [row["method"] + (" (planned)" if row["planned"] else "") for row in cut]
    columns = [(word, key) for key, word in _SPACING if any(row[key] is not None for row in cut)]
    table = table_of(
        [("", names)] + [(word, [figure_text(row[key]) for row in cut]) for word, key in columns]
    )
    reasons = "".join(
        f'<p class="sub">{escape(row["method"] + ": " + row["reason"])}.</p>'
        for row in rows
        if row["reason"]
    )
    name = f": {escape(wall.name)}" if wall.name else ""
    return (
        f'<h2>Distances between layers{name}</h2><p class="sub">Distance of each point to the nearest point of the layer below, '
        f"around the wall; every curve is a layer, dark ones first.</p>{grid_of(plots)}{overlay}{table}{reasons}"
    )


def _spacing_motion(report: dict[str, Any]) -> str:
    rows = [row for row in report["spacing_comparison"] if row["motion"]]
    if len(rows) < 2:
        return ""
    totals = [("", [row["method"] for row in rows])] + [
        (word, [figure_text(row["motion"][key]) for row in rows]) for key, word in _MOTION
    ]
    axes = [("", ["", *axis_names(report)])] + [
        (
            in_units(word, report) if number == 0 else "",
            [row["method"], *(figure_text(value) for value in row["motion"][key] or ())],
        )
        for key, word in _MOTION_PER_AXIS
        for number, row in enumerate(rows)
    ]
    return f"<h2>Joint motion by spacing</h2>{table_of(totals)}{table_of(axes)}"


def _totals(report: dict[str, Any]) -> str:
    """Return the table of time, deposit and material."""
    sums = report["totals"]
    return pairs_of(
        "Time and material",
        {
            "the whole job": clock(sums["time_s"]),
            "depositing": clock(sums["deposit_s"]),
            "rapid moves": clock(sums["rapid_s"]),
            "waits and lead times": clock(sums["wait_s"]),
            "length of the deposit": f"{sums['deposit_mm'] / 1000:.3f} m",
            "length of rapid moves": f"{sums['rapid_mm'] / 1000:.3f} m",
            "volume of the deposit": f"{sums['volume_cm3']:,.2f} cm\u00b3",
            "volume of the wire fed": "unknown"
            if sums["fed_cm3"] is None
            else f"{sums['fed_cm3']:,.2f} cm\u00b3",
            "mass of the deposit": f"{sums['mass_g']:,.1f} g",
            **material_row(report),
        },
    )


def _criteria(report: dict[str, Any]) -> str:
    """Return the table of all planning criteria, not only the optimised one; smaller is better."""
    if report["joints"] is None or not report["joints"]["criteria"]:
        return ""
    methods = [report["joints"], *report["comparison"]]
    rows = [("", [entry["method"] for entry in methods])] + [
        (name, [figure_text(entry["criteria"][name]) for entry in methods])
        for name in report["joints"]["criteria"]
    ]
    text = f"All criteria of the joint path, whether optimised or not; smaller values are better.{_optimality(report)}"
    return f'<h2>Criteria</h2><p class="sub">{text}</p>{table_of(rows)}'


def _optimality(report: dict[str, Any]) -> str:
    optimality = report["joints"].get("optimality")
    if optimality is None:
        return ""
    name, value, bound = (
        escape(report["joints"]["objective"]),
        figure_text(optimality["objective"]),
        figure_text(optimality["bound"]),
    )
    return f" {name}, bead by bead: {value}; no rotation about the tool goes below {bound}, a gap of {optimality['gap']:.1%}."


def _comparison(report: dict[str, Any]) -> str:
    """Compare the job's planning method with other methods: totals, then values per axis."""
    if not report["comparison"]:
        return ""
    methods = [report["joints"], *report["comparison"]]
    totals = [("", [entry["method"] for entry in methods])] + [
        (word, [figure_text(entry.get(key)) for entry in methods]) for key, word in _PER_METHOD
    ]
    axes = [("", ["", *axis_names(report)])] + [
        (
            in_units(word, report) if number == 0 else "",
            [entry["method"], *(figure_text(value) for value in entry.get(key) or ())],
        )
        for key, word in _PER_AXIS
        for number, entry in enumerate(methods)
    ]
    return f"<h2>Comparison of the methods</h2>{table_of(totals)}{table_of(axes)}"


def _programs(programs: list[str]) -> str:
    return (
        "<h2>Programs</h2>"
        + table_of([(str(number), [name]) for number, name in enumerate(programs, 1)])
        if programs
        else ""
    )
