#!/bin/bash
# SPDX-License-Identifier: MIT
#
# test-run.sh - tests tests/vm/run itself: exit codes, files, time limits, and a
# guest that dies.
# arch: x86_64 aarch64 armv7
. "$(dirname "$0")/lib.sh"

guest ends -i ORIGINAL=tests/vm/run <<'END'
uname -m
echo "to the host" >out
cp /in/ORIGINAL copy
su user -c 'id -u' >user
exit 7
END
expect "exit code of the program" exited 7
expect "what it prints" says ends/log "${arch%7}"
expect "files it writes" says ends/out '^to the host$'
expect "files it gets" cmp tests/vm/run "$out/ends/copy"
expect "another user" says ends/user '^1000$'

guest stuck -t 8 <<'END'
sleep 1000
END
expect "out of time: 124" exited 124

guest panics <<'END'
echo c >/proc/sysrq-trigger
END
expect "a kernel panic: 125" exited 125
expect "and says so" says panics/console 'Kernel panic'

# Time that counts instructions passes the same whatever the host does; on one
# architecture, as it is slow.
[ "$arch" = aarch64 ] || exit 0
for i in 1 2; do
    guest counted$i -I 0 <<'END'
read -r before rest </proc/uptime
for i in $(seq 200000); do :; done
read -r after rest </proc/uptime
echo "$before $after" | awk '{ print $2 - $1 }'
END
done
expect "counted time repeats to 2 %: $(cat "$out"/counted?/log | tr '\n' ' ')" \
    awk '{ t[NR] = $1 } END { d = t[1] - t[2]; d = d < 0 ? -d : d
        exit !(t[1] > 0.2 && d <= 0.02 * t[1]) }' "$out"/counted?/log
