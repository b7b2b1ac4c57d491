# SPDX-License-Identifier: MIT
# shellcheck shell=bash
#
# rooms.sh - clean Debian systems to build and try packages in, made by mmdebstrap
# of the mirror $GLINT_MIRROR and thrown away. Sourced from the root of the tree, by
# root.
#
#   room DIR ARCHITECTURE       a new one, of a system that is kept packed
#   inside DIR COMMAND...       runs there, with /proc, /dev and $1's own /tmp
#   alone DIR COMMAND...        likewise, without a network
#   with_emulator COMMAND...    where programs of other machines run
kept=build/debian
# A folder in memory spares a disk some gigabytes.
rooms=${GLINT_ROOMS:-$kept}
mirror=${GLINT_MIRROR:-http://deb.debian.org/debian}
suite=bookworm

# What is in a new system, besides the least: what builds packages, where it is
# of this machine's kind.
room() {
    local dir=$1 arch=$2 packed=$kept/base-$2.tar
    if [ ! -s "$packed" ]; then
        mkdir -p "$kept"
        local how=(--variant=apt)
        [ "$arch" != "$(dpkg --print-architecture)" ] || how=(--variant=buildd --include=debhelper)
        echo "a clean Debian for $arch, once" >&2
        rm -rf "$packed.part" # of a run that was ended, perhaps a folder
        mmdebstrap --mode=root --format=tar "--arch=$arch" "${how[@]}" --dpkgopt=force-unsafe-io \
            --aptopt='Acquire::Retries 3' $suite "$packed.part" "$mirror" >"$kept/base-$arch.log" 2>&1 ||
            { tail -n 5 "$kept/base-$arch.log" >&2; return 1; }
        mv "$packed.part" "$packed"
    fi
    mkdir -p "$dir" "$kept/archives/partial"
    # devices are bound from outside, as an emulator's namespace may not make them
    tar -xf "$packed" --numeric-owner --exclude='./dev/*' -C "$dir"
    mkdir -p "$dir/tree" "$dir/cache"
}

inside() {
    local dir=$1
    shift
    # shellcheck disable=SC2016 # which the inner shell expands
    unshare --mount --pid --fork --kill-child ${offline:+--net} sh -c '
        dir=$1 archives=$2; shift 2
        for device in null zero full random urandom tty; do
            : >"$dir/dev/$device" && mount --bind "/dev/$device" "$dir/dev/$device" || exit 1
        done
        ln -sfn /proc/self/fd "$dir/dev/fd"
        mkdir -p "$dir/dev/pts" && mount -t devpts -o newinstance,ptmxmode=0666 none "$dir/dev/pts" &&
            ln -sfn pts/ptmx "$dir/dev/ptmx" || exit 1
        mkdir -p "$dir/dev/shm" && mount -t tmpfs none "$dir/dev/shm" &&
            mount -t proc none "$dir/proc" && mount --bind "$archives" "$dir/var/cache/apt/archives" || exit 1
        [ -z "$CCACHE_DIR" ] || mount --bind "$CCACHE_DIR" "$dir/cache" || exit 1
        exec env -i PATH=/usr/sbin:/usr/bin:/sbin:/bin HOME=/nonexistent LC_ALL=C.UTF-8 DEBIAN_FRONTEND=noninteractive \
            ${CCACHE_DIR:+CCACHE_DIR=/cache} ${http_proxy:+http_proxy="$http_proxy"} chroot "$dir" "$@"' sh "$dir" "$PWD/$kept/archives" "$@"
}
alone() { local offline=yes; inside "$@"; }

# Packages of the room's, kept for the next.
install_in() { # DIR APT-GET-ARGUMENTS...
    local dir=$1
    shift
    inside "$dir" apt-get -q -y --no-install-recommends -o APT::Keep-Downloaded-Packages=true \
        -o Acquire::Retries=3 -o APT::Sandbox::User=root -o Debug::NoLocking=1 "$@"
}

# A kernel that knows no other machine's programs is told of them in a namespace
# of its own, so that nothing changes outside.
with_emulator() {
    if [ -e /proc/sys/fs/binfmt_misc/qemu-aarch64 ]; then
        "$@"
        return
    fi
    local gate child
    gate=$(mktemp -u)
    mkfifo "$gate"
    # shellcheck disable=SC2016
    unshare --user --mount --fork --kill-child bash -c 'read -r go <"$1" && shift && mount -t binfmt_misc none /proc/sys/fs/binfmt_misc &&
        cat /usr/lib/binfmt.d/qemu-aarch64.conf >/proc/sys/fs/binfmt_misc/register && exec "$@"' bash "$gate" "$@" &
    local outer=$!
    until child=$(pgrep -P $outer) && [ "$(readlink "/proc/$child/ns/user")" != "$(readlink /proc/self/ns/user)" ]; do sleep .1; done
    for map in uid gid; do echo '0 0 4294967295' >"/proc/$child/${map}_map"; done
    echo go >"$gate"
    rm "$gate"
    wait $outer
}
