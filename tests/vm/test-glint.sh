#!/bin/bash
# SPDX-License-Identifier: MIT
#
# test-glint.sh - the static glint on a real kernel must render the same bytes
# as on the build machine. Also runs it with ASan and strace where they are
# available.
# arch: x86_64 aarch64 armv7
. "$(dirname "$0")/lib.sh"

model=$(model heliar-tronnier)
look=(-o flare.pfm --light 7,33 --size 320x180)
build/x86_64/glint render "$model" "${look[@]/flare/$out/host}" >/dev/null ||
    exit 1
guest render -i "$glint" -i "$model" <<END
glint render /in/heliar-tronnier.glint ${look[*]}
END
expect "renders" exited 0
expect "the same bytes as on x86_64" same render/flare.pfm host.pfm
expect "that are not black" test "$(od -An -v -tx4 -j 16 "$out/host.pfm" |
    tr -s ' ' '\n' | sort -u | wc -l)" -gt 1000
[ "$arch" = x86_64 ] || exit 0

asan=$(asan_glint) || exit
guest asan -m 1024 -l "$asan" -i "$model" <<END
glint render /in/heliar-tronnier.glint ${look[*]}
END
expect "ASan and UBSan have no complaint" exited 0
expect "the same bytes with them" same asan/flare.pfm host.pfm

guest strace -l "$(command -v strace)" -i "$glint" -i "$model" <<END
strace -f -o calls glint render /in/heliar-tronnier.glint ${look[*]}
END
expect "strace sees the model being opened" \
    says strace/calls 'open.*heliar-tronnier'
