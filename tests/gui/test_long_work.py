# SPDX-License-Identifier: LGPL-2.1-or-later
"""During long work the window stays responsive: progress, Cancel by mouse and by Esc, and an
unchanged document."""

import gc
import re
import subprocess
import threading
import time

import FreeCAD as App
import pytest

from freecad_am import api
from freecad_am.core.issues import InputError
from freecad_am.gui import busy
from freecad_am.gui.worker import Worker
from freecad_am.objects.feature import RevolutionFeature
from freecad_am.objects.shapes import part_file
from freecad_am.objects.toolpath import Toolpath
from freecad_am.objects.work import hooks, progress
from freecad_am.objects.work.progress import Cancelled
from tests.gui.long_jobs import JOBS

pytestmark = pytest.mark.planned_anew

# s; a longer pause counts as not responding, however busy the machine; `bench long_work` measures
# the pause
MAX_PAUSE_S = 5.0
WORK_S = 60.0  # s; none of the works below ends earlier


@pytest.fixture(params=JOBS, ids=lambda make: make.__name__)
def long_job(person, request, root):
    return request.param(root)


def find_dialogs(person):
    widgets = person.present(person.widgets.QDialog, busy.NAME)
    return [dialog for dialog in widgets if dialog.isVisible()]


class Traced:
    """Record the thread in which it is deleted, which matters for widgets; Python's collection
    deletes one of a cycle."""

    def __init__(self, ends, cycle):
        self.ends = ends
        self.itself = self if cycle else None

    def __del__(self):
        self.ends.append(threading.current_thread())


class Watcher:
    """Tick during the work, like everything in the window, and act when the dialog is open."""

    def __init__(self, person, act):
        self.person, self.act = person, act
        self.ticks, self.acted, self.gaps = [], None, []
        self.timer = person.core.QTimer()
        self.timer.setInterval(20)
        self.timer.timeout.connect(self.tick)
        self.timer.start()

    def tick(self):
        self.ticks.append(time.monotonic())
        open_dialogs = find_dialogs(self.person)
        if open_dialogs and self.acted is None:
            self.acted = time.monotonic()
            self.act(open_dialogs[0])

    def stop(self):
        self.timer.stop()
        self.gaps = [later - earlier for earlier, later in zip(self.ticks, self.ticks[1:])]


def state(document):
    """Return all saved data of the objects, except those that FreeCAD 1.0 shows as an address."""
    left_out = ("Visibility", "Proxy", "Shape")
    return {
        obj.Name: [
            re.sub(" at 0x[0-9a-f]+", "", str(getattr(obj, name)))
            for name in sorted(obj.PropertiesList)
            if name not in left_out
        ]
        for obj in document.Objects
    }


def wind_down(person):
    """Wait until cancelled work has ended."""
    person.until(
        lambda: not [thread for thread in threading.enumerate() if thread.name == "Robotic AM"],
        "the work to end",
        WORK_S,
    )


def test_cancel_ends_the_work_and_leaves_the_document_as_it_was(person, long_job):
    document = long_job.document
    original, steps = state(document), (document.UndoCount, document.RedoCount)
    texts = []

    def cancel(dialog):
        texts.append([label.text() for label in dialog.findChildren(person.widgets.QLabel)])
        person.core.QTimer.singleShot(300, press)

    def press():
        stamps.append(time.monotonic())
        person.field(find_dialogs(person)[0], "cancel").click()

    stamps = []
    watcher = Watcher(person, cancel)
    with pytest.raises(Cancelled):
        getattr(api, long_job.function)(document, **long_job.inputs)
    latency = time.monotonic() - stamps[0]
    watcher.stop()
    assert latency < MAX_PAUSE_S and max(watcher.gaps) < MAX_PAUSE_S
    assert texts[0][0].startswith(("Toolpath", "Joint path"))
    assert len(watcher.ticks) > 3 and find_dialogs(person) == []
    assert (state(document), (document.UndoCount, document.RedoCount)) == (original, steps)
    assert not hooks.carrying()
    wind_down(person)


