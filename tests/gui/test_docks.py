# SPDX-License-Identifier: LGPL-2.1-or-later
"""All docks together: tabs in one area of a window of 1280 x 800, moved by hand, closed, reopened,
in French."""

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
ORDERS = [tuple(list(BELOW)[(start + offset) % 3] for offset in range(3)) for start in range(3)]
WIDTH_PX, HEIGHT_PX = 1280, 800
TOLERANCE_PX = 3  # pixels


@pytest.fixture
def path(person, hemisphere, rough_map):
    document = hemisphere.Document
    feature = api.make_feature(document, hemisphere, layer_height=9)
    cell = api.make_cell(document, limits="paper")
    joint_path = api.make_joint_path(document, api.make_toolpath(document, feature, cell), cell)
    joint_path.Label = "A joint path whose label goes on and on, as that of a part of an assembly of assemblies may do"
    person.window.showNormal()
    person.window.setGeometry(0, 0, WIDTH_PX, HEIGHT_PX)
    still(person)
    return joint_path


def still(person):
    """Wait until docks stop moving, which they do in small steps."""
    states = []

    def same():
        docks = person.present(person.widgets.QDockWidget)
        states.append([dock.geometry().getRect() for dock in docks if dock.isVisible()])
        return len(states) > 18 and all(state == states[-1] for state in states[-18:])

    person.until(same, "docks to stand still")


def opened(person, path, command):
    """Open the dock of a tool by its button, and return it when it has stopped moving."""
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


def other_docks(person):
    """Return FreeCAD's visible docks at the bottom by name, with their heights."""
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
        assert (person.window.width(), person.window.height()) == (WIDTH_PX, HEIGHT_PX)
        assert [in_front(dock) for dock in docks] == [False] * (len(docks) - 1) + [True]
        assert set(person.window.tabifiedDockWidgets(docks[0])) >= set(docks[1:])
        assert {person.window.dockWidgetArea(dock) for dock in docks} == {
            person.core.Qt.BottomDockWidgetArea
        }
        assert in_front(simulation)
    person.screenshot(f"docks-{'-'.join(order)}")
    minimum_size = person.window.minimumSizeHint()
    assert minimum_size.width() <= WIDTH_PX and minimum_size.height() <= HEIGHT_PX
    # the tool of a hidden or closed dock brings it to the front
    for dock, command in zip(docks, order, strict=True):
        assert opened(person, path, command) is dock and in_front(dock)
        close(person, dock)
        assert opened(person, path, command) is dock
        assert [in_front(candidate) for candidate in docks] == [
            candidate is dock for candidate in docks
        ]


def test_a_window_of_1280_pixels_shows_all_tools(person, path):
    bar = next(
        bar for bar in person.present(person.widgets.QToolBar) if bar.windowTitle() == "Robotic AM"
    )
    person.until(lambda: bar.width() >= bar.sizeHint().width(), "room for the toolbar", 5)
    for name in (name for group in GROUPS for name in group):
        button = person.button(f"RoboticAM_{name}")
        assert (
            bar.rect().contains(button.geometry())
            and button.mapTo(person.window, button.rect().topRight()).x() < WIDTH_PX
        )
    rows = {
        toolbar.y()
        for toolbar in person.present(person.widgets.QToolBar)
        if toolbar.isVisible() and toolbar is not bar
    }
    person.screenshot("toolbar-1280")
    # if it fits next to others, it stays where the user puts it
    person.window.removeToolBarBreak(bar)
    person.window.setGeometry(0, 0, 2400, HEIGHT_PX)
    person.idle(0.3)
    assert bar.y() in rows and not person.window.toolBarBreak(bar)
    person.window.setGeometry(0, 0, WIDTH_PX, HEIGHT_PX)
    person.until(lambda: person.window.toolBarBreak(bar), "its row again", 5)


def test_where_the_user_has_put_them_they_are_again(person, path):
    right = person.core.Qt.RightDockWidgetArea
    path_dock_, simulation_dock_, map_dock_ = (opened(person, path, command) for command in BELOW)
    person.window.addDockWidget(right, path_dock_)
    simulation_dock_.setFloating(True)
    simulation_dock_.setGeometry(300, 200, 800, 400)
    still(person)
    close(person, path_dock_)
    close(person, simulation_dock_)
    assert (
        opened(person, path, "RoboticAM_Path") is path_dock_
        and person.window.dockWidgetArea(path_dock_) == right
    )
    again = opened(person, path, "RoboticAM_Plots")
    assert (
        again is simulation_dock_
        and simulation_dock_.isFloating()
        and simulation_dock_.geometry().getRect() == (300, 200, 800, 400)
    )
    # the map next to the path at the right, and the simulation at the left
    person.window.addDockWidget(right, map_dock_)
    person.window.splitDockWidget(path_dock_, map_dock_, person.core.Qt.Vertical)
    simulation = opened(person, path, "RoboticAM_Simulate")
    person.window.addDockWidget(person.core.Qt.LeftDockWidgetArea, simulation)
    still(person)
    for dock, command in ((map_dock_, "RoboticAM_SpinMap"), (simulation, "RoboticAM_Simulate")):
        area = person.window.dockWidgetArea(dock)
        close(person, dock)
        assert opened(person, path, command) is dock and person.window.dockWidgetArea(dock) == area
    assert (
        in_front(path_dock_)
        and in_front(map_dock_)
        and path_dock_ not in person.window.tabifiedDockWidgets(map_dock_)
    )
    assert path_dock_.geometry().bottom() < map_dock_.geometry().top()


