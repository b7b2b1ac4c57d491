#!/bin/bash
# SPDX-License-Identifier: MIT
#
# test-steady.sh - after start-up, glint live must allocate no memory per frame:
# its system calls contain no brk, mmap or munmap. Memory and open files must
# stay the same over FRAMES frames (1500, which take 15 to 40 s). At exit,
# nothing may leak (ASan).
# arch: x86_64
. "$(dirname "$0")/lib.sh"

host=build/x86_64
lens=$(model heliar-tronnier)
strace=$(command -v strace) || skip "it needs strace"
asan=$(asan_glint) || exit
cp "$asan" "$out/glint-asan"
size=64x36
# a lamp that goes there, out of the picture, and is back
$host/vm/scene -n 90 -m 1,0.3 YUYV $size "$out/moving" -12,5,4 20,20,3 || exit
$host/vm/scene y4m 320x180 "$out/scene.y4m" 80,60,6 &&
    $host/vm/jpeg encode "$out/scene.y4m" "$out/scene.jpg" || exit

echo "${FRAMES:-1500}" >"$out/frames"
guest steady -m 1024 -d bochs:640x480 -V '' -i "$glint" -l "$strace" \
    -l "$out/glint-asan" -i "$out/moving" -i "$out/scene.jpg" \
    -i model="$lens" -i "$out/frames" <<'END'
frames=$(cat /in/frames)
look="--lens /in/model --exposure 4 -j 1"
loopback
calls="mmap,munmap,mremap,brk,madvise,open,openat,close,clone,clone3,ioctl"
traced() { # NAME OPTION...
    name=$1
    shift
    strace -f -e trace=$calls -e signal=none -o /tmp/trace glint live $look \
        --count 300 --stats json "$@" >$name.json 2>$name.err
    echo "code $?" >$name.code
    mv /tmp/trace $name.trace
}
data_kb() { sed -n 's/^VmData:[[:space:]]*\([0-9]*\).*/\1/p' "/proc/$1/status"; }
# watched NAME OPTION...: memory and files each second
watched() {
    name=$1
    shift
    glint live $look --stats json "$@" >$name.json 2>$name.err &
    live=$!
    wait_for grep -q '"frames":[1-9]' $name.json
    sleep 1
    while kill -0 $live 2>/dev/null; do
        now="$(data_kb $live) $(rss_kb $live) $(fd_count $live)"
        kill -0 $live 2>/dev/null && echo "$now" >>$name.now
        sleep 1
    done
    wait $live
    echo "code $?" >$name.code
}

# else the kernel makes huge pages of small ones after ten seconds, which counts
# as resident
echo never >/sys/kernel/mm/transparent_hugepage/enabled
start_feed -r 120 /dev/video9 YUYV 64x36 /in/moving
traced trace-null -d 9 -o null
traced trace-panel -d 9
watched long -d 9 -o null --count $frames
for output in null fb y4m:/tmp/x.y4m; do
    name=asan-${output%%:*}
    ASAN_OPTIONS=detect_leaks=1 glint-asan live $look -d 9 -o $output \
        --count 60 --stats json >$name.json 2>$name.err
    echo "code $?" >$name.code
done
stop_feed

start_feed -r 60 /dev/video9 MJPG 320x180 /in/scene.jpg
traced trace-jpeg -d 9 -o null
ASAN_OPTIONS=detect_leaks=1 glint-asan live $look -d 9 -o null --count 30 \
    --stats json >asan-jpeg.json 2>asan-jpeg.err
echo "code $?" >asan-jpeg.code
stop_feed
traced trace-camera -d 0 -i 0 -s 320x180 -r 60 -o y4m:/tmp/x.y4m
true
END
expect "the guest's script" exited 0

is() { # NAME CODE
    says "steady/$1.code" "^code $2$" || { cat "$out/steady/$1.err"; return 1; }
}
# Calls for memory, files or threads from the 100th frame taken to the last.
per_frame() { # NAME
    awk '/DQBUF/ && !/EAGAIN/ { n++; had = n_calls }
        !/ioctl\(/ && !/^[0-9]+ +[+-]{3}/ && n >= 100 { n_calls++; last = $0 }
        END { print n + 0, "frames,", had + 0, "calls", had ? last : ""
              exit n < 300 || had > 0 }' "$out/steady/$1.trace"
}
# What drawing may take is set aside at the start, and resident from when a
# frame first needs it: data stay the same, the resident part steps up to 4 MiB
# at most and not at all in the second half.
same_all() { # NAME
    awk '{ data[NR] = $1; rss[NR] = $2; n_files[NR] = $3 }
        END {
            half = int(NR / 2) + 1
            for (i = 1; i <= NR; i++)
                if (data[i] != data[1] || n_files[i] != n_files[1] ||
                    rss[i] - rss[1] > 4096 || i > half && rss[i] != rss[half])
                    bad++
            print data[1], "to", data[NR], "kB,", rss[1], "to", rss[NR],
                "resident,", n_files[1], "to", n_files[NR], "files,", NR,
                "seconds"
            exit NR < 6 || bad > 0
        }' "$out/steady/$1.now"
}
for name in trace-null trace-panel trace-jpeg trace-camera; do
    expect "$name: ends with 0" is $name 0
    expect "$name: no call for memory, files or threads" per_frame $name
done
expect "a lamp's ghosts were drawn" \
    says steady/trace-null.json '"lights":[1-9],"ghosts":[1-9]'
expect "long: ends with 0" is long 0
expect "long: all frames" says steady/long.json \
    "\"frames\":$(cat "$out/frames"),.*\"total\":true"
expect "long: memory and files stay the same" same_all long
for name in asan-null asan-fb asan-y4m asan-jpeg; do
    expect "$name: nothing leaks" is $name 0
done
expect "no complaint by sanitizers" \
    [ "$(cat "$out"/steady/*.err | grep -cE 'Sanitizer|runtime error')" = 0 ]
rm -f "$out"/{glint-asan,moving,scene.*}
