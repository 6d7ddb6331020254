#!/usr/bin/env python3
"""Runs planners over the planning competition's tasks and prints how they compare.

    python3 tests/planner/ipc.py COLLECTION [--suite satisficing|optimal] [--time-limit 30] [--only TEXT] [--rows FILE]

COLLECTION is a checkout of github.com/aibasel/downward-benchmarks (not shipped here). The instances come from
`satisficing.txt` or `optimal.txt` beside this file; `--list-rule` prints the suite's list anew from the collection, by the rule
that its head states.

Peers are used where they are found, and named where not:
  lama-first, lmcut   Fast Downward: `fast-downward.py` on the PATH, or the path in $FAST_DOWNWARD
                      (`pip install up-fast-downward` has it in up_fast_downward/downward/)
  kairos              on the PATH or in $KAIROS (`pip install up-kairos`)
  ferroplan           `ff` on the PATH or in $FERROPLAN (`cargo install ferroplan-cli`)

Every planner gets one instance after the other, each in a folder of its own, with the same limits: CPU seconds
of the whole process tree and address space. A plan counts only if `lamma validate` accepts it; its cost is the
one the validator works out. Compared are CPU times (user and system, everything from process start on), so
other work on the machine matters little.

With `--rows` results are kept: what the file says of a planner of the same content on the same machine is not
run again, as far as it answers. A plan found within the limit answers, and so does a failure that came before its
limit or under one that was no lower. So a first round with `--time-limit 3` is not lost for the one with 30, and a change of our own planner costs
no run of its peers.
"""

import argparse
import csv
import glob
import hashlib
import json
import math
import os
import platform
import re
import resource
import shutil
import signal
import subprocess
import sys
import tempfile
import time

HERE = os.path.dirname(os.path.abspath(__file__))
ROOT = os.path.dirname(os.path.dirname(HERE))


# --- the collection ------------------------------------------------------------------------------------------

def domain_of(problem):
    """The domain file of a problem, by the collection's naming habits; None if there is none."""
    folder, name = os.path.split(problem)
    stem = os.path.splitext(name)[0]
    habits = ["domain.pddl", f"{stem}-domain.pddl", f"{stem[:3]}-domain.pddl", f"domain_{name}", f"domain-{name}"]
    found = (os.path.join(folder, habit) for habit in habits)
    return next((path for path in found if os.path.exists(path)), None)


def natural(text):
    """A key that sorts p2 before p10."""
    return [int(part) if part.isdigit() else part for part in re.split(r"(\d+)", text)]


# Where in a domain's problems the instances of a suite stand, from the first (0) to the last (1).
PLACES = {"satisficing": [1 / 6, 3 / 6, 5 / 6], "optimal": [1 / 12, 3 / 12]}


def list_rule(collection, suite):
    """Prints the instances of a suite; the rule is in the text it starts with."""
    sys.path.insert(0, collection)
    import suites  # The collection's own lists of domains.

    families = {}
    for domain in suites.suite_satisficing() if suite == "satisficing" else suites.suite_optimal():
        family = re.sub(r"-(sat|opt|agl|mco)?\d\d(?=-|$)", "", domain)
        family = re.sub(r"-(strips|adl)$", "", family)
        families.setdefault(family, []).append(domain)

    def age(domain):
        year = re.search(r"-(?:sat|opt|agl|mco)?(\d\d)(?=-|$)", domain)
        return (int(year.group(1)) if year else 0, domain)

    parts = ", ".join(f"{place:.2f}" for place in PLACES[suite])
    print(f"# {len(PLACES[suite])} instances of every domain family of the collection's `suite_{suite}`: of the family's newest")
    print(f"# version the problems in natural order, those at {parts} of their number.")
    for family in sorted(families):
        newest = max(families[family], key=age)
        problems = [p for p in glob.glob(f"{collection}/{newest}/*.pddl") if "domain" not in os.path.basename(p)]
        problems = sorted((p for p in problems if domain_of(p)), key=natural)
        for place in PLACES[suite]:
            print(os.path.relpath(problems[int(place * len(problems) + 1e-9)], collection))


# --- the planners --------------------------------------------------------------------------------------------

def tool(variable, name):
    """A program from an environment variable or the PATH."""
    return os.environ.get(variable) or shutil.which(name)