def endless(monkeypatch, stage, entered=None):
    """Let the work of a stage continue until it is cancelled, and report its progress."""

    def prepare(self, obj):
        def work():
            if entered is not None:
                entered.append(threading.current_thread())
            for number in range(int(WORK_S / 0.01)):
                time.sleep(0.01)
                progress.report(min(1.0, number / 100), "counting")
            raise AssertionError("seen to the end")

        return work

    monkeypatch.setattr(stage, "prepare", prepare)


@pytest.fixture
def feature(person, hemisphere):
    return api.make_feature(hemisphere.Document, hemisphere, layer_height=10)


def by_esc(person):
    """Press Esc on the keyboard."""
    process = []

    def press():
        process.append(subprocess.Popen(["xdotool", "key", "Escape"]))

    return lambda dialog: person.core.QTimer.singleShot(200, press)


def by_mouse(person):
    """Click Cancel with the mouse."""

    def press(dialog):
        button = person.field(dialog, "cancel")
        position = button.mapToGlobal(button.rect().center())
        subprocess.Popen(
            ["xdotool", "mousemove", str(position.x()), str(position.y()), "click", "1"]
        )

    return lambda dialog: person.core.QTimer.singleShot(200, lambda: press(dialog))


@pytest.mark.parametrize("way", [by_esc, by_mouse])
def test_ok_is_cancelled_and_the_panel_stays_with_what_was_entered(
    person, feature, monkeypatch, way
):
    document, steps = feature.Document, feature.Document.UndoCount
    original = state(document)
    endless(monkeypatch, Toolpath)
    person.click("RoboticAM_Toolpath")
    panel = person.panel("RoboticAM_Toolpath")
    person.type(panel, "TravelSpeed", "7 mm/s")
    watcher = Watcher(person, way(person))
    person.press("Ok")
    watcher.stop()
    assert watcher.acted and state(document) == original and document.UndoCount == steps
    assert (
        "Cancelled" in person.panel_error(panel) and person.field(panel, "TravelSpeed").isVisible()
    )
    monkeypatch.undo()
    person.press("Ok")
    person.panel_closed()
    assert (document.Toolpath.TravelSpeed.Value, document.UndoCount) == (7.0, steps + 1)


@pytest.mark.parametrize("way", [by_esc, by_mouse])
def test_a_recompute_of_freecad_is_cancelled_and_what_follows_waits(
    person, feature, monkeypatch, way
):
    document = feature.Document
    toolpath = api.make_toolpath(document, feature)
    layers, key = toolpath.Layers, toolpath.Key
    feature.LayerHeight = 5
    entered = []
    endless(monkeypatch, RevolutionFeature, entered)
    watcher = Watcher(person, way(person))
    person.gui.runCommand("Std_Refresh")
    watcher.stop()
    assert watcher.acted and len(entered) == 1 and entered[0] is not threading.main_thread()
    assert (toolpath.Layers, toolpath.Key) == (layers, key) and feature.Proxy.value(
        feature
    ) is not None
    assert (feature.Status, toolpath.Status) == ("stale", "stale")
    assert (
        "cancelled" in person.console()
        and "error[" not in person.console().rpartition("watching")[2]
    )
    monkeypatch.undo()
    person.gui.runCommand("Std_Refresh")
    assert (feature.Status, toolpath.Status) == (
        "up to date",
        "up to date",
    ) and toolpath.Layers > layers


def test_a_document_closed_while_computing_drops_the_work(person, feature, monkeypatch):
    document = feature.Document
    endless(monkeypatch, Toolpath)
    person.click("RoboticAM_Toolpath")
    panel = person.panel("RoboticAM_Toolpath")

    def close(dialog):
        App.closeDocument(document.Name)
        person.core.QTimer.singleShot(100, person.field(dialog, "cancel").click)

    watcher = Watcher(person, close)
    person.press("Ok")
    watcher.stop()
    assert watcher.acted and not hooks.carrying()
    if person.gui.Control.activeDialog():
        assert "gone" in person.panel_error(panel) or "Cancelled" in person.panel_error(panel)
        person.press("Cancel")


