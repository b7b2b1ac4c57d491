#!/bin/bash
# SPDX-License-Identifier: MIT
#
# test-faults.sh - faults of cameras and panels in glint live: it must recover,
# or end with exit code 4 and one line. Then the console must be in text mode
# again, nothing may leak (ASan on x86_64, open files on all), and the panel
# must never turn black. How soon it ends is tested with a fake clock
# (test_v4l2_faults).
# arch: x86_64 aarch64 armv7
. "$(dirname "$0")/lib.sh"

program=(-i "$glint")
if [ "$arch" = x86_64 ]; then
    asan=$(asan_glint) || exit
    program=(-m 1024 -l "$asan")
fi
build/x86_64/vm/scene YUYV 640x480 "$out/scene" 200,150,9
model=$(model heliar-tronnier)

guest faults -d bochs:640x480 -V '' "${program[@]}" -i "$model" \
    -i "$out/scene" <<'END'
camera="-i 0 -s 320x180 -r 60"
# start NAME OPTION...: live runs and has shown frames
start() {
    name=$1
    shift
    glint live -d 0 $camera --lens /in/heliar-tronnier.glint \
        --light 7,33 --exposure 4 -j 1 --stats json "$@" \
        >"$name.json" 2>"$name.err" &
    live=$!
    wait_for grep -q '"frames":[1-9]' "$name.json"
}
# goes_on: a second that begins later has frames
goes_on() {
    wait_frames "$name.json" 1 && echo goes-on >>"$name.is"
}
ended() {
    wait $live
    echo "code $?" >>"$name.is"
    vt >>"$name.is"
}
finish() {
    kill -INT $live
    ended
}

start flagged
ctl /dev/video0 0x00f0f042 1
goes_on; finish

start qbuf
fds=$(fd_count $live)
ctl /dev/video0 0x00f0f044 1
goes_on
[ "$(fd_count $live)" = "$fds" ] && echo same-fds >>qbuf.is
finish

ctl /dev/video0 0x00f0f043 1
start reqbufs; goes_on; finish
ctl /dev/video0 0x00f0f045 1
start streamon; goes_on; finish

start fatal
fds=$(fd_count $live)
for i in 1 2 3; do
    ctl /dev/video0 0x00f0f046 1
    goes_on
done
[ "$(fd_count $live)" = "$fds" ] && echo same-fds >>fatal.is
finish

start dropped
ctl /dev/video0 0x00f0f040 30
goes_on
ctl /dev/video0 0x00f0f040 0
finish

ctl /dev/video0 0x00f0f026 1
start wrap; goes_on; goes_on; goes_on; finish
ctl /dev/video0 0x00f0f026 0

start busy
ctl /dev/video0 format NV12 640x360 >busy.other 2>&1
glint live -d 0 -o null --light 7,33 --lens /in/heliar-tronnier.glint \
    --stats none >two.json 2>two.err
echo "code $?" >two.is
goes_on; finish

start disconnect
shot lit
ctl /dev/video0 0x00f0f041 1
ended

start unplugged
unplug_camera
ended
plug_camera

start reconnect --reconnect
unplug_camera
wait_for grep -q waiting reconnect.err && echo waits >>reconnect.is
shot kept
plug_camera
goes_on; finish

start panel
unplug_panel
ended
plug_panel

start repanel --reconnect
unplug_panel
wait_for grep -q waiting repanel.err
plug_panel
goes_on
shot again
finish

for device in /dev/null /dev/video1 /dev/fb0 /in/scene /dev/video77; do
    glint live -d $device -o null --lens /in/heliar-tronnier.glint \
        --stats none 2>>not.err
    echo "code $?" >>not.is
done

chmod 600 /dev/video0
as 1000 glint live -d 0 -o null --lens /in/heliar-tronnier.glint \
    2>denied.err
echo "code $?" >denied.is

# HDMI: the signal goes, and comes back as another mode
start_feed -c /dev/video0 /dev/video1 YUYV 640x480 /in/scene
camera="-i 3"
start source
ctl /dev/video0 0x00f0f03e 1
goes_on
stop_feed
ctl /dev/video0 0x00f0f03f 16
ctl /dev/video0 0x00f0f03e 4
goes_on; finish
END
expect "the guest's script" exited 0

is() { # NAME WORD...
    local n=$1 word
    shift
    for word; do
        grep -qx "$word" "$out/faults/$n.is" ||
            { echo "$n: not '$word':" && cat "$out/faults/$n.is" \
                "$out/faults/$n.err"; return 1; }
    done
}
total() { # NAME KEY LOW HIGH
    local v
    v=$(sed -n "\$s/.*\"$2\":\\([0-9]*\\).*/\\1/p" "$out/faults/$1.json")
    [ "${v:-x}" -ge "$3" ] && [ "$v" -le "$4" ] || { echo "$2 $v"; return 1; }
}
one_line() { # NAME REGEX - the last of what was said
    tail -n 1 "$out/faults/$1.err" | grep -Eq "$2" ||
        { cat "$out/faults/$1.err"; return 1; }
}
for name in flagged qbuf reqbufs streamon fatal dropped wrap busy reconnect \
    repanel source; do
    expect "$name: goes on, and ends when asked" \
        is $name goes-on "code 0" text
done
expect "damaged buffers are counted" total flagged corrupt 1 20
expect "a refused buffer leaks no file" is qbuf same-fds
expect "three new starts leak no file" is fatal same-fds
expect "lost frames are counted" total dropped drops 5 10000
# The camera makes 60 frames a second, whatever is lost; a second for rounding.
expect "a sequence that wraps adds none" awk -F '[:,]' '{ t = $2; n = 0
    for (i = 3; i < NF; i += 2)
        if ($i ~ /"(frames|drops|late|corrupt)"/) n += $(i + 1)
} END { print n, "frames in", t, "s"; exit !(n > 128 && n <= 60 * t + 60) }' \
    "$out/faults/wrap.json"
expect "nobody changes the format of a stream" says faults/busy.other '[Bb]usy'
expect "a second user is told" is two "code 4"
expect "and why" one_line two "another program"
for name in disconnect unplugged panel; do
    expect "$name: ends with 4, console restored" is $name "code 4" text
done
expect "disconnect: one line" one_line disconnect "/dev/video0: .*removed"
expect "unplugged: one line" one_line unplugged "/dev/video0: .*removed"
expect "panel: one line" one_line panel "/dev/fb0: "
expect "reconnect waits" is reconnect waits
bright() { # NAME - the panel has many colours
    [ "$(od -An -v -tu1 -j 15 "$out/faults/$1.ppm" | tr -s ' ' '\n' |
        sort -u | wc -l)" -ge 4 ]
}
expect "a picture is shown" bright lit
expect "the panel keeps its picture meanwhile" bright kept
expect "the panel has a picture again" bright again
expect "what is no camera is refused with 4" \
    [ "$(grep -c 'code 4' "$out/faults/not.is")" = 5 ]
expect "in a line each" [ "$(wc -l <"$out/faults/not.err")" = 5 ]
expect "without permission it ends with 4" is denied "code 4"
expect "and says what to do" one_line denied "group 'video'"
expect "a lost signal is said" says faults/source.err "no signal"
expect "another mode is taken" says faults/source.err "1920x1080"
expect "no complaint by sanitizers" \
    [ "$(cat "$out"/faults/*.err | grep -cE 'Sanitizer|runtime error')" = 0 ]
rm -f "$out/scene"