@pytest.mark.long
@pytest.mark.parametrize("order", ORDERS, ids=lambda order: "-".join(name[10:] for name in order))
def test_the_height_they_take_is_given_back(person, path, order):
    """Closing docks gives their height back to the others, in either order of closing."""
    original_heights = other_docks(person)
    heights, docks = [original_heights], []
    for command in order:
        docks.append(opened(person, path, command))
        heights.append(other_docks(person))
        heights[-1][docks[-1].objectName()] = docks[-1].height()
    for dock in reversed(docks):
        close(person, dock)
        heights.pop()
        new_heights = other_docks(person)
        new_heights.update(
            {
                open_dock.objectName(): open_dock.height()
                for open_dock in docks
                if in_front(open_dock)
            }
        )
        assert set(new_heights) == set(heights[-1])
        assert all(
            abs(new_heights[name] - high) <= TOLERANCE_PX for name, high in heights[-1].items()
        ), (
            new_heights,
            heights[-1],
        )
    alone = opened(person, path, order[-1])
    single = alone.height()
    close(person, alone)
    docks = [opened(person, path, command) for command in order]
    for dock in docks[:-1]:
        close(person, dock)
    assert abs(docks[-1].height() - single) <= TOLERANCE_PX
    close(person, docks[-1])
    assert other_docks(person) == original_heights


def test_a_height_that_the_user_has_given_stays(person, path):
    dock = opened(person, path, "RoboticAM_SpinMap")
    person.window.resizeDocks([dock], [430], person.core.Qt.Vertical)
    still(person)
    high = dock.height()
    assert high > 400
    beside = opened(person, path, "RoboticAM_Path")
    close(person, beside)
    assert abs(dock.height() - high) <= TOLERANCE_PX
    close(person, dock)
    assert abs(opened(person, path, "RoboticAM_SpinMap").height() - high) <= TOLERANCE_PX


def test_a_click_on_the_map_leaves_it_in_front(person, hand, path):
    opened(person, path, "RoboticAM_Path")
    dock = opened(person, path, "RoboticAM_SpinMap")
    map_dock = map_tool._open[0]
    person.until(lambda: map_dock.canvas.painted is not None, "the cells", 60)
    hand.click(map_dock.canvas)
    person.until(lambda: path.ViewObject.Proxy.shown is not None, "the path to follow", 5)
    assert in_front(dock) and not in_front(paths.only.dock.dock)
    # a click on the tab of the path's dock brings it to the front
    bar = next(
        bar
        for bar in person.present(person.widgets.QTabBar)
        if bar.isVisible()
        and dock.windowTitle() in [bar.tabText(index) for index in range(bar.count())]
    )
    number = next(
        tab for tab in range(bar.count()) if bar.tabText(tab) == paths.only.dock.dock.windowTitle()
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
    """Return all texts of a dock, including its title and tooltips."""
    kinds = (person.widgets.QLabel, person.widgets.QAbstractButton)
    texts = [
        dock.windowTitle(),
        *(widget.text() for kind in kinds for widget in dock.findChildren(kind)),
    ]
    texts += [widget.toolTip() for widget in dock.findChildren(person.widgets.QWidget)]
    boxes = dock.findChildren(person.widgets.QComboBox)
    texts += [box.itemText(index) for box in boxes for index in range(box.count())]
    return {re.sub(r"[\s\xa0:]+$", "", text) for text in texts}


def settled(person):
    dock = plots.only.dock
    person.until(lambda: dock.building.worker is None and dock.canvas.ready, "the plot", 20)


def test_docks_that_are_open_follow_the_language(person, path, speak):
    docks = [opened(person, path, command) for command in (*BELOW, "RoboticAM_Simulate")]
    rotation_dock, simulation, plot = map_tool._open[0], simulations._open[0], plots.only.dock
    person.until(lambda: rotation_dock.canvas.painted is not None, "the cells", 60)
    path_dock, plots_dock, map_dock, simulation_dock = docks
    path.ViewObject.Visibility = True
    # the choice must survive
    person.field(path_dock, "single").setChecked(True)
    person.field(path_dock, "to_spin").setValue(2)
    box = person.field(plots_dock, "picture")
    box.setCurrentIndex(box.findData("spacing"))
    person.field(plots_dock, "from").setValue(1)
    settled(person)
    person.field(map_dock, "together").setChecked(False)
    person.field(map_dock, "curve").setCurrentIndex(1)
    person.field(map_dock, "curve").activated.emit(1)
    rotation_dock.figures.hide_curve("planned")
    simulation.fields.factor.setCurrentIndex(1)
    simulation.player.go(0.4 * simulation.run.times.total)
    simulation.show()
    person.idle(0.5)
    english = [words(person, dock) for dock in docks]
    title = plot.picture.charts[0].title
    french_words = (
        {"Trajectoire", "Couleurs", "Tout montrer", "Une seule couche", "Point", "tubes"},
        {"Graphiques", "couches"},
        {"Branche", "Courbe", "Degré"},
        {"Temps", "Masse", "Mouvements rapides"},
    )
    speak("French")
    settled(person)
    for dock, english_words, expected_words in zip(docks, english, french_words, strict=True):
        french = words(person, dock)
        assert expected_words <= french, (expected_words - french, sorted(french))
        assert dock.windowTitle() not in english_words
        assert len(english_words - french) > 8
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
    assert not rotation_dock.figures.shows("planned")
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
    # the texts belong to working fields: the new ones react
    person.field(simulation_dock, "point_on").click()
    person.field(path_dock, "all").click()
    person.idle()
    assert path.ViewObject.Proxy.shown is None
    person.field(map_dock, "again").click()
    person.idle()
    assert rotation_dock.draft.kind != draft.CONSTANT


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