def test_what_events_bring_about_meanwhile_is_refused_and_fails_nothing(
    person, feature, monkeypatch
):
    toolpath = api.make_toolpath(feature.Document, feature)
    endless(monkeypatch, RevolutionFeature)
    refused = []

    def again(dialog):
        try:
            api.recompute(toolpath, force=True)
        except InputError as error:
            refused.append(error.code)
        person.core.QTimer.singleShot(0, person.field(dialog, "cancel").click)

    watcher = Watcher(person, again)
    with pytest.raises(Cancelled):
        api.change(feature, layer_height=5)
    watcher.stop()
    assert refused == ["BUSY"] and (feature.LayerHeight.Value, feature.Status) == (
        10.0,
        "up to date",
    )
    assert toolpath.Status == "up to date"


def test_progress_is_shown_with_words(person, feature, monkeypatch):
    endless(monkeypatch, Toolpath)
    shown_progress = []

    def look(dialog):
        def read():
            bar = person.field(dialog, "bar")
            shown_progress.append(
                (
                    person.field(dialog, "text").text(),
                    bar.value(),
                    bar.geometry().right() < dialog.rect().right(),
                )
            )
            person.screenshot("progress")
            person.field(dialog, "cancel").click()

        person.core.QTimer.singleShot(400, read)

    watcher = Watcher(person, look)
    with pytest.raises(Cancelled):
        api.make_toolpath(feature.Document, feature)
    watcher.stop()
    assert shown_progress[0][0] == "Toolpath: counting" and shown_progress[0][1] > 0
    assert shown_progress[0][2]  # the whole bar is visible

    def endlessly(path):
        while True:
            time.sleep(0.01)

    monkeypatch.setattr(part_file, "shape_content", endlessly)
    watcher = Watcher(person, look)
    with pytest.raises(Cancelled):
        part_file.part_shape("/parts/cup.step")
    watcher.stop()
    assert shown_progress[1][0] == "cup: reading the file"  # not the word for computing


def test_work_that_swallows_the_order_to_end_is_left_to_itself(person):
    """Python raises no exception within compiled code, so it requests the end again, and the window
    does not wait."""
    goes_on, caught = threading.Event(), []

    def work():
        for _ in range(2):
            try:
                while not goes_on.is_set():
                    time.sleep(0.01)
            except Cancelled:
                caught.append("swallowed")

    worker = Worker(work)
    person.idle(0.1)
    worker.cancel()
    with pytest.raises(Cancelled):
        worker.result()
    person.until(lambda: worker.ended.is_set(), "the second order to end", 10)
    assert caught == ["swallowed", "swallowed"]


@pytest.mark.parametrize("cancelled", [False, True])
def test_nothing_of_the_window_is_deleted_in_the_thread_of_work(person, cancelled):
    """This holds for the work's references and for cycles: Qt would still call a timer deleted in
    another thread."""
    assert gc.isenabled()
    ends, collections, go_on = [], [], threading.Event()

    def begin():
        traced = Traced(ends, cycle=False)

        def work():
            while not go_on.is_set():
                len(
                    [[traced, number] for number in range(20_000)]
                )  # many times the threshold of Python's collection
                time.sleep(0.01)

        return Worker(work)

    def collected(phase, info):
        collections.append(threading.current_thread())

    gc.callbacks.append(collected)
    try:
        worker = begin()
        Traced(ends, cycle=True)
        person.until(lambda: ends, "the cycle to be collected", 10)
        worker.cancel() if cancelled else go_on.set()
        del worker  # the window drops the work, as when a panel closes
        person.until(lambda: len(ends) == 2, "what the work refers to, to be deleted", 10)
        person.until(gc.isenabled, "Python to collect by itself again", 10)
    finally:
        gc.callbacks.remove(collected)
    assert set(ends) == set(collections) == {threading.main_thread()}
