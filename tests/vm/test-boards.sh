#!/bin/bash
# SPDX-License-Identifier: MIT
#
# test-boards.sh - runs glint-live as on a board: the program built with only
# the modules that boards need, a camera of 1280x720, and the panels that boot
# loaders set up, in sizes that are sold for boards. It must show pictures with
# the lamp's ghosts, and use at most 12 MiB, including the camera's buffers. The
# green bar may be detected as a second lamp, as v4l2loopback reports that
# colours are BT.601.
# arch: aarch64 armv7
. "$(dirname "$0")/lib.sh"

model=$(model heliar-tronnier)
build/x86_64/vm/scene -n 2 -m 3,1 YUYV 1280x720 "$out/scene" 300,250,9

on_panel() { # DISPLAY
    local at=${1//:/-}
    guest "$at" -m 512 -d "$1" -i "build/$arch/glint-live" \
        -i model="$model" -i "$out/scene" <<'END'
loopback
start_feed -r 10 /dev/video9 YUYV 1280x720 /in/scene
/in/glint-live -d 9 --lens /in/model -j 1 --stats json >stats 2>err &
live=$!
wait_for grep -q '"lights":[12],"ghosts":[1-9]' stats
wait_frames stats 3
shot last
# the most that was resident
sed -n 's/^VmHWM:[[:space:]]*\([0-9]*\).*/\1/p' /proc/$live/status >most
kill -INT $live
wait $live
echo $? >code
END
    expect "$1: shows its frames" says "$at/code" '^0$'
    expect "$1: a lamp with ghosts" says "$at/stats" \
        '"lights":[12],"ghosts":[1-9]'
    expect "$1: nothing is left out" says "$at/stats" '"total":true'
    expect "$1: a picture on the panel" lit "$out/$at/last.ppm"
    expect "$1: 12 MiB at most" within "$out/$at/most" 12288
}
lit() { # PICTURE - has bright pixels, and dark ones
    tail -c +16 "$1" | od -An -v -tu1 -w1 | awk '
        $1 > 200 { bright++ } $1 < 60 { dark++ }
        END { print bright + 0, "bright,", dark + 0, "dark"; exit !(bright > 50 && dark > 1000) }'
}
within() { # FILE LIMIT - the number in FILE
    awk -v most="$2" '{ print $1, "kB"; n = $1 } END { exit !(n > 0 && n <= most) }' "$1"
}
on_panel simple:480x320-r5g6b5
on_panel simple:800x480-x8r8g8b8
rm -f "$out/scene"
