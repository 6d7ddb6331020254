//! The processes themselves: `lamma robot`, `lamma coordinator`, `lamma simulator`.

use std::ops::Range;
use std::sync::Arc;

use lamma_bus::Bus;
use lamma_bus::driver::{Settings, drive, drive_crowd};
use lamma_protocol::{AgentId, Machine, Node};

use crate::cli::{ChildArgs, CoordinatorArgs};
use crate::error::Failure;
use crate::exit;
use crate::process::join::join;
use crate::process::{Parts, arbiter_parts, coordinator_parts, planner, robot_parts};
use crate::spec::RunSpec;

/// A robot, or all that share its process, until the run is over.
pub fn robot(args: &ChildArgs) -> Result<u8, Failure> {
    let spec = RunSpec::read(&args.run_dir)?;
    let first = AgentId(args.agent);
    let mut robots = Vec::new();
    for agent in seat(args).map(AgentId) {
        robots.push((Node::Robot(agent), robot_parts(&spec, &args.run_dir, agent)?.machine));
    }
    let mut bus = enter(args, &spec, Node::Robot(first))?;
    drive_crowd(&mut robots, bus.as_mut(), Settings::default(), vec![planner()]).map_err(Failure::fault)?;
    Ok(exit::SUCCESS)
}

/// The robots of this process: the one it is called by, and all that share its endpoint.
pub fn seat(args: &ChildArgs) -> Range<u16> {
    let alone = args.agent..args.agent.saturating_add(1);
    args.scope.as_ref().map_or(alone, |scope| scope.seat_mates(AgentId(args.agent)))
}

/// The coordinator, until the run is over. Without a launcher it watches over the run itself.
pub fn coordinator(args: &CoordinatorArgs) -> Result<u8, Failure> {
    let spec = RunSpec::read(&args.child.run_dir)?;
    let parts = coordinator_parts(&spec, || spec.world().map(Arc::new))?;
    match args.child.launched {
        true => serve(&args.child, &spec, Node::Coordinator, parts),
        false => crate::remote_host::coordinate(args, &spec, parts),
    }
}

/// The simulator, until it is told to end.
pub fn simulator(args: &ChildArgs) -> Result<u8, Failure> {
    let spec = RunSpec::read(&args.run_dir)?;
    serve(args, &spec, Node::Simulator, arbiter_parts(&spec, &spec.world()?)?)
}

/// Joins the run, tied to the launcher if there is one.
fn enter(args: &ChildArgs, spec: &RunSpec, node: Node) -> Result<Box<dyn Bus>, Failure> {
    if args.launched {
        lamma_bus::process::tie_self_to_parent().map_err(Failure::fault)?;
        // The second line of defence, should the parent die without the kernel telling us.
        lamma_bus::process::exit_when_stdin_closes().map_err(Failure::fault)?;
    }
    lamma_bus::process::raise_open_files_limit().map_err(Failure::fault)?;
    join(args, spec, node)
}

fn serve<M>(
    args: &ChildArgs,
    spec: &RunSpec,
    node: Node,
    parts: Parts<M, M::Job, M::Done>,
) -> Result<u8, Failure>
where
    M: Machine,
    M::Job: Send + 'static,
    M::Done: Send + 'static,
{
    let mut bus = enter(args, spec, node)?;
    let Parts { mut machine, workers } = parts;
    drive(&mut machine, bus.as_mut(), Settings::default(), workers).map_err(Failure::fault)?;
    Ok(exit::SUCCESS)
}
