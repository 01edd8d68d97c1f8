# SPDX-License-Identifier: LGPL-2.1-or-later
"""Clicks lead from a line of the program to its point of the path and back, compared with the text
itself."""

import re

import numpy as np
import pytest

from freecad_am import api
from freecad_am.gui.path import dock
from freecad_am.objects.joint_path import planned_of
from tests.gui.test_path import screen_position


@pytest.fixture
def program(person, hemisphere):
    document = hemisphere.Document
    cell = api.make_cell(document)
    toolpath = api.make_toolpath(
        document, api.make_feature(document, hemisphere, layer_height=10), cell
    )
    joint_path = api.make_joint_path(document, toolpath, cell)
    program_object = api.make_program(
        document, joint_path, name="CUP", post="fanuc", max_points=150
    )
    person.idle()
    return program_object


def first_axis(text, line):
    """Return J1, in deg, of the position that a line of a FANUC program leads to."""
    number = re.match(r" *\d+:[JL] P\[(\d+)\]", text.split("\n")[line])[1]
    return float(re.search(rf"P\[{number}\]\s*\{{.*?J1=\s*(-?[\d.]+) deg", text, re.DOTALL)[1])


def click_line(person, hand, text, line):
    block = text.document().findBlockByNumber(line)
    text.verticalScrollBar().setValue(max(0, line - 3))
    person.idle(0.2)
    box = text.blockBoundingGeometry(block).translated(text.contentOffset())
    position = text.viewport().mapToGlobal(person.core.QPoint(60, round(box.center().y())))
    hand.at((position.x(), position.y()))


def test_a_click_on_a_line_shows_its_point_and_a_click_on_the_path_its_line(person, hand, program):
    path = program.JointPath
    motion = planned_of(path, path.Label)[0].motion
    person.double_click(program)
    window = person.panel("RoboticAM_ProgramText")
    text, location = person.field(window, "text"), person.field(window, "place")
    files = api.result(program).files
    name = max(files, key=lambda name: len(files[name]))
    assert len(files) > 2
    person.choose(window, "file", name)
    content = text.toPlainText()
    moves = [
        number
        for number, line in enumerate(content.split("\n"))
        if re.match(r" *\d+:[JL] P\[", line)
    ]
    proxy = path.ViewObject.Proxy
    for line in (moves[len(moves) // 2], moves[-9]):
        proxy.show(None)
        click_line(person, hand, text, line)
        person.until(lambda: proxy.shown is not None, "the path up to the line's point", 10)
        match = re.fullmatch(
            rf"Line {line + 1}: layer (\d+) bead (\d+) point (\d+)", location.text()
        )
        layer, bead, point = map(int, match.groups())
        assert proxy.shown[1] == layer and proxy.shown[2] == point + 1 and bead == 0
        row = np.flatnonzero(motion.deposit & (motion.layer == layer) & (motion.point == point))[0]
        assert np.degrees(motion.joints[row, 0]) == pytest.approx(
            first_axis(content, line), abs=1e-3
        )
    person.screenshot("program_line")
    # and back: a click on the path marks the line that leads to the point
    proxy.show(None)
    path.Document.Sphere.ViewObject.Visibility = False
    person.panel(dock.NAME).close()
    window.move(0, 0)
    window.resize(420, 620)
    view = person.gui.activeDocument().activeView()
    view.viewFront()
    person.gui.SendMsgToActiveView("ViewFit")
    person.idle(0.5)
    rows, toward = proxy.rows, np.array(view.getViewDirection())
    facing = np.flatnonzero((rows.points @ toward < -12.0) & (rows.points[:, 2] > 20.0))
    positions = {int(row): screen_position(view, hand, rows.points[row]) for row in facing[::7]}
    beside = [
        row
        for row, (x, _) in positions.items()
        if not window.frameGeometry().contains(x, positions[row][1])
    ]
    assert beside
    old_location = location.text()
    hand.at(positions[beside[0]])
    person.until(lambda: location.text() != old_location, "the line of the point", 10)
    line, layer, point = map(
        int, re.fullmatch(r"Line (\d+): layer (\d+) bead 0 point (\d+)", location.text()).groups()
    )
    row = np.flatnonzero(motion.deposit & (motion.layer == layer) & (motion.point == point))[0]
    assert np.linalg.norm(motion.position[row] - rows.points[beside[0]]) < 3.0
    program_text = text.toPlainText()
    assert text.textCursor().blockNumber() == line - 1 and text.extraSelections()
    assert np.degrees(motion.joints[row, 0]) == pytest.approx(
        first_axis(program_text, line - 1), abs=1e-3
    )
    assert person.field(window, "file").currentText() in program.Files
    person.field(window, "close").click()


def test_a_text_of_an_earlier_plan_leads_nowhere(person, program):
    person.double_click(program)
    window = person.panel("RoboticAM_ProgramText")
    program.Document.Feature.LayerHeight = 8
    person.idle(0.2)
    from freecad_am.gui import program_window as windows

    program_window = next(window_ for window_ in windows._shown if window_.obj is program)
    assert program_window.located is None and person.field(window, "place").text() == ""
    person.field(window, "close").click()
