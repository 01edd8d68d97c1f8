# SPDX-License-Identifier: LGPL-2.1-or-later
"""The path in the page of the report, to turn and to step through: its rows as columns of bytes, drawn by WebGL."""
