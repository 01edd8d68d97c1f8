# SPDX-License-Identifier: LGPL-2.1-or-later
"""Panels scroll only vertically, also when a widget in them scrolls into view."""

import pytest


def scroll_area(person, panel):
    """Return the single area that scrolls a panel."""
    (area,) = [
        area
        for area in person.present(person.widgets.QScrollArea)
        if area.isVisible() and area.isAncestorOf(panel)
    ]
    return area


def narrow(person, panel):
    """Make the scroll area of a panel too small for it, in both directions."""
    area = scroll_area(person, panel)
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
    """This also holds next to the vertical scroll bar, which takes 14 pixels of the width."""
    person.select(hemisphere)
    person.click("RoboticAM_NewJob")
    panel = person.panel("RoboticAM_NewJob")
    area = scroll_area(person, panel)
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
    """With a note that makes the panel too high, the next field scrolls into view, and its heading
    stays completely visible."""
    person.select(hemisphere)
    person.click("RoboticAM_NewJob")
    panel = person.panel("RoboticAM_NewJob")
    area = scroll_area(person, panel)
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
