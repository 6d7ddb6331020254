//! The shortest schedule against brute force.
//!
//! What counts is what the partial order says: all valid linear plans of a few actions are deordered, and the
//! least makespan among them is one that no bound may exceed. What the scheduler finds is deordered, too, and
//! must be as short as it says. `LAMMA_CASES=1000 cargo test -p lamma-planner --test makespan` for more tasks.

#![allow(clippy::unwrap_used, reason = "a test that cannot go on says so by panicking")]

use std::collections::BTreeSet;
use std::sync::Arc;
use std::sync::atomic::AtomicBool;

use lamma_pddl::ast::{Condition, Domain, GroundAtom, Init, Problem, TypedName};
use lamma_pddl::{Name, Source, parse_condition, parse_domain};
use lamma_planner::partial_order::{TeamStep, deorder, deorder_with};
use lamma_planner::{
    FactId, GroundAct, GroundCondition, GroundLimits, Interpreter, Literal, MakespanLimits, Milestone, Need,
    OperatorId, Plan, Scheduler, Task, WorldState, ground,
};
use proptest::prelude::*;

const DOMAIN: &str = "(define (domain flat)
  (:requirements :typing :negative-preconditions :conditional-effects :disjunctive-preconditions)
  (:types robot thing place)
  (:predicates (at ?r - robot ?p - place) (in ?x - thing ?p - place) (holding ?r - robot ?x - thing)
    (free ?r - robot) (open ?p - place) (lit ?p - place) (seen ?x - thing) (road ?p ?q - place) (powered)
    (can-open ?r - robot) (near ?r - robot ?x - thing))
  (:action go :parameters (?r - robot ?p - place) :precondition ()
    :effect (and (forall (?q - place) (not (at ?r ?q))) (at ?r ?p)
      (forall (?y - thing) (not (near ?r ?y)))
      (forall (?y - thing) (when (in ?y ?p) (near ?r ?y)))))
  (:action go-to-thing :parameters (?r - robot ?x - thing) :precondition ()
    :effect (and (forall (?q - place) (not (at ?r ?q)))
      (forall (?y - thing) (not (near ?r ?y))) (near ?r ?x)
      (forall (?p - place) (when (in ?x ?p) (at ?r ?p)))))
  (:action open :parameters (?r - robot ?p - place)
    :precondition (and (can-open ?r) (at ?r ?p) (not (open ?p))) :effect (open ?p))
  (:action close :parameters (?r - robot ?p - place)
    :precondition (and (at ?r ?p) (open ?p)) :effect (not (open ?p)))
  (:action pick :parameters (?r - robot ?x - thing ?p - place)
    :precondition (and (near ?r ?x) (at ?r ?p) (in ?x ?p) (free ?r) (open ?p))
    :effect (and (holding ?r ?x) (not (free ?r)) (not (in ?x ?p)) (not (seen ?x))
      (forall (?a - robot) (not (near ?a ?x)))))
  (:action put :parameters (?r - robot ?x - thing ?p - place)
    :precondition (and (at ?r ?p) (holding ?r ?x) (open ?p))
    :effect (and (in ?x ?p) (free ?r) (not (holding ?r ?x)) (near ?r ?x) (when (lit ?p) (seen ?x))))
  (:action power :parameters (?r - robot) :precondition ()
    :effect (and (when (powered) (not (powered))) (when (not (powered)) (powered))))
  (:action light :parameters (?r - robot ?p - place)
    :precondition (and (at ?r ?p) (or (powered) (open ?p)))
    :effect (and (lit ?p) (forall (?x - thing) (when (in ?x ?p) (seen ?x))))))";

const ROBOTS: [&str; 2] = ["r1", "r2"];
const THINGS: [&str; 2] = ["x", "y"];
const PLACES: [&str; 2] = ["a", "b"];

struct World {
    problem: Problem,
    interpreter: Interpreter,
    initial: WorldState,
    acts: Vec<(usize, GroundAct)>,
}

