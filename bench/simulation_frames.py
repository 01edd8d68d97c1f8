# SPDX-License-Identifier: LGPL-2.1-or-later
"""Measure frames inside FreeCAD's window; run by `simulation`, which sets FRAMES_TO to the file for
the results."""

from __future__ import annotations

import time
from statistics import median

from in_window import Drawn, begin, settle
from sizes import choose

FRAMES = choose(40, 4)
# layer height, points of a turn: about 10,000, 100,000 and 300,000 points in total
SIZES = choose(((2.4, 140), (1.0, 1420), (1.0, 4280)), ((15.0, 60),))


def run_of_points(layer_height: float, points: int, document: str):
    """Return a hemisphere of many points as a simulation plays it."""
    import numpy as np

    from freecad_am.core.geometry.curves.profile import Meridian, RevolvedWall, sample_curve
    from freecad_am.core.kinematics import cell as cells
    from freecad_am.core.parameters.build_direction import BuildDirectionParameters
    from freecad_am.core.parameters.cell import CellParameters, NozzleParameters
    from freecad_am.core.parameters.joints import JointParameters
    from freecad_am.core.parameters.process import ProcessParameters
    from freecad_am.core.parameters.strategy import RevolutionParameters
    from freecad_am.core.planning.motion import assemble
    from freecad_am.core.planning.plan import plan_joints
    from freecad_am.core.simulation.achievable_feed import achievable_feed
    from freecad_am.core.simulation.timeline import timeline, totals
    from freecad_am.core.simulation.watch import watch
    from freecad_am.core.strategies.revolution import plan as revolution
    from freecad_am.gui.simulation.player import Run

    def dome(t):
        return np.c_[45.0 * np.cos(t), 45.0 * np.sin(t)], np.c_[-np.sin(t), np.cos(t)]

    wall = RevolvedWall(Meridian.chained([sample_curve(dome, [0, np.pi / 2])]), np.eye(4))
    process, cell_parameters = ProcessParameters(), CellParameters(limits="paper")
    toolpath = revolution.plan(
        wall,
        RevolutionParameters(layer_height=layer_height, min_points=points),
        BuildDirectionParameters(clearance="none"),
        process,
        NozzleParameters(),
        113.0,
        None,
    )
    cell = cells.resolve(cell_parameters, toolpath.frame)
    motion, _ = assemble(
        plan_joints(toolpath, cell, JointParameters(method="constant", rz=0.0)), cell, process
    )
    times, feed = (
        timeline(motion, process),
        achievable_feed(motion, cell.machine.max_speed, cell.machine.max_acceleration),
    )
    unknown = np.full(len(motion), np.nan)
    return Run(
        document=document,
        title="frames",
        objects=(),
        cell=cell,
        looks=cell_parameters,
        toolpath=toolpath,
        width=1.0,
        motion=motion,
        times=times,
        feed=feed,
        watch=watch(motion, cell, feed, unknown, unknown),
        totals=totals(motion, times, process, toolpath),
    )


def measure_frames(layer_height: float, points: int) -> dict[str, float]:
    """Return the medians (ms of processor time) and our longest frame (ms by the clock)."""
    import FreeCAD as App
    import FreeCADGui as Gui
    from pivy import coin

    from freecad_am.gui.simulation import dock

    document = App.newDocument("Frames")
    view = Gui.activeDocument().activeView()
    view.viewIsometric()
    run = run_of_points(layer_height, points, document.Name)
    simulation = dock.show(run, view)
    settle(0.5)
    drawn, camera = Drawn(view), view.getCameraNode()
    small_turn = coin.SbRotation(coin.SbVec3f(0, 0, 1), 0.01)

    def play(frame: int) -> None:
        # near the end nearly all of the deposit exists
        simulation.player.go((0.9 + 0.1 * frame / FRAMES) * run.times.total)
        simulation.show()

    def turn() -> None:
        camera.orientation = small_turn * camera.orientation.getValue()

    ours, peer = [], []
    for frame in range(FRAMES):
        ours.append(cost(drawn, lambda frame=frame: play(frame)))
        peer.append(cost(drawn, turn))
    result = {
        "points": int(run.motion.deposit.sum()),
        "ours": median(processor for processor, _ in ours[3:]),
        "peer": median(processor for processor, _ in peer[3:]),
        "longest": max(clock for _, clock in ours[3:]),
    }
    simulation.close()
    App.closeDocument(document.Name)
    return result


def cost(drawn: Drawn, act) -> tuple[float, float]:
    """Return ms of processor time and by the clock from an action until it is drawn, including
    deferred work."""
    import FreeCADGui as Gui

    processor, clock = time.process_time(), time.perf_counter()
    drawn.after(act)
    for _ in range(4):
        Gui.updateGui()
    return 1e3 * (time.process_time() - processor), 1e3 * (time.perf_counter() - clock)


begin(lambda: [measure_frames(layer_height, points) for layer_height, points in SIZES])
