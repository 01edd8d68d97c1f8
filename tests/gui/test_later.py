# SPDX-License-Identifier: LGPL-2.1-or-later
"""What a panel does later: that a field of it is gone by then is passed over, and no other error."""

import pytest

from freecad_am.gui.worker import Background, Later


@pytest.fixture
def form(person):
    widget = person.widgets.QWidget()
    yield widget
    widget.deleteLater()


def gone(person):
    """A field that Qt has deleted and Python still has."""
    outer = person.widgets.QWidget()
    inner = person.widgets.QLabel("text", outer)
    outer.deleteLater()
    person.core.QCoreApplication.sendPostedEvents(outer, person.core.QEvent.DeferredDelete)
    return inner


def failing(person, kind):
    """What ends with an error of a kind."""
    if kind == "deleted field":
        return gone(person).text
    error = {
        "of FreeCAD": RuntimeError("Recompute failed"),
        "of Python": RuntimeError("dictionary changed size"),
    }[kind]

    def fail():
        raise error

    return fail


def shown(person, form, kind):
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


def asked(person, form, kind):
    """Do at once what a panel was asked for, which fails."""
    panel = Panel(form, failing(person, kind))
    panel.later.ask()
    panel.later.at_once()


@pytest.mark.parametrize("act", [shown, asked])
def test_a_field_that_is_gone_is_passed_over_and_nothing_else(person, form, act):
    with pytest.raises(RuntimeError, match="deleted"):
        gone(person).text()
    act(person, form, "deleted field")
    for kind, text in (
        ("of FreeCAD", "Recompute failed"),
        ("of Python", "dictionary changed size"),
    ):
        with pytest.raises(RuntimeError, match=text):
            act(person, form, kind)
