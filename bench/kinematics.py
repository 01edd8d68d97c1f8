# SPDX-License-Identifier: LGPL-2.1-or-later
"""Kinematics against eaik, ssik and PyKDL, each as a ratio measured in the same run. Peers take
turns with ours, round by round, and medians are compared; each uses one thread. All results are
compared with each other before any is timed."""

from __future__ import annotations

from collections.abc import Callable
from functools import partial
from statistics import median
from time import perf_counter

import numpy as np

from freecad_am import kdl
from freecad_am.core.geometry import frames
from freecad_am.core.kinematics import jacobian as jac
from freecad_am.core.kinematics.machines import machine

from rows import Row
from sizes import choose

POSES, SEEDED_POSES, ROUNDS = choose((2000, 200, 15), (20, 4, 1))
JUDGED_POSES = choose(10_000, 20)
MACHINE = "fanuc-arcmate120ic"
LENGTH = 1000.0
METRES = np.ones((4, 4))
METRES[:3, 3] = 1e-3
# peer for each class of wrist, and the number of poses
JUDGED = (
    ("eaik", "fanuc-arcmate120ic", JUDGED_POSES),
    ("eaik", "ur-ur10e", JUDGED_POSES),
    ("ssik", "fanuc-crx10ia", JUDGED_POSES),
    ("ssik", "motoman-hc10", JUDGED_POSES),
)
SSIK_NAMES = {"fanuc-crx10ia": "fanuc_crx10ia", "motoman-hc10": "hc10"}
# machines, and the allowed time (us per pose)
OTHER_WRISTS = {
    "ur-ur10e": 2.0,
    "fanuc-crx10ia": 60.0,
    "motoman-hc10": 60.0,
    "abb-crb15000-5-95": 60.0,
    "fanuc-m710ic-50e": 60.0,
}


def run() -> list[Row]:
    """Return all comparisons."""
    arm = machine.load(MACHINE)
    rng = np.random.default_rng(1)
    # the well-conditioned middle of the workspace, where every solver has a solution
    q = rng.uniform((-1.5, -0.5, -0.5, -2, 0.3, -2), (1.5, 0.8, 0.8, 2, 1.8, 2), (POSES, 6))
    poses = arm.chain.forward(q)
    return [
        _all_branches(arm, poses),
        *_other_wrists(),
        *compare_solutions(),
        *_one_branch(arm, q, poses),
        _condition(arm, q, poses),
    ]


def has_avx512() -> bool:
    """Return whether numpy's loops use AVX-512 on this processor; without it arc tangents are
    slower."""
    core = getattr(np, "_core", None) or np.core
    features = core._multiarray_umath.__cpu_features__
    return bool(features.get("AVX512_SKX") or features.get("X86_V4"))


def _all_branches(arm: machine.Machine, poses: np.ndarray) -> Row:
    required = 5.0 if has_avx512() else 2.0
    name = f"inverse, 8 branches, batch of {POSES}, against eaik's batch ({'' if has_avx512() else 'no '}AVX-512)"

    def ours() -> object:
        return arm.opw.inverse(poses)

    try:
        from eaik.IK_Homogeneous import HomogeneousRobot
    except ImportError:
        return Row(
            f"{name}: peer not installed", 1e6 * _time(ours) / POSES, None, "us/pose", required
        )
    robot, metric_poses = eaik_robot(HomogeneousRobot, arm), list(poses * METRES)
    closed = arm.opw.inverse(poses[:50])
    for index, answer in enumerate(robot.IK_batched(metric_poses[:50], 1)):
        for solution in np.asarray(answer.Q)[~np.asarray(answer.is_LS, bool)]:
            difference = np.abs(np.exp(1j * solution) - np.exp(1j * closed[:, index])).max(axis=1)
            if not np.nanmin(difference) < 1e-6:
                raise AssertionError(f"eaik and the closed form differ at pose {index}")
    return _row(name, ours, lambda: robot.IK_batched(metric_poses, 1), POSES, POSES, required)


