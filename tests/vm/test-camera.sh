#!/bin/bash
# SPDX-License-Identifier: MIT
#
# test-camera.sh - frames written to a virtual camera must arrive bit for bit,
# through vivid's HDMI loop and through v4l2loopback.
# arch: x86_64 aarch64 armv7
. "$(dirname "$0")/lib.sh"

# Noise: no two frames and no two rows are alike.
head -c $((640 * 480 * 4)) /dev/urandom >"$out/YUYV"
head -c $((640 * 480 * 3)) /dev/urandom >"$out/NV12"
head -c 20000 /dev/urandom >"$out/MJPG"

guest frames -V '' -i "$out/YUYV" -i "$out/NV12" -i "$out/MJPG" <<'END'
through() { # CAMERA OUTPUT FOURCC
    start_feed -c "$1" "$2" "$3" 640x480 "/in/$3"
    grab -s 4 "$1" "$3" 640x480 10 /tmp/frames "/in/$3"
    echo "$?" >"${1#/dev/}-$3"
    stop_feed
}
through /dev/video0 /dev/video1 YUYV
through /dev/video0 /dev/video1 NV12
loopback
through /dev/video9 /dev/video9 NV12
through /dev/video9 /dev/video9 MJPG

ctl /dev/video0 "Percentage of Dropped Buffers" 30
ctl /dev/video0 0x00f0f040
ctl /dev/video0 0x00f0f040 0

grab /dev/video0 NV12 640x480 60 /tmp/frames >flagged &
while kill -0 $! 2>/dev/null; do
    ctl /dev/video0 "Inject V4L2_BUF_FLAG_ERROR" 1
    usleep 100000
done
unplug_camera
ls /dev/video0 >unplugged 2>&1
plug_camera && grab /dev/video0 NV12 640x360 2 /tmp/frames >plugged
END
expect "the guest's script" exited 0
for camera in video0-YUYV video0-NV12 video9-NV12 video9-MJPG; do
    expect "$camera: 10 of 10 frames" says frames/$camera '^0$'
done
expect "controls by name and number" says frames/log 'Dropped Buffers.*= 30$'
expect "a flagged frame" says frames/flagged 'bytes, ERROR$'
expect "a camera that goes" says frames/unplugged 'No such file'
expect "and comes back" says frames/plugged '^2 frames'
rm -f "$out"/{YUYV,NV12,MJPG}
