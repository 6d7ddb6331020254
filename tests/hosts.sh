#!/usr/bin/env bash
# Three hosts on one machine: three network namespaces joined by veth to a bridge in the first, a Zenoh router
# there, the team spread over all three. The same task as on one host, then again with a link cut for five seconds
# in the middle. Prints outcome, makespan and time of each; fails if an outcome differs.
#
#   tests/hosts.sh [LAMMA]        LAMMA is the binary, target/release/lamma by default
#
# Needs `ip` (iproute2) and either root or unprivileged user namespaces.
set -euo pipefail

lamma=$(realpath "${1:-target/release/lamma}")
if [ "$(id -u)" != 0 ] && [ -z "${LAMMA_UNSHARED:-}" ]; then
    LAMMA_UNSHARED=1 exec unshare --map-root-user --net --mount --fork "$0" "$lamma"
fi
if [ -n "${LAMMA_UNSHARED:-}" ]; then
    # `ip netns` keeps its names in /run, which is somebody else's here.
    mount -t tmpfs tmpfs /run
fi

task="Put the tomato and the lettuce in the fridge, then switch off the light"
team=robot1,robot17,robot24
work=$(mktemp -d)
hub=lamma-$$-hub west=lamma-$$-west east=lamma-$$-east
pids=()

finish() {
    for pid in "${pids[@]}"; do kill "$pid" 2>/dev/null || true; done
    wait 2>/dev/null || true
    for ns in $hub $west $east; do ip netns del "$ns" 2>/dev/null || true; done
    rm -rf "$work"
}
trap finish EXIT

# ---- the network
for ns in $hub $west $east; do ip netns add "$ns" && ip -n "$ns" link set lo up; done
ip -n "$hub" link add br0 type bridge
ip -n "$hub" addr add 10.77.0.1/24 dev br0
ip -n "$hub" link set br0 up
host=2
for ns in $west $east; do
    ip -n "$ns" link add eth0 type veth peer name "port$host" netns "$hub"
    ip -n "$hub" link set "port$host" master br0 up
    ip -n "$ns" addr add "10.77.0.$host/24" dev eth0
    ip -n "$ns" link set eth0 up
    host=$((host + 1))
done

now() { date +%s%3N; }
field() { sed -n "s/.*\"$2\": *\"\{0,1\}\([^\",}]*\).*/\1/p" "$1" | head -1; }
in_ns() { # namespace, log, arguments of lamma
    local ns=$1 log=$2
    shift 2
    ip netns exec "$ns" "$lamma" "$@" >"$log" 2>&1 &
    pids+=($!)
}

# ---- the same task on one host
start=$(now)
"$lamma" run "$task" --scene FloorPlan6 --team $team --bus zenoh --step-ms 300 --run-dir "$work/one" \
    >"$work/one.log" 2>&1 || { cat "$work/one.log"; exit 1; }
one=$(field "$work/one/result.json" outcome) makespan=$(field "$work/one/result.json" makespan)
printf '%-34s %-16s makespan %-5s %6d ms\n' "one host" "$one" "$makespan" $(($(now) - start))

# ---- on three
in_ns "$hub" "$work/router.log" router --listen tcp/10.77.0.1:7447
run_hosts() { # name, seconds of the cut
    local name=$1 cut=$2 run=$work/$1 own=()
    "$lamma" prepare "$task" --scene FloorPlan6 --team $team --run-dir "$run" --step-ms 300 --stall-limit 20 \
        >"$work/$name.log"
    local join=(--bus zenoh --connect tcp/10.77.0.1:7447 --run-dir "$run")
    local start
    start=$(now)
    in_ns "$west" "$run/simulator.log" simulator "${join[@]}"
    in_ns "$west" "$run/robot0.log" robot "${join[@]}" --agent 0
    in_ns "$east" "$run/robot1.log" robot "${join[@]}" --agent 1
    in_ns "$east" "$run/robot2.log" robot "${join[@]}" --agent 2
    own=("${pids[@]: -4}")
    in_ns "$hub" "$run/coordinator.log" coordinator "${join[@]}" --lost-after 30
    local coordinator=${pids[-1]}
    if [ "$cut" -gt 0 ]; then
        # In the middle: the first steps are done, others are to come.
        until grep -q '\[ *2/' "$run/coordinator.log" 2>/dev/null; do
            kill -0 "$coordinator" 2>/dev/null || break
            sleep 0.05
        done
        ip -n "$east" link set eth0 down
        sleep "$cut"
        ip -n "$east" link set eth0 up
    fi
    local code=0
    wait "$coordinator" || code=$?
    local time=$(($(now) - start)) outcome steps left=0
    outcome=$(field "$run/result.json" outcome)
    steps=$(field "$run/result.json" makespan)
    for pid in "${own[@]}"; do
        for _ in $(seq 100); do kill -0 "$pid" 2>/dev/null || break; sleep 0.1; done
        kill -0 "$pid" 2>/dev/null && left=$((left + 1))
    done
    printf '%-34s %-16s makespan %-5s %6d ms   %d processes left\n' "$name" "$outcome" "$steps" "$time" "$left"
    if [ "$outcome" != "$one" ] || [ "$code" != 0 ] || [ "$left" != 0 ]; then
        tail -n 20 "$run"/*.log "$work/router.log"
        exit 1
    fi
}
run_hosts three-hosts 0
run_hosts three-hosts-link-cut-for-5-s 5