const GOALS: [&str; 14] = [
    "(in x b)",
    "(in y a)",
    "(lit a)",
    "(lit b)",
    "(seen x)",
    "(seen y)",
    "(open b)",
    "(not (open a))",
    "(powered)",
    "(holding r1 x)",
    "(holding r2 y)",
    "(at r2 a)",
    "(near r1 y)",
    "(or (seen x) (in x a))",
];

fn typed(names: &[&str], of: &str) -> Vec<TypedName> {
    names.iter().map(|n| TypedName::new(*n, of)).collect()
}

/// A start drawn by `bits`.
fn world(bits: u32, goal: Condition) -> World {
    let domain = parse_domain(&Source::new("flat.pddl", DOMAIN)).unwrap().value;
    let objects = [typed(&ROBOTS, "robot"), typed(&THINGS, "thing"), typed(&PLACES, "place")].concat();
    let interpreter = Interpreter::new(&domain, &objects).unwrap();
    let bit = |at: u32| bits >> at & 1 == 1;
    let place = |at: u32| PLACES[usize::from(bit(at))];
    let mut facts = vec![
        GroundAtom::new("in", ["x", place(0)]),
        GroundAtom::new("in", ["y", place(1)]),
        GroundAtom::new("at", ["r1", place(2)]),
        GroundAtom::new("at", ["r2", place(3)]),
        GroundAtom::new("free", ["r1"]),
        GroundAtom::new("free", ["r2"]),
    ];
    let maybe = [
        (4, GroundAtom::new("open", ["a"])),
        (5, GroundAtom::new("open", ["b"])),
        (6, GroundAtom::new("powered", [""; 0])),
        (7, GroundAtom::new("can-open", ["r1"])),
        (8, GroundAtom::new("can-open", ["r2"])),
        (9, GroundAtom::new("lit", ["a"])),
    ];
    facts.extend(maybe.into_iter().filter(|(at, _)| bit(*at)).map(|(_, fact)| fact));
    let init: Vec<Init> = facts.into_iter().map(Init::Fact).collect();
    let initial = interpreter.initial(&init).unwrap();
    let mut acts = Vec::new();
    for (agent, r) in ROBOTS.iter().enumerate() {
        acts.push((agent, GroundAct::new("power", [*r])));
        acts.extend(THINGS.map(|x| (agent, GroundAct::new("go-to-thing", [*r, x]))));
        for p in PLACES {
            acts.extend(["go", "open", "close", "light"].map(|a| (agent, GroundAct::new(a, [*r, p]))));
            acts.extend(THINGS.map(|x| (agent, GroundAct::new("pick", [*r, x, p]))));
            acts.extend(THINGS.map(|x| (agent, GroundAct::new("put", [*r, x, p]))));
        }
    }
    let problem =
        Problem { name: Name::new("p"), domain: Name::new("flat"), objects, init, goal, metric: None };
    World { problem, interpreter, initial, acts }
}

/// What a plan may do only while something else holds: the literals, and that condition.
struct Order {
    later: BTreeSet<Literal>,
    earlier: GroundCondition,
}

impl Order {
    /// Of two goals, the second is brought about while the first holds, as far as it is new.
    fn new(world: &World, earlier: GroundCondition, later: &GroundCondition) -> Self {
        let free: Vec<&Literal> = earlier.literals();
        let new = |l: &&Literal| world.initial.facts.contains(&l.atom) != l.holds && !free.contains(l);
        Order { later: later.literals().into_iter().filter(new).cloned().collect(), earlier }
    }

    /// What the step relies on for the sake of the order; `None` if it may not be done in that state.
    fn relied_on(&self, world: &World, state: &WorldState, step: &TeamStep) -> Option<Vec<Literal>> {
        let brings_about = step
            .action
            .literal_effects()
            .any(|(when, effect)| self.later.contains(effect) && world.interpreter.holds(state, when));
        if brings_about { self.earlier.witness(state) } else { Some(Vec::new()) }
    }
}

