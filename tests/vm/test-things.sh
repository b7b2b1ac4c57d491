#!/bin/bash
# SPDX-License-Identifier: MIT
#
# test-things.sh - a night with lamps -> camera -> glint live --scene -> panel.
# A pipe of poses moves a ball in front of a lamp. The ball and its shadow must
# be on the panel, byte for byte, as glint overlay draws them.
# arch: aarch64
. "$(dirname "$0")/lib.sh"

host=build/x86_64
lens=$(model heliar-tronnier)
look=(--exposure 4 --max-lights 4)
cat >"$out/ball.scene" <<'END'
hand left
camera fov 50 at 0 0 0 toward 0 0 1
light sun direction .2 .8 -.5 colour 2e4 2e4 2e4
material red phong .1 .7 .2 colour .9 .1 .05 power 40
sphere ball at 9 0 4 radius .3 material red
plane floor at 0 -.7 0 normal 0 1 0 catcher .6
shadow on
END
# before the lamp at (880, 200): 1280 pixels are 2 tan 25 degrees wide
echo '*,ball,.7,.464,4' >"$out/poses.csv"
$host/glint bake "$out/ball.scene" -o "$out/ball.glint" -q
lamps=(880,200,9 250,500,5)
$host/vm/scene YUYV 1280x720 "$out/night.yuyv" "${lamps[@]}"
$host/vm/scene -n 3 y4m 1280x720 "$out/night.y4m" "${lamps[@]}"
$host/glint overlay "$out/night.y4m" -o "$out/overlay.y4m" -q --lens "$lens" \
    "${look[@]}" --scene "$out/ball.glint" --pose "$out/poses.csv" --json >"$out/drawn"
expect 'the ball hides a lamp' says drawn '"lamps_hidden": 1'

things() { # DISPLAY LAYOUT WxH
    local at=${1//[:@]/-}
    guest "$at" -d "$1" -V '' -i "$glint" -i "$out/night.yuyv" -i "$out/ball.glint" \
        -i "$out/poses.csv" -i model="$lens" <<END
start_feed -c /dev/video0 /dev/video1 YUYV 1280x720 /in/night.yuyv
mkfifo /tmp/pipe
glint live -d 0 -i 3 -f YUYV --lens /in/model ${look[*]} --scene /in/ball.glint \
    --pose /tmp/pipe --no-adaptive 2>err --json >stats &
live=\$!
wait_for grep -q '"frames":[1-9]' stats
cat /in/poses.csv >/tmp/pipe
wait_frames stats 3
shot panel
kill -INT \$live
wait \$live
echo "\$?" >code
END
    $host/vm/expected "$2" "$3" "$out/overlay.y4m" "$out/$at/expected.ppm" scale
    expect "$1: the panel shows things, byte for byte" \
        same "$at/panel.ppm" "$at/expected.ppm"
    expect "$1: leaves with 0 when asked to end" says "$at/code" '^0$'
    expect "$1: the scene is a stage" says "$at/stats" '"scene":[0-9.]*[1-9]'
}

things simple:480x320-r5g6b5 r5g6b5 480x320
rm -f "$out"/night.y* "$out"/overlay.y4m
