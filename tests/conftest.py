# SPDX-License-Identifier: LGPL-2.1-or-later
"""Makes FreeCAD importable in whatever Python runs the tests, and skips GUI tests where there is no window."""

import sys
from pathlib import Path

import pytest

ROOT = Path(__file__).resolve().parent.parent
sys.path.insert(0, str(ROOT))

from freecad_am.batch import host  # noqa: E402

host.find_freecad()

import FreeCAD  # noqa: E402


def pytest_collection_modifyitems(items):
    for item in items:
        if item.get_closest_marker("gui") and not FreeCAD.GuiUp:
            item.add_marker(pytest.mark.skip(reason="no FreeCAD main window: ./freecad-am test opens one under Xvfb"))


@pytest.fixture
def doc():
    """An empty document, closed afterwards."""
    document = FreeCAD.newDocument("Test")
    name = document.Name
    yield document
    if name in FreeCAD.listDocuments():
        FreeCAD.closeDocument(name)


@pytest.fixture(scope="session")
def root():
    """The top folder of the repository."""
    return ROOT
