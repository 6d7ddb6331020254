#!/usr/bin/env python3
"""Asks VAL about our plans and about broken ones, and counts where `lamma validate` says otherwise.

    python3 tests/planner/val.py --val .../Validate [--lamma target/release/lamma]
        [--ipc COLLECTION] [--codmap FOLDER] [--only TEXT] [--per-domain N] [--time-limit 5] [--mutants 8] [--seed 1]
    python3 tests/planner/val.py --val .../Validate --plans OUT/plans --codmap FOLDER [--only TEXT]

VAL is github.com/KCL-Planning/VAL, built with cmake (not shipped). COLLECTION is a checkout of
github.com/aibasel/downward-benchmarks; FOLDER holds a folder a domain with `domain.pddl` and problems beside it.
The tasks in `tests/planner/tasks` are always asked: numbers, axioms, conditional effects, a household.

Of each task the first plan is one question, and so are MUTANTS copies of it with an action dropped, doubled,
swapped with another, or with one argument replaced by another of the plan's. A task that VAL itself cannot read,
or to whose plan it gives no verdict, counts as outside VAL's language. Exit code 1 if there is a disagreement.

With `--plans`, VAL is asked about the teams' plans that `lamma bench --codmap SET --out OUT` has written, and about
nothing else; FOLDER is SET/classical. Exit code 1 if it refuses one.
"""

import argparse
import collections
import glob
import os
import random
import re
import subprocess
import sys
import tempfile

HERE = os.path.dirname(os.path.abspath(__file__))


def arguments():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--val", required=True, help="VAL's Validate")
    parser.add_argument("--lamma", default=os.path.join(HERE, "../../target/release/lamma"))
    parser.add_argument("--ipc", help="a checkout of the competition's tasks")
    parser.add_argument("--codmap", help="a folder of domain folders")
    parser.add_argument("--plans", help="a folder of plans, DOMAIN/PROBLEM.plan, of the --codmap tasks")
    parser.add_argument("--only", default="", help="only tasks whose path contains this")
    parser.add_argument("--per-domain", type=int, default=1, help="how many tasks of each domain")
    parser.add_argument("--time-limit", type=float, default=5.0, help="seconds for each plan")
    parser.add_argument("--mutants", type=int, default=8, help="broken copies of each plan")
    parser.add_argument("--seed", type=int, default=1)
    return parser.parse_args()


def natural(name):
    return [int(part) if part.isdigit() else part for part in re.split(r"(\d+)", name)]


def domain_of(problem):
    """The domain file of a problem, as the collections lay them out; none for a domain file."""
    folder, name = os.path.split(problem)
    if "domain" in name:
        return None
    stem = os.path.splitext(name)[0]
    number = re.match(r"p\d+", stem)
    candidates = ["domain.pddl", f"{stem}-domain.pddl", f"domain-{name}", f"domain_{stem}.pddl"]
    if number:
        candidates.append(f"{number.group()}-domain.pddl")
    for candidate in candidates:
        path = os.path.join(folder, candidate)
        if os.path.exists(path):
            return path
    return None


def tasks(options):
    found = [(os.path.join(folder, "domain.pddl"), problem)
             for folder in sorted(glob.glob(os.path.join(HERE, "tasks/*")))
             for problem in sorted(glob.glob(os.path.join(folder, "p*.pddl")))]
    for root in filter(None, [options.codmap, options.ipc]):
        for folder in sorted(glob.glob(os.path.join(root, "*/"))):
            problems = sorted(glob.glob(os.path.join(folder, "*.pddl")), key=natural)
            pairs = [(domain_of(problem), problem) for problem in problems]
            found += [pair for pair in pairs if pair[0]][:options.per_domain]
    return [pair for pair in found if options.only in pair[1]]


def lamma_accepts(options, domain, problem, plan):
    done = subprocess.run([options.lamma, "validate", domain, problem, plan], capture_output=True, text=True)
    return {0: True, 1: False}.get(done.returncode), (done.stdout + done.stderr).strip()