def eaik_robot(robot_class: Callable[[np.ndarray], object], arm: machine.Machine) -> object:
    """Build the robot for eaik in metres, the unit of its tolerances."""
    zero = arm.chain.frames(np.zeros(6))
    upright = frames.pose(frames.smallest_rotation((0.0, 0.0, 1.0), zero.directions), zero.origins)
    return robot_class(np.concatenate((upright, zero.flange[None])) * METRES)


def compare_solutions() -> list[Row]:
    """Compare the solutions of eaik and ssik for random poses with ours, joints over a whole turn,
    and the times.

    Raise AssertionError where a solution of the peer is missing.
    """
    rows = []
    for peer, name, count in JUDGED:
        arm = machine.load(name)
        poses = arm.chain.forward(np.random.default_rng(14).uniform(-np.pi, np.pi, (count, 6)))
        title = f"inverse, every solution of {name} that {peer} finds of {count} poses, against it"
        ours, took = time_once(partial(arm.arm.inverse, poses))
        solve = {"eaik": _eaik_solver, "ssik": _ssik_solver}[peer](arm)
        if solve is None:
            rows.append(
                Row(f"{title}: peer not installed", 1e6 * took / count, None, "us/pose", 1.0)
            )
            continue
        theirs, peer_took = time_once(partial(solve, poses))
        for index, solutions in enumerate(theirs):
            pose_error = (
                np.abs(arm.chain.forward(solutions) - poses[index]).max(axis=(1, 2))
                if len(solutions)
                else np.zeros(0)
            )
            own_solutions = ours[:, index][np.isfinite(ours[:, index]).all(axis=1)]
            for angles in solutions[pose_error < 1e-3]:
                if (
                    not np.abs(np.exp(1j * angles) - np.exp(1j * own_solutions))
                    .max(axis=1, initial=0.0)
                    .min(initial=9.0)
                    < 1e-3
                ):
                    raise AssertionError(
                        f"{name}: {peer} finds {np.degrees(angles)} at pose {index}, and we do not"
                    )
        rows.append(Row(title, 1e6 * took / count, 1e6 * peer_took / count, "us/pose", 1.0))
    return rows


def _eaik_solver(arm: machine.Machine) -> Callable[[np.ndarray], list[np.ndarray]] | None:
    try:
        from eaik.IK_Homogeneous import HomogeneousRobot
    except ImportError:
        return None
    robot = eaik_robot(HomogeneousRobot, arm)

    def solve(poses: np.ndarray) -> list[np.ndarray]:
        answers = robot.IK_batched(list(poses * METRES), 1)
        return [
            np.asarray(answer.Q).reshape(-1, 6)[~np.asarray(answer.is_LS, bool)]
            for answer in answers
        ]

    return solve


def _ssik_solver(arm: machine.Machine) -> Callable[[np.ndarray], list[np.ndarray]] | None:
    """Return a solver for one of ssik's arms with joints as ours; the flange offset comes from the
    zero position."""
    try:
        import ssik
    except ImportError:
        return None
    robot, unit = ssik.Manipulator.from_prebuilt(SSIK_NAMES[arm.id]), METRES

    def peer_pose(q: np.ndarray) -> np.ndarray:
        return np.array(robot.fk(q)) / unit

    to_peer = np.linalg.inv(arm.chain.forward(np.zeros((1, 6)))[0]) @ peer_pose(np.zeros(6))
    if (
        not np.abs(
            arm.chain.forward(np.full((1, 6), 0.7))[0] @ to_peer - peer_pose(np.full(6, 0.7))
        ).max()
        < 1e-6
    ):
        raise AssertionError(f"{arm.id} is another arm in ssik")

    def solve(poses: np.ndarray) -> list[np.ndarray]:
        return [
            np.array([solution.q for solution in robot.solve(pose @ to_peer * unit)]).reshape(-1, 6)
            for pose in poses
        ]

    return solve


def time_once(work: Callable[[], np.ndarray]) -> tuple[np.ndarray, float]:
    """Return the result of `work` and the seconds it takes."""
    start = perf_counter()
    return work(), perf_counter() - start


