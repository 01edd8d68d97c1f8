# SPDX-License-Identifier: LGPL-2.1-or-later
"""report.html: the report to look at, one file without scripts or links."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from html import escape
from typing import Any

from freecad_am.core.geometry.on_hub import SolidsOnHub
from freecad_am.core.process.spacing import local_distances
from freecad_am.core.strategies.wall_comparison import Compared
from freecad_am.core.toolpath import Toolpath
from freecad_am.plots.source import Source

from . import hub_figures, view, wall_figures
from .of_feature import OfFeature
from .pictures import MISSING, Pictures

_MOST_ISSUES = 200
_WHOLE = (
    ("feasible", "feasible"), ("objective_value", "objective"), ("condition_min", "smallest condition"),
    ("planning_time_s", "planning time, s"),
)
_PER_AXIS = (
    ("range_per_layer_max_deg", "largest range within a layer, deg"), ("limit_margin_deg", "margin to the limit, deg"),
    ("speed_max_deg_s", "largest speed, deg/s"), ("acceleration_max_deg_s2", "largest acceleration, deg/s\u00b2"),
    ("jerk_max_deg_s3", "largest jerk, deg/s\u00b3"), ("speed_ratio_max", "largest share of the speed limit"),
)
_SPACING = (
    ("layers", "layers to the end"), ("min_mm", "least distance, mm"), ("mean_mm", "mean, mm"),
    ("max_mm", "largest, mm"), ("length_mm", "length, mm"), ("turn_max_deg_mm", "sharpest turn beside corners, deg/mm"),
    ("cornered_layers", "layers with corners"), ("corner_max_deg", "sharpest corner, deg"),
)
_MOTION = (
    ("duration_s", "time of all moves, s"), ("deposit_s", "deposit at the travel speed, s"),
    ("axis_limited_s", "deposit as fast as the axes can, s"), ("condition_min", "smallest condition"),
)
_MOTION_PER_AXIS = (
    ("speed_ratio_max", "largest share of the speed limit"),
    ("acceleration_max_deg_s2", "largest acceleration, deg/s\u00b2"), ("jerk_max_deg_s3", "largest jerk, deg/s\u00b3"),
)
# how a promise is marked: what was not checked is never green
_MARKS = {True: ("good", "kept"), False: ("error", "broken"), None: ("unknown", "not checked")}
STYLE = """
:root{--ink:#1d2430;--soft:#667085;--line:#dfe3ea;--paper:#fff;--ground:#f3f5f8;--good:#1a7f4b;--bad:#b8322a;--warn:#9a6700}
@media(prefers-color-scheme:dark){:root{--ink:#e6e9ef;--soft:#98a2b3;--line:#323a47;--paper:#1a202b;--ground:#11151c;
--good:#4cc38a;--bad:#ff7a70;--warn:#e2b340}}
*{box-sizing:border-box}body{margin:0;background:var(--ground);color:var(--ink);font:15px/1.5 system-ui,sans-serif}
main{max-width:1040px;margin:0 auto;padding:28px 20px 60px}h1{font-size:28px;margin:0}h2{font-size:18px;margin:34px 0 10px}
header{display:flex;align-items:center;gap:14px;flex-wrap:wrap}.sub{color:var(--soft);margin:4px 0 18px}
.status{font-weight:600;padding:2px 12px;border-radius:99px;color:#fff;background:var(--good)}
.status.infeasible,.status.failed{background:var(--bad)}@media(prefers-color-scheme:dark){.status{color:#11151c}}
.cards{display:grid;grid-template-columns:repeat(auto-fit,minmax(125px,1fr));gap:10px;margin:0 0 16px}
.card,figure,.table{background:var(--paper);border:1px solid var(--line);border-radius:10px}
.card{padding:10px 12px}.card b{display:block;font-size:17px;white-space:nowrap;font-weight:600}
.card span{color:var(--soft);font-size:13px}
figure{margin:0;padding:8px}.grid{display:grid;grid-template-columns:repeat(auto-fit,minmax(min(400px,100%),1fr));gap:10px}
figcaption{color:var(--soft);font-size:13px;padding:2px 8px 4px}
.table{overflow-x:auto}.findings{max-height:340px;overflow-y:auto}
table{border-collapse:collapse;width:100%;font-size:14px;font-variant-numeric:tabular-nums}
th,td{padding:6px 12px;text-align:right;border-top:1px solid var(--line);white-space:nowrap}
tr:first-child>*{border-top:0}th{color:var(--soft);font-weight:500}th:first-child,td:first-child{text-align:left}
td.text,td.place{text-align:left}td.text{white-space:normal}
.good{color:var(--good);font-weight:600}.unknown{color:var(--soft);font-style:italic}
.error{color:var(--bad);font-weight:600}.warning{color:var(--warn);font-weight:600}
svg{width:100%;height:auto;display:block}svg text{fill:var(--soft);font:11px system-ui,sans-serif}
svg .title{fill:var(--ink);font-size:13px;font-weight:600}
svg .grid{stroke:var(--line)}
svg .frame{fill:none;stroke:var(--soft);opacity:.5}
svg.plot path{stroke-linejoin:round}figure.wide{margin-top:10px}
svg .curve{fill:none;stroke-linejoin:round}
svg .asked{stroke:var(--soft);stroke-dasharray:5 4}
svg .rule{fill:var(--bad)}
svg .near,svg .far{fill:none;stroke-width:2.1;stroke-linejoin:round}
svg .far{stroke-width:1.2;opacity:.6}svg .direction{stroke:var(--ink);stroke-width:1.1;opacity:.6}
svg .body{stroke-width:.6;stroke-linejoin:round}
svg .b0,svg .b1{fill:#9aa4b5;stroke:#9aa4b5}svg .b2{fill:#a8b1c0;stroke:#a8b1c0}svg .b3{fill:#b5bdca;stroke:#b5bdca}
svg .b4{fill:#c2c9d4;stroke:#c2c9d4}svg .b5{fill:#ced4dd;stroke:#ced4dd}svg .b6{fill:#d9dee5;stroke:#d9dee5}
svg .platform{fill:var(--line);stroke:var(--soft);stroke-width:.8}svg .platform-side{fill:var(--soft);opacity:.55}
"""


@dataclass(frozen=True)
class Content:
    """What the page shows besides the report itself. source: the job."""

    report: dict[str, Any]
    source: Source
    features: Sequence[OfFeature]
    platform_diameter: float | None = None
    solids: SolidsOnHub | None = None

    @property
    def toolpath(self) -> Toolpath:
        """As it is run."""
        return self.source.toolpath


def render(content: Content) -> str:
    """The page."""
    report = content.report
    name, status = escape(report["name"]), report["status"]
    pictures = Pictures(content.source)
    sections = [
        f'<header><h1>{name}</h1><span class="status {status}">{status}</span></header>'
        f'<p class="sub">{escape(_subtitle(content))}</p>{_cards(report)}{_issues(report["issues"])}',
        _preflight(report["preflight"]),
        "" if pictures.modules else f'<p class="sub">{MISSING}</p>',
        f'<figure>{view.picture(content.toolpath, content.platform_diameter)}<figcaption>The beads, coloured by layer; '
        "short strokes show the build direction.</figcaption></figure>",
        *_joints(content, pictures),
        _process(content, pictures),
        _on_hub(content, pictures),
        *(_spacings(one) for one in content.features if one.rows),
        _spacing_motion(report),
        _comparison(report),
        _totals(report["totals"]),
        _criteria(report),
        _pairs("Time taken", {stage: f"{seconds:.3f} s" for stage, seconds in report["timing_s"].items()}),
        _programs(report["programs"]),
    ]
    return (
        f'<!DOCTYPE html>\n<html lang="en"><head><meta charset="utf-8"><title>{name}</title>'
        f'<meta name="viewport" content="width=device-width,initial-scale=1"><style>{STYLE}</style></head>'
        f'<body><main>{"".join(sections)}</main></body></html>\n'
    )


def _subtitle(content: Content) -> str:
    joints = content.report["joints"]
    if joints is None:
        return "the path alone, without joints"
    return f"{content.report['machine']['title']}, limits {content.report['machine']['limits']}, joints {joints['method']}"


def _cards(report: dict[str, Any]) -> str:
    counts, spacing = report["counts"], report["spacing_mm"]
    cards = [
        (f"{counts['layers']:,}", "layers"), (f"{counts['beads']:,}", "beads"), (f"{counts['points']:,}", "points"),
        (f"{report['length_mm'] / 1000:.3f} m", "length of the beads"), (_clock(report["duration_s"]), "time of all moves"),
    ]
    cards.append((f"{report['totals']['mass_g']:,.1f} g", f"deposit, {report['totals']['volume_cm3']:,.2f} cm\u00b3"))
    if spacing["mean"] is not None:
        cards.append((f"{spacing['mean']:.4f} mm", f"spacing, {spacing['min']:.4f} to {spacing['max']:.4f}"))
    if report["joints"] is not None and report["joints"]["condition_min"] is not None:
        cards.append((_figure(report["joints"]["condition_min"]), "smallest condition"))
    boxes = "".join(f'<div class="card"><b>{escape(value)}</b><span>{escape(word)}</span></div>' for value, word in cards)
    return f'<div class="cards">{boxes}</div>'


def _clock(seconds: float) -> str:
    minutes, rest = divmod(round(seconds), 60)
    hours, minutes = divmod(minutes, 60)
    return f"{hours} h {minutes:02d} min" if hours else f"{minutes} min {rest:02d} s"


def _joints(content: Content, pictures: Pictures) -> list[str]:
    if content.source.cell is None:
        return []
    sections = ["<h2>Joints against their limits</h2>", _grid(pictures.angles()), _joint_table(content)]
    if content.source.motion.reachable.any():
        plots = "".join(f'<figure class="wide">{plot}</figure>' for plot in pictures.rates())
        sections.append(f"<h2>Speed and condition</h2>{plots}" if plots else "")
    return sections


def _grid(plots: Iterable[str]) -> str:
    figures = "".join(f"<figure>{plot}</figure>" for plot in plots)
    return f'<div class="grid">{figures}</div>' if figures else ""


def _joint_table(content: Content) -> str:
    joints = content.report["joints"]
    rows = [("", _axes(content.report))] + [
        (_in_units(word, content.report), [_figure(value) for value in joints[key] or ()]) for key, word in (
            ("min_deg", "smallest, deg"), ("max_deg", "largest, deg"), _PER_AXIS[0], _PER_AXIS[1], _PER_AXIS[-1],
        )
    ]
    return _table(rows)


def _axes(report: dict[str, Any]) -> list[str]:
    """The names of the axes, with their units where these are not all the same."""
    axes, units = report["machine"]["labels"], report["machine"]["units"]
    return [f"{axis}, {unit}" for axis, unit in zip(axes, units)] if "mm" in units else axes


def _in_units(word: str, report: dict[str, Any]) -> str:
    """The name of a figure of the axes, with mm beside degrees where some of them slide."""
    name, _, unit = word.rpartition(", ")
    mixed = unit.startswith("deg") and "mm" in report["machine"]["units"]
    return f"{name}, {unit} or {unit.replace('deg', 'mm')}" if mixed else word


def _process(content: Content, pictures: Pictures) -> str:
    plots = pictures.process(content.features)
    return f"<h2>Layers and path</h2>{_grid(plots)}" if plots else ""


def _on_hub(content: Content, pictures: Pictures) -> str:
    """Layers of solids on a hub laid flat, and what the bead model makes of them."""
    if content.solids is None:
        return ""
    return f"<h2>Layers laid flat</h2>{_grid(hub_figures.layer_plots(content.solids, content.toolpath) + pictures.beads())}"


def _spacings(of: OfFeature) -> str:
    """What each spacing of a wall costs: the paper's plots and the figures."""
    rows, toolpath = of.rows, of.toolpath
    done = [one for one in of.compared if isinstance(one, Compared)]
    height = toolpath.layer_height
    plots = wall_figures.distance_plots(done, height) if done else []
    plots += [wall_figures.step_plot(one, height) for one in done if one.method == "constant-distance"]
    plots.append(wall_figures.deposit_plot(toolpath, local_distances(toolpath)))
    both = wall_figures.both_paths(done)
    if both:
        both = (f'<figure style="margin-top:10px">{both}<figcaption>Both paths: along the lines up the wall, and at a '
                "constant distance from the layer below.</figcaption></figure>")
    cut = [row for row in rows if row["layers"] is not None]
    names = [row["method"] + (" (planned)" if row["planned"] else "") for row in cut]
    told = [(word, key) for key, word in _SPACING if any(row[key] is not None for row in cut)]
    table = _table([("", names)] + [(word, [_figure(row[key]) for row in cut]) for word, key in told])
    reasons = "".join(f'<p class="sub">{escape(row["method"] + ": " + row["reason"])}.</p>' for row in rows if row["reason"])
    name = f": {escape(of.name)}" if of.name else ""
    return (
        f'<h2>What spacing costs{name}</h2><p class="sub">Distance of each point to the nearest point of the layer below, '
        f'around the wall; every curve is a layer, dark ones first.</p>{_grid(plots)}{both}{table}{reasons}'
    )


def _spacing_motion(report: dict[str, Any]) -> str:
    rows = [row for row in report["spacing_comparison"] if row["motion"]]
    if len(rows) < 2:
        return ""
    whole = [("", [row["method"] for row in rows])] + [
        (word, [_figure(row["motion"][key]) for row in rows]) for key, word in _MOTION
    ]
    axes = [("", ["", *_axes(report)])] + [
        (_in_units(word, report) if number == 0 else "",
         [row["method"], *(_figure(value) for value in row["motion"][key] or ())])
        for key, word in _MOTION_PER_AXIS for number, row in enumerate(rows)
    ]
    return f"<h2>What spacing gains in motion</h2>{_table(whole)}{_table(axes)}"


def _totals(sums: dict[str, Any]) -> str:
    """What the job takes and deposits."""
    return _pairs("Time and material", {
        "the whole job": _clock(sums["time_s"]), "depositing": _clock(sums["deposit_s"]),
        "rapid moves": _clock(sums["rapid_s"]), "waits and lead times": _clock(sums["wait_s"]),
        "length of the deposit": f"{sums['deposit_mm'] / 1000:.3f} m",
        "length of rapid moves": f"{sums['rapid_mm'] / 1000:.3f} m",
        "volume of the deposit": f"{sums['volume_cm3']:,.2f} cm\u00b3",
        "volume of the wire fed": "unknown" if sums["fed_cm3"] is None else f"{sums['fed_cm3']:,.2f} cm\u00b3",
        "mass of the deposit": f"{sums['mass_g']:,.1f} g",
    })


def _criteria(report: dict[str, Any]) -> str:
    """Every criterion a path can be judged by, whichever it was planned by; the smaller the better."""
    if report["joints"] is None or not report["joints"]["criteria"]:
        return ""
    methods = [report["joints"], *report["comparison"]]
    rows = [("", [entry["method"] for entry in methods])] + [
        (name, [_figure(entry["criteria"][name]) for entry in methods]) for name in report["joints"]["criteria"]
    ]
    told = f"Whichever was optimised; smaller is better.{_optimality(report)}"
    return f"<h2>Criteria</h2><p class=\"sub\">{told}</p>{_table(rows)}"


def _optimality(report: dict[str, Any]) -> str:
    known = report["joints"].get("optimality")
    if known is None:
        return ""
    name, value, least = escape(report["joints"]["objective"]), _figure(known["objective"]), _figure(known["bound"])
    return f" {name}, bead by bead: {value}; no rotation about the tool goes below {least}, a gap of {known['gap']:.1%}."


def _comparison(report: dict[str, Any]) -> str:
    """The method of the job beside those it was compared with: figures of the whole, then those of each axis."""
    if not report["comparison"]:
        return ""
    methods = [report["joints"], *report["comparison"]]
    whole = [("", [entry["method"] for entry in methods])] + [
        (word, [_figure(entry.get(key)) for entry in methods]) for key, word in _WHOLE
    ]
    axes = [("", ["", *_axes(report)])] + [
        (_in_units(word, report) if number == 0 else "",
         [entry["method"], *(_figure(value) for value in entry.get(key) or ())])
        for key, word in _PER_AXIS for number, entry in enumerate(methods)
    ]
    return f"<h2>Comparison of the methods</h2>{_table(whole)}{_table(axes)}"


def _issues(issues: list[dict[str, Any]]) -> str:
    if not issues:
        return ""
    rows = []
    for issue in sorted(issues, key=lambda entry: ("error", "warning", "note").index(entry["level"]))[:_MOST_ISSUES]:
        place = _where(issue)
        rows.append(
            f'<tr><td class="{issue["level"]}">{issue["level"]}</td><td class="text">{escape(issue["code"])}</td>'
            f'<td class="place">{place}</td><td class="text">{escape(issue["message"])}</td></tr>'
        )
    more = f"<p>{len(issues) - len(rows)} more stand in report.json.</p>" if len(issues) > len(rows) else ""
    return f'<h2>Findings</h2><div class="table findings"><table>{"".join(rows)}</table></div>{more}<h2>Path</h2>'


def _where(place: dict[str, Any]) -> str:
    """Layer, bead and point, as far as they are told."""
    return " ".join(f"{word} {place[word]}" for word in ("layer", "bead", "point") if place[word] is not None)


def _preflight(promises: list[dict[str, Any]]) -> str:
    """Every promise with its mark: kept, broken, or not checked."""
    if not promises:
        return ""
    rows = []
    for one in promises:
        mark, word = _MARKS[one["ok"]]
        where = "" if one["place"] is None else _where(one["place"])
        worst = "" if one["worst"] is None else f"{_figure(one['worst'])} {one['unit']}".strip()
        sign = "\u2265" if one["at_least"] else "\u2264"
        bound = "" if one["bound"] is None else f"{sign} {_figure(one['bound'])} {one['unit']}".strip()
        rows.append(
            f'<tr><td class="{mark}">{word}</td><td class="text">{escape(one["promise"])}</td><td>{worst}</td>'
            f'<td>{bound}</td><td class="place">{where}</td><td class="text">{escape(one["how"])}</td></tr>'
        )
    head = "".join(f"<th>{word}</th>" for word in ("", "promise", "worst", "allowed", "place", "how it was checked"))
    return f'<h2>Preflight</h2><div class="table"><table><tr>{head}</tr>{"".join(rows)}</table></div>'


def _programs(programs: list[str]) -> str:
    return _pairs("Programs", {str(number): name for number, name in enumerate(programs, 1)}) if programs else ""


def _pairs(title: str, values: dict[str, str]) -> str:
    return f"<h2>{title}</h2>{_table([(word, [value]) for word, value in values.items()])}"


def _table(rows: Iterable[tuple[str, Iterable[str]]]) -> str:
    lines = "".join(
        f"<tr><td>{escape(word)}</td>{''.join(f'<td>{escape(str(value))}</td>' for value in values)}</tr>"
        for word, values in rows
    )
    return f'<div class="table" style="margin-top:10px"><table>{lines}</table></div>'


def _figure(value: Any) -> str:
    if value is None:
        return "\u2013"
    if isinstance(value, bool):
        return "yes" if value else "no"
    if isinstance(value, float):
        if abs(value) >= 1e4:
            return f"{value:,.0f}"
        if abs(value) < 1e-8:
            return "0"  # what rounding leaves says nothing
        return f"{value:.4g}" if abs(value) >= 1e-3 else f"{value:.1e}"
    return str(value)
