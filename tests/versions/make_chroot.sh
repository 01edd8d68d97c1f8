#!/bin/sh
# SPDX-License-Identifier: LGPL-2.1-or-later
# Makes a folder with a small Debian that has FreeCAD and all that the tests need:  make_chroot.sh SUITE FOLDER
# Needs root, debootstrap, and a Debian archive among the machine's apt sources. Does nothing when the folder is
# complete. Nothing is mounted that outlives this command, so the folder may be deleted at any time.
set -eu
suite=$1
folder=$2
packages='ca-certificates freecad freecad-python3 python3-pykdl python3-numpy python3-scipy python3-yaml'
packages="$packages python3-matplotlib python3-shapely xvfb xauth libgl1-mesa-dri python3-pytest python3-pytest-xdist"
packages="$packages python3-pytest-timeout python3-venv xdotool locales"
stamp=etc/freecad-am-packages

made() {
    [ "$(cat "$folder/$stamp" 2>/dev/null)" = "$packages" ]
}

if made; then exit 0; fi

# the archive this machine itself installs from; the security archive holds only parts of it
mirror() {
    # shellcheck disable=SC2016
    apt-get indextargets --format '$(LABEL) $(REPO_URI)' 'Created-By: Packages' | sed -n 's/^Debian //p' | head -n 1
}

# one at a time: two runs may want the same folder
if [ -z "${FREECAD_AM_ALONE:-}" ]; then
    mkdir -p "$(dirname "$folder")"
    FREECAD_AM_ALONE=1 exec flock "$folder.lock" unshare --mount --propagation private "$0" "$@"
fi
if made; then exit 0; fi

archive=$(mirror)
if [ -z "$archive" ]; then
    echo "make_chroot.sh: no Debian archive among this machine's apt sources (or their lists were never fetched)" >&2
    exit 1
fi
echo "make_chroot.sh: making $folder from $suite of $archive" >&2
new=$folder.new
rm -rf "$new"
debootstrap --variant=minbase --include=ca-certificates "$suite" "$new" "$archive" >"$folder.log" 2>&1 || {
    tail -n 20 "$folder.log" >&2
    exit 1
}
# how this machine reaches its archive: names, proxies, certificates, snapshots past their date
cp /etc/resolv.conf "$new/etc/resolv.conf"
cp /etc/hosts "$new/etc/hosts"
apt-config dump | grep -E '^Acquire::(https?::|Check-)' >"$new/etc/apt/apt.conf.d/90machine" || true
if [ -f /etc/ssl/certs/ca-certificates.crt ]; then
    cp /etc/ssl/certs/ca-certificates.crt "$new/etc/ssl/certs/ca-certificates.crt"
fi
printf '#!/bin/sh\nexit 101\n' >"$new/usr/sbin/policy-rc.d" # no services here
chmod +x "$new/usr/sbin/policy-rc.d"
mount -t proc proc "$new/proc"
mkdir -p "$new/dev/shm"
mount -t tmpfs tmpfs "$new/dev/shm"
inside() {
    chroot "$new" /usr/bin/env -i HOME=/root PATH=/usr/sbin:/usr/bin:/sbin:/bin LC_ALL=C.UTF-8 DEBIAN_FRONTEND=noninteractive "$@"
}
{
    inside apt-get update -q
    # shellcheck disable=SC2086
    inside apt-get install -y -q --no-install-recommends $packages
    inside apt-get clean
} >>"$folder.log" 2>&1 || {
    tail -n 20 "$folder.log" >&2
    exit 1
}
umount "$new/dev/shm" "$new/proc"
echo "$packages" >"$new/$stamp"
rm -rf "$folder"
mv "$new" "$folder"
rm -f "$folder.log"
# shellcheck disable=SC2016
inside_version=$(chroot "$folder" dpkg-query -W -f='${Version}' freecad)
echo "make_chroot.sh: $folder has FreeCAD $inside_version" >&2
