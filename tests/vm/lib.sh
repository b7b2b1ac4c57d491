# SPDX-License-Identifier: MIT
# shellcheck shell=bash
#
# lib.sh - functions and variables for the tests tests/vm/test-*.sh, which source
# this file with the architecture as its first argument. See README.md here.
#
#   $arch $out $glint $tools   architecture; folder of artefacts; static glint;
#                              folder of the guest's tools, all in each guest
#   guest NAME [OPTION...] <<'END' ... END
#                              boots and runs the script; $code is its exit code,
#                              $out/NAME gets log, console, pictures
#   expect TEXT COMMAND...     one check
#   model LENS, asan_glint       path of a baked lens, of a glint with ASan
#   skip TEXT                  ends the test: not possible here
set -u
cd "$(dirname "${BASH_SOURCE[0]}")/../.." || exit 2
arch=${1:?an architecture: x86_64, aarch64 or armv7}
name=$(basename "$0" .sh)
name=${name#test-}
out=$PWD/build/vm/$arch/$name
glint=$PWD/build/$arch/glint
tools=$PWD/build/$arch/vm
rm -rf "$out"
mkdir -p "$out"
passed=0 failed=0 code=''

guest() { # NAME [OPTION of run...], script on standard input
    local to=$out/$1 tool inputs=()
    shift
    mkdir -p "$to"
    cat >"$to/script"
    for tool in "$tools"/*; do
        [ -x "$tool" ] && [ -f "$tool" ] && inputs+=(-i "$tool")
    done
    tests/vm/run -a "$arch" "${inputs[@]}" "$@" -o "$to" -e "$to/script" \
        >"$to/said" 2>&1
    code=$?
    [ $code -ne 125 ] || { echo "the guest failed:" && tail -n 5 "$to/said"; }
}

expect() { # TEXT COMMAND...
    local text=$1
    shift
    if "$@" >"$out/.why" 2>&1; then
        passed=$((passed + 1))
        echo "ok $text"
    else
        failed=$((failed + 1))
        echo "not ok $text ($*)"
        sed 's/^/   /' "$out/.why" | head -n 8
    fi
}

skip() { # TEXT
    echo "skipped: $*"
    trap - EXIT
    exit 77
}

# What expect may ask besides shell commands; paths are relative to $out.
exited() { # CODE - the last guest did
    [ "$code" = "$1" ] || { echo "exit code $code"; return 1; }
}
says() { # FILE REGEX
    grep -Eq "$2" "$out/$1" || { tail -n 6 "$out/$1"; return 1; }
}
same() { # FILE FILE - byte for byte
    cmp "$out/$1" "$out/$2"
}

# glint with ASan and UBSan, dynamic: for guest -m 1024 -l. Prints its path.
asan_glint() {
    (
        flock 8
        make -s --no-print-directory CONFIG=asan OUT=build/asan \
            build/asan/glint >&2
    ) 8>build/vm/.asan && echo build/asan/glint
}

# The model of LENS, baked once for all tests; prints its path.
model() { # LENS
    mkdir -p build/vm/models
    (
        flock 8
        [ -s "build/vm/models/$1.glint" ] ||
            build/x86_64/glint bake "$1" -o "build/vm/models/$1.glint" >&2
    ) 8>build/vm/models/.lock
    echo "build/vm/models/$1.glint"
}

end() {
    local status=$?
    rm -f "$out/.why"
    [ $status -eq 0 ] || { echo "not ok the test ran to its end ($status)"; failed=$((failed + 1)); }
    [ $((passed + failed)) -gt 0 ] || { echo "not ok nothing was checked"; failed=1; }
    echo "$passed passed, $failed failed"
    exit $((failed > 0))
}
trap end EXIT

# Sets host, lens and look; makes scene.yuyv, frames of a camera, and
# overlay.y4m, what glint overlay makes of them by this lens and these options.
make_scene_with_lamps() {
    host=build/x86_64
    lens=$(model heliar-tronnier)
    look=(--exposure 4 --max-lights 4)
    lamps=(880,200,9 250,500,5)
    $host/vm/scene YUYV 1280x720 "$out/scene.yuyv" "${lamps[@]}"
    $host/vm/scene -n 3 y4m 1280x720 "$out/scene.y4m" "${lamps[@]}"
    $host/glint overlay "$out/scene.y4m" -o "$out/overlay.y4m" -q \
        --lens "$lens" "${look[@]}"
}
