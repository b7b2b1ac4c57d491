#!/bin/bash
# SPDX-License-Identifier: MIT
#
# test-rate.sh - the frame rate of glint live with a moving lamp, on a clock
# that counts instructions. With 640x360 at 30 fps, 1 GIPS, and one point and
# three wavelengths per lamp, none of 300 frames may be lost or late by two
# frames. With the default numbers of points and wavelengths, the quality must
# fall until the rate is reached, and the fall must be reported. The same must
# hold with 1280x720 at 25 fps, and with 250 MIPS, where no frames are queued.
# Stars are off: one star costs more than the ghosts here, and no quality level
# lowers this cost. In the emulator every instruction takes the same time, and
# the program that feeds the camera runs on the same processor.
# arch: aarch64
. "$(dirname "$0")/lib.sh"

model=$(model heliar-tronnier)
size=640x360 rate=30 frames=300
build/x86_64/vm/scene -n 60 -m 3,1 YUYV $size "$out/scene" 100,150,7

run_at() { # NAME SHIFT OPTION...
    local at=$1 shift=$2
    shift 2
    guest "$at" -I "$shift" -m 512 -d bochs:640x480 -i "$glint" \
        -i model="$model" -i "$out/scene" <<END
cp /in/scene /tmp/scene # what the host is asked for makes the clock jump
loopback
start_feed -r $rate /dev/video9 YUYV $size /tmp/scene
glint live -d 9 --lens /in/model --starburst off -j 1 --count $frames --stats json $* \
    >/tmp/stats 2>/tmp/err
echo "\$?" >/tmp/code
shot last
cp /tmp/stats /tmp/err /tmp/code .
END
    expect "$at: shows $frames frames" says "$at/code" '^0$'
}
# Of all frames together, the last line; or of the last second, the one before.
value() { # NAME KEY [LINE]
    tail -n "${3:-1}" "$out/$1/stats" | head -n 1 | grep -oE "\"$2\":[0-9.]+" |
        head -n 1 | cut -d: -f2
}
at_end() { # NAME KEY
    value "$1" "$2" 2
}
between() { # LOW VALUE HIGH
    awk -v a="$1" -v x="$2" -v b="$3" \
        'BEGIN { print x " of " a " .. " b; exit !(x != "" && a <= x && x <= b) }'
}
stages() { # NAME
    printf '%-8s' "$1"
    for key in fps drops late latency_ms_p50 latency_ms_p99 find plan bin draw \
        show quality; do
        printf ' %s %s' "$key" "$(value "$1" $key)"
    done
    echo
}

run_at gips 0 --no-adaptive --area-samples 1 --dispersion 0
expect "1 GIPS: 30 fps" between 29.5 "$(value gips fps)" 30.5
expect "1 GIPS: no frame is lost" between 0 "$(value gips drops)" 0
expect "1 GIPS: none is late" between 0 "$(value gips late)" 0
expect "1 GIPS: latency below two frames" \
    between 1 "$(value gips latency_ms_p99)" 66.7
expect "1 GIPS: at full quality" between 1 "$(value gips quality)" 1

run_at default 0
expect "1 GIPS, default: the quality is lowered, and that is said" \
    says default/err 'quality lowered to keep the frame rate: step [1-3] '
expect "1 GIPS, default: 30 fps at the end" \
    between 29 "$(at_end default fps)" 31
expect "1 GIPS, default: no frame is lost at the end" \
    between 0 "$(at_end default drops)" 0

run_at low 2
expect "250 MIPS: nothing queues" between 1 "$(value low latency_ms_p99)" 100
expect "250 MIPS: quality is lowered, and that is said" \
    says low/err 'quality lowered to keep the frame rate: step [1-9]'
expect "250 MIPS: lights and ghosts are still drawn" \
    says low/stats '"lights":1,"ghosts":[1-9]'
run_at plain 2 --no-adaptive
expect "250 MIPS: faster than without" between "$(value plain fps)" \
    "$(value low fps)" 31
size=1280x720 rate=25 frames=250
build/x86_64/vm/scene -n 20 -m 6,2 YUYV $size "$out/scene" 200,300,14
run_at hd 0
expect "1 GIPS, 1280x720: 25 fps at the end" between 24 "$(at_end hd fps)" 26
expect "1 GIPS, 1280x720: no frame is lost at the end" \
    between 0 "$(at_end hd drops)" 0

for at in gips default low plain hd; do
    stages $at
done | tee "$out/stages"
rm -f "$out/scene"