def val_accepts(options, domain, problem, plan):
    try:
        done = subprocess.run([options.val, domain, problem, plan], capture_output=True, text=True, timeout=120)
    except subprocess.TimeoutExpired:
        return None, "no verdict in 120 s"
    said = done.stdout + done.stderr
    if "Plan valid" in said:
        return True, said
    # A plan that names what is not there is a bad one, too.
    for refusal in ["Plan failed", "Plan invalid", "Goal not satisfied", "Bad operator", "Bad plan"]:
        if refusal in said:
            return False, said
    return None, said


def mutant(rng, plan):
    plan = [list(act) for act in plan]
    kind = rng.choice(["drop", "double", "swap", "argument", "argument"])
    at = rng.randrange(len(plan))
    if kind == "drop":
        del plan[at]
    elif kind == "double":
        plan.insert(at, plan[at])
    elif kind == "swap":
        other = rng.randrange(len(plan))
        plan[at], plan[other] = plan[other], plan[at]
    else:
        objects = sorted({arg for act in plan for arg in act[1:]})
        if len(plan[at]) > 1 and objects:
            plan[at][rng.randrange(1, len(plan[at]))] = rng.choice(objects)
    return kind, plan


def write(path, plan):
    with open(path, "w", encoding="utf-8") as file:
        file.writelines("(" + " ".join(act) + ")\n" for act in plan)


def ask_about_plans(options):
    valid = refused = 0
    for plan in sorted(glob.glob(os.path.join(options.plans, "*/*.plan"))):
        folder, name = os.path.split(plan)
        task = os.path.join(options.codmap, os.path.basename(folder))
        problem = os.path.join(task, os.path.splitext(name)[0] + ".pddl")
        if options.only not in plan:
            continue
        accepted, said = val_accepts(options, os.path.join(task, "domain.pddl"), problem, plan)
        valid += accepted is True
        refused += accepted is not True
        if accepted is not True:
            print(f"{plan}: {' '.join(said.split())[:200]}", flush=True)
    print(f"VAL accepts {valid} of {valid + refused} plans")
    return 1 if refused else 0


def main():
    options = arguments()
    if options.plans:
        return ask_about_plans(options)
    rng = random.Random(options.seed)
    counts = collections.Counter()
    disagreements = []
    with tempfile.TemporaryDirectory() as scratch:
        file = os.path.join(scratch, "plan")
        for domain, problem in tasks(options):
            name = os.path.relpath(problem, os.path.dirname(os.path.dirname(problem)))
            counts["tasks"] += 1
            planned = subprocess.run(
                [options.lamma, "plan", domain, problem, "--time-limit", str(options.time_limit), "--memory-limit",
                 "2048", "--plan-file", file], capture_output=True, text=True)
            if planned.returncode != 0:
                counts[f"without a plan (exit {planned.returncode})"] += 1
                continue
            with open(file, encoding="utf-8") as lines:
                plan = [line.strip("() \n").split() for line in lines if not line.startswith(";")]
            if not plan:
                counts["empty plans"] += 1
                continue
            questions = [("plan", plan)] + [mutant(rng, plan) for _ in range(options.mutants)]
            for kind, question in questions:
                write(file, question)
                val, said = val_accepts(options, domain, problem, file)
                if val is None:
                    counts["outside VAL's language"] += 1
                    print(f"{name}: VAL has no verdict: {' '.join(said.split())[:140]}", flush=True)
                    break
                ours, text = lamma_accepts(options, domain, problem, file)
                group = "plans" if kind == "plan" else "mutants"
                counts[f"{group} asked"] += 1
                counts[f"{group} that VAL accepts"] += val
                counts[f"{group} agreed on"] += val == ours
                if val != ours:
                    disagreements.append((name, kind))
                    kept = os.path.join(tempfile.gettempdir(), f"disagreement-{len(disagreements)}.plan")
                    write(kept, question)
                    print(f"{name}, {kind}: VAL {val}, lamma {ours}: {text[:200]} ({kept})", flush=True)
    for key in sorted(counts):
        print(f"{counts[key]:6}  {key}")
    print(f"{len(disagreements):6}  disagreements")
    return 1 if disagreements else 0


if __name__ == "__main__":
    sys.exit(main())