/// The least makespan over the deordered forms of all linear plans of at most `length` actions; `None` if there
/// is none. Nothing is merged or pruned, so keep `length` small.
fn brute_force(world: &World, goal: &Condition, asked: &Order, length: usize) -> Option<f64> {
    let ground = world.interpreter.ground_condition(goal).unwrap();
    let actions: Vec<TeamStep> = world
        .acts
        .iter()
        .map(|(agent, act)| TeamStep {
            agent: *agent,
            action: Arc::new(world.interpreter.instantiate(act).unwrap()),
        })
        .collect();
    let mut best: Option<f64> = None;
    let mut open = vec![(Vec::new(), Vec::new(), world.initial.clone())];
    while let Some((plan, relied_on, state)) = open.pop() {
        if world.interpreter.holds(&state, &ground) {
            let steps = plan.iter().map(|&i: &usize| actions[i].clone()).collect();
            let order =
                deorder_with(&world.interpreter, &world.initial, steps, &ground, &[], &relied_on).unwrap();
            best = Some(best.map_or(order.makespan(), |b| b.min(order.makespan())));
            continue;
        }
        if plan.len() == length {
            continue;
        }
        for (i, step) in actions.iter().enumerate() {
            let mut next = state.clone();
            let Some(relies) = asked.relied_on(world, &state, step) else { continue };
            if world.interpreter.apply(&mut next, &step.action).is_ok() && next != state {
                let own = relies.into_iter().map(|literal| (plan.len(), literal));
                let relied_on = relied_on.iter().cloned().chain(own).collect();
                open.push(([plan.as_slice(), &[i]].concat(), relied_on, next));
            }
        }
    }
    best
}

fn agents(task: &Task) -> Vec<u32> {
    let operators = (0..task.operators.len() as u32).map(OperatorId);
    operators.map(|o| u32::from(task.act(o).args[0] == "r2")).collect()
}

fn cases() -> u32 {
    std::env::var("LAMMA_CASES").ok().and_then(|n| n.parse().ok()).unwrap_or(40)
}

proptest! {
    #![proptest_config(ProptestConfig { cases: cases(), ..ProptestConfig::default() })]

    #[test]
    fn the_shortest_schedule_is_what_brute_force_finds(
        bits in any::<u32>(),
        wanted in proptest::collection::btree_set(0usize..GOALS.len(), 1..4),
    ) {
        const LENGTH: usize = 4;
        let goal = Condition::And(wanted.iter().map(|&g| parse_condition(GOALS[g]).unwrap()).collect());
        let world = world(bits, goal.clone());
        let domain = parse_domain(&Source::new("flat.pddl", DOMAIN)).unwrap().value;
        let task = ground(&domain, &world.problem, &GroundLimits::default()).unwrap();
        let free = Order::new(&world, GroundCondition::TRUE, &GroundCondition::TRUE);
        let expected = brute_force(&world, &goal, &free, LENGTH);
        let of = agents(&task);
        let limits = MakespanLimits::default();
        let Some(scheduler) = Scheduler::new(&task, &of) else {
            prop_assert_eq!(expected, None, "a plan where the scheduler sees none");
            return Ok(());
        };
        let found = scheduler.shortest(0, Some(12), &limits, &AtomicBool::new(false));
        let bound = found.lower_bound.unwrap();
        if let Some(expected) = expected {
            prop_assert!(f64::from(bound) <= expected, "bound {} above a plan of {}", bound, expected);
            let work = scheduler.work(16);
            prop_assert!(f64::from(work) <= expected, "bound by work {} above a plan of {}", work, expected);
        }
        if let Some(schedule) = found.schedule {
            prop_assert_eq!(schedule.makespan(), bound, "the first schedule on the way up meets the bound");
            let mut steps = Vec::new();
            for operator in schedule.operators() {
                let action = world.interpreter.instantiate(&task.act(operator)).unwrap();
                steps.push(TeamStep { agent: of[operator.index()] as usize, action: Arc::new(action) });
            }
            let ground = world.interpreter.ground_condition(&goal).unwrap();
            let order = deorder(&world.interpreter, &world.initial, steps, &ground, &[])
                .map_err(|(i, v)| TestCaseError::fail(format!("step {i}: {v}")))?;
            prop_assert!(order.makespan() <= f64::from(bound), "deordered {} of {}", order.makespan(), bound);
        }
    }

    #[test]
    fn windows_shorten_plans_and_keep_them_valid(
        draws in proptest::collection::vec(any::<u8>(), 5..60),
        wanted in proptest::collection::vec(any::<u8>(), 1..5),
    ) {
        let team = Carriers::new();
        let (acts, end) = team.walk(&draws);
        let goal = Condition::And(wanted.iter().map(|&w| team.fact(&end, w)).collect());
        let task = team.task(&goal);
        let of = team.agents_of(&task);
        let cancel = AtomicBool::new(false);
        let Some(scheduler) = Scheduler::new(&task, &of) else {
            return Err(TestCaseError::fail("the scheduler sees no plan where a walk is one"));
        };
        // Grounding has left out operators that nobody can need; so does the walk.
        let known: BTreeSet<GroundAct> =
            (0..task.operators.len() as u32).map(|o| task.act(OperatorId(o))).collect();
        let acts: Vec<GroundAct> = acts.into_iter().filter(|act| known.contains(act)).collect();
        let plan = task.trace(&Plan { acts, cost: 0.0 }).unwrap();
        let as_walked = team.makespan(&task, &of, &plan, &goal)?;
        prop_assert_eq!(scheduler.makespan_of(&plan), Some(as_walked), "two ways of ordering a plan");
        let limits = MakespanLimits { work: 100_000_000, ..MakespanLimits::default() };
        let found = scheduler.improve(&plan, as_walked, scheduler.work(16), &limits, &cancel);
        let bound = found.lower_bound.unwrap();
        let Some(schedule) = found.schedule else {
            prop_assert_eq!(bound, as_walked, "neither shorter nor proved shortest");
            return Ok(());
        };
        let shorter: Vec<OperatorId> = schedule.operators().collect();
        let carried_out = team.makespan(&task, &of, &shorter, &goal)?;
        prop_assert!(carried_out <= schedule.makespan() && schedule.makespan() < as_walked);
        prop_assert_eq!(bound, schedule.makespan(), "so small a task is solved and proved");
        // The proof from below, without plans and windows, agrees.
        let proved = scheduler.shortest(0, None, &MakespanLimits::default(), &cancel);
        prop_assert_eq!(proved.schedule.map(|s| s.makespan()), Some(bound));
    }
}

