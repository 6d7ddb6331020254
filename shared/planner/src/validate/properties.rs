//! Plans, valid and mutated: the verdict agrees with a second semantics of one domain, written by hand in
//! another form, and text that is no plan is refused.

use lamma_pddl::{Source, parse_domain, parse_problem};
use proptest::collection::vec;
use proptest::prelude::*;
use proptest::test_runner::RngSeed;

use super::*;

const ROOMS: usize = 3;
const BALLS: usize = 2;

/// Moving shakes a full shelf's balls down: a conditional effect over all balls. Nobody enters a room that holds
/// all of them.
const DOMAIN: &str = "(define (domain shelves) (:types room ball)
    (:predicates (at ?r - room) (in ?b - ball ?r - room) (held ?b - ball) (dusty ?b - ball))
    (:action move :parameters (?a ?b - room)
      :precondition (and (at ?a) (not (= ?a ?b)) (not (forall (?x - ball) (in ?x ?b))))
      :effect (and (not (at ?a)) (at ?b)
        (forall (?x - ball) (when (in ?x ?b) (and (dusty ?x) (not (held ?x)))))
        (forall (?x - ball) (when (and (held ?x) (dusty ?x)) (not (dusty ?x))))))
    (:action pick :parameters (?b - ball ?r - room)
      :precondition (and (not (exists (?x - ball) (held ?x))) (at ?r) (in ?b ?r))
      :effect (and (held ?b) (not (in ?b ?r))))
    (:action drop :parameters (?b - ball ?r - room) :precondition (and (held ?b) (at ?r))
      :effect (and (in ?b ?r) (not (held ?b)))))";

/// The same domain as a program.
#[derive(Clone, Debug)]
struct Shelves {
    at: usize,
    /// The room of each ball; none while it is held.
    room: [Option<usize>; BALLS],
    dusty: [bool; BALLS],
}

#[derive(Clone, Copy, Debug)]
enum Step {
    Move(usize, usize),
    Pick(usize, usize),
    Drop(usize, usize),
}

impl Shelves {
    const START: Shelves = Shelves { at: 0, room: [Some(0), Some(1)], dusty: [false; BALLS] };

    fn does(&mut self, step: Step) -> bool {
        match step {
            Step::Move(from, to) => {
                if self.at != from || from == to || self.room.iter().all(|room| *room == Some(to)) {
                    return false;
                }
                self.at = to;
                for ball in 0..BALLS {
                    match self.room[ball] {
                        Some(room) if room == to => self.dusty[ball] = true,
                        Some(_) => {}
                        None => self.dusty[ball] = false,
                    }
                }
            }
            Step::Pick(ball, room) => {
                if self.room.contains(&None) || self.at != room || self.room[ball] != Some(room) {
                    return false;
                }
                self.room[ball] = None;
            }
            Step::Drop(ball, room) => {
                if self.room[ball].is_some() || self.at != room {
                    return false;
                }
                self.room[ball] = Some(room);
            }
        }
        true
    }

    fn is_goal(&self) -> bool {
        self.room == [Some(2), Some(1)] && self.dusty == [false, true]
    }
}

impl Step {
    fn any() -> impl Strategy<Value = Step> {
        prop_oneof![
            (0..ROOMS, 0..ROOMS).prop_map(|(from, to)| Step::Move(from, to)),
            (0..BALLS, 0..ROOMS).prop_map(|(ball, room)| Step::Pick(ball, room)),
            (0..BALLS, 0..ROOMS).prop_map(|(ball, room)| Step::Drop(ball, room)),
        ]
    }

    fn act(self) -> GroundAct {
        match self {
            Step::Move(from, to) => GroundAct::new("move", [format!("r{from}"), format!("r{to}")]),
            Step::Pick(ball, room) => GroundAct::new("pick", [format!("b{ball}"), format!("r{room}")]),
            Step::Drop(ball, room) => GroundAct::new("drop", [format!("b{ball}"), format!("r{room}")]),
        }
    }
}

