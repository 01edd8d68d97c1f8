# SPDX-License-Identifier: LGPL-2.1-or-later
"""If a deferred action of a panel finds that a field is deleted, it does nothing; other errors are
raised."""

import pytest

from freecad_am.gui.worker import Background, Later


@pytest.fixture
def form(person):
    widget = person.widgets.QWidget()
    yield widget
    widget.deleteLater()


def deleted_field(person):
    """Return a field that Qt has deleted and Python still holds."""
    outer = person.widgets.QWidget()
    inner = person.widgets.QLabel("text", outer)
    outer.deleteLater()
    person.core.QCoreApplication.sendPostedEvents(outer, person.core.QEvent.DeferredDelete)
    return inner


def failing(person, kind):
    """Return a function that raises an error of a kind."""
    if kind == "deleted field":
        return deleted_field(person).text
    error = {
        "of FreeCAD": RuntimeError("Recompute failed"),
        "of Python": RuntimeError("dictionary changed size"),
    }[kind]

    def fail():
        raise error

    return fail


def show_result(person, form, kind):
    """Show the result of work in a panel, which fails."""
    background, fail = Background(form), failing(person, kind)
    background.start(lambda: 1, lambda _: fail())
    background.worker.ended.wait(10)
    background.at_once()


class Panel:
    """A panel whose method fails."""

    def __init__(self, form, fail):
        self.fail, self.later = fail, Later(form, self.act)

    def act(self):
        self.fail()


def run_now(person, form, kind):
    """Run the requested action of a panel at once, which fails."""
    panel = Panel(form, failing(person, kind))
    panel.later.ask()
    panel.later.at_once()


@pytest.mark.parametrize("act", [show_result, run_now])
def test_a_field_that_is_gone_is_passed_over_and_nothing_else(person, form, act):
    with pytest.raises(RuntimeError, match="deleted"):
        deleted_field(person).text()
    act(person, form, "deleted field")
    for kind, text in (
        ("of FreeCAD", "Recompute failed"),
        ("of Python", "dictionary changed size"),
    ):
        with pytest.raises(RuntimeError, match=text):
            act(person, form, kind)
