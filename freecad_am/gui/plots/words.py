# SPDX-License-Identifier: LGPL-2.1-or-later
"""The words of pictures in the language of the window."""

from __future__ import annotations

from dataclasses import replace

from ...plots.chart import Chart, Picture, Quantity
from ...plots.look import Words
from ..texts.translation import marked, sentence, tr, translated

# all that stands alone in pictures, which `plots` draws in English for reports
WORDS = (
    marked("Joint angles"),
    marked("Joint speeds"),
    marked("Joint speeds in %"),
    marked("Joint accelerations"),
    marked("Joint jerks"),
    marked("Condition"),
    marked("Speed along the path"),
    marked("Deposit rate"),
    marked("Deposited mass"),
    marked("Distance between layers"),
    marked("Predicted heights"),
    marked("Predicted widths and speeds"),
    marked("Fit of the bead widths"),
    marked("Width of beads"),
    marked("Joint speeds while depositing"),
    marked("Condition of the Jacobian (0 is singular)"),
    marked("Travel speed"),
    marked("Predicted width of the bead"),
    marked("Predicted height of the bead"),
    marked("Predicted height by layer"),
    marked("Sum of the heights, off the layers"),
    marked("time"),
    marked("path"),
    marked("layer"),
    marked("angle"),
    marked("place"),
    marked("speed"),
    marked("acceleration"),
    marked("jerk"),
    marked("rate"),
    marked("mass"),
    marked("width"),
    marked("height"),
    marked("off"),
    marked("travel speed"),
    marked("local distance"),
    marked("share of the limit"),
    marked("share of the points"),
    marked("share of the length"),
    marked("rapid"),
    marked("deposit"),
    marked("as the axes can"),
    marked("lowest"),
    marked("mean"),
    marked("highest"),
    marked("drift"),
    marked("least allowed"),
    marked("condition"),
    marked("layer height"),
    marked("a toolpath has no joints yet; choose a joint path"),
    marked("these layers have nothing to show"),
    marked("this machine has no condition"),
    marked("no limit known: the machine file has no max_speed"),
    marked("no limit known: the machine file has no max_acceleration"),
    marked("no limit known: the machine file has no max_jerk"),
    marked("Volume by layer"),
    marked("Section of the last layer"),
    marked("volume"),
    marked("share"),
    marked("part"),
    marked("deposited"),
    marked("bead"),
    marked("only solids in planar layers have sections and volumes of layers"),
    marked("none of these layers rests on another"),
    marked("no bead model sets the speeds (process.bead_model)"),
)


def of_frames() -> Words:
    """What is written in frames."""
    return Words(
        layer=tr("layer {}"),
        beyond=tr("{}: {} points beyond the limit"),
        limits=tr("limits {} to {} {}"),
        limit=tr("limits up to {} {}"),
    )


def in_words(picture: Picture, user_units: bool = True) -> Picture:
    """A picture in the language of the window; what is a name, such as that of an axis, stays. user_units: whether
    quantities in its texts are in the user's units."""

    def of_chart(chart: Chart) -> Chart:
        return replace(
            chart,
            title=translated(chart.title, user_units),
            x=Quantity(translated(chart.x.name), chart.x.unit),
            y=Quantity(translated(chart.y.name), chart.y.unit),
            curves=tuple(
                replace(curve, name=translated(curve.name, user_units)) for curve in chart.curves
            ),
            marks=tuple((value, translated(name)) for value, name in chart.marks),
            unlimited=translated(chart.unlimited),
            upright=tuple((value, translated(name)) for value, name in chart.upright),
        )

    return replace(
        picture, charts=tuple(map(of_chart, picture.charts)), lacking=sentence(picture.lacking)
    )
