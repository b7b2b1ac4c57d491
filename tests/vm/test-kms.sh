#!/bin/bash
# SPDX-License-Identifier: MIT
#
# test-kms.sh - a scene with lamps -> camera -> glint live -o kms -> display: the
# display must show, byte for byte, what glint overlay makes of the same frame,
# after a switch of consoles and with --reconnect after it was unplugged, too,
# and what it showed before when glint ends or is killed.
# arch: x86_64 aarch64
. "$(dirname "$0")/lib.sh"

make_scene_with_lamps

show() { # DISPLAY LAYOUT WxH
    local at=${1//[:@]/-}
    guest "$at" -d "$1" -V '' -i "$glint" -i "$out/scene.yuyv" -i model="$lens" <<END
echo 0 >/sys/class/graphics/fbcon/cursor_blink
start_feed -c /dev/video0 /dev/video1 YUYV 1280x720 /in/scene.yuyv
show="glint live -d 0 -i 3 -f YUYV --lens /in/model ${look[*]} --no-adaptive -o kms --json"
shot before
\$show 2>err >stats &
live=\$!
wait_for grep -q '"frames":[1-9]' stats
wait_frames stats 3
shot display
glint live -d test -o kms --count 1 2>second
echo "\$?" >>second
kill -INT \$live
wait \$live
echo "\$?" >code
shot after
\$show 2>/dev/null >again &
live=\$!
wait_for grep -q '"frames":[1-9]' again
kill -9 \$live
wait \$live
sleep 1
shot killed
\$show --reconnect 2>back >back.stats &
live=\$!
wait_for grep -q '"frames":[1-9]' back.stats
chvt 2
wait_frames back.stats 3
shot switched
chvt 1
for status in /sys/class/drm/card0-*/status; do echo off >\$status; done
wait_for grep -q 'was unplugged' back
for status in /sys/class/drm/card0-*/status; do echo detect >\$status; done
wait_frames back.stats 3
shot back
kill -INT \$live
wait \$live
echo "\$?" >>back
\$show 2>lost >lost.stats &
live=\$!
wait_for grep -q '"frames":[1-9]' lost.stats
for status in /sys/class/drm/card0-*/status; do echo off >\$status; done
wait \$live
echo "\$?" >>lost
glint live -d test -o kms --count 1 2>none
echo "\$?" >>none
END
    $host/vm/expected "$2" "$3" "$out/overlay.y4m" "$out/$at/expected.ppm" scale
    expect "$1: the display shows the overlay, byte for byte" \
        same "$at/display.ppm" "$at/expected.ppm"
    expect "$1: ends with 0 when asked to end" says "$at/code" '^0$'
    expect "$1: a second glint names the first as the cause" \
        says "$at/second" 'another program draws on the display'
    expect "$1: and ends with 4" says "$at/second" '^4$'
    expect "$1: the console is back" same "$at/after.ppm" "$at/before.ppm"
    expect "$1: and after kill -9" same "$at/killed.ppm" "$at/before.ppm"
    expect "$1: an unplugged display is named" says "$at/lost" 'was unplugged'
    expect "$1: and ends it with 4" says "$at/lost" '^4$'
    expect "$1: the display still shows it after a switch of consoles" \
        same "$at/switched.ppm" "$at/expected.ppm"
    expect "$1: and after it was plugged in again" \
        same "$at/back.ppm" "$at/expected.ppm"
    expect "$1: ends with 0 then" says "$at/back" '^0$'
    expect "$1: no display" says "$at/none" 'no display is connected; the connectors are'
}

show bochs:1280x720 x8r8g8b8 1280x720
show virtio:640x480 x8r8g8b8 640x480
[ "$arch" != x86_64 ] || show cirrus r5g6b5 1024x768
rm -f "$out"/scene.y* "$out"/overlay.y4m
