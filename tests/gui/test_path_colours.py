# SPDX-License-Identifier: LGPL-2.1-or-later
"""The colours of joint paths show the machine's reserves, and its infeasible points."""

import numpy as np
import pytest

from freecad_am import api
from freecad_am.core.kinematics.limits import margins
from freecad_am.core.kinematics.machines import machine as machines
from freecad_am.core.simulation.achievable_feed import speed_ratios
from freecad_am.gui.colours import ramp
from freecad_am.gui.path import colouring, legend

RED = tuple(round(255 * channel) for channel in colouring.UNREACHABLE)


def test_joint_paths_are_coloured_by_what_the_machine_has_left(person, joint_path):
    document, vobj = joint_path.Document, joint_path.ViewObject
    assert vobj.getEnumerationsOfProperty("Colouring") == list(colouring.JOINT_KINDS)
    # the toolpath is hidden, because it is at the same place
    assert not document.Toolpath.ViewObject.Visibility
    planned = api.result(joint_path)
    motion, machine = planned.motion, machines.load(document.Cell.Machine)
    limits = machine.limits(planned.joint_path.limits)
    share = np.nanmin(
        np.concatenate(
            [
                margins(motion.joints, limits.lower, limits.upper),
                margins(
                    motion.joints @ limits.coefficients.T,
                    limits.coupled_lower,
                    limits.coupled_upper,
                ),
            ],
            axis=1,
        ),
        axis=1,
    )
    scale = vobj.Proxy.scale
    assert (scale.title, scale.unit) == ("joint margin", "%")
    assert scale.lowest == pytest.approx(100 * share[motion.deposit].min())
    assert scale.highest == pytest.approx(100 * share[motion.deposit].max())
    assert scale.text_at(7) == f"joint margin {100 * share[motion.deposit][7]:.3g} %"
    vobj.Colouring = "joint speed"
    ratio = speed_ratios(motion.joints, motion.duration, machine.max_speed).max(axis=1)
    assert vobj.Proxy.scale.highest == pytest.approx(100 * ratio[motion.deposit].max())
    vobj.Colouring = "condition"
    assert vobj.Proxy.scale.lowest == pytest.approx(joint_path.SmallestCondition)
    for kind in colouring.JOINT_KINDS:
        vobj.Colouring = kind
        person.idle()
        assert [scale_.title for scale_ in legend.visible_scales(document)] == [kind]
        person.screenshot(f"joint_path_{kind.replace(' ', '_')}")


def test_what_the_machine_cannot_do_has_colours_of_its_own(person):
    values = np.array([np.nan, -0.1, 0.0, 0.5, 1.0, 1.4])
    colours, scale = colouring.by_machine(values, colouring.MARGIN)
    assert (colours[0] == colouring.UNREACHABLE).all() and (
        colours[1] == colouring.BELOW_COLOUR
    ).all()
    assert (
        scale.text_at(0) == "joint margin unreachable" and scale.text_at(3) == "joint margin 50 %"
    )
    assert scale.without == "unreachable" and scale.below == "beyond a limit" and not scale.above
    colours, scale = colouring.by_machine(values, colouring.RATIO)
    assert (
        (colours[5] == colouring.ABOVE_COLOUR).all()
        and scale.above == "above its maximum"
        and not scale.below
    )
    assert np.array_equal(colours[[2, 3, 4]], ramp(np.array([0.1, 0.6, 1.1]) / 1.1))
    # without values there are no numbers: neither 0 nor a ramp
    scale = colouring.by_machine(np.full(3, np.nan), colouring.CONDITION)[1]
    assert scale.classes == (("unreachable", colouring.UNREACHABLE),) and scale.ticks == ()
    assert scale.text_at(1) == "condition unreachable"
    scale = colouring.by_machine(np.array([np.nan, -0.2]), colouring.MARGIN)[1]
    assert scale.classes == (
        ("beyond a limit", colouring.BELOW_COLOUR),
        ("unreachable", colouring.UNREACHABLE),
    )
    assert scale.ticks == () and scale.text_at(1) == "joint margin -20 %"


def test_unreachable_points_are_red(person, hemisphere, no_remedies):
    document = hemisphere.Document
    cell = api.make_cell(document, limits="paper")
    toolpath = api.make_toolpath(
        document, api.make_feature(document, hemisphere, layer_height=5), cell
    )
    joint_path = api.make_joint_path(document, toolpath, cell, method="constant")
    assert joint_path.Status == "infeasible"
    person.look()
    assert person.screen_pixels(RED, 12) > 20
    joint_path.ViewObject.Proxy.show((0, 0, None))
    person.idle()


@pytest.mark.parametrize("kind", [colouring.MARGIN, colouring.RATIO, colouring.CONDITION])
def test_the_legend_of_what_is_out_of_reach_altogether_says_so(person, hemisphere, kind):
    document = hemisphere.Document
    cell = api.make_cell(document, limits="paper", deposition_point=(9000, 0, 0, 0, 0, 0))
    toolpath = api.make_toolpath(
        document, api.make_feature(document, hemisphere, layer_height=9), cell
    )
    path = api.make_joint_path(document, toolpath, cell)
    path.ViewObject.Colouring = kind
    person.idle(0.3)
    (scale,) = legend.visible_scales(document)
    assert (
        scale.title == kind
        and scale.ticks == ()
        and scale.classes == (("unreachable", colouring.UNREACHABLE),)
    )
    person.screenshot(f"legend_unreachable_{kind.replace(' ', '_')}")
    assert person.screen_pixels(RED, 4) > 100  # its mark in the legend
