# SPDX-License-Identifier: MIT
# shellcheck shell=sh
#
# debian.sh - packages of another architecture, fetched and unpacked without
# being installed. Sourced; apt works on a state of its own in $work, a
# directory, for $debian (arm64 ...), of the mirror $GLINT_VM_MIRROR.
#
#   update                   the package lists; complains, but goes on
#   apt COMMAND...           apt-get or apt-cache on that state
#   fetch PACKAGE...         into $work/debs; $work/log says what went wrong
#   unpack PACKAGE DIRECTORY
#   libraries DIRECTORY PACKAGE...   fetches packages and puts what compilers
#                            need of them into DIRECTORY/include and /lib
mirror=${GLINT_VM_MIRROR:-http://deb.debian.org}
keyring=/usr/share/keyrings/debian-archive-keyring.gpg
host=$(dpkg --print-architecture)

# The host's proxy settings hold.
apt() {
    command=$1
    shift
    "$command" -q -o Dir::Etc::SourceList="$work/sources" \
        -o Dir::Etc::SourceParts=/dev/null -o Dir::State="$work/state" \
        -o Dir::State::Status="$work/status" -o Dir::Cache="$work/cache" \
        -o APT::Architecture="$debian" -o APT::Architectures::="$debian" \
        -o APT::Architectures::="$host" \
        -o APT::Sandbox::User=root -o Acquire::Retries=3 \
        -o Acquire::Languages=none -o Debug::NoLocking=1 "$@"
}
update() {
    mkdir -p "$work/state/lists/partial" "$work/cache/archives/partial"
    : >"$work/status"
    for suite in "debian bookworm" "debian bookworm-updates" \
        "debian-security bookworm-security"; do
        echo "deb [arch=$debian,$host signed-by=$keyring]" \
            "$mirror/${suite% *} ${suite#* } main"
    done >"$work/sources"
    # An index out of step with its Release file costs newer packages, no more.
    apt apt-get update >"$work/log" 2>&1 ||
        grep -E '^[WE]:' "$work/log" >&2 || :
}
fetch() {
    mkdir -p "$work/debs"
    (cd "$work/debs" && apt apt-get download "$@") >>"$work/log" 2>&1
}
unpack() {
    mkdir -p "$2"
    dpkg-deb -x "$work/debs/$1"_*.deb "$2"
}
libraries() {
    to=$1
    shift
    fetch "$@" || return 1
    for package; do
        unpack "$package" "$work/libraries"
    done
    mkdir -p "$to/include" "$to/lib"
    [ ! -d "$work/libraries/usr/include" ] ||
        cp -r "$work/libraries/usr/include" "$to/"
    # headers of one architecture are two folders in Debian, here one
    for d in "$to"/include/*-linux-gnu*; do
        [ -d "$d" ] || continue
        cp -r "$d"/. "$to/include/"
        rm -r "$d"
    done
    for file in "$work"/libraries/usr/lib/*/*.a \
        "$work"/libraries/usr/lib/*/*.so*; do
        [ ! -e "$file" ] || cp -P "$file" "$to/lib/"
    done
}
