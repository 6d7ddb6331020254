//! Competition tasks from the shared data folder: each is grounded, solved and validated. Skipped, saying so,
//! where the folder is absent.

use std::path::{Path, PathBuf};
use std::sync::atomic::AtomicBool;

use lamma_pddl::{Source, parse_domain, parse_problem};
use lamma_planner::{Limits, Outcome, Verdict, plan, validate};

fn folder() -> Option<PathBuf> {
    let root = std::env::var_os("LAMMA_SHARED_DATA").map(PathBuf::from);
    let beside = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../../shared/data");
    root.into_iter().chain([beside]).map(|dir| dir.join("codmap/classical")).find(|dir| dir.is_dir())
}

#[test]
fn one_competition_task_of_each_domain_is_solved() {
    let Some(root) = folder() else {
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