def planners(suite, lamma):
    """Name and command of every planner of a suite; the command is None where the planner is absent.
    `{seconds}`, `{mib}`, `{domain}`, `{problem}` and `{plan}` are filled in."""
    driver = tool("FAST_DOWNWARD", "fast-downward.py")
    downward = driver and [sys.executable, driver, "--plan-file", "{plan}"]
    own = [lamma, "plan", "{domain}", "{problem}", "--plan-file", "{plan}", "--memory-limit", "{mib}"]
    if suite == "optimal":
        yield "lamma", own + ["--search", "astar-lmcut"]
        yield "lmcut", downward and downward + ["{domain}", "{problem}", "--search", "astar(lmcut())"]
        return
    kairos, ferroplan = tool("KAIROS", "kairos"), tool("FERROPLAN", "ff")
    yield "lamma", own
    yield "lama-first", downward and downward + ["--alias", "lama-first", "{domain}", "{problem}"]
    # kairos divides the time it is told; always told the same, it finds a plan at the same point under any limit.
    yield "kairos", kairos and [kairos, "{domain}", "{problem}", "--no-anytime", "--threads", "1",
                               "--timeout", "30", "--memory", "{mib}"]
    yield "ferroplan", ferroplan and [ferroplan, "-o", "{domain}", "-f", "{problem}", "--json", "--threads", "1"]


def run(command, folder, seconds, mib):
    """Runs a command; its exit status, CPU seconds (children included), peak memory in MiB and output."""
    def limits():
        resource.setrlimit(resource.RLIMIT_AS, (mib << 20, mib << 20))
        cpu = math.ceil(seconds)
        resource.setrlimit(resource.RLIMIT_CPU, (cpu, cpu + 1))
        resource.setrlimit(resource.RLIMIT_CORE, (0, 0))

    with open(os.path.join(folder, "stdout"), "wb") as out, open(os.path.join(folder, "stderr"), "wb") as err:
        process = subprocess.Popen(command, cwd=folder, stdin=subprocess.DEVNULL, stdout=out, stderr=err,
                                   preexec_fn=limits, start_new_session=True)
        # On a machine with other work a process gets (much) less than a second of CPU in a second.
        end = time.monotonic() + 100 * seconds + 60
        pause = 0.0005
        while True:
            pid, status, usage = os.wait4(process.pid, os.WNOHANG)
            if pid:
                break
            if time.monotonic() > end:
                os.killpg(process.pid, signal.SIGKILL)
                _, status, usage = os.wait4(process.pid, 0)
                break
            time.sleep(pause)
            pause = min(pause * 1.5, 0.05)
        process.returncode = status
    try:
        os.killpg(process.pid, signal.SIGKILL)
    except ProcessLookupError:
        pass
    with open(os.path.join(folder, "stdout"), errors="replace") as out:
        text = out.read(64 << 20)
    return os.waitstatus_to_exitcode(status), usage.ru_utime + usage.ru_stime, usage.ru_maxrss // 1024, text


def plan_lines(folder, text):
    """The plan a planner left: in its plan file, in a JSON object, or among the lines it printed."""
    files = sorted(glob.glob(os.path.join(folder, "plan*")), key=natural)
    if files:
        with open(files[-1], errors="replace") as plan:
            text = plan.read()
    else:
        try:
            steps = json.loads(text).get("plan") or []
            steps = steps.get("steps", []) if isinstance(steps, dict) else steps
            named = [s if isinstance(s, str) else " ".join([s.get("action", s.get("name")), *s.get("args", [])])
                     for s in steps]
            text = "\n".join(named)
            text = "\n".join(line if line.startswith("(") else f"({line})" for line in text.splitlines())
        except (ValueError, AttributeError, TypeError):
            pass
    lines = (re.match(r"\s*(?:[\d.]+:\s*)?(\([^()]*\))", line) for line in text.splitlines())
    return [match.group(1).lower() for match in lines if match]


