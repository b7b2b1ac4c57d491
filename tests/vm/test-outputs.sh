#!/bin/bash
# SPDX-License-Identifier: MIT
#
# test-outputs.sh - a scene with lamps -> vivid's HDMI loop -> glint live -> all
# outputs except panels: y4m, pipes, v4l2loopback, snapshots. The output must
# be, byte for byte, what glint overlay makes of the same frame. Then tests the
# effect of signals.
# arch: x86_64 aarch64
. "$(dirname "$0")/lib.sh"

host=build/x86_64
size=1280x720 frame=1843200
heliar=$(model heliar-tronnier)
stopped=$out/stopped.glint
look=(--exposure 4 --max-lights 4)
lamps=(880,200,9 250,500,5)
overlay() { # MODEL NAME
    $host/glint overlay "$out/scene.y4m" -o "$out/$2.y4m" -q --lens "$1" \
        "${look[@]}" &&
        $host/vm/expected x8r8g8b8 $size "$out/$2.y4m" "$out/$2.ppm"
}
$host/glint bake heliar-tronnier -q --f-number 8 --tolerance 4 -o "$stopped" &&
    $host/vm/scene YUYV $size "$out/scene" "${lamps[@]}" &&
    $host/vm/scene -n 3 y4m $size "$out/scene.y4m" "${lamps[@]}" &&
    overlay "$heliar" heliar && overlay "$stopped" stopped &&
    $host/vm/expected yuyv $size "$out/heliar.y4m" "$out/yuyv" || exit
tail -c $frame "$out/heliar.y4m" >"$out/planes"
echo "frame=$frame size=$size look='${look[*]}'" >"$out/names"

guest all -m 512 -d bochs:$size -V '' -i "$glint" -i "$out/names" \
    -i "$out/scene" -i "$out/yuyv" -i heliar="$heliar" -i "$stopped" <<'END'
. /in/names
start_feed -c /dev/video0 /dev/video1 YUYV $size /in/scene
camera="-i 3 -f YUYV"
live() { # NAME OPTION...
    name=$1
    shift
    glint live -d 0 $camera $look --no-adaptive "$@" 2>$name.err
    echo "code $?" >$name.code
}
# start NAME OPTION...: until frames are shown
start() {
    name=$1
    shift
    glint live -d 0 $camera $look --no-adaptive --stats json "$@" \
        >$name.json 2>$name.err &
    live=$!
    wait_for grep -q '"frames":[1-9]' $name.json
}
ended() {
    wait $live
    echo "code $?" >$name.code
    vt >$name.mode
}
heliar="--lens /in/heliar"

live file $heliar -o y4m:/tmp/x.y4m --count 12 --stats none
head -n 1 /tmp/x.y4m >file.header
tail -c $frame /tmp/x.y4m >/tmp/file.planes
wc -c </tmp/x.y4m >file.bytes
ls -A /tmp | grep -c 'glint-' >file.left
mv /tmp/file.planes file.planes
rm /tmp/x.y4m

live piped $heliar -o y4m:- --stats json --count 5 | tail -c $frame >piped.planes
live gone $heliar -o y4m:- --stats none | head -c 3000000 | wc -c >gone.bytes

# a pipe that takes nothing holds the first signal up, not the second
mkfifo /tmp/fifo
sleep 1000 <>/tmp/fifo &
reader=$!
glint live -d 0 $camera $heliar -o y4m:- --stats none >/tmp/fifo 2>twice.err &
live=$! name=twice
wait_for grep -q pipe /proc/$live/wchan # it blocks as it writes
kill -INT $live
sleep 1
kill -0 $live && echo waits >twice.first
kill -INT $live
ended
kill $reader

live full $heliar -o y4m:/dev/full --stats none -q
mkdir /tmp/small
mount -t tmpfs -o size=4m small /tmp/small
live small $heliar -o y4m:/tmp/small/x.y4m --stats none -q
ls -A /tmp/small >small.left
live null $heliar -o null --count 3 --stats json >null.json

loopback
start node -o v4l2:/dev/video9 $heliar
grab -s 6 /dev/video9 YUYV $size 3 /tmp/frames /in/yuyv >node.grabbed 2>&1
echo "code $?" >node.grab
kill -TERM $live
ended

