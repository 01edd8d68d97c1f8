#!/bin/sh
# SPDX-License-Identifier: LGPL-2.1-or-later
# Runs the tests on another FreeCAD than this machine's:  run.sh VERSION [PYTEST ARGUMENTS]
# or makes that FreeCAD alone:  run.sh VERSION --make
# Each version is a small Debian in a folder, made the first time (3 GB, 2 minutes) and kept in FREECAD_AM_CHROOTS or
# the cache folder of the user. The tests see a copy of this checkout and a temporary folder of their own, no network,
# and end with their processes and mounts. ROBOTIC_AM_PICTURES names a folder that keeps the screenshots.
# Ends with 77 and one line where this cannot be done on this machine (no root, no debootstrap, no Debian archive).
set -eu
here=$(CDPATH='' cd -- "$(dirname -- "$0")" && pwd)
root=$(dirname "$(dirname "$here")")
version=${1:-}
case "$version" in
1.0) suite=trixie ;; # a stable release
1.1) suite=sid ;;    # an archive that moves on
*)
    echo "run.sh: FreeCAD '$version' is not one of 1.0, 1.1" >&2
    exit 2
    ;;
esac
shift

cannot() {
    echo "freecad-am: FreeCAD $version is NOT tested: $1" >&2
    exit 77
}

[ "$(id -u)" -eq 0 ] || cannot "only root may make and enter a system in a folder"
for tool in debootstrap unshare flock apt-get; do
    command -v $tool >/dev/null 2>&1 || cannot "$tool is missing"
done
unshare --mount --pid --net --fork true 2>/dev/null || cannot "this machine does not let processes have mounts of their own"
chroots=${FREECAD_AM_CHROOTS:-${XDG_CACHE_HOME:-$HOME/.cache}/freecad-am/chroots}
case "$chroots" in /*) ;; *) chroots=$PWD/$chroots ;; esac
folder=$chroots/$suite
"$here/make_chroot.sh" "$suite" "$folder" || cannot "$suite of the Debian archive cannot be installed"
[ "${1:-}" != --make ] || exit 0

work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
inside=
trap '[ -z "$inside" ] || kill -KILL "$inside"; exit 130' INT TERM HUP
mkdir "$work/tmp" "$work/tmp/pictures"
chmod 1777 "$work/tmp"
mkdir "$work/checkout"
(cd "$root" && tar -cf - --exclude=./.git --exclude=./.test-env --exclude=./.bench-env --exclude=./out --exclude=__pycache__ .) |
    tar -xf - -C "$work/checkout"
pictures=${ROBOTIC_AM_PICTURES:-$work/pictures}
mkdir -p "$pictures"

status=0
# mounts, processes and network of its own: all of them end with the last line
# shellcheck disable=SC2016
unshare --mount --propagation private --pid --net --fork --kill-child sh -euc '
    folder=$1 work=$2 pictures=$3 version=$4
    shift 4
    mount -t proc proc "$folder/proc"
    mount --rbind /dev "$folder/dev"
    mount --bind "$work/tmp" "$folder/tmp"
    mount --bind "$pictures" "$folder/tmp/pictures"
    mount --bind "$work/checkout" "$folder/srv"
    # a command in the background starts with Ctrl-C ignored, and tests of ours send it
    exec chroot "$folder" /usr/bin/env -i --default-signal=INT HOME=/root PATH=/usr/sbin:/usr/bin:/sbin:/bin LC_ALL=C.UTF-8 \
        ROBOTIC_AM_PICTURES="${ROBOTIC_AM_PICTURES:+/tmp/pictures}" FREECAD_AM_VERSION="$version" \
        sh -c "cd /srv && exec ./freecad-am test \"\$@\"" test "$@"
' run "$folder" "$work" "$pictures" "$version" "$@" &
inside=$!
wait "$inside" || status=$?
exit $status
