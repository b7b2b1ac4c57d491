#!/bin/bash
# SPDX-License-Identifier: MIT
#
# test-live.sh - a scene with lamps -> camera -> glint live -> panel: the panel
# must show, byte for byte, what glint overlay makes of the same frame.
# arch: x86_64 aarch64 armv7
. "$(dirname "$0")/lib.sh"

make_scene_with_lamps

live() { # DISPLAY LAYOUT WxH [OPTION...]
    local at=${1//[:@]/-} display=$1 layout=$2 size=$3
    shift 3
    guest "$at" -d "$display" -V '' -i "$glint" -i "$out/scene.yuyv" -i model="$lens" <<END
start_feed -c /dev/video0 /dev/video1 YUYV 1280x720 /in/scene.yuyv
glint live -d 0 -i 3 -f YUYV --lens /in/model ${look[*]} --no-adaptive $* \
    2>err --json >stats &
live=\$!
wait_for grep -q '"frames":[1-9]' stats
wait_frames stats 3 # lamps rise with the first ones
vt >mode
shot panel
kill -INT \$live
wait \$live
echo "\$?" >code
vt >>mode
END
    $host/vm/expected "$layout" "$size" "$out/overlay.y4m" \
        "$out/$at/expected.ppm" "${fit:-scale}"
    expect "$display: the panel shows the overlay, byte for byte" \
        same "$at/panel.ppm" "$at/expected.ppm"
    expect "$display: leaves with 0 when asked to end" says "$at/code" '^0$'
    expect "$display: lights and ghosts were drawn" \
        says "$at/stats" '"lights":2,"ghosts":[1-9]'
    expect "$display: the console is graphics, and text again afterwards" \
        [ "$(tr '\n' ' ' <"$out/$at/mode")" = "graphics text " ]
}

live bochs:1280x720 x8r8g8b8 1280x720
case $arch in
x86_64)
    live virtio:640x480 x8r8g8b8 640x480
    live cirrus r5g6b5 1024x768
    live vesa:0x310 x1r5g5b5-shifted 640x480
    live vesa:0x344 a8r8g8b8 1024x768
    live vfb:640x480-32@60 a8b8g8r8 640x480
    fit=centre live vesa:0x315 r8g8b8 800x600 --fit centre
    ;;
*)
    live simple:480x320-r5g6b5 r5g6b5 480x320
    ;;
esac
rm -f "$out"/scene.y* "$out"/overlay.y4m