/// One that reaches the goal.
fn valid_plan() -> Vec<Step> {
    vec![Step::Move(0, 1), Step::Move(1, 0), Step::Pick(0, 0), Step::Move(0, 2), Step::Drop(0, 2)]
}

fn verdict(steps: &[Step]) -> Verdict {
    let domain = parse_domain(&Source::new("domain", DOMAIN)).expect("a domain").value;
    let problem = "(define (problem p) (:domain shelves) (:objects r0 r1 r2 - room b0 b1 - ball)
        (:init (at r0) (in b0 r0) (in b1 r1))
        (:goal (and (in b0 r2) (in b1 r1) (dusty b1) (not (dusty b0)))))";
    let problem = parse_problem(&Source::new("problem", problem)).expect("a problem").value;
    let acts: Vec<GroundAct> = steps.iter().map(|step| step.act()).collect();
    validate(&domain, &problem, &acts).expect("a meaningful task")
}

/// Holds the verdict on the steps against the program.
fn agrees(steps: &[Step]) -> Result<(), TestCaseError> {
    let mut shelves = Shelves::START;
    let failing = steps.iter().position(|step| !shelves.does(*step));
    match (verdict(steps), failing) {
        (Verdict::Impossible { step, .. }, Some(failing)) => prop_assert_eq!(step, failing),
        (Verdict::Valid { cost, .. }, None) => {
            prop_assert!(shelves.is_goal(), "valid, but the goal is not reached: {:?}", shelves);
            prop_assert_eq!(cost, steps.len() as f64);
        }
        (Verdict::GoalNotReached { .. }, None) => prop_assert!(!shelves.is_goal(), "the goal is reached"),
        (verdict, failing) => prop_assert!(false, "{} but the failing step is {:?}", verdict, failing),
    }
    Ok(())
}

#[test]
fn the_plan_that_is_mutated_is_valid() {
    assert!(verdict(&valid_plan()).is_valid(), "{}", verdict(&valid_plan()));
}

/// The same cases in every run.
fn config(cases: u32) -> ProptestConfig {
    let default = ProptestConfig::default();
    ProptestConfig { cases, rng_seed: RngSeed::Fixed(20_251), failure_persistence: None, ..default }
}

proptest! {
    #![proptest_config(config(400))]

    #[test]
    fn mutated_plans_get_the_verdict_of_the_program(
        mutations in vec((0..6usize, 0..6usize, Step::any(), 0..4), 0..4),
    ) {
        let mut steps = valid_plan();
        for (at, other, step, kind) in mutations {
            let (at, other) = (at % (steps.len() + 1), other % (steps.len() + 1));
            match kind {
                0 => steps.insert(at, step),
                1 if at < steps.len() => drop(steps.remove(at)),
                2 if at < steps.len() => steps[at] = step,
                _ if at < steps.len() && other < steps.len() => steps.swap(at, other),
                _ => {}
            }
        }
        agrees(&steps)?;
    }

    #[test]
    fn random_walks_get_the_verdict_of_the_program(tries in vec(Step::any(), 0..120), last in Step::any()) {
        let mut shelves = Shelves::START;
        let mut steps: Vec<Step> = tries.into_iter().filter(|step| shelves.does(*step)).collect();
        agrees(&steps)?;
        steps.push(last);
        agrees(&steps)?;
    }

    #[test]
    fn any_text_is_a_plan_or_refused(
        bytes in vec(any::<u8>(), 0..200),
        pieces in vec(prop::sample::select(vec!["(", ")", "a", " ", "\n", ";", "0.5:", "[1]", "[", "]", ":", "é", "-1"]), 0..60),
    ) {
        for source in [Source::from_bytes("plan", &bytes), Source::new("plan", pieces.concat())] {
            match read_plan(&source) {
                Ok(acts) => prop_assert!(acts.iter().all(|act| !act.action.as_str().is_empty())),
                Err(report) => prop_assert!(report.has_errors() && !report.render().is_empty()),
            }
        }
    }
}
