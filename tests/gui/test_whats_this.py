# SPDX-License-Identifier: LGPL-2.1-or-later
"""What's This by mouse: tools and fields lead to their page, without a message about an addon."""

import pytest

from freecad_am.gui.tools import commands, whats_this
from freecad_am.gui.widgets import upright


@pytest.fixture
def shown(person):
    """Return the first line of the page in the window for help, and the note above it."""

    def look():
        windows = [
            help_window
            for help_window in person.present(person.widgets.QDialog, whats_this.NAME)
            if help_window.isVisible()
        ]
        if not windows:
            return None
        note = person.field(windows[0], "note")
        return person.field(windows[0], "page").toPlainText().splitlines()[
            0
        ], note.text() if note.isVisible() else ""

    yield look
    for help_window in whats_this._windows:
        help_window.window.hide()


def ask(person, hand, widget):
    hand.click(person.button("Std_WhatsThis"))
    person.until(person.widgets.QWhatsThis.inWhatsThisMode, "the mode of What's This", 5)
    hand.click(widget)


def test_every_command_has_its_page():
    pages = {name: whats_this.page_of(name) for group in commands.GROUPS for name in group}
    assert whats_this.INDEX not in pages.values() and len(set(pages.values())) == len(pages) == 21
    assert all((whats_this.PAGES / page).is_file() for page in pages.values())


def test_a_tool_leads_to_its_page(person, hand, hemisphere, shown):
    for command, title in (
        ("Cell", "Cell"),
        ("SpinMap", "Free Rotation Map"),
    ):  # the second is disabled
        ask(person, hand, person.button(f"RoboticAM_{command}"))
        person.until(lambda: shown() == (title, ""), f"the page of {command}", 5)  # noqa: B023
        assert not person.widgets.QWhatsThis.inWhatsThisMode()
        person.screenshot("whats_this_tool")
        whats_this._windows[-1].window.close()  # without a window manager it covers the toolbar


def test_a_field_leads_to_the_page_of_its_panel_and_is_told(person, hand, hemisphere, shown):
    person.select(hemisphere)
    person.click("RoboticAM_Feature")
    panel = person.panel("RoboticAM_RevolutionFeature")
    field = person.field(panel, "LayerHeight")
    ask(person, hand, field)
    person.until(lambda: shown() is not None, "the page", 5)
    title, note = shown()
    assert (
        title == "Feature"
        and note
        and note in (field.whatsThis(), field.parentWidget().whatsThis())
    )
    person.screenshot("whats_this_field")
    person.press("Cancel")
    person.panel_closed()


def test_links_lead_on_and_the_menu_leads_to_all_tools(person, hemisphere, shown):
    from PySide import QtCore

    person.gui.runCommand(whats_this.NAME)
    assert shown() == ("Tools", "")
    page = whats_this._windows[-1].text
    page.setSource(page.source().resolved(QtCore.QUrl("../tutorials/README.md")))
    assert shown()[0] == "Tutorials"


def test_what_is_not_ours_is_left_to_freecad(person):
    docks = person.present(person.widgets.QDockWidget)
    combo = next(dock for dock in docks if not dock.objectName().startswith("RoboticAM"))
    assert whats_this._ours(combo) == ("", "")


def test_what_pyside_mistakes_for_an_event_is_let_pass(person):
    """PySide sometimes passes an earlier object at the event's address."""
    for event_filter in (whats_this._watches[0], upright._guard):
        assert event_filter.eventFilter(person.window, person.window) is False


def test_tables_of_the_help_begin_with_what_they_say(person, shown):
    person.gui.runCommand(whats_this.NAME)
    for page in ("README.md", "cell.md", "export-path.md"):
        whats_this.show(page)
        person.idle(0.1)
        document = whats_this._windows[-1].text.document()
        tables = [
            frame
            for frame in document.rootFrame().childFrames()
            if isinstance(frame, person.widgets.QTextTable)
        ]
        assert tables, page
        for table in tables:
            cells = [table.cellAt(0, column) for column in range(table.columns())]
            assert any(cell.firstCursorPosition().block().text().strip() for cell in cells), page