echo 'lens = /in/heliar' >/tmp/config
start signals --config /tmp/config --snapshot /tmp/shot-%d.ppm
wait_frames signals.json 3
shot heliar
kill -USR2 $live
wait_for test -e /tmp/shot-1.ppm
kill -USR2 $live
wait_for test -e /tmp/shot-2.ppm
mv /tmp/shot-1.ppm snapshot.ppm
echo 'lens = /in/stopped.glint' >/tmp/config
kill -HUP $live
wait_for grep -q 'live: reloaded' signals.err
wait_frames signals.json 3
shot stopped
refused() { [ "$(grep -c 'not reloaded' signals.err)" -gt "$had" ]; }
for broken in 'lens = /in/none' 'lenz = /in/heliar' 'exposure = lots'; do
    had=$(grep -c 'not reloaded' signals.err)
    echo "$broken" >/tmp/config
    kill -HUP $live
    wait_for refused
done
wait_frames signals.json 3
shot still
kill -INT $live
ended

stop_feed
camera="-i 0 -s 320x180 -r 30"
start reports $heliar -o null
reports() { grep -c frames reports.json; }
more() { [ "$(reports)" -gt "$had" ]; }
for i in 1 2 3 4 5; do # each right after the one of the second
    had=$(reports)
    wait_for more
    had=$(reports)
    kill -USR1 $live
    wait_for more
done
kill -INT $live
ended

start killed $heliar
kill -9 $live
ended
live next $heliar --count 3 --stats none
vt >next.mode
END
expect "the guest's script" exited 0

is() { # NAME CODE
    says "all/$1.code" "^code $2$" || { cat "$out/all/$1.err"; return 1; }
}
quiet() { # NAME
    [ ! -s "$out/all/$1.err" ] || { cat "$out/all/$1.err"; return 1; }
}
lines() { # NAME N
    [ "$(wc -l <"$out/all/$1.err")" = "$2" ] ||
        { cat "$out/all/$1.err"; return 1; }
}
header_bytes=$(wc -c <"$out/all/file.header")
expect "y4m: ends with 0 after the frames it was asked for" is file 0
expect "y4m: C422 of that size" says all/file.header "^YUV4MPEG2 W1280 H720 .*C422"
expect "y4m: 12 whole frames" \
    [ "$(cat "$out/all/file.bytes")" = $((header_bytes + 12 * (frame + 6))) ]
expect "y4m: the last is the overlay, byte for byte" same all/file.planes planes
expect "y4m: no other file is left" says all/file.left '^0$'
expect "pipe: ends with 0" is piped 0
expect "pipe: the overlay alone, byte for byte" same all/piped.planes planes
expect "pipe: statistics go to the other stream" says all/piped.err '"total":true'
expect "pipe: a reader that goes away ends it with 0" is gone 0
expect "pipe: it had enough" says all/gone.bytes '^3000000$'
expect "pipe: nobody complains" [ "$(grep -cvE '^glint live: /dev/video0 ' \
    "$out/all/gone.err")" = 0 ]
expect "full pipe: the first signal waits" says all/twice.first waits
expect "full pipe: the second ends it" is twice 130
expect "/dev/full: ends with 6" is full 6
expect "/dev/full: one line" lines full 1
expect "full disk: ends with 6" is small 6
expect "full disk: one line" lines small 1
expect "full disk: nothing is left" [ ! -s "$out/all/small.left" ]
expect "null: ends with 0" is null 0
expect "null: three frames" says all/null.json '"frames":3,.*"total":true'
expect "v4l2: three frames are the overlay" says all/node.grab 'code 0'
expect "v4l2: ends with 0" is node 0
expect "panel: the overlay, byte for byte" same all/heliar.ppm heliar.ppm
expect "snapshot: what the panel shows" same all/snapshot.ppm heliar.ppm
expect "snapshots: numbered" says all/signals.err 'snapshot /tmp/shot-2.ppm$'
# a report that nobody requests comes a second after the last, or later
soon() {
    sed -n 's/^{"t":\([0-9.]*\).*/\1/p' "$out/all/reports.json" | head -n -1 |
        awk '{ if (NR > 1 && $1 - t < 0.99) n++; t = $1 } END { print n + 0 }'
}
expect "SIGUSR1: reports at once" [ "$(soon)" -ge 4 ]
expect "SIGHUP: another lens" same all/stopped.ppm stopped.ppm
expect "SIGHUP: three files that are wrong" \
    [ "$(grep -c 'not reloaded' "$out/all/signals.err")" = 3 ]
expect "SIGHUP: what is wrong" says all/signals.err 'config:1: .*lenz'
expect "SIGHUP: and all stays as it was" same all/still.ppm stopped.ppm
expect "SIGINT: ends with 0" is signals 0
expect "SIGINT: the console is text" says all/signals.mode '^text$'
expect "kill -9: the console is graphics" says all/killed.mode '^graphics$'
expect "kill -9: the next run ends with 0" is next 0
expect "kill -9: and leaves text" says all/next.mode '^text$'
rm -f "$out"/{scene,scene.y4m,yuyv,planes,*.y4m} "$out"/all/*.planes
