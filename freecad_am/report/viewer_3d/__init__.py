# SPDX-License-Identifier: LGPL-2.1-or-later
"""The path in 3D on the page of the report: rows as columns of bytes (`columns.py`), drawn by WebGL (`viewer.js`)."""