const CARRYING: &str = "(define (domain carrying) (:requirements :typing)
  (:types robot thing place)
  (:predicates (at ?r - robot ?p - place) (in ?x - thing ?p - place) (holding ?r - robot ?x - thing)
    (free ?r - robot) (road ?p ?q - place) (open ?p - place) (shut ?p - place) (opener ?r - robot))
  (:action go :parameters (?r - robot ?p ?q - place) :precondition (and (at ?r ?p) (road ?p ?q) (open ?q))
    :effect (and (not (at ?r ?p)) (at ?r ?q)))
  (:action open :parameters (?r - robot ?p ?q - place)
    :precondition (and (opener ?r) (at ?r ?p) (road ?p ?q) (shut ?q)) :effect (and (open ?q) (not (shut ?q))))
  (:action shut :parameters (?r - robot ?p ?q - place)
    :precondition (and (opener ?r) (at ?r ?p) (road ?p ?q) (open ?q)) :effect (and (shut ?q) (not (open ?q))))
  (:action pick :parameters (?r - robot ?x - thing ?p - place)
    :precondition (and (at ?r ?p) (in ?x ?p) (free ?r))
    :effect (and (holding ?r ?x) (not (free ?r)) (not (in ?x ?p))))
  (:action put :parameters (?r - robot ?x - thing ?p - place)
    :precondition (and (at ?r ?p) (holding ?r ?x)) :effect (and (in ?x ?p) (free ?r) (not (holding ?r ?x)))))";

/// Robots that carry things along roads; only the first can open and shut places.
struct Carriers {
    domain: Domain,
    objects: Vec<TypedName>,
    interpreter: Interpreter,
    init: Vec<Init>,
    acts: Vec<GroundAct>,
}

