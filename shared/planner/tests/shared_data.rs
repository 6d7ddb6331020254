//! Competition tasks from the shared data folder: each is grounded, solved and validated. Skipped, saying so,
//! where the folder is absent.

use std::path::{Path, PathBuf};
use std::sync::atomic::AtomicBool;

use lamma_pddl::{Source, parse_domain, parse_problem};
use lamma_planner::{Limits, Outcome, Verdict, plan, validate};

fn folder(name: &str) -> Option<PathBuf> {
    let root = std::env::var_os("LAMMA_SHARED_DATA").map(PathBuf::from);
    let beside = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../../shared/data");
    root.into_iter().chain([beside]).map(|dir| dir.join(name)).find(|dir| dir.is_dir())
}

#[test]
fn one_competition_task_of_each_domain_is_solved() {
    let Some(root) = folder("codmap/classical") else {
        println!("skipped: no shared data folder (set LAMMA_SHARED_DATA)");
        return;
    };
    let easy = [
        "blocksworld/probBLOCKS-9-1.pddl",
        "depot/pfile1.pddl",
        "driverlog/pfile1.pddl",
        "elevators08/p01.pddl",
        "logistics00/probLOGISTICS-6-0.pddl",
        "sokoban/p01.pddl",
        "taxi/p05.pddl",
        "woodworking08/p01.pddl",
        "zenotravel/pfile4.pddl",
    ];
    for name in easy {
        let file = root.join(name);
        let read = |path: &Path| Source::read(path).unwrap_or_else(|e| panic!("{}: {e}", path.display()));
        if !file.exists() {
            println!("skipped: {name}");
            continue;
        }
        let domain = parse_domain(&read(&file.with_file_name("domain.pddl")))
            .unwrap_or_else(|r| panic!("{}", r.render()));
        let problem = parse_problem(&read(&file)).unwrap_or_else(|r| panic!("{}", r.render()));
        let limits = Limits { expansions: Some(100_000), ..Limits::default() };
        match plan(&domain.value, &problem.value, &limits, &AtomicBool::new(false)) {
            Ok(Outcome::Found(found)) => match validate(&domain.value, &problem.value, &found.acts) {
                Ok(Verdict::Valid { cost, .. }) => assert_eq!(cost, found.cost, "{name}: cost"),
                other => panic!("{name}: {other:?}"),
            },
            other => panic!("{name}: {other:?}"),
        }
    }
}

#[test]
fn the_domain_of_all_actions_counts_its_fridge_doors() {
    let Some(root) = folder("mat-thor/domains") else {
        println!("skipped: no shared data folder (set LAMMA_SHARED_DATA)");
        return;
    };
    let path = root.join("allactionrobot.pddl");
    let source = Source::read(&path).unwrap_or_else(|e| panic!("{}: {e}", path.display()));
    let domain = parse_domain(&source).unwrap_or_else(|r| panic!("{}", r.render())).value;
    let problem = |doors: &str| {
        let text = format!(
            "(define (problem p) (:domain allactionrobot)
               (:objects r1 r2 - robot Fridge_1 Counter_1 Egg_1 - object)
               (:init (is-fridge Fridge_1) (at-location Egg_1 Counter_1) {doors})
               (:goal (and (at-location Egg_1 Fridge_1) (object-close r2 Fridge_1))))"
        );
        parse_problem(&Source::new("problem", text)).unwrap_or_else(|r| panic!("{}", r.render())).value
    };
    let limits = Limits { expansions: Some(100_000), ..Limits::default() };
    let shut = problem("(= (fridge-state Fridge_1) 0)");
    match plan(&domain, &shut, &limits, &AtomicBool::new(false)) {
        Ok(Outcome::Found(found)) => {
            let opened = found.acts.iter().position(|act| act.action == "OpenFridge");
            let put = found.acts.iter().position(|act| act.action == "PutObject");
            assert!(opened.is_some() && opened < put, "{found:?}");
            let verdict = validate(&domain, &shut, &found.acts);
            assert!(verdict.as_ref().is_ok_and(Verdict::is_valid), "{verdict:?}");
        }
        other => panic!("{other:?}"),
    }
    // A number that has no value never gets above 0.
    let unknown = plan(&domain, &problem(""), &limits, &AtomicBool::new(false));
    assert!(matches!(unknown, Ok(Outcome::Unsolvable(_))), "{unknown:?}");
}
