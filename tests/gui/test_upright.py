# SPDX-License-Identifier: LGPL-2.1-or-later
"""Panels are scrolled up and down alone, whatever is brought into sight in them."""

import pytest


def around(person, panel):
    """The one area that scrolls a panel."""
    (area,) = [
        one
        for one in person.present(person.widgets.QScrollArea)
        if one.isVisible() and one.isAncestorOf(panel)
    ]
    return area


def narrow(person, panel):
    """Make what scrolls a panel too small for it, both ways."""
    area = around(person, panel)
    area.widget().setMinimumWidth(area.viewport().width() + 40)
    panel.setMinimumHeight(2 * area.viewport().height())
    person.until(
        lambda: area.horizontalScrollBar().maximum() > 0 and area.verticalScrollBar().maximum() > 0,
        "room",
        5,
    )
    return area


def sides(area):
    return area.horizontalScrollBar().value(), area.widget().x()


@pytest.mark.parametrize("machine", ["", "kuka-kr16-2"])
def test_a_new_job_is_as_wide_as_what_is_seen_of_it(person, hand, hemisphere, machine):
    """Also beside the bar that scrolls it up and down, which takes 14 pixels of the width."""
    person.select(hemisphere)
    person.click("RoboticAM_NewJob")
    panel = person.panel("RoboticAM_NewJob")
    area = around(person, panel)
    if machine:
        hand.enter(panel, "Machine", machine)
    panel.setMinimumHeight(2 * area.viewport().height())
    try:
        person.until(lambda: area.verticalScrollBar().isVisible(), "a bar", 5)
        person.idle(0.3)
        assert area.horizontalScrollBar().maximum() == 0
        person.screenshot(f"new-job-{machine}")
    finally:
        panel.setMinimumHeight(0)
    person.press("Cancel")
    person.panel_closed()


@pytest.mark.parametrize(
    ("tool", "name", "field"),
    [
        ("RoboticAM_NewJob", "RoboticAM_NewJob", "ProgramName"),
        ("RoboticAM_Feature", "RoboticAM_RevolutionFeature", "LayerHeight"),
    ],
)
def test_a_panel_is_not_scrolled_sideways(person, hand, hemisphere, tool, name, field):
    person.select(hemisphere)
    person.click(tool)
    panel = person.panel(name)
    area = narrow(person, panel)
    widest = area.widget().minimumWidth()
    try:
        area.verticalScrollBar().setValue(area.verticalScrollBar().maximum())
        area.ensureWidgetVisible(person.field(panel, field))
        person.idle(0.2)
        assert sides(area) == (0, 0)
        area.verticalScrollBar().setValue(0)
        person.idle(0.1)
        area.horizontalScrollBar().setValue(20)
        person.idle(0.1)
        assert sides(area) == (0, 0) and area.widget().width() >= widest
        area.verticalScrollBar().setValue(30)
        assert area.verticalScrollBar().value() == 30
    finally:
        area.widget().setMinimumWidth(0)
        panel.setMinimumHeight(0)
    person.press("Cancel")
    person.panel_closed()


def test_the_keys_do_not_scroll_a_new_job_sideways(person, hand, hemisphere):
    """Under a note that makes the panel too high the next field is brought into sight, and its heading stays there whole."""
    person.select(hemisphere)
    person.click("RoboticAM_NewJob")
    panel = person.panel("RoboticAM_NewJob")
    area = around(person, panel)
    hand.enter(panel, "Machine", "no-such-machine")
    person.press("Ok")
    assert person.field(panel, "MachineNote").isVisible()
    hand.click(person.field(panel, "Machine"))
    for _ in range(3):
        hand.do("key", "Tab")
        assert sides(area) == (0, 0)
    assert area.verticalScrollBar().value() > 0
    fold = person.field(panel, "FoldInputs")
    hand.click(fold)
    assert not fold.isChecked()
    person.press("Cancel")
    person.panel_closed()
