#!/bin/bash
# SPDX-License-Identifier: MIT
#
# test-camera.sh - frames that are fed arrive bit for bit, through vivid's HDMI
# loop and through v4l2loopback.
# arch: x86_64 aarch64 armv7
. "$(dirname "$0")/lib.sh"

# Two frames of noise: no two rows alike, the same on every run.
noise() { # BYTES
    awk -v n="$1" 'BEGIN { srand(7); for (i = 0; i < n; i += 4)
        printf "%08x", int(rand() * 4294967296) }' | xxd -r -p
}
noise $((640 * 480 * 4)) >"$out/YUYV"
noise $((640 * 480 * 3)) >"$out/NV12"
noise 20000 >"$out/MJPG"

guest frames -V '' -i "$out/YUYV" -i "$out/NV12" -i "$out/MJPG" <<'END'
through() { # CAMERA OUTPUT FOURCC
    feed -c "$1" "$2" "$3" 640x480 "/in/$3" &
    wait_for 5 test -e "$1" && sleep 1
    grab -s 4 "$1" "$3" 640x480 10 /tmp/frames "/in/$3"
    echo "$?" >"${1#/dev/}-$3"
    kill $!
    wait
}
through /dev/video0 /dev/video1 YUYV
through /dev/video0 /dev/video1 NV12
loopback
through /dev/video9 /dev/video9 NV12
through /dev/video9 /dev/video9 MJPG

ctl /dev/video0 "Percentage of Dropped Buffers" 30
ctl /dev/video0 0x00f0f040
END
expect "the guest's script" exited 0
for camera in video0-YUYV video0-NV12 video9-NV12 video9-MJPG; do
    expect "$camera: 10 of 10 frames" says frames/$camera '^0$'
done
expect "controls by name and number" says frames/log 'Dropped Buffers.*= 30$'
rm -f "$out"/{YUYV,NV12,MJPG}