impl Carriers {
    fn new() -> Self {
        let (robots, things, places) = (["r1", "r2", "r3"], ["x", "y", "z"], ["a", "b", "c", "d"]);
        let domain = parse_domain(&Source::new("carrying.pddl", CARRYING)).unwrap().value;
        let objects = [typed(&robots, "robot"), typed(&things, "thing"), typed(&places, "place")].concat();
        let mut init = vec![
            GroundAtom::new("opener", ["r1"]),
            GroundAtom::new("open", ["a"]),
            GroundAtom::new("open", ["b"]),
            GroundAtom::new("open", ["c"]),
            GroundAtom::new("shut", ["d"]),
        ];
        init.extend(robots.iter().zip(places).map(|(r, p)| GroundAtom::new("at", [r, p])));
        init.extend(robots.iter().map(|r| GroundAtom::new("free", [*r])));
        init.extend(things.iter().zip(["a", "a", "b"]).map(|(x, p)| GroundAtom::new("in", [x, p])));
        let roads = [("a", "b"), ("b", "a"), ("b", "c"), ("c", "b"), ("c", "d"), ("d", "c")];
        init.extend(roads.map(|(p, q)| GroundAtom::new("road", [p, q])));
        let mut acts = Vec::new();
        for r in robots {
            for (p, q) in roads {
                acts.extend(["go", "open", "shut"].map(|name| GroundAct::new(name, [r, p, q])));
            }
            for p in places {
                acts.extend(things.map(|x| GroundAct::new("pick", [r, x, p])));
                acts.extend(things.map(|x| GroundAct::new("put", [r, x, p])));
            }
        }
        let interpreter = Interpreter::new(&domain, &objects).unwrap();
        let init = init.into_iter().map(Init::Fact).collect();
        Carriers { domain, objects, interpreter, init, acts }
    }

    /// A walk: each draw picks from the acts that apply. With the state it leads to.
    fn walk(&self, draws: &[u8]) -> (Vec<GroundAct>, WorldState) {
        let mut state = self.interpreter.initial(&self.init).unwrap();
        let mut done = Vec::new();
        for &draw in draws {
            let ways: Vec<(&GroundAct, WorldState)> = self
                .acts
                .iter()
                .filter_map(|act| {
                    let mut next = state.clone();
                    let action = self.interpreter.instantiate(act).ok()?;
                    self.interpreter.apply(&mut next, &action).ok()?;
                    Some((act, next))
                })
                .collect();
            let (act, next) = ways[usize::from(draw) % ways.len()].clone();
            done.push(act.clone());
            state = next;
        }
        (done, state)
    }

    /// A fact of the state that could be otherwise.
    fn fact(&self, state: &WorldState, draw: u8) -> Condition {
        let facts: Vec<&GroundAtom> =
            state.facts.iter().filter(|f| f.predicate != "road" && f.predicate != "opener").collect();
        parse_condition(&facts[usize::from(draw) % facts.len()].to_string()).unwrap()
    }

    fn task(&self, goal: &Condition) -> Task {
        let problem = Problem {
            name: Name::new("p"),
            domain: Name::new("carrying"),
            objects: self.objects.clone(),
            init: self.init.clone(),
            goal: goal.clone(),
            metric: None,
        };
        ground(&self.domain, &problem, &GroundLimits::default()).unwrap()
    }

    fn agents_of(&self, task: &Task) -> Vec<u32> {
        let of = |o: u32| ["r1", "r2", "r3"].iter().position(|r| task.act(OperatorId(o)).args[0] == *r);
        (0..task.operators.len() as u32).map(|o| of(o).unwrap() as u32).collect()
    }

    /// How long the plan takes on the plain semantics.
    fn makespan(
        &self,
        task: &Task,
        of: &[u32],
        plan: &[OperatorId],
        goal: &Condition,
    ) -> Result<u32, TestCaseError> {
        let step = |&o: &OperatorId| {
            let action = self.interpreter.instantiate(&task.act(o)).unwrap();
            TeamStep { agent: of[o.index()] as usize, action: Arc::new(action) }
        };
        let initial = self.interpreter.initial(&self.init).unwrap();
        let goal = self.interpreter.ground_condition(goal).unwrap();
        let order = deorder(&self.interpreter, &initial, plan.iter().map(step).collect(), &goal, &[])
            .map_err(|(i, v)| TestCaseError::fail(format!("step {i}: {v}")))?;
        let end = order.steps.iter().try_fold(initial, |mut state, step| {
            self.interpreter.apply(&mut state, &step.action).map(|_| state)
        });
        prop_assert!(self.interpreter.holds(&end.unwrap(), &goal), "the plan misses the goal");
        Ok(order.makespan() as u32)
    }
}

