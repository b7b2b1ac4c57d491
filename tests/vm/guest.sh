# SPDX-License-Identifier: MIT
# shellcheck shell=sh
#
# guest.sh - functions for scripts that run in the guest; the guest sources this
# file before the script.

# One line to the host, its answer on standard output. The port takes one
# process at a time.
tell() { # WORD...
    for port in /dev/vport*p1; do :; done
    until mkdir /tmp/.port 2>/dev/null; do usleep 10000; done
    {
        echo "$*" >&3
        read -r answer <&3 && echo "$answer"
    } 3<>"$port"
    rmdir /tmp/.port
}

# Runs COMMAND ten times a second until it succeeds; the limit of ten minutes
# ends a hang only.
wait_for() { # COMMAND...
    tries=6000
    until "$@"; do
        tries=$((tries - 1))
        [ $tries -gt 0 ] || return 1
        usleep 100000
    done
}

# A picture of the panel as it is now: /out/NAME.ppm, .png. Drivers that flush
# by a timer had time to. vfb has no panel: its memory, /out/NAME.raw.
shot() { # NAME
    usleep 100000
    [ "$(cat /proc/fb)" != "0 Virtual FB" ] || {
        cat /dev/fb0 >"/out/$1.raw"
        return
    }
    answer=$(tell shot "$1")
    [ "$answer" = ok ] || { echo "shot $1: $answer" >&2; return 1; }
}

# /dev/video9 as a camera that `feed` feeds.
loopback() {
    modprobe videodev
    insmod /lib/loop.ko devices=1 video_nr=9 exclusive_caps=1 "$@"
}

# Waits until FILE, JSON statistics, has N frames of seconds that begin later.
wait_frames() { # FILE N
    had=$(grep -c frames "$1")
    wait_for has_frames "$1" $((had + 2)) "$2"
}
has_frames() { # FILE LINE N
    tail -n +"$2" "$1" | awk -F '"frames":' -v most="$3" \
        '{ n += $2 } END { exit !(n >= most) }'
}

# Runs `feed` until $feeder is killed; returns when frames have gone through.
start_feed() { # ARGUMENT...
    rm -f /tmp/fed
    feed "$@" &
    feeder=$!
    wait_for test -e /tmp/fed
}
stop_feed() {
    kill $feeder
    wait $feeder
}

# Cameras of vivid go and come back as if by the cable.
unplug_camera() { echo vivid.0 >/sys/bus/platform/drivers/vivid/unbind; }
plug_camera() {
    echo vivid.0 >/sys/bus/platform/drivers/vivid/bind
    wait_for test -e /dev/video0
}
# /dev/fb0 goes; `plug_panel` brings it back.
unplug_panel() {
    panel=$(readlink -f /sys/class/graphics/fb0/device)
    # that of virtio is below the card's: what has a driver is unbound
    panel_driver=$(readlink -f "$panel/driver")
    echo "${panel##*/}" >"$panel_driver/unbind"
}
plug_panel() {
    echo "${panel##*/}" >"$panel_driver/bind"
    wait_for test -e /dev/fb0
}

fd_count() { # PID
    find "/proc/$1/fd" -type l | wc -l
}
rss_kb() { # PID
    sed -n 's/^VmRSS:[[:space:]]*\([0-9]*\).*/\1/p' "/proc/$1/status"
}
