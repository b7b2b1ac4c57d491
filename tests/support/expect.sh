# SPDX-License-Identifier: MIT
#
# For scripts that test the command (tests/cli): sourced from the root of the
# repository. Sets glint, dir (removed at the end) and status.
glint=${GLINT:-build/glint}
pan=${PAN:-}
reference=${OUT:-build/x86_64-gcc-release} # programs of tests/programs
dir=$(mktemp -d)
trap 'rm -rf "$dir"' EXIT
status=0

pass() { echo "ok $1"; }
miss() {
    echo "not ok $1"
    sed 's/^/  /' "$dir/err" 2>/dev/null | head -n 5
    status=1
}
# check NAME COMMAND...: succeeds
check() {
    local name=$1
    shift
    if "$@" >/dev/null 2>&1; then pass "$name"; else miss "$name"; fi
}
# without_progress FILE: its lines except progress, which depends on speed
without_progress() {
    grep -vE '^[^:]+: ([0-9]+ % in [0-9]+ s, about |will take about )|^glint overlay: frame [0-9]+, [0-9.]+ fps' "$1"
}
# expect NAME CODE WORDS COMMAND...: leaves with CODE, says WORDS, of failure in
# two lines at most
expect() {
    local name=$1 code=$2 words=$3 got
    shift 3
    "$@" >"$dir/out" 2>"$dir/err"
    got=$?
    if [ $got = "$code" ] && grep -qiE -e "$words" "$dir/err" "$dir/out" &&
        { [ "$code" = 0 ] || [ "$(without_progress "$dir/err" | wc -l)" -le 2 ]; }; then
        pass "$name"
    else
        echo "  exit $got, wanted $code and /$words/"
        miss "$name"
    fi
}
same() { # NAME A B
    if cmp -s "$2" "$3"; then pass "$1"; else miss "$1"; fi
}
differ() { # NAME A B: both are there and not the same
    if [ -s "$2" ] && [ -s "$3" ] && ! cmp -s "$2" "$3"; then pass "$1"
    else miss "$1"; fi
}
has_file() { [ -n "$(find "$dir" -name "$1")" ]; } # PATTERN
gone() { # NAME PATTERN: no such file is left
    if has_file "$2"; then miss "$1"; else pass "$1"; fi
}
# await COMMAND...: waits until COMMAND succeeds. Fails after five minutes, a
# limit that only ends a hang.
await() {
    local i
    for ((i = 0; i < 6000; i++)); do
        if "$@" >/dev/null 2>&1; then return; fi
        sleep 0.05
    done
    return 1
}

# what many scripts draw on, and quickly
photo=tests/data/bridge.ppm
# shellcheck disable=SC2034
quick=(--grid 16 --max-lights 2 --rays model)
# shellcheck disable=SC2034
model=tests/fuzz/corpus/model/auto

# small_lens: $dir/small.lens, and bake MODEL OPTIONS... of it
small_lens() {
    cat >"$dir/small.lens" <<'EOT'
name      small
source    a cemented doublet with the stop behind it
f-number  5.6
film      36 24

surface    61.47   6    13  1.5168  64.17
surface   -44.64   2.5  13  1.6727  32.21
surface  -129.94   2    13  air
stop              93    10
EOT
}
bake() { # MODEL OPTIONS...
    local model=$1
    shift
    "$glint" bake "$dir/small.lens" -o "$model" --tolerance 5 \
        --max-angle 15 "$@"
}
