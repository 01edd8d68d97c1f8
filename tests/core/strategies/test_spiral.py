# SPDX-License-Identifier: LGPL-2.1-or-later
"""The spiral against its surface."""

import numpy as np
import pytest

from freecad_am.core.geometry.curves.profile import Meridian, RevolvedWall, arc, line
from freecad_am.core.issues import InputError
from freecad_am.core.parameters.build_direction import BuildDirectionParameters
from freecad_am.core.parameters.cell import NozzleParameters
from freecad_am.core.parameters.process import ProcessParameters, SeamParameters
from freecad_am.core.parameters.strategy import RevolutionParameters
from freecad_am.core.strategies.revolution import plan as revolution

TURN = 2.0 * np.pi
SPHERE = Meridian.chained([arc((0.0, 0.0), 45.0, 0.0, np.pi / 2)])
FUNNEL = Meridian.chained([arc((90.0, 0.0), 45.0, np.pi, np.pi / 2)])
BENT = Meridian.chained([line((10.0, 0.0), (10.0, 5.0)), line((10.0, 5.0), (4.0, 13.0))])


def spiral(meridian, direction="counter-clockwise", turn=None, **strategy):
    start, end = turn or (0.0, TURN)
    wall = RevolvedWall(meridian, np.eye(4), start, end, turn is None)
    return revolution.plan(
        wall,
        RevolutionParameters(path="spiral", **strategy),
        BuildDirectionParameters(),
        ProcessParameters(direction=direction, seam=SeamParameters(0.3, 0.0)),
        NozzleParameters(),
        0.0,
    )


def exact(meridian, turned, pitch, end):
    r, h, _ = meridian.at(np.clip(pitch * (turned / TURN - 1.0), 0.0, end))
    return np.stack([r * np.cos(0.3 + turned), r * np.sin(0.3 + turned), h], axis=1)


@pytest.mark.parametrize("meridian", [FUNNEL, BENT, SPHERE])
@pytest.mark.parametrize("pitch", [1.0, 2.7])
@pytest.mark.parametrize("chord_error", [0.01, 0.1])
@pytest.mark.always
def test_one_open_bead_rises_by_a_layer_height_per_turn(meridian, pitch, chord_error):
    toolpath = spiral(meridian, layer_height=pitch, chord_error=chord_error)
    (layer,) = toolpath.layers
    (bead,) = layer.beads
    assert not bead.closed
    turned = bead.parameter - 0.3
    end = meridian.length
    if meridian.closed_top:
        end = pitch * (turned[-1] / TURN - 1.0)
        assert np.hypot(*bead.points[-1, :2]) == pytest.approx(0.5 * pitch, abs=1e-6)
    else:
        assert turned[-1] == pytest.approx(TURN * (2.0 + meridian.length / pitch))
    assert bead.points == pytest.approx(exact(meridian, turned, pitch, end), abs=1e-9)
    # between the points, on a grid ten times finer
    share = np.linspace(0.0, 1.0, 11)[1:-1, None]
    fine = (turned[:-1] + share * np.diff(turned)).T.ravel()
    chords = (bead.points[:-1, None] + share[None] * np.diff(bead.points, axis=0)[:, None]).reshape(
        -1, 3
    )
    along = np.repeat(np.diff(bead.points, axis=0), 9, axis=0)
    off = exact(meridian, fine, pitch, end) - chords
    along = along / np.linalg.norm(along, axis=1, keepdims=True)
    off -= (off * along).sum(axis=1, keepdims=True) * along
    assert np.linalg.norm(off, axis=1).max() <= chord_error * (1.0 + 1e-6)


def test_first_and_last_turns_are_flat_circles():
    bead = spiral(FUNNEL).layers[0].beads[0]
    turned = bead.parameter - 0.3
    for turn, height in ((turned <= TURN, 0.0), (turned >= turned[-1] - TURN, 45.0)):
        assert turn.sum() > 24
        assert np.abs(bead.points[turn, 2] - height).max() < 1e-9


def test_clockwise_spirals_fall_in_their_angle():
    bead = spiral(FUNNEL, "clockwise").layers[0].beads[0]
    assert bead.parameter[0] == pytest.approx(0.3)
    assert (np.diff(bead.parameter) < 0.0).all()
    assert bead.points[:, 1] == pytest.approx(
        np.hypot(*bead.points[:, :2].T) * np.sin(bead.parameter), abs=1e-9
    )


def test_kinks_are_points_of_the_spiral():
    bead = spiral(BENT).layers[0].beads[0]
    at_kink = np.abs(bead.points[:, 2] - 5.0) < 1e-9
    assert at_kink.sum() == 1
    assert np.hypot(*bead.points[at_kink][0, :2]) == pytest.approx(10.0, abs=1e-9)


def test_a_part_of_a_turn_has_no_spiral():
    with pytest.raises(InputError, match="not a full turn") as refused:
        spiral(SPHERE, turn=(0.0, 3.0))
    assert refused.value.code == "PARTIAL_TURN"


@pytest.mark.parametrize("meridian, flat_top", [(FUNNEL, True), (BENT, True), (SPHERE, False)])
def test_the_places_where_it_lies_over_itself_are_told(meridian, flat_top):
    """Where the space above the turn below is less than a layer height: from 0 in the second turn,
    to 0 in the last."""
    toolpath = spiral(meridian, layer_height=2.0)
    bead = toolpath.layers[0].beads[0]
    turned = bead.parameter - 0.3
    notes = [issue for issue in toolpath.issues if issue.code == "DEPOSITED_TWICE"]
    assert [(note.level, note.layer, note.bead) for note in notes] == [("note", 0, 0)] * (
        1 + flat_top
    )
    assert turned[notes[0].point] == pytest.approx(TURN)
    if flat_top:
        assert turned[notes[1].point] == pytest.approx(turned[-1] - TURN, abs=0.3)
