#!/usr/bin/env python3
"""How long `lamma plan` takes, as a whole process, on household tasks of 6 to 60 objects.

    python3 tests/planner/household.py [--tasks 20] [--lamma-p DIR] [--peer-every 10] [--warm 50]

Tasks are generated from the seed: for `kitchen.pddl` beside this file and, with `--lamma-p`, for the domains
`allactionrobot.pddl` (numbers) and `robot1.pddl` of LaMMA-P in that folder (not shipped). Printed are the median and
the 99th percentile of CPU and wall-clock time, what `/bin/true` and `lamma --version` take alone, and, where Fast
Downward is found (see ipc.py), how many times longer a call of its `lama-first` takes. Every plan is checked by
`lamma validate`.

With `--warm N` the same tasks are also planned N times each inside one process, as a robot plans its packages, and
the median and the 99th percentile of each stage printed (build it first:
`cargo build --release -p lamma-planner --example warm`).
"""

import argparse
import os
import random
import signal
import statistics
import subprocess
import sys
import tempfile
import time

import ipc

# Seconds for one call. On some of these tasks `lama-first` computes landmarks without end.
PATIENCE = 10

SIZES = [6, 12, 20, 30, 40, 50, 60]


def kitchen(rng, size):
    """A problem of `size` objects for kitchen.pddl: things to move, slice and heat, a switch to turn."""
    furniture = ["counter", "fridge", "microwave", "lamp", "table", "cabinet", "sink", "shelf"]
    places = [f"{furniture[n % 8]}{n}" for n in range(max(3, size // 3))]
    items = [f"item{n}" for n in range(max(2, size - len(places) - 1))]
    closable = [p for p in places if p.startswith(("fridge", "microwave", "cabinet"))]
    switchable = [p for p in places if p.startswith(("microwave", "lamp", "sink"))]
    init = [f"(at robot1 {rng.choice(places)})", "(knife item0)"]
    init += [f"(in {i} {rng.choice(places)})" for i in items]
    init += [f"(closable {p})" for p in closable] + [f"(switchable {p})" for p in switchable]
    init += [f"(heats {p})" for p in places if p.startswith("microwave")]
    wanted = rng.sample(items, min(len(items), 3))
    goal = [f"(in {wanted[0]} {rng.choice(places)})", f"(on {rng.choice(switchable)})"]
    goal += [f"(sliced {i})" for i in wanted[1:2] if i != "item0"] + [f"(hot {i})" for i in wanted[2:]]
    return (f"(define (problem p) (:domain kitchen) (:objects robot1 - robot {' '.join(places)} - place "
            f"{' '.join(items)} - item) (:init {' '.join(init)}) (:goal (and {' '.join(goal)})))")


def lamma_p(rng, size):
    """A problem of `size` objects for LaMMA-P's robot1.pddl."""
    objects = [f"object{n}" for n in range(size)]
    init = [f"(at-location {o} {rng.choice(objects[: 1 + size // 3])})" for o in objects]
    moved, sliced, switched, opened = rng.sample(objects, 4)
    goal = [f"(at-location {moved} {opened})", f"(sliced {sliced})", f"(switch-off robot1 {switched})",
            f"(object-open robot1 {opened})"]
    return (f"(define (problem p) (:domain robot1) (:objects robot1 - robot {' '.join(objects)} - object) "
            f"(:init {' '.join(init)}) (:goal (and {' '.join(goal)})))")


def lamma_p_numbers(rng, size):
    """A problem of `size` objects for LaMMA-P's allactionrobot.pddl."""
    objects = ["fridge"] + [f"object{n}" for n in range(size - 1)]
    init = ["(is-fridge fridge)", "(= (fridge-state fridge) 0)", "(not (inaction robot1))"]
    init += [f"(= (fridge-state {o}) 0)" for o in objects[1:]]
    init += [f"(at-location {o} {rng.choice(objects[: 1 + size // 3])})" for o in objects[1:]]
    moved, sliced, switched = rng.sample(objects[1:], 3)
    goal = [f"(at-location {moved} fridge)", f"(sliced {sliced})", f"(switch-off robot1 {switched})"]
    return (f"(define (problem p) (:domain allactionrobot) (:objects robot1 - robot {' '.join(objects)} - object) "
            f"(:init {' '.join(f for f in init if not f.startswith('(not'))}) (:goal (and {' '.join(goal)})))")


def timed(command):
    """CPU and wall-clock seconds and the exit code. Nothing is done between fork and exec, or it would count."""
    null = os.open(os.devnull, os.O_RDWR)
    silence = [(os.POSIX_SPAWN_DUP2, null, descriptor) for descriptor in range(3)]
    start = time.perf_counter()
    pid = os.posix_spawn(command[0], command, os.environ, file_actions=silence, setpgroup=0)
    # A peer is a script that starts others: they end with it.
    signal.signal(signal.SIGALRM, lambda *_: os.killpg(pid, signal.SIGKILL))
    signal.alarm(PATIENCE)
    _, status, usage = os.wait4(pid, 0)
    wall = time.perf_counter() - start
    signal.alarm(0)
    os.close(null)
    return usage.ru_utime + usage.ru_stime, wall, os.waitstatus_to_exitcode(status)


def percentile(values, share):
    return sorted(values)[min(len(values) - 1, int(share * len(values)))]


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--tasks", type=int, default=20, help="tasks for each size")
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--lamma-p", help="a folder with LaMMA-P's domains")
    parser.add_argument("--peer-every", type=int, default=10, help="run the peer on every Nth task only")
    parser.add_argument("--warm", type=int, help="also plan each task so often inside one process")
    parser.add_argument("--lamma", default=os.path.join(ipc.ROOT, "target/release/lamma"))
    options = parser.parse_args()
    lamma = os.path.abspath(options.lamma)
    if not os.path.exists(lamma):
        sys.exit(f"{lamma} is not there: build it with `cargo build --release -p lamma`, or give --lamma")
    downward = ipc.tool("FAST_DOWNWARD", "fast-downward.py")
    if not downward:
        print("fast-downward.py is not installed: no comparison", file=sys.stderr)
    worlds = [("kitchen", os.path.join(ipc.HERE, "kitchen.pddl"), kitchen)]
    if options.lamma_p:
        given = os.path.abspath(options.lamma_p)
        worlds.append(("robot1", os.path.join(given, "robot1.pddl"), lamma_p))
        worlds.append(("allaction", os.path.join(given, "allactionrobot.pddl"), lamma_p_numbers))
    with tempfile.TemporaryDirectory() as folder:
        # Fast Downward leaves its files where it is started.
        os.chdir(folder)
        for command in (["/bin/true"], [lamma, "--version"]):
            cpus, walls = zip(*(timed(command)[:2] for _ in range(100)))
            print(f"`{' '.join(map(os.path.basename, command))}`: "
                  f"CPU {statistics.median(cpus) * 1e3:.2f} ms, p99 {percentile(cpus, 0.99) * 1e3:.2f}; "
                  f"wall {statistics.median(walls) * 1e3:.2f} ms, p99 {percentile(walls, 0.99) * 1e3:.2f}")
        print(f"\n{'domain':9} {'objects':>7} {'tasks':>5} {'CPU p50':>8} {'p99 ms':>7} {'wall p50':>8} {'p99 ms':>7} "
              f"{'lama-first call / ours: CPU':>28} {'wall':>6}")
        for name, domain, world in worlds:
            problems = write_tasks(folder, name, world, options)
            # Ours all in one go: what a peer leaves behind on the machine would be counted as ours.
            own = {task: time_own(lamma, domain, problem, folder) for task, problem in problems.items()}
            for size in SIZES:
                rows = [own[size, number] for number in range(options.tasks)]
                theirs, silent = [], 0
                for number in range(0, options.tasks if downward else 0, options.peer_every):
                    cpu, wall, code = timed([sys.executable, downward, "--plan-file", os.path.join(folder, "theirs"),
                                             "--alias", "lama-first", domain, problems[size, number]])
                    silent += code != 0
                    if code == 0:
                        theirs.append((cpu * 1e3 / max(rows[number][0], 0.1), wall * 1e3 / max(rows[number][1], 0.1)))
                report(name, size, rows, theirs, silent)
            report(name, "all", list(own.values()), [], 0)
            if options.warm:
                warm = os.path.join(os.path.dirname(lamma), "examples/warm")
                told = subprocess.run([warm, str(options.warm), domain, *problems.values()], capture_output=True,
                                      text=True, check=True)
                print(told.stdout, flush=True)


def write_tasks(folder, name, world, options):
    """The files of the tasks, by size and number."""
    problems = {}
    for size in SIZES:
        rng = random.Random(options.seed * 1000 + size)
        for number in range(options.tasks):
            problems[size, number] = os.path.join(folder, f"{name}-{size}-{number}.pddl")
            with open(problems[size, number], "w") as file:
                file.write(world(rng, size))
    return problems


def time_own(lamma, domain, problem, folder):
    """CPU and wall-clock milliseconds of our planner, whose plan has to be valid."""
    plan = os.path.join(folder, "plan")
    cpu, wall, code = timed([lamma, "plan", domain, problem, "--plan-file", plan])
    judged = subprocess.run([lamma, "validate", domain, problem, plan], capture_output=True)
    if code != 0 or judged.returncode != 0:
        sys.exit(f"{os.path.basename(problem)}: no valid plan (exit code {code})")
    return cpu * 1e3, wall * 1e3


def report(name, size, rows, theirs, silent):
    """One line of the table: CPU and wall-clock times in milliseconds, and the peer's times as multiples."""
    (cpus, walls), shares = zip(*rows), ["-", "-"]
    if theirs:
        shares = [f"{ipc.mean(column):.0f}" for column in zip(*theirs)]
    print(f"{name:9} {size:>7} {len(rows):5} {statistics.median(cpus):8.1f} {percentile(cpus, 0.99):7.1f} "
          f"{statistics.median(walls):8.1f} {percentile(walls, 0.99):7.1f} {shares[0]:>28} {shares[1]:>6}"
          f"{f'  no answer in {PATIENCE} s: {silent}' if silent else ''}", flush=True)


if __name__ == "__main__":
    main()