/// The condition over the facts of the task; what the task does not know never changes.
fn need(task: &Task, world: &World, condition: &GroundCondition) -> Need {
    let all = |parts: &[GroundCondition]| parts.iter().map(|part| need(task, world, part)).collect();
    match condition {
        GroundCondition::And(parts) => Need::All(all(parts)),
        GroundCondition::Or(parts) => Need::Any(all(parts)),
        GroundCondition::Literal(wanted) => {
            let facts = (0..task.facts.len() as u32).map(FactId);
            let mut known = facts.filter_map(|f| task.literal(f).map(|literal| (f, literal)));
            match known.find(|(_, literal)| literal.atom == wanted.atom) {
                Some((fact, literal)) => Need::Fact(fact, literal.holds == wanted.holds),
                None if world.initial.facts.contains(&wanted.atom) == wanted.holds => Need::All(Vec::new()),
                None => Need::Any(Vec::new()),
            }
        }
        GroundCondition::Compare(..) => unreachable!("the goals compare no numbers"),
    }
}

proptest! {
    #![proptest_config(ProptestConfig { cases: cases(), ..ProptestConfig::default() })]

    #[test]
    fn no_schedule_in_order_is_shorter_than_the_bound_says(
        bits in any::<u32>(),
        first in 0usize..GOALS.len(),
        then in 0usize..GOALS.len(),
    ) {
        let parts = [first, then].map(|g| parse_condition(GOALS[g]).unwrap());
        let goal = Condition::And(parts.to_vec());
        let world = world(bits, goal.clone());
        let domain = parse_domain(&Source::new("flat.pddl", DOMAIN)).unwrap().value;
        let task = ground(&domain, &world.problem, &GroundLimits::default()).unwrap();
        let [earlier, later] = parts.map(|part| world.interpreter.ground_condition(&part).unwrap());
        let milestones = [(&earlier, Vec::new()), (&later, vec![0])]
            .map(|(condition, after)| Milestone { need: need(&task, &world, condition), after });
        let asked = Order::new(&world, earlier, &later);
        let expected = brute_force(&world, &goal, &asked, 4);
        let of = agents(&task);
        let Some(scheduler) = Scheduler::in_order(&task, &of, &milestones) else {
            prop_assert_eq!(expected, None, "a plan where the scheduler sees none");
            return Ok(());
        };
        let found = scheduler.shortest(0, Some(8), &MakespanLimits::default(), &AtomicBool::new(false));
        if let (Some(bound), Some(expected)) = (found.lower_bound, expected) {
            prop_assert!(f64::from(bound) <= expected, "bound {} above a plan of {}", bound, expected);
        }
    }
}

#[test]
fn what_is_to_come_later_waits() {
    let goal = Condition::And(["(lit a)", "(lit b)"].map(|g| parse_condition(g).unwrap()).to_vec());
    // r1 at a, r2 at b, and power is on: each can light its place at once.
    let world = world(1 << 3 | 1 << 6, goal);
    let domain = parse_domain(&Source::new("flat.pddl", DOMAIN)).unwrap().value;
    let task = ground(&domain, &world.problem, &GroundLimits::default()).unwrap();
    let of = agents(&task);
    let lit = |place: &str| {
        let condition = parse_condition(&format!("(lit {place})")).unwrap();
        need(&task, &world, &world.interpreter.ground_condition(&condition).unwrap())
    };
    let makespan = |after: Vec<usize>| {
        let milestones = [Milestone { need: lit("a"), after: vec![] }, Milestone { need: lit("b"), after }];
        let scheduler = Scheduler::in_order(&task, &of, &milestones).unwrap();
        let found = scheduler.shortest(0, None, &MakespanLimits::default(), &AtomicBool::new(false));
        found.schedule.map(|schedule| schedule.makespan())
    };
    assert_eq!((makespan(vec![]), makespan(vec![0])), (Some(1), Some(2)));
}
