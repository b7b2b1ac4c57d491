#!/bin/bash
# SPDX-License-Identifier: MIT
#
# test-motion.sh - a recorded motion on a panel of 480x320 at 30 fps, with a
# clock that counts instructions, 1 GIPS. The body, its foods, shells, lines,
# box and time line are drawn over black and over a colour. Of 150 frames none
# may be late. A frame at which it stops must be on the panel byte for byte as
# glint live writes it to a file on the host. With a floor that receives
# shadows, even the lowest quality is too slow: frames are late, and must be
# counted.
# arch: aarch64
. "$(dirname "$0")/lib.sh"

host=build/x86_64
scenes=tools/examples/scenes
cp $scenes/walk.json "$out"
sed '/^plane\|^material floor\|^background/d' $scenes/walk.scene >"$out/black.scene"
sed '/^plane\|^material floor/d' $scenes/walk.scene >"$out/colour.scene"
cp $scenes/walk.scene "$out/floor.scene"
for scene in black colour floor; do
    $host/glint bake "$out/$scene.scene" -q -o "$out/$scene.glint"
done

printf '0 jump 40\n0 pause\n' >"$out/pause"

# Of all frames together, the last line.
value() { # NAME KEY
    tail -n 1 "$out/$1/stats" | grep -oE "\"$2\":[0-9.]+" | head -n 1 |
        cut -d: -f2
}
between() { # LOW VALUE HIGH
    awk -v a="$1" -v x="$2" -v b="$3" \
        'BEGIN { print x " of " a " .. " b; exit !(x != "" && a <= x && x <= b) }'
}
play() { # SCENE FRAMES OPTION...
    local scene=$1 frames=$2
    shift 2
    guest "$scene" -I 0 -m 512 -d simple:480x320-r5g6b5 -i "$glint" \
        -i "$out/$scene.glint" -i "$out/pause" <<END
cp /in/$scene.glint /tmp/scene.glint # the host's files make the clock jump
vt graphics
glint live -d none -s 480x320 -r 30 --scene /tmp/scene.glint --lens none -j 1 \
    --count $frames --stats json $* >/tmp/stats 2>/tmp/err
echo "\$?" >/tmp/code
glint live -d none -s 480x320 -r 30 --scene /tmp/scene.glint --lens none -j 1 \\
    --show timeline --stats none --no-adaptive --control /in/pause &
live=\$!
sleep 3
shot panel
kill -INT \$live
wait \$live
cp /tmp/stats /tmp/err /tmp/code .
END
    expect "$scene: shows $frames frames" says "$scene/code" '^0$'
}

for scene in black colour; do
    play $scene 150 --no-adaptive --show timeline
    expect "$scene: 30 fps" between 29.5 "$(value $scene fps)" 30.5
    expect "$scene: no frame is late" between 0 "$(value $scene late)" 0
    expect "$scene: no frame is lost" between 0 "$(value $scene drops)" 0
    $host/glint live -d none -s 480x320 -r 30 --scene "$out/$scene.glint" \
        --lens none --count 3 --no-adaptive --show timeline --stats none \
        --control "$out/pause" -o "$out/$scene.y4m" 2>"$out/$scene.err"
    $host/vm/expected r5g6b5 480x320 "$out/$scene.y4m" "$out/$scene.ppm"
    expect "$scene: frame 40 is on the panel" \
        same $scene/panel.ppm $scene.ppm
done
play floor 60 --quality least
expect 'floor: late frames are counted' between 1 "$(value floor late)" 1000

for scene in black colour floor; do
    printf '%-8s' $scene
    for key in fps drops late latency_ms_p50 latency_ms_p99 scene show quality; do
        printf ' %s %s' $key "$(value $scene $key)"
    done
    echo
done | tee "$out/stages"
rm -f "$out"/*.y4m