def _other_wrists() -> list[Row]:
    """Time all solutions of arms without a spherical wrist against the allowed time (us per
    pose)."""
    rows = []
    for name, limit_us in OTHER_WRISTS.items():
        arm = machine.load(name)
        q = np.random.default_rng(3).uniform(-np.pi, np.pi, (POSES, 6))
        poses = arm.chain.forward(q)
        solutions = arm.arm.inverse(poses)
        if (
            not np.nanmin(np.abs(np.exp(1j * solutions) - np.exp(1j * q)).max(axis=2), axis=0).max()
            < 1e-4
        ):
            raise AssertionError(f"{name}: the joint angles of a pose are not among its solutions")
        took = 1e6 * median(_time(partial(arm.arm.inverse, poses)) for _ in range(ROUNDS)) / POSES
        title = f"inverse, all solutions of {name}, batch of {POSES}, against {limit_us:g} us"
        rows.append(Row(title, took, limit_us, "us/pose", 1.0))
    return rows


def _one_branch(arm: machine.Machine, q: np.ndarray, poses: np.ndarray) -> list[Row]:
    branch = int(arm.opw.branch_of(q[0]))
    name = f"inverse, one branch, batch of {POSES}, against PyKDL's"

    def ours() -> object:
        return arm.opw.inverse_branch(poses, branch)

    if not kdl.available():
        return [
            Row(
                f"{name} solvers: peer not installed",
                1e6 * _time(ours) / POSES,
                None,
                "us/pose",
                100.0,
            )
        ]
    second = kdl.KdlArm(arm)
    seeds = q[:SEEDED_POSES] + np.random.default_rng(2).uniform(
        -1, 1, (SEEDED_POSES, 6)
    ) * np.radians(2.0)
    rows = []
    for solver in kdl.SOLVERS:
        solutions = second.inverse(poses[:SEEDED_POSES], seeds, solver, 1e-5)
        # a numeric solver may return another configuration, but must reach the pose
        pose_error = np.abs(arm.chain.forward(solutions) - poses[:SEEDED_POSES]).max(axis=(1, 2))
        if not np.mean(pose_error < 1e-2) > 0.95:
            raise AssertionError(f"PyKDL's {solver} does not find the poses")
        peer = _kdl_calls(second, solver, poses[:SEEDED_POSES], seeds)
        rows.append(
            _row(
                f"{name} {solver.upper()} seeded within 2 deg",
                ours,
                peer,
                POSES,
                SEEDED_POSES,
                100.0,
            )
        )
    return rows


def _kdl_calls(
    second: kdl.KdlArm, solver: str, poses: np.ndarray, seeds: np.ndarray
) -> Callable[[], object]:
    """Return the bare calls of PyKDL; its inputs are prepared beforehand."""
    solve = second.solver(solver, 1e-5)
    arguments = [
        (second.angles(seed), second.frame(pose)) for seed, pose in zip(seeds, poses, strict=True)
    ]
    joints = second.kdl.JntArray(6)

    def call() -> None:
        for seed, pose in arguments:
            solve.CartToJnt(seed, pose, joints)

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
    name: str,
    ours: Callable[[], object],
    peer: Callable[[], object],
    count: int,
    peer_count: int,
    required: float,
) -> Row:
    """Time both in turns."""
    for function in (ours, peer):
        function()
    times = [(_time(ours), _time(peer)) for _ in range(ROUNDS)]
    own_us = 1e6 * median(time for time, _ in times) / count
    peer_us = 1e6 * median(time for _, time in times) / peer_count
    return Row(name, own_us, peer_us, "us/pose", required)


def _time(function: Callable[[], object], min_seconds: float = choose(0.01, 0.0)) -> float:
    """Seconds per call, averaged over enough calls to last `least` seconds."""
    calls, start = 0, perf_counter()
    while True:
        function()
        calls += 1
        took = perf_counter() - start
        if took > min_seconds:
            return took / calls
