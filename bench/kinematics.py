# SPDX-License-Identifier: LGPL-2.1-or-later
"""Kinematics against eaik and PyKDL, each as a ratio measured in the same run.

Peers take turns with ours, round by round, and medians are compared. One thread each. All answers are checked
against each other before anything is timed.
"""

from __future__ import annotations

from collections.abc import Callable
from functools import partial
from statistics import median
from time import perf_counter

import numpy as np

from freecad_am.core.geometry import frames
from freecad_am.core.kinematics import jacobian as jac
from freecad_am.core.kinematics import machine
from freecad_am.kdl import chain as kdl

from rows import Row

POSES, FEW, ROUNDS = 2000, 200, 15
MACHINE = "fanuc-arcmate120ic"
LENGTH = 1000.0
OTHER_WRISTS = {"ur-ur10e": 2.0, "fanuc-crx10ia": 60.0}  # machines, and us a pose


def run() -> list[Row]:
    """All comparisons of this file."""
    arm = machine.load(MACHINE)
    rng = np.random.default_rng(1)
    # the bent, reachable middle of the work space, where every solver answers
    q = rng.uniform((-1.5, -0.5, -0.5, -2, 0.3, -2), (1.5, 0.8, 0.8, 2, 1.8, 2), (POSES, 6))
    poses = arm.chain.forward(q)
    return [
        _all_branches(arm, poses),
        *_other_wrists(),
        *_one_branch(arm, q, poses),
        _condition(arm, q, poses),
    ]


def has_avx512() -> bool:
    """Whether numpy's loops use AVX-512 on this processor: without it the arc tangents are slower."""
    core = getattr(np, "_core", None) or np.core
    found = core._multiarray_umath.__cpu_features__
    return bool(found.get("AVX512_SKX") or found.get("X86_V4"))


def _all_branches(arm: machine.Machine, poses: np.ndarray) -> Row:
    required = 5.0 if has_avx512() else 2.0
    name = f"inverse, 8 branches, batch of {POSES}, against eaik's batch ({'' if has_avx512() else 'no '}AVX-512)"

    def ours() -> object:
        return arm.opw.inverse(poses)

    try:
        from eaik.IK_Homogeneous import HomogeneousRobot
    except ImportError:
        return Row(f"{name}: peer not installed", 1e6 * _time(ours) / POSES, None, "us/pose", required)
    zero = arm.chain.frames(np.zeros(6))
    upright = frames.pose(frames.smallest_rotation((0.0, 0.0, 1.0), zero.directions), zero.origins)
    scale = np.ones((4, 4))
    scale[:3, 3] = 1e-3  # eaik's tolerances are made for metres
    robot = HomogeneousRobot(np.concatenate((upright, zero.flange[None])) * scale)
    given = list(poses * scale)
    closed = arm.opw.inverse(poses[:50])
    for index, answer in enumerate(robot.IK_batched(given[:50], 1)):
        for found in np.asarray(answer.Q)[~np.asarray(answer.is_LS, bool)]:
            off = np.abs(np.exp(1j * found) - np.exp(1j * closed[:, index])).max(axis=1)
            if not np.nanmin(off) < 1e-6:
                raise AssertionError(f"eaik and the closed form differ at pose {index}")
    return _row(name, ours, lambda: robot.IK_batched(given, 1), POSES, POSES, required)


def _other_wrists() -> list[Row]:
    """All solutions of arms without a spherical wrist, against what is asked for in us a pose."""
    rows = []
    for name, wanted in OTHER_WRISTS.items():
        arm = machine.load(name)
        q = np.random.default_rng(3).uniform(-np.pi, np.pi, (POSES, 6))
        poses = arm.chain.forward(q)
        found = arm.arm.inverse(poses)
        if not np.nanmin(np.abs(np.exp(1j * found) - np.exp(1j * q)).max(axis=2), axis=0).max() < 1e-4:
            raise AssertionError(f"{name}: the joint angles of a pose are not among its solutions")
        took = 1e6 * median(_time(partial(arm.arm.inverse, poses)) for _ in range(ROUNDS)) / POSES
        title = f"inverse, all solutions of {name}, batch of {POSES}, against {wanted:g} us"
        rows.append(Row(title, took, wanted, "us/pose", 1.0))
    return rows


def _one_branch(arm: machine.Machine, q: np.ndarray, poses: np.ndarray) -> list[Row]:
    branch = int(arm.opw.branch_of(q[0]))
    name = f"inverse, one branch, batch of {POSES}, against PyKDL's"

    def ours() -> object:
        return arm.opw.inverse_branch(poses, branch)

    if not kdl.available():
        return [Row(f"{name} solvers: peer not installed", 1e6 * _time(ours) / POSES, None, "us/pose", 100.0)]
    second = kdl.KdlArm(arm)
    seeds = q[:FEW] + np.random.default_rng(2).uniform(-1, 1, (FEW, 6)) * np.radians(2.0)
    rows = []
    for solver in kdl.SOLVERS:
        found = second.inverse(poses[:FEW], seeds, solver, 1e-5)
        # a numeric solver may end in another branch, but at the pose
        off = np.abs(arm.chain.forward(found) - poses[:FEW]).max(axis=(1, 2))
        if not np.mean(off < 1e-2) > 0.95:
            raise AssertionError(f"PyKDL's {solver} does not find the poses")
        peer = _kdl_calls(second, solver, poses[:FEW], seeds)
        rows.append(_row(f"{name} {solver.upper()} seeded within 2 deg", ours, peer, POSES, FEW, 100.0))
    return rows


def _kdl_calls(second: kdl.KdlArm, solver: str, poses: np.ndarray, seeds: np.ndarray) -> Callable[[], object]:
    """The bare calls: what goes into PyKDL is made beforehand."""
    solve = second.solver(solver, 1e-5)
    arguments = [(second.angles(seed), second.frame(pose)) for seed, pose in zip(seeds, poses, strict=True)]
    found = second.kdl.JntArray(6)

    def call() -> None:
        for seed, pose in arguments:
            solve.CartToJnt(seed, pose, found)

    return call


def _condition(arm: machine.Machine, q: np.ndarray, poses: np.ndarray) -> Row:
    jacobians = jac.jacobian(arm.chain, q, poses[:, :3, 3])
    scaled = np.array(jacobians, order="C")
    scaled[:, :3] /= LENGTH

    def peer() -> object:
        return np.linalg.svd(scaled, compute_uv=False)

    name = f"condition of {POSES} Jacobians against numpy's singular values"
    return _row(name, lambda: jac.condition(jacobians, LENGTH), peer, POSES, POSES, 1.0)


def _row(
    name: str, ours: Callable[[], object], peer: Callable[[], object], count: int, peer_count: int, required: float
) -> Row:
    """Both timed in turns."""
    for function in (ours, peer):
        function()
    times = [(_time(ours), _time(peer)) for _ in range(ROUNDS)]
    own = 1e6 * median(time for time, _ in times) / count
    other = 1e6 * median(time for _, time in times) / peer_count
    return Row(name, own, other, "us/pose", required)


def _time(function: Callable[[], object], least: float = 0.01) -> float:
    """Seconds per call, over enough calls to last."""
    calls, start = 0, perf_counter()
    while True:
        function()
        calls += 1
        took = perf_counter() - start
        if took > least:
            return took / calls
