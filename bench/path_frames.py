# SPDX-License-Identifier: LGPL-2.1-or-later
"""Measure path views inside FreeCAD's window; run by `paths`, which sets FRAMES_TO to the file for
the results."""

from __future__ import annotations

import json
import os
import time
from statistics import median

from in_window import Drawn, begin, settle
from sizes import choose

FRAMES, OPENINGS = choose((6, 5), (1, 1))
SIZES = choose((10_000, 100_000, 300_000), (3_000,))
POINTS_PER_LAYER = 1000


def vase(like, count: int):
    """Return a toolpath with `count` points."""
    import dataclasses

    import numpy as np

    from freecad_am.core.toolpath import Bead, Layer

    layers, angle = count // POINTS_PER_LAYER, np.linspace(0.0, 2.0 * np.pi, POINTS_PER_LAYER)
    up, vase_layers = np.tile([0.0, 0.0, 1.0], (POINTS_PER_LAYER, 1)), []
    for height in np.linspace(0.0, 100.0, layers):
        radius = 60.0 + 20.0 * np.sin(height / 20.0)
        points = np.column_stack(
            [radius * np.cos(angle), radius * np.sin(angle), np.full(POINTS_PER_LAYER, height)]
        )
        points[-1] = points[0]
        vase_layers.append(
            Layer((Bead(points, up, up, angle, np.full(POINTS_PER_LAYER, 8.0), True),))
        )
    return dataclasses.replace(like, layers=tuple(vase_layers), layer_height=100.0 / layers)


def measure_frames(saved: str) -> list[dict[str, object]]:
    """Return the medians (ms) of ours and of the peer."""
    import FreeCAD as App
    import FreeCADGui as Gui
    from pivy import coin

    from freecad_am import api
    from freecad_am.gui.nodes.lines import Lines
    from freecad_am.gui.path import dock
    from freecad_am.gui.path.colouring import coloured

    document = App.openDocument(saved)
    settle(1.0)
    toolpath = document.getObject("Toolpath")
    like = api.result(toolpath)
    for obj in document.Objects:
        obj.ViewObject.Visibility = obj is toolpath
    drawing, view, results = toolpath.ViewObject.Proxy, Gui.activeDocument().activeView(), []
    dock.show(toolpath)
    drawn, camera = Drawn(view), view.getCameraNode()
    spin = coin.SbRotation(coin.SbVec3f(0, 0, 1), 0.05)
    plain = Lines()
    view.getSceneGraph().addChild(plain.node)
    slider = dock.only.dock.form.to.slider

    def turn() -> None:
        camera.orientation = spin * camera.orientation.getValue()

    for count in SIZES:
        path = vase(like, count)
        toolpath.Proxy._kept = (toolpath.Key, path)
        colours, _ = coloured(path, "layer", 0.2)
        for look in ("lines", "tubes"):
            toolpath.ViewObject.Look = look
            drawing.draw(toolpath, path)
            drawing.style(toolpath.ViewObject)
            plain.set(drawing.rows.points, [POINTS_PER_LAYER] * (count // POINTS_PER_LAYER))
            plain.paint(colours)
            dock.only.dock.fill()
            view.viewIsometric()
            view.fitAll()
            settle(0.5)
            ours, moved, peer = [], [], []
            for frame in range(FRAMES):
                plain.show(True)
                toolpath.ViewObject.Visibility = False
                drawn.after(turn)
                peer += [drawn.after(turn), drawn.after(turn)]
                plain.show(False)
                toolpath.ViewObject.Visibility = True
                settle(0.02)
                drawn.after(turn)
                ours += [drawn.after(turn), drawn.after(turn)]
                end_index = slider.maximum() - 1 - frame % max(1, slider.maximum() // 4)
                moved.append(drawn.after(lambda end_index=end_index: slider.setValue(end_index)))
            dock.only.dock._show_all()
            for what, took in (
                (look, ours),
                ("slider" if look == "lines" else "slider, tubes", moved),
            ):
                results.append(
                    {"points": count, "what": what, "ours": median(took), "peer": median(peer)}
                )
    App.closeDocument(document.Name)
    return results


def measure_opening(saved: str) -> dict[str, float]:
    """Seconds until the path of the job is drawn, with its results and without."""
    import FreeCAD as App

    document = App.openDocument(saved)
    settle(1.0)
    points = document.getObject("Toolpath").Points
    document.save()  # as the window saves it
    for obj in document.Objects:
        if hasattr(obj, "ResultData"):
            obj.ResultData, obj.ResultLayout, obj.Key = [], "", ""
    bare = saved.replace(".FCStd", "-bare.FCStd")
    document.saveAs(bare)
    App.closeDocument(document.Name)
    took: dict[str, list[float]] = {saved: [], bare: []}
    for _ in range(OPENINGS + 1):
        for path, times in took.items():
            settle(0.3)
            times.append(time_opening(path, path == saved))
    return {"points": points, "with": median(took[saved][1:]), "without": median(took[bare][1:])}


def time_opening(path: str, drawn: bool) -> float:
    import FreeCAD as App
    import FreeCADGui as Gui

    start = time.perf_counter()
    document = App.openDocument(path)
    nodes = document.getObject("JointPath").ViewObject.Proxy.path
    view_drawn = Drawn(Gui.activeDocument().activeView(), lambda: nodes.painted or not drawn)
    if not drawn:
        Gui.activeDocument().activeView().redraw()
    while not view_drawn.count and time.perf_counter() < start + 30.0:
        Gui.updateGui()
    took = time.perf_counter() - start
    App.closeDocument(document.Name)
    return took


def measure_all() -> dict[str, object]:
    """Return frames, then openings."""
    jobs = json.loads(os.environ["FRAMES_JOBS"])
    return {
        "frames": measure_frames(jobs["cylinder"]),
        "openings": {name: measure_opening(saved) for name, saved in jobs.items()},
    }


begin(measure_all)
