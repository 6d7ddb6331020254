//! `lamma prepare`: the folder of a run that is started by hand, on several hosts.

use std::collections::BTreeMap;

use crate::cli::PrepareArgs;
use crate::commands::run::{new_folder, spec_of};
use crate::error::Failure;
use crate::exit;
use crate::out::say;
use crate::spec::{HUB, RunSpec};
use crate::world::World;

/// Writes the folder and says what to start where.
pub fn prepare(args: &PrepareArgs) -> Result<u8, Failure> {
    let mut spec = spec_of(&args.run)?;
    spec.away = away(args, &spec)?;
    let world = spec.world()?;
    if let World::Household(setup) = &world {
        crate::events::resolve(&spec.events, setup)?;
    }
    let folder = new_folder(&args.run.common)?;
    spec.id = folder.id().to_string();
    spec.write(folder.path(), &world)?;
    if !spec.away.is_empty() {
        let at = folder.path().display();
        say(format_args!("run {} is in {at}: copy that folder to every host, then start", spec.id));
        say(format_args!(
            "  lamma host {HUB} --listen tcp/0.0.0.0:7447 --run-dir {at}    # prints the outcome"
        ));
        for name in spec.away.keys() {
            say(format_args!("  lamma host {name} --connect tcp/HUB:7447 --run-dir {at}"));
        }
        return Ok(exit::SUCCESS);
    }
    let run = format!("--bus zenoh --connect tcp/HUB:7447 --run-dir {}", folder.path().display());
    say(format_args!(
        "run {} is in {}: copy that folder to every host, then start",
        spec.id,
        folder.path().display()
    ));
    say("  lamma router --listen tcp/0.0.0.0:7447          on the host HUB");
    say(format_args!("  lamma simulator {run}"));
    for (agent, name) in spec.source.names().into_iter().enumerate() {
        say(format_args!("  lamma robot {run} --agent {agent}    # {name}"));
    }
    say(format_args!("  lamma coordinator {run}    # prints the outcome and ends the others"));
    Ok(exit::SUCCESS)
}

/// Who lives where: `west=robot17+robot24`.
fn away(args: &PrepareArgs, spec: &RunSpec) -> Result<BTreeMap<String, Vec<u16>>, Failure> {
    let mut away: BTreeMap<String, Vec<u16>> = BTreeMap::new();
    for text in &args.away {
        let fail = |why: String| Failure::bad_input(format!("--away {text}: {why}; write HOST=ROBOT+ROBOT"));
        let (host, robots) = text.split_once('=').ok_or_else(|| fail("no `=`".into()))?;
        let fits = |c: char| c.is_ascii_alphanumeric() || c == '-' || c == '_';
        if host.is_empty() || host == HUB || !host.chars().all(fits) {
            return Err(fail(format!("{host:?} cannot name another host")));
        }
        for robot in robots.split('+') {
            let agent = spec.source.names().into_iter().position(|name| name == robot);
            let agent = agent.ok_or_else(|| fail(format!("no {robot:?} in the team")))? as u16;
            if away.values().flatten().any(|a| *a == agent) {
                return Err(fail(format!("{robot} lives elsewhere already")));
            }
            away.entry(host.into()).or_default().push(agent);
        }
    }
    Ok(away)
}
