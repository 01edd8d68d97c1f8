# SPDX-License-Identifier: LGPL-2.1-or-later
"""Our docks together: tabs of one place in a window of 1280 x 800, moved by hand, closed, opened again, in French."""

import re

import numpy as np
import pytest

from freecad_am import api
from freecad_am.gui.path import dock as paths
from freecad_am.gui.plots import dock as plots
from freecad_am.gui.redundancy_map import dock as map_tool
from freecad_am.gui.redundancy_map import dock as maps
from freecad_am.gui.redundancy_map import draft
from freecad_am.gui.simulation import dock as simulations
from freecad_am.gui.simulation import fields
from freecad_am.gui.tools.commands import GROUPS

BELOW = {
    "RoboticAM_Path": paths.NAME,
    "RoboticAM_Plots": plots.NAME,
    "RoboticAM_SpinMap": maps.NAME,
}
ORDERS = [tuple(list(BELOW)[(start + at) % 3] for at in range(3)) for start in range(3)]
WIDE, HIGH = 1280, 800
ALIKE = 3  # pixels


@pytest.fixture
def path(person, hemisphere, rough_map):
    document = hemisphere.Document
    feature = api.make_feature(document, hemisphere, layer_height=9)
    cell = api.make_cell(document, limits="paper")
    made = api.make_joint_path(document, api.make_toolpath(document, feature, cell), cell)
    made.Label = "A joint path whose label goes on and on, as that of a part of an assembly of assemblies may do"
    person.window.showNormal()
    person.window.setGeometry(0, 0, WIDE, HIGH)
    still(person)
    return made


def still(person):
    """Wait until docks no longer move, which they do little by little."""
    seen = []

    def same():
        docks = person.present(person.widgets.QDockWidget)
        seen.append([dock.geometry().getRect() for dock in docks if dock.isVisible()])
        return len(seen) > 18 and all(one == seen[-1] for one in seen[-18:])

    person.until(same, "docks to stand still")


def opened(person, path, command):
    """The dock of a tool, opened by its button, once it stands still."""
    person.select(path)
    person.click(command)
    dock = person.panel({**BELOW, "RoboticAM_Simulate": simulations.NAME}[command])
    still(person)
    return dock


def close(person, dock):
    dock.close()
    still(person)


def in_front(dock):
    return dock.isVisible() and not dock.visibleRegion().isEmpty()


def around(person):
    """FreeCAD's docks at the bottom that are seen, by name, with their heights."""
    bottom = person.core.Qt.BottomDockWidgetArea
    docks = [
        dock
        for dock in person.present(person.widgets.QDockWidget)
        if in_front(dock) and person.window.dockWidgetArea(dock) == bottom
    ]
    return {
        dock.objectName(): dock.height()
        for dock in docks
        if not dock.objectName().startswith("RoboticAM")
    }


@pytest.mark.parametrize("order", ORDERS, ids=lambda order: "-".join(name[10:] for name in order))
@pytest.mark.always("Path-Plots-SpinMap")
def test_a_window_of_1280_by_800_holds_them_as_tabs_with_the_newest_in_front(person, path, order):
    simulation = opened(person, path, "RoboticAM_Simulate")
    docks = []
    for command in order:
        docks.append(opened(person, path, command))
        assert (person.window.width(), person.window.height()) == (WIDE, HIGH)
        assert [in_front(dock) for dock in docks] == [False] * (len(docks) - 1) + [True]
        assert set(person.window.tabifiedDockWidgets(docks[0])) >= set(docks[1:])
        assert {person.window.dockWidgetArea(dock) for dock in docks} == {
            person.core.Qt.BottomDockWidgetArea
        }
        assert in_front(simulation)
    person.screenshot(f"docks-{'-'.join(order)}")
    least = person.window.minimumSizeHint()
    assert least.width() <= WIDE and least.height() <= HIGH
    # one that is behind comes to the front by its tool, one that was closed too
    for dock, command in zip(docks, order, strict=True):
        assert opened(person, path, command) is dock and in_front(dock)
        close(person, dock)
        assert opened(person, path, command) is dock
        assert [in_front(one) for one in docks] == [one is dock for one in docks]


def test_a_window_of_1280_pixels_shows_all_tools(person, path):
    bar = next(
        bar for bar in person.present(person.widgets.QToolBar) if bar.windowTitle() == "Robotic AM"
    )
    person.until(lambda: bar.width() >= bar.sizeHint().width(), "room for the toolbar", 5)
    for name in (name for group in GROUPS for name in group):
        button = person.button(f"RoboticAM_{name}")
        assert (
            bar.rect().contains(button.geometry())
            and button.mapTo(person.window, button.rect().topRight()).x() < WIDE
        )
    rows = {
        one.y()
        for one in person.present(person.widgets.QToolBar)
        if one.isVisible() and one is not bar
    }
    person.screenshot("toolbar-1280")
    # where it has room beside others it stays where the user puts it
    person.window.removeToolBarBreak(bar)
    person.window.setGeometry(0, 0, 2400, HIGH)
    person.idle(0.3)
    assert bar.y() in rows and not person.window.toolBarBreak(bar)
    person.window.setGeometry(0, 0, WIDE, HIGH)
    person.until(lambda: person.window.toolBarBreak(bar), "its row again", 5)


