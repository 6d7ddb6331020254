//! Each robot's own domain file is the union domain without the actions it has no skill for.
//!
//! After a change to the domain or the catalogue: `UPDATE_ROBOTS=1 cargo test -p lamma-domains --test robots`.
#![allow(clippy::unwrap_used, reason = "a test fails by panicking")]

use std::path::PathBuf;

use lamma_domains::robots::{catalogue, project, union_domain};
use lamma_pddl::{Source, parse_domain};

#[test]
fn every_robot_file_is_the_projection_of_the_union_domain() {
    let folder = PathBuf::from(env!("CARGO_MANIFEST_DIR")).join("household/robots");
    for robot in catalogue() {
        let projected = project(union_domain(), robot.skills.iter().map(String::as_str));
        let path = folder.join(format!("{}.pddl", robot.name));
        if std::env::var_os("UPDATE_ROBOTS").is_some() {
            std::fs::write(&path, projected.to_string()).unwrap();
        }
        let source = Source::read(&path).unwrap_or_else(|e| panic!("{}: {e}", path.display()));
        let read = parse_domain(&source).unwrap_or_else(|report| panic!("{report}")).value;
        assert_eq!(read, projected, "{} is out of date: run with UPDATE_ROBOTS=1", path.display());
        assert_eq!(projected.to_string(), source.text.as_ref(), "{} is not as printed", path.display());
    }
    let files = std::fs::read_dir(&folder).unwrap().count();
    assert_eq!(files, catalogue().len(), "a file without a robot in {}", folder.display());
}
