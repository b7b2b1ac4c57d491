#!/bin/bash
# SPDX-License-Identifier: MIT
#
# test-gstreamer.sh - gst-launch-1.0 v4l2src ! glintflare ! fbdevsink: a
# camera's frames must have the bytes that glint overlay draws on them, and
# appear on the panel.
# arch: x86_64
. "$(dirname "$0")/lib.sh"

folder=$(pkg-config --variable=pluginsdir gstreamer-1.0 2>/dev/null) || skip "no libgstreamer1.0-dev"
command -v gst-launch-1.0 >/dev/null || skip "no gstreamer1.0-tools"
plugins=()
for plugin in coreelements video4linux2 fbdevsink videoconvertscale debug; do
    [ -f "$folder/libgst$plugin.so" ] || skip "no $folder/libgst$plugin.so"
    plugins+=(-l "$folder/libgst$plugin.so")
done
make -s --no-print-directory gstreamer >&2

w=640 h=480 n=12
caps=video/x-raw,format=YUY2,width=$w,height=$h
build/x86_64/vm/scene YUYV ${w}x$h "$out/lamps.yuyv" 180,120,12 460,240,18
guest camera -m 1024 -V '' -d bochs:${w}x$h "${plugins[@]}" -l build/gstreamer-1.0/libgstglint.so \
    -l "$(command -v gst-launch-1.0)" -i "$(model heliar-tronnier)" -i "$out/lamps.yuyv" <<END
loopback
start_feed -t -r 5 /dev/video9 YUYV ${w}x$h /in/lamps.yuyv
export GST_PLUGIN_SYSTEM_PATH= GST_PLUGIN_PATH=/in GST_REGISTRY_FORK=no GST_REGISTRY=/tmp/registry
gst-launch-1.0 -q v4l2src device=/dev/video9 num-buffers=$n ! $caps ! tee name=both ! queue max-size-buffers=0 max-size-bytes=0 ! filesink location=in.yuyv \
    both. ! queue max-size-buffers=0 max-size-bytes=0 ! glintflare lens=/in/heliar-tronnier.glint ! filesink location=out.yuyv || exit
kill \$!
# Frames of vivid are the reader's alone, to be drawn on where they lie. It says sRGB
# of their curve, which a y4m stream cannot.
start_feed -c /dev/video0 -t /dev/video1 YUYV ${w}x$h /in/lamps.yuyv
vt graphics
gst-launch-1.0 -q v4l2src device=/dev/video0 num-buffers=$n ! $caps ! \
    capssetter caps=video/x-raw,colorimetry=bt601 ! glintflare lens=/in/heliar-tronnier.glint ! videoconvert ! fbdevsink sync=false || exit
shot panel
END
planar() { # FILE: the frames of YUYV as a y4m stream
    printf 'YUV4MPEG2 W%d H%d F30:1 Ip A1:1 C422 XCOLORRANGE=LIMITED\n' $w $h
    perl -0777 -ne 'for (unpack "(a'$((2 * w * h))')*", $_) {
        print "FRAME\n", pack("C*", map { $_ % 2 ? () : $b[$_] } 0 .. (@b = unpack "C*", $_) - 1),
            map { my $at = $_; pack "C*", map { $b[4 * $_ + $at] } 0 .. @b / 4 - 1 } 1, 3 }' "$1"
}
planar "$out/camera/in.yuyv" >"$out/in.y4m"
planar "$out/camera/out.yuyv" >"$out/out.y4m"
"$glint" overlay "$out/in.y4m" -o "$out/overlay.y4m" -q --lens "$(model heliar-tronnier)"
expect "the guest's pipelines end well" exited 0
expect "the camera's frames came" test "$(stat -c %s "$out/camera/in.yuyv")" = $((n * 2 * w * h))
expect "they have a flare" test "$(cmp -l "$out/in.y4m" "$out/out.y4m" | wc -l)" -gt 10000
expect "its bytes are those of glint overlay" same overlay.y4m out.y4m
# What the panel shows, by another program's conversion, which interpolates chroma
# at the edges of the colour bars.
build/x86_64/vm/expected x8r8g8b8 ${w}x$h "$out/overlay.y4m" "$out/panel.ppm"
expect "the panel shows it: 99 % of all samples within 6 codes" perl -e '
    local $/; my ($p, $q) = map { open F, $_ or die; [unpack "C*", substr <F>, -3 * '$((w * h))'] } @ARGV;
    my $far = grep { abs $$p[$_] - $$q[$_] > 6 } 0 .. $#$p;
    print "$far are not\n"; exit($far > @$p / 100)' "$out/panel.ppm" "$out/camera/panel.ppm"
