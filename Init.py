# SPDX-License-Identifier: LGPL-2.1-or-later
"""Runs when FreeCAD starts, with and without a window. Nothing to do: objects are loaded when a document needs them."""
