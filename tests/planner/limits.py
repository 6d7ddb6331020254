#!/usr/bin/env python3
"""Whether `lamma plan` keeps its limits of time and memory, from outside: as a whole process, on tasks too hard for them.

    python3 tests/planner/limits.py COLLECTION [--seconds 3,10] [--mib 256,1024]

COLLECTION is a checkout of github.com/aibasel/downward-benchmarks (not shipped). Printed is, for each task and limit,
how long the process took or the most memory it had, and how much above the limit that is. Tasks that end before the
limit say nothing and are named. Exit code 1 if a limit is overrun by more than 5 %.
"""

import argparse
import os
import subprocess
import sys
import time

import ipc

# Large tasks of different kinds: long grounding, long search, many axioms, large states.
TASKS = [
    ("satellite/domain.pddl", "satellite/p36-HC-pfile16.pddl"),
    ("sokoban-sat11-strips/domain.pddl", "sokoban-sat11-strips/p20.pddl"),
    ("pipesworld-tankage/domain.pddl", "pipesworld-tankage/p50-net5-b30-g8-t50.pddl"),
    ("psr-large/domain.pddl", "psr-large/p50-s219-n100-l3-f30.pddl"),
    ("visitall-sat14-strips/domain.pddl", "visitall-sat14-strips/pfile65.pddl"),
    ("tetris-sat14-strips/domain.pddl", "tetris-sat14-strips/p040.pddl"),
    ("organic-synthesis-sat18-strips/domain-p20.pddl", "organic-synthesis-sat18-strips/p20.pddl"),
]
TOLERANCE = 0.05


def measure(command):
    """Seconds, most MiB, and the exit code of a command."""
    start = time.monotonic()
    process = subprocess.Popen(command, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
    _, status, usage = os.wait4(process.pid, 0)
    return time.monotonic() - start, usage.ru_maxrss / 1024, os.waitstatus_to_exitcode(status)


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("collection")
    parser.add_argument("--seconds", default="3,10")
    parser.add_argument("--mib", default="256,1024")
    parser.add_argument("--only", default="", help="only tasks whose path contains this")
    parser.add_argument("--lamma", default=os.path.join(ipc.ROOT, "target/release/lamma"))
    options = parser.parse_args()
    worst = {}
    for domain, problem in TASKS:
        files = [os.path.join(options.collection, name) for name in (domain, problem)]
        if options.only not in problem or not all(map(os.path.exists, files)):
            print(f"{problem}: not here")
            continue
        # Better and better plans are sought until a limit ends it; the other limit is far away.
        command = [options.lamma, "plan", *files, "--search", "anytime"]
        limits = [("s", float(s), ["--time-limit", s, "--memory-limit", "16384"]) for s in options.seconds.split(",")]
        limits += [("MiB", float(m), ["--memory-limit", m, "--time-limit", "120"]) for m in options.mib.split(",")]
        for unit, limit, flags in limits:
            seconds, mib, code = measure(command + flags)
            used = seconds if unit == "s" else mib
            over = used / limit - 1
            if used < 0.9 * limit:
                print(f"{problem}: {used:.1f} of {limit:g} {unit}: the limit was not reached (exit code {code})", flush=True)
                continue
            worst[unit] = max(worst.get(unit, -1.0), over)
            print(f"{problem}: {used:.2f} of {limit:g} {unit}, {over:+.1%} (exit code {code})", flush=True)
    print("worst: " + ", ".join(f"{over:+.1%} of the limit in {unit}" for unit, over in worst.items()))
    return 1 if any(over > TOLERANCE for over in worst.values()) else 0


if __name__ == "__main__":
    sys.exit(main())
