# SPDX-License-Identifier: LGPL-2.1-or-later
"""The words of pictures in the language of the window."""

from __future__ import annotations

from dataclasses import replace

from ...plots.chart import Chart, Picture, Quantity
from ..texts import tr


def _words() -> dict[str, str]:
    """All words that stand alone in pictures; literals, so that a script can collect them."""
    found = (
        ("Joint angles", tr("Joint angles")), ("Joint speeds", tr("Joint speeds")),
        ("Joint speeds in %", tr("Joint speeds in %")),
        ("Joint accelerations", tr("Joint accelerations")), ("Joint jerks", tr("Joint jerks")),
        ("Condition", tr("Condition")), ("Speed along the path", tr("Speed along the path")),
        ("Deposit rate", tr("Deposit rate")), ("Deposited mass", tr("Deposited mass")),
        ("Distance between layers", tr("Distance between layers")), ("Predicted heights", tr("Predicted heights")),
        ("Predicted widths and speeds", tr("Predicted widths and speeds")),
        ("Fit of the bead widths", tr("Fit of the bead widths")), ("Width of beads", tr("Width of beads")),
        ("Joint speeds while depositing", tr("Joint speeds while depositing")),
        ("Condition of the Jacobian (0 is singular)", tr("Condition of the Jacobian (0 is singular)")),
        ("Travel speed", tr("Travel speed")), ("Predicted width of the bead", tr("Predicted width of the bead")),
        ("Predicted height of the bead", tr("Predicted height of the bead")),
        ("Predicted height by layer", tr("Predicted height by layer")),
        ("Sum of the heights, off the layers", tr("Sum of the heights, off the layers")),
        ("time", tr("time")), ("path", tr("path")), ("layer", tr("layer")), ("angle", tr("angle")), ("place", tr("place")),
        ("speed", tr("speed")), ("acceleration", tr("acceleration")), ("jerk", tr("jerk")), ("rate", tr("rate")),
        ("mass", tr("mass")), ("width", tr("width")), ("height", tr("height")), ("off", tr("off")),
        ("travel speed", tr("travel speed")), ("local distance", tr("local distance")),
        ("share of the limit", tr("share of the limit")), ("share of the points", tr("share of the points")),
        ("share of the length", tr("share of the length")), ("rapid", tr("rapid")), ("deposit", tr("deposit")),
        ("as the axes can", tr("as the axes can")), ("lowest", tr("lowest")), ("mean", tr("mean")),
        ("highest", tr("highest")), ("drift", tr("drift")), ("least allowed", tr("least allowed")),
        ("condition", tr("condition")), ("layer height", tr("layer height")),
        ("a toolpath has no joints yet; choose a joint path", tr("a toolpath has no joints yet; choose a joint path")),
        ("there is nothing to be seen in these layers", tr("there is nothing to be seen in these layers")),
        ("this machine has no condition", tr("this machine has no condition")),
        ("none of these layers lies on another", tr("none of these layers lies on another")),
        ("no bead model sets the speeds (process.bead_model)", tr("no bead model sets the speeds (process.bead_model)")),
    )
    return dict(found)


def translated(text: str) -> str:
    """A word of a picture; itself where it is a name, such as that of an axis."""
    return _words().get(text, text)


def in_words(picture: Picture) -> Picture:
    """A picture in the language of the window."""
    words = _words()

    def of(text: str) -> str:
        return words.get(text, text)

    def of_chart(chart: Chart) -> Chart:
        return replace(
            chart, title=of(chart.title), x=Quantity(of(chart.x.name), chart.x.unit),
            y=Quantity(of(chart.y.name), chart.y.unit),
            curves=tuple(replace(curve, name=of(curve.name)) for curve in chart.curves),
            upright=tuple((value, of(name)) for value, name in chart.upright),
        )

    return replace(picture, charts=tuple(map(of_chart, picture.charts)), lacking=of(picture.lacking))
