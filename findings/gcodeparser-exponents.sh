#!/bin/sh
# SPDX-License-Identifier: LGPL-2.1-or-later
# gcodeparser splits a number with an exponent into an E word, and reads G90.1 as G90.
#
# gcodeparser 0.3.0, seen on 2026-11-28: `X-1.5E+01` becomes X -1.5 and E 1, so that a move without deposit deposits;
# `G90.1` (absolute arc centres) becomes G90; the text after M117 is returned as a G1 command. None of it is reported.
set -eu
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
cd "$folder"
python3 -m venv venv
venv/bin/pip -q install gcodeparser==0.3.0
venv/bin/python -W ignore - <<'PYTHON'
from gcodeparser import GcodeParser


def commands(text):
    parsed = [(line.command_str, line.params) for line in GcodeParser(text).lines]
    print(f"{text!r} is read as {parsed}")
    return parsed


assert commands("G1 X-1.5E+01") == [("G1", {"X": -1.5, "E": 1})]
assert commands("G90.1") == [("G90", {})]
assert commands("M117 G1 X5") == [("M117", {}), ("G1", {"X": 5})]
PYTHON
