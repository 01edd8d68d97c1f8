#!/bin/sh
# SPDX-License-Identifier: LGPL-2.1-or-later
# nc-gcode-interpreter lists coordinates in single precision, and as they stand in the text under G91 and G70.
#
# nc-gcode-interpreter 0.1.9 (SINUMERIK dialect), seen on 2026-11-28: 12345.6789 becomes 12345.6787; two moves of X5 under G91 are
# listed as 5 and 5, where X=IC(5) twice is 5 and 10; X1 under G70 stays 1; the number X1EX3 is X 1 and a call of EX3.
set -eu
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
cd "$folder"
python3 -m venv venv
venv/bin/pip -q install --no-deps --only-binary :all: nc-gcode-interpreter==0.1.9 polars==2.1.0 polars-runtime-32==2.1.0
venv/bin/python - 2>&1 <<'PYTHON'
import nc_gcode_interpreter as nc


def column(text, name="X"):
    table = nc.nc_to_dataframe(text)[0]
    values = table[name].to_list()
    print(f"{text!r}: {name} {values}")
    return values


assert abs(column("G1 X12345.6789")[0] - 12345.6787109375) < 1e-9
assert column("G91\nX5\nX5")[1:] == [5.0, 5.0]
assert column("X=IC(5)\nX=IC(5)") == [5.0, 10.0]
assert column("G70\nX1")[-1] == 1.0
assert column("X1EX3", "function_call") == ["EX3"]
PYTHON