def attempt(command, lamma, domain, problem, options):
    """One planner on one instance, as a row of results."""
    with tempfile.TemporaryDirectory() as folder:
        plan = os.path.join(folder, "plan")
        fields = dict(domain=domain, problem=problem, plan=plan, seconds=options.time_limit, mib=options.memory_limit)
        code, cpu, peak, text = run([part.format(**fields) for part in command], folder, options.time_limit,
                                    options.memory_limit)
        row = dict(status="", cpu=round(cpu, 4), mib=peak, exit=code, cost="")
        steps = plan_lines(folder, text)
        if cpu > options.time_limit * 1.02:
            return row | dict(status="time")
        if not steps and not (code == 0 and os.path.exists(plan)):
            with open(os.path.join(folder, "stderr"), errors="replace") as err:
                said = (err.read().strip() or text.strip()).splitlines()
            return row | dict(status="none", said=said[-1][:100] if said else "")
        with open(plan, "w") as file:
            file.write("\n".join(steps) + "\n")
        judged = subprocess.run([lamma, "validate", domain, problem, plan], capture_output=True, text=True)
        cost = re.search(r"cost\D*([\d.]+)", judged.stdout)
        if judged.returncode != 0:
            return row | dict(status="invalid", said=(judged.stdout + judged.stderr).strip()[-100:])
        return row | dict(status="solved", cost=float(cost.group(1)) if cost else float(len(steps)))


# --- results that are kept --------------------------------------------------------------------------------------

KEYS = ["problem", "planner", "status", "cost", "cpu", "mib", "exit", "said", "limit", "memory", "content", "machine"]


def content_of(command):
    """What tells a planner from its other versions: a hash over the program (of Fast Downward: the search)."""
    program = next(part for part in command if os.path.basename(part) != os.path.basename(sys.executable))
    search = os.path.join(os.path.dirname(program), "builds/release/bin/downward")
    digest = hashlib.sha256()
    for path in (program, search):
        if os.path.exists(path):
            with open(path, "rb") as file:
                digest.update(file.read())
    return digest.hexdigest()[:12]


class Rows:
    """The rows of a file, if one is given, and those that come."""

    def __init__(self, path, options):
        self.path, self.options, self.known = path, options, {}
        self.machine = f"{platform.node()} {platform.machine()} {os.cpu_count()}"
        if path and os.path.exists(path):
            with open(path, newline="") as file:
                for row in csv.DictReader(file):
                    number = dict(cpu=float(row["cpu"]), limit=float(row["limit"]), memory=int(row["memory"]))
                    number["cost"] = float(row["cost"]) if row["cost"] else ""
                    row = row | number | dict(mib=int(row["mib"]))
                    self.known.setdefault((row["problem"], row["planner"], row["content"]), []).append(row)

    def answer(self, problem, planner, content):
        """What is known already under these limits, or nothing."""
        for row in reversed(self.known.get((problem, planner, content), [])):
            if row["machine"] != self.machine or row["memory"] != self.options.memory_limit:
                continue
            if row["status"] == "solved" and row["cpu"] <= self.options.time_limit:
                return row
            short = row["cpu"] < 0.9 * row["limit"]
            # Killed before its time was up: the machine was too busy.
            if short and int(row["exit"]) == -signal.SIGKILL:
                continue
            if row["limit"] >= self.options.time_limit or short:
                return row if row["cpu"] <= self.options.time_limit else row | dict(status="time", cost="")
        return None

    def add(self, row):
        """Keeps a new row."""
        row.update(limit=self.options.time_limit, memory=self.options.memory_limit, machine=self.machine)
        if self.path:
            new = not os.path.exists(self.path)
            with open(self.path, "a", newline="") as file:
                writer = csv.DictWriter(file, KEYS)
                if new:
                    writer.writeheader()
                writer.writerow(row)


# --- the report ----------------------------------------------------------------------------------------------

def mean(ratios):
    """The geometric mean."""
    return math.exp(sum(map(math.log, ratios)) / len(ratios)) if ratios else float("nan")


