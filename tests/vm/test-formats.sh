#!/bin/bash
# SPDX-License-Identifier: MIT
#
# test-formats.sh - the camera's colour bars must have the right colours on the
# panel, in every format that glint reads and with every I/O method.
# arch: x86_64 aarch64
. "$(dirname "$0")/lib.sh"

formats="YUYV UYVY NV12 NV21 YU12 422P RGB3 BGR3 XR24 RGBP GREY"
planar="NM12 NM21 YM12"
guest formats -d bochs:640x360 -V 'n_devs=2 multiplanar=1,2' \
    -i "$glint" -i model="$(model heliar-tronnier)" <<END
bars() { # NAME OPTION...
    name=\$1
    shift
    glint live -s 320x180 -r 30 -i 0 --lens /in/model --light 7,33 --exposure 0 \
        --stats json "\$@" >\$name.json 2>\$name.err &
    live=\$!
    wait_for grep -q '"frames":[1-9]' \$name.json
    shot \$name
    kill -INT \$live
    wait \$live
    echo \$? >\$name.code
}
for format in $formats; do
    bars \$format -d 0 -f \$format
done
for format in $planar; do
    bars \$format -d 4 -f \$format
done
for io in userptr read; do
    bars \$io -d 0 -f YUYV --io \$io
done
ls /dev/video*
glint live --list-devices
glint live -d 0 --list-formats --json >formats.json
END
expect "the guest's script" exited 0

# Of the lowest rows, where no text is: the middle of each of 8 bars.
colours() { # FILE
    local x
    for x in 40 120 200 280 360 440 520 600; do
        od -An -v -tu1 -j $((15 + 3 * (640 * 350 + x))) -N 3 "$1"
    done
}
right() { # NAME TOLERANCE [grey]
    colours "$out/formats/$1.ppm" | awk -v most="$2" -v grey="${3:-0}" '
        BEGIN {
            split("1 1 1  1 1 0  0 1 1  0 1 0  1 0 1  1 0 0  0 0 1  0 0 0", c)
        }
        {
            for (i = 1; i <= 3; i++) {
                want = 191 * c[3 * (NR - 1) + i]
                if (grey)
                    want = 191 * (0.2126 * c[3 * NR - 2] + \
                        0.7152 * c[3 * NR - 1] + 0.0722 * c[3 * NR])
                off = $i - want
                if (off < 0)
                    off = -off
                if (off > worst)
                    worst = off
            }
        }
        END { print "off by " worst; exit !(NR == 8 && worst <= most) }'
}
for format in $formats $planar userptr read; do
    expect "$format: runs" says "formats/$format.code" '^0$'
done
for format in ${formats/GREY/} $planar userptr read; do
    expect "$format: the colours are right" right $format 12
done
expect "GREY: the greys are right" right GREY 12 grey
expect "formats are listed" says formats/formats.json '"format": "NV12", "read": true'
