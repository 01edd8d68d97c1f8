#!/bin/sh
# SPDX-License-Identifier: LGPL-2.1-or-later
# LinuxCNC of Debian 12 raises inverse time feeds (G93) below 0.1 mm/min to 0.1, without a message.
#
# linuxcnc-uspace 2.9.0~pre1+git20230208.f1270d6ed7-1+deb12u2, rs274, seen on 2026-11-28: G93 G1 X100 F0.0005 asks for 100 mm in
# 2000 min, 0.05 mm/min; the canonical feed rate is 0.1000. A slow move of a turning axis alone is raised alike, in deg/min. A move
# that is faster gets the feed that it asks for.
set -eu
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
cd "$folder"
apt-get download -q linuxcnc-uspace=2.9.0~pre1+git20230208.f1270d6ed7-1+deb12u2 \
    libboost-python1.74.0 libtirpc3 libedit2 >/dev/null 2>&1
for package in *.deb; do dpkg-deb -x "$package" root; done
cat >slow.ngc <<'NGC'
G21 G90 G17
G0 X0 Y0 Z0 A0
G93 G1 X100 F0.0005
G1 X200 F0.01
G1 A90 F0.0005
M2
NGC
printf '[RS274NGC]\n[TRAJ]\nLINEAR_UNITS=mm\n[EMCIO]\n' >machine.ini
: >tool.tbl
libraries=$(find "$PWD/root/usr/lib" "$PWD/root/lib" -type d 2>/dev/null | paste -sd:)
LD_LIBRARY_PATH=$libraries root/usr/bin/rs274 -g -n 2 -t tool.tbl -v numbers.var -i machine.ini slow.ngc >canon.txt 2>&1
feeds=$(sed -n 's/.*SET_FEED_RATE(\([0-9.]*\)).*/\1/p' canon.txt | head -3 | paste -sd' ')
echo "canonical feed rates of 0.05 and 1 mm/min and 0.045 deg/min: $feeds"
[ "$feeds" = "0.1000 1.0000 0.1000" ]
