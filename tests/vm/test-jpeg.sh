#!/bin/bash
# SPDX-License-Identifier: MIT
#
# test-jpeg.sh - MJPEG frames of cameras -> v4l2loopback -> glint live. Intact
# frames must be shown with the right bytes. Truncated, empty and garbage frames
# must be counted and skipped. If there are no others, glint must end with exit
# code 4 and one line.
# arch: x86_64 aarch64
. "$(dirname "$0")/lib.sh"

host=build/x86_64
[ -x $host/vm/jpeg ] || skip "glint is built without libjpeg"
lens=$(model heliar-tronnier)
in=$out/in
look=(--exposure 4 --max-lights 4)
scene() { # NAME WxH LAMP...
    local name=$1
    shift
    $host/vm/scene y4m "$1" "$in/$name.y4m" "${@:2}" &&
        $host/vm/jpeg encode "$in/$name.y4m" "$in/$name.jpg" || exit
}
overlay() { # NAME, of the JPEGs that follow
    $host/vm/jpeg decode "$in/$1.y4m" "${@:2}" &&
        $host/glint overlay "$in/$1.y4m" -o "$in/$1-over.y4m" -q \
            --lens "$lens" "${look[@]}" $tracking || exit
}
# The frames of a video, each once, as sums.
frames() { # VIDEO BYTES
    tail -c +$(($(head -n 1 "$1" | wc -c) + 1)) "$1" |
        split -b $((6 + $2)) --filter=md5sum | sort -u
}

mkdir "$in"
cp tests/fuzz/corpus/mjpeg/{good,bad}-* "$in"
head -c 300 /dev/urandom >"$in/bad-garbage"
head -c 60 "$in/good-422.jpg" >"$in/bad-header"
# four scenes, of which two arrive damaged
scene one 320x180 80,60,6
scene two 320x180 200,100,8
scene cut 320x180 100,120,7
scene torn 320x180 240,60,7
head -c $(($(wc -c <"$in/cut.jpg") * 6 / 10)) "$in/cut.jpg" >"$in/cut"
{
    head -c 1500 "$in/torn.jpg"
    head -c 1500 /dev/urandom
} >"$in/torn"
tracking=--no-tracking
overlay both "$in/one.jpg" "$in/two.jpg"
tracking=''
scene large 640x480 200,150,9 500,380,6
overlay panel "$in/large.jpg" "$in/large.jpg" "$in/large.jpg"
$host/vm/expected x8r8g8b8 640x480 "$in/panel-over.y4m" "$out/expected.ppm"

guest jpeg -d bochs:640x480 -i "$glint" -i "$in" -i model="$lens" <<'END'
loopback
cd /in/in
look="--exposure 4 --max-lights 4"
start() { # NAME OPTION...
    name=/out/$1
    shift
    glint live -d 9 --lens /in/model $look --no-adaptive "$@" \
        >$name.json 2>$name.err &
    live=$!
}
ended() {
    wait $live
    echo "code $?" >$name.code
}
live() { # NAME OPTION...
    start "$@"
    ended
}
feed_with() { # FPS WxH FILE...
    fps=$1
    shift
    start_feed -t -r $fps /dev/video9 MJPG "$@"
}

feed_with 15 33x17 good-* bad-*
live corpus --count 60 -o null --stats json
stop_feed

# Loops of 7 and 5 frames: a machine that fetches every second one, or every
# third, sees all of them.
feed_with 10 320x180 one.jpg cut torn bad-empty two.jpg bad-garbage one.jpg
live video --count 20 --no-tracking -o y4m:/tmp/x.y4m --stats json
mv /tmp/x.y4m /out/video.y4m
stop_feed

feed_with 30 640x480 large.jpg bad-truncated.jpg large.jpg large.jpg large.jpg
start panel --stats json
wait_for grep -q '"frames":[1-9]' $name.json
wait_frames $name.json 3
shot panel
wait_for grep -q '"corrupt":[1-9]' $name.json
kill -INT $live
ended
stop_feed

feed_with 30 320x180 bad-garbage bad-empty bad-header
live garbage --stats none -q
start empty --reconnect -o null --stats json
wait_for grep -q waiting $name.err && echo waits >$name.is
stop_feed
feed_with 30 320x180 one.jpg
wait_for grep -q '"frames":[1-9]' $name.json && echo shows >>$name.is
kill -INT $live
ended
stop_feed
true
END
expect "the guest's script" exited 0
total() { # NAME KEY LOW HIGH
    local v
    v=$(sed -n "\$s/.*\"$2\":\\([0-9]*\\).*/\\1/p" "$out/jpeg/$1.json")
    [ "${v:-x}" -ge "$3" ] && [ "$v" -le "$4" ] || { echo "$2 $v"; return 1; }
}
is() { # NAME CODE
    says "jpeg/$1.code" "^code $2$" || { cat "$out/jpeg/$1.err"; return 1; }
}
one_line() { # NAME REGEX
    [ "$(wc -l <"$out/jpeg/$1.err")" = 1 ] && says "jpeg/$1.err" "$2"
}
bytes=$((320 * 180 * 2))
for name in corpus video panel empty; do
    expect "$name: ends with 0" is $name 0
done
expect "corpus: good frames of many kinds" total corpus frames 60 60
# A camera drops what a slow machine does not fetch, so how many of the damaged
# frames arrive is not known.
expect "corpus: bad ones are counted" total corpus corrupt 1 10000
frames "$in/both-over.y4m" $bytes >"$out/want"
frames "$out/jpeg/video.y4m" $bytes >"$out/got"
expect "video: there are two different frames to show" \
    [ "$(wc -l <"$out/want")" = 2 ]
# A slow machine may see one of them alone.
expect "video: what was shown is one of them, byte for byte" \
    sh -c '[ -s "$1" ] && ! grep -vxFf "$2" "$1"' sh "$out/got" "$out/want"
expect "video: the damaged ones are counted" total video corrupt 1 10000
expect "video: a lamp and its ghosts" \
    says jpeg/video.json '"lights":1,"ghosts":[1-9]'
expect "panel: what glint overlay makes of it" \
    same jpeg/panel.ppm expected.ppm
expect "panel: lamps and ghosts" says jpeg/panel.json '"lights":2,"ghosts":[1-9]'
expect "panel: the damaged ones are counted" total panel corrupt 1 10000
expect "garbage: ends with 4" is garbage 4
expect "garbage: one line" one_line garbage "/dev/video9: all frames are damaged"
expect "reconnect: waits" says jpeg/empty.is waits
expect "reconnect: goes on when good frames come" says jpeg/empty.is shows
rm -rf "$in" "$out"/jpeg/*.y4m
