# SPDX-License-Identifier: LGPL-2.1-or-later
"""Issues and preflight of the page, with locations that link to the path view."""

from __future__ import annotations

from html import escape
from typing import Any

from ..core.preflight.promise import amount
from . import units
from .tables import figure_text
from .viewer_3d.columns import Shown

_MOST_ISSUES = 200
# CSS class and word per promise status: an unchecked promise is never green
_MARKS = {True: ("good", "kept"), False: ("error", "broken"), None: ("unknown", "not checked")}


def findings(issues: list[dict[str, Any]], path_rows: Shown) -> str:
    """Return the table of issues, errors first; empty without issues."""
    if not issues:
        return ""
    rows = []
    for issue in sorted(
        issues, key=lambda entry: ("error", "warning", "note").index(entry["level"])
    )[:_MOST_ISSUES]:
        link = place_of(issue, path_rows)
        rows.append(
            f'<tr><td class="{issue["level"]}">{issue["level"]}</td><td class="text">{escape(issue["code"])}</td>'
            f'<td class="place">{link}</td><td class="text">{escape(units.message(issue["message"]))}</td></tr>'
        )
    note = (
        f"<p>{len(issues) - len(rows)} more findings are in report.json.</p>"
        if len(issues) > len(rows)
        else ""
    )
    return (
        f'<h2>Findings</h2><div class="table findings"><table>{"".join(rows)}</table></div>{note}'
    )


def place_of(position: dict[str, Any], path_rows: Shown) -> str:
    """Return the known indices of layer, bead and point as a link into the path view."""
    words = " ".join(
        f"{word} {position[word]}"
        for word in ("layer", "bead", "point")
        if position[word] is not None
    )
    row = path_rows.row_of(position["layer"], position["bead"], position["point"])
    return words if row is None else f'<button data-row="{row}">{words}</button>'


def preflight(promises: list[dict[str, Any]], path_rows: Shown) -> str:
    """Return the table of promises with their status: kept, broken or not checked."""
    if not promises:
        return ""
    rows = []
    for promise in promises:
        mark, word = _MARKS[promise["ok"]]
        where = "" if promise["place"] is None else place_of(promise["place"], path_rows)
        worst = (
            ""
            if promise["worst"] is None
            else amount(promise["worst"], promise["unit"], figure_text)
        )
        sign = "\u2265" if promise["at_least"] else "\u2264"
        bound = (
            ""
            if promise["bound"] is None
            else f"{sign} {amount(promise['bound'], promise['unit'], figure_text)}"
        )
        rows.append(
            f'<tr><td class="{mark}">{word}</td><td class="text">{escape(units.message(promise["promise"]))}</td><td>{units.text(worst)}</td>'
            f'<td>{units.text(bound)}</td><td class="place">{where}</td><td class="text">{escape(units.message(promise["how"]))}</td></tr>'
        )
    head = "".join(
        f"<th>{word}</th>"
        for word in ("", "promise", "worst", "allowed", "place", "how it was checked")
    )
    return (
        f'<h2>Preflight</h2><div class="table"><table><tr>{head}</tr>{"".join(rows)}</table></div>'
    )