def test_where_the_user_has_put_them_they_are_again(person, path):
    right = person.core.Qt.RightDockWidgetArea
    first, second, third = (opened(person, path, command) for command in BELOW)
    person.window.addDockWidget(right, first)
    second.setFloating(True)
    second.setGeometry(300, 200, 800, 400)
    still(person)
    close(person, first)
    close(person, second)
    assert (
        opened(person, path, "RoboticAM_Path") is first
        and person.window.dockWidgetArea(first) == right
    )
    again = opened(person, path, "RoboticAM_Plots")
    assert (
        again is second
        and second.isFloating()
        and second.geometry().getRect() == (300, 200, 800, 400)
    )
    # the map beside the path at the right, and the simulation at the left
    person.window.addDockWidget(right, third)
    person.window.splitDockWidget(first, third, person.core.Qt.Vertical)
    simulation = opened(person, path, "RoboticAM_Simulate")
    person.window.addDockWidget(person.core.Qt.LeftDockWidgetArea, simulation)
    still(person)
    for dock, command in ((third, "RoboticAM_SpinMap"), (simulation, "RoboticAM_Simulate")):
        area = person.window.dockWidgetArea(dock)
        close(person, dock)
        assert opened(person, path, command) is dock and person.window.dockWidgetArea(dock) == area
    assert (
        in_front(first)
        and in_front(third)
        and first not in person.window.tabifiedDockWidgets(third)
    )
    assert first.geometry().bottom() < third.geometry().top()


@pytest.mark.long
@pytest.mark.parametrize("order", ORDERS, ids=lambda order: "-".join(name[10:] for name in order))
def test_the_height_they_take_is_given_back(person, path, order):
    """To those that stay, the last that is opened closed first, and the first closed first."""
    before = around(person)
    heights, docks = [before], []
    for command in order:
        docks.append(opened(person, path, command))
        heights.append(around(person))
        heights[-1][docks[-1].objectName()] = docks[-1].height()
    for dock in reversed(docks):
        close(person, dock)
        heights.pop()
        found = around(person)
        found.update({one.objectName(): one.height() for one in docks if in_front(one)})
        assert set(found) == set(heights[-1])
        assert all(abs(found[name] - high) <= ALIKE for name, high in heights[-1].items()), (
            found,
            heights[-1],
        )
    alone = opened(person, path, order[-1])
    single = alone.height()
    close(person, alone)
    docks = [opened(person, path, command) for command in order]
    for dock in docks[:-1]:
        close(person, dock)
    assert abs(docks[-1].height() - single) <= ALIKE
    close(person, docks[-1])
    assert around(person) == before


def test_a_height_that_the_user_has_given_stays(person, path):
    dock = opened(person, path, "RoboticAM_SpinMap")
    person.window.resizeDocks([dock], [430], person.core.Qt.Vertical)
    still(person)
    high = dock.height()
    assert high > 400
    beside = opened(person, path, "RoboticAM_Path")
    close(person, beside)
    assert abs(dock.height() - high) <= ALIKE
    close(person, dock)
    assert abs(opened(person, path, "RoboticAM_SpinMap").height() - high) <= ALIKE


def test_a_click_on_the_map_leaves_it_in_front(person, hand, path):
    opened(person, path, "RoboticAM_Path")
    dock = opened(person, path, "RoboticAM_SpinMap")
    one = map_tool._open[0]
    person.until(lambda: one.canvas.painted is not None, "the cells", 60)
    hand.click(one.canvas)
    person.until(lambda: path.ViewObject.Proxy.shown is not None, "the path to follow", 5)
    assert in_front(dock) and not in_front(paths.only.dock.dock)
    # and the path's dock tells it when its tab is clicked
    bar = next(
        bar
        for bar in person.present(person.widgets.QTabBar)
        if bar.isVisible() and dock.windowTitle() in [bar.tabText(at) for at in range(bar.count())]
    )
    number = next(
        at for at in range(bar.count()) if bar.tabText(at) == paths.only.dock.dock.windowTitle()
    )
    middle = bar.mapToGlobal(bar.tabRect(number).center())
    hand.at((middle.x(), middle.y()))
    assert in_front(paths.only.dock.dock)
    assert person.field(paths.only.dock.dock, "to_spin").value() == path.ViewObject.Proxy.shown[1]


