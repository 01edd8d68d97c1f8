# SPDX-License-Identifier: LGPL-2.1-or-later
"""Functions of URScript that take no arguments: written like the call of a function of the user, they are none."""

from __future__ import annotations

INSTRUCTIONS = frozenset(
    [
        "ENABLE_EXTERNAL_FT_SENSOR",
        "END_FORCE_MODE",
        "END_FREEDRIVE_MODE",
        "END_SCREW_DRIVING",
        "END_TEACH_MODE",
        "FORCE_MODE_STOP",
        "FREEDRIVE_MODE",
        "FT_RTDE_INPUT_ENABLE",
        "HALT",
        "PATH_OFFSET_DISABLE",
        "PATH_OFFSET_ENABLE",
        "POWERDOWN",
        "RESET_REVOLUTION_COUNTER",
        "RESET_WORLD_MODEL",
        "SOCKET_CLOSE",
        "STOP_CONVEYOR_TRACKING",
        "SYNC",
        "TEACH_MODE",
        "TOOL_CONTACT",
        "ZERO_FTSENSOR",
        "GET_STEPTIME",
        "IS_STEADY",
    ]
)
