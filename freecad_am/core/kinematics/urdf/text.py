# SPDX-License-Identifier: LGPL-2.1-or-later
"""Export machines as URDF for simulators and other programs."""

from __future__ import annotations

import math

import numpy as np

from ...geometry import frames
from ...types import Array
from ..chain import Chain
from ..machines.machine import Machine


def text(machine: Machine) -> str:
    """Return a machine with its limit set `maker` as a URDF without visuals."""
    limits, count = machine.limits("maker"), len(machine.axes)
    base = None if np.array_equal(machine.base, np.eye(4)) else machine.base
    return _text_of(
        machine.id,
        machine.axes,
        machine.chain,
        limits.lower[:count],
        limits.upper[:count],
        machine.max_speed,
        base,
    )


def _text_of(
    name: str,
    joints: tuple[str, ...],
    chain: Chain,
    lower: Array,
    upper: Array,
    max_speed: Array,
    base: Array | None = None,
) -> str:
    """Return a chain as a URDF without visuals.

    Its links are base_link, link_1 and so on, and tool0 for the flange; `base` too if the
    manufacturer's base frame is given. Numbers keep full precision.
    """
    lines = [
        '<?xml version="1.0"?>',
        f'<robot name="{_escaped(name)}">',
        '  <link name="base_link"/>',
    ]
    links = ["base_link", *(f"link_{number}" for number in range(1, chain.axes + 1))]
    for index, joint in enumerate(joints):
        sliding, unit = bool(chain.sliding[index]), 0.001 if chain.sliding[index] else 1.0
        continuous = not math.isfinite(lower[index]) or not math.isfinite(upper[index])
        kind = "prismatic" if sliding else "continuous" if continuous else "revolute"
        speed = unit * float(max_speed[index]) if math.isfinite(max_speed[index]) else 0.0
        span = (
            ""
            if continuous
            else f'lower="{unit * float(lower[index])!r}" upper="{unit * float(upper[index])!r}" '
        )
        lines += [
            f'  <link name="{links[index + 1]}"/>',
            f'  <joint name="{_escaped(joint)}" type="{kind}">',
            f'    <parent link="{links[index]}"/>',
            f'    <child link="{links[index + 1]}"/>',
            f"    {_origin(chain.origins[index])}",
            f'    <axis xyz="{_words(chain.directions[index])}"/>',
            f'    <limit {span}effort="0" velocity="{speed!r}"/>',
            "  </joint>",
        ]
    lines += _fixed(f"link_{chain.axes}", "tool0", chain.flange)
    if base is not None:
        lines += _fixed("base_link", "base", base)
    return "\n".join([*lines, "</robot>", ""])


def _fixed(parent: str, child: str, pose: Array) -> list[str]:
    return [
        f'  <link name="{child}"/>',
        f'  <joint name="{parent}-{child}" type="fixed">',
        f'    <parent link="{parent}"/>',
        f'    <child link="{child}"/>',
        f"    {_origin(pose)}",
        "  </joint>",
    ]


def _origin(pose: Array) -> str:
    rpy = -frames.to_bryant(pose[:3, :3].T)
    return f'<origin xyz="{_words(0.001 * pose[:3, 3])}" rpy="{_words(rpy)}"/>'


def _words(values: Array) -> str:
    return " ".join(repr(float(value) + 0.0) for value in values)


def _escaped(text: str) -> str:
    return text.replace("&", "&amp;").replace('"', "&quot;").replace("<", "&lt;")
