#!/bin/bash
# SPDX-License-Identifier: MIT
#
# test-panel.sh - every type of /dev/fb0: colour bars drawn by the driver's bit
# fields must be on the panel byte for byte.
# arch: x86_64 aarch64 armv7
. "$(dirname "$0")/lib.sh"

bars() { # DISPLAY LAYOUT WxH [COMMAND after it]
    local at=${1//[:@]/-}
    guest "$at" -d "$1" <<END
vt graphics
bars || exit
shot panel
${4:-:}
END
    build/x86_64/vm/bars "$2" "$3" >"$out/$at/expected.ppm"
    expect "$1: bars of $2, $3" same "$at/panel.ppm" "$at/expected.ppm"
    expect "$1: a PNG of them" test -s "$out/$at/panel.png"
}
gone='
unplug_panel
ls /dev/fb0 >unplugged 2>&1
plug_panel && bars >plugged'
goes() { # DISPLAY - as the last guest saw it
    expect "$1: a panel that goes" says "${1/:/-}/unplugged" 'No such'
    expect "$1: and comes back" says "${1/:/-}/plugged" '640x480'
}

bars bochs:640x480 x8r8g8b8 640x480 "$gone"
goes bochs:640x480
bars virtio:640x480 x8r8g8b8 640x480 "$gone"
goes virtio:640x480
case $arch in
x86_64)
    bars cirrus r5g6b5 1024x768
    bars vesa:0x311 r5g6b5 640x480
    bars vesa:0x310 x1r5g5b5-shifted 640x480
    bars vesa:0x312 r8g8b8 640x480
    bars vesa:0x342 a8r8g8b8 640x480
    bars vfb:640x480-16@60 b5g6r5 640x480
    bars vfb:640x480-24@60 b8g8r8 640x480
    bars vfb:640x480-32@60 a8b8g8r8 640x480
    ;;
*)
    bars simple:480x320-r5g6b5 r5g6b5 480x320
    bars simple:320x240-x1r5g5b5 x1r5g5b5 320x240
    bars simple:320x240-r8g8b8 r8g8b8 320x240
    bars simple:800x480-x8r8g8b8 x8r8g8b8 800x480
    ;;
esac