def report(rows, names):
    """Prints coverage, and every peer against the first planner on the instances that both solve."""
    by = {name: {r["problem"]: r for r in rows if r["planner"] == name} for name in names}
    count = len({r["problem"] for r in rows})
    print(f"\n{count} instances of {len({os.path.dirname(r['problem']) for r in rows})} domains\n")
    print(f"{'planner':12} {'solved':>6} {'wrong':>5} | {'both':>5} {'CPU ours/theirs':>15} {'cost ours/theirs':>16} {'cheaper':>7} {'dearer':>6}")
    own = by[names[0]]
    for name in names:
        solved = {p for p, r in by[name].items() if r["status"] == "solved"}
        line = f"{name:12} {len(solved):6} {sum(r['status'] == 'invalid' for r in by[name].values()):5}"
        if name != names[0]:
            both = sorted(p for p in solved if p in own and own[p]["status"] == "solved")
            ratio = mean([max(own[p]["cpu"], 1e-4) / max(by[name][p]["cpu"], 1e-4) for p in both])
            ours, theirs = (sum(side[p]["cost"] for p in both) for side in (own, by[name]))
            costs = ours / theirs if theirs else float("nan")
            cheaper = sum(own[p]["cost"] < by[name][p]["cost"] for p in both)
            dearer = sum(own[p]["cost"] > by[name][p]["cost"] for p in both)
            line += f" | {len(both):5} {ratio:15.3f} {costs:16.3f} {cheaper:7} {dearer:6}"
        print(line)
    for name in names[1:]:
        only = sorted((p for p, r in by[name].items()
                       if r["status"] == "solved" and p in own and own[p]["status"] != "solved"), key=natural)
        if only:
            print(f"\nsolved by {name} and not by {names[0]}: {' '.join(only)}")


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("collection", help="a checkout of aibasel/downward-benchmarks")
    parser.add_argument("--suite", choices=["satisficing", "optimal"], default="satisficing")
    parser.add_argument("--list", help="a file of problems instead of the suite's own")
    parser.add_argument("--list-rule", action="store_true", help="print the suite's list and stop")
    parser.add_argument("--time-limit", type=float, default=30, help="CPU seconds for each run")
    parser.add_argument("--memory-limit", type=int, default=2048, help="MiB of address space")
    parser.add_argument("--only", default="", help="only problems whose path contains this")
    parser.add_argument("--every", type=int, default=1, help="only every Nth problem of the list")
    parser.add_argument("--planners", help="only these, by name, comma-separated")
    parser.add_argument("--lamma", default=os.path.join(ROOT, "target/release/lamma"))
    parser.add_argument("--rows", help="a CSV file that keeps the results, read first and added to as they come")
    parser.add_argument("--known", action="store_true", help="report what --rows knows, run nothing")
    options = parser.parse_args()
    collection = os.path.abspath(options.collection)
    if options.list_rule:
        return list_rule(collection, options.suite)
    if not os.path.exists(options.lamma):
        sys.exit(f"{options.lamma} is not there: build it with `cargo build --release -p lamma`, or give --lamma")
    lamma = os.path.abspath(options.lamma)
    chosen = []
    for name, command in planners(options.suite, lamma):
        if options.planners and name not in options.planners.split(","):
            continue
        if command is None:
            print(f"{name} is not installed: left out", file=sys.stderr)
            continue
        chosen.append((name, command))
    with open(options.list or os.path.join(HERE, f"{options.suite}.txt")) as file:
        problems = [line.strip() for line in file if line.strip() and not line.startswith("#")]
    problems = [p for p in problems if options.only in p][:: options.every]
    # The first of every domain, then the second: an early end has seen all domains.
    seen = {}
    turn = [seen.setdefault(os.path.dirname(p), []).append(p) or len(seen[os.path.dirname(p)]) for p in problems]
    problems = [p for _, p in sorted(zip(turn, problems), key=lambda pair: pair[0])]
    kept = Rows(options.rows, options)
    contents = {name: content_of(command) for name, command in chosen}
    rows = []
    for problem in problems:
        path = os.path.join(collection, problem)
        domain = domain_of(path)
        if domain is None or not os.path.exists(path):
            print(f"{problem}: not in this collection", file=sys.stderr)
            continue
        line = []
        for name, command in chosen:
            row = kept.answer(problem, name, contents[name])
            if row is None and options.known:
                continue
            if row is None:
                row = dict(problem=problem, planner=name, content=contents[name])
                row |= attempt(command, lamma, domain, path, options)
                kept.add(row)
                result = f"{row['cost']:g}" if row["status"] == "solved" else row["status"]
                line.append(f"{name} {result} {row['cpu']:.3f}s {row['mib']}M {row.get('said', '')}")
            rows.append(row)
        if line:
            print(f"{problem}: {' · '.join(line)}", file=sys.stderr, flush=True)
    if rows:
        report(rows, [name for name, _ in chosen])


if __name__ == "__main__":
    main()