# ---- the language


@pytest.fixture
def speak(person):
    def change(language):
        person.gui.setLocale(language)
        person.idle(0.6)

    yield change
    change("English")


def words(person, dock):
    """All that a dock shows in words, its title and helps among them."""
    kinds = (person.widgets.QLabel, person.widgets.QAbstractButton)
    texts = [dock.windowTitle(), *(one.text() for kind in kinds for one in dock.findChildren(kind))]
    texts += [one.toolTip() for one in dock.findChildren(person.widgets.QWidget)]
    boxes = dock.findChildren(person.widgets.QComboBox)
    texts += [box.itemText(at) for box in boxes for at in range(box.count())]
    return {re.sub(r"[\s\xa0:]+$", "", text) for text in texts}


def settled(person):
    dock = plots.only.dock
    person.until(lambda: dock.building.worker is None and dock.canvas.ready, "the plot", 20)


def test_docks_that_are_open_follow_the_language(person, path, speak):
    docks = [opened(person, path, command) for command in (*BELOW, "RoboticAM_Simulate")]
    one, simulation, plot = map_tool._open[0], simulations._open[0], plots.only.dock
    person.until(lambda: one.canvas.painted is not None, "the cells", 60)
    path_dock, plots_dock, map_dock, simulation_dock = docks
    path.ViewObject.Visibility = True
    # what is chosen is to stay
    person.field(path_dock, "single").setChecked(True)
    person.field(path_dock, "to_spin").setValue(2)
    box = person.field(plots_dock, "picture")
    box.setCurrentIndex(box.findData("spacing"))
    person.field(plots_dock, "from").setValue(1)
    settled(person)
    person.field(map_dock, "together").setChecked(False)
    person.field(map_dock, "curve").setCurrentIndex(1)
    person.field(map_dock, "curve").activated.emit(1)
    one.figures.hide_curve("planned")
    simulation.fields.factor.setCurrentIndex(1)
    simulation.player.go(0.4 * simulation.run.times.total)
    simulation.show()
    person.idle(0.5)
    english = [words(person, dock) for dock in docks]
    title = plot.picture.charts[0].title
    wanted = (
        {"Trajectoire", "Couleurs", "Tout montrer", "Une seule couche", "Point", "tubes"},
        {"Graphiques", "couches"},
        {"Branche", "Courbe", "Degré"},
        {"Temps", "Masse", "Mouvements rapides"},
    )
    speak("French")
    settled(person)
    for dock, before, some in zip(docks, english, wanted, strict=True):
        french = words(person, dock)
        assert some <= french, (some - french, sorted(french))
        assert dock.windowTitle() not in before
        assert len(before - french) > 8
    assert plot.picture.charts[0].title != title and plot.picture.name == "spacing"
    assert person.field(path_dock, "single").isChecked() and path.ViewObject.Proxy.shown[:2] == (
        2,
        2,
    )
    assert "Couche 2" in person.field(path_dock, "facts").text()
    assert person.field(plots_dock, "picture").currentData() == "spacing"
    assert person.field(plots_dock, "from").value() == 1
    assert (
        not person.field(map_dock, "together").isChecked()
        and person.field(map_dock, "curve").currentIndex() == 1
    )
    assert person.field(map_dock, "curve").currentText() == "RZ constant"
    assert not one.figures.shows("planned")
    assert (
        simulation.player.factor
        == fields.FACTORS[1]
        == fields.FACTORS[simulation.fields.factor.currentIndex()]
    )
    assert abs(simulation.fields.slider.value() / fields.STEPS - 0.4) < 0.01
    person.screenshot("docks-french")
    speak("English")
    settled(person)
    assert [words(person, dock) for dock in docks] == english
    # what stands there works: the new fields act
    person.field(simulation_dock, "point_on").click()
    person.field(path_dock, "all").click()
    person.idle()
    assert path.ViewObject.Proxy.shown is None
    person.field(map_dock, "again").click()
    person.idle()
    assert one.draft.kind != draft.CONSTANT


def test_legends_follow_the_language(person, path, speak):
    person.look()

    def corner():
        file = str(person.folder / "legend.png")
        person.gui.activeDocument().activeView().saveImage(file, 600, 450, "White")
        image = person.widgets.QImage(file).convertToFormat(person.widgets.QImage.Format_RGB32)
        return (
            np.frombuffer(bytes(image.constBits()), dtype=np.uint8)
            .reshape(450, -1, 4)[:220, :130, :3]
            .astype(int)
        )

    english = corner()
    speak("French")
    assert (np.abs(corner() - english) > 60).any(axis=2).sum() > 30
    speak("English")
    assert (np.abs(corner() - english) > 60).any(axis=2).sum() == 0
