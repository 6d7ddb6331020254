//! The processes themselves: `lamma robot`, `lamma coordinator`, `lamma simulator`.

use std::sync::Arc;

use lamma_bus::driver::{Settings, drive, drive_crowd};
use lamma_bus::iceoryx::Endpoint;
use lamma_protocol::{AgentId, Machine, Node};

use crate::cli::ChildArgs;
use crate::error::Failure;
use crate::exit;
use crate::process::{Parts, arbiter_parts, coordinator_parts, planner, robot_parts};
use crate::spec::RunSpec;

/// A robot, or all that share its process, until the run is over.
pub fn robot(args: &ChildArgs) -> Result<u8, Failure> {
    let spec = RunSpec::read(&args.run_dir)?;
    let first = AgentId(args.agent);
    let mut robots = Vec::new();
    for agent in args.scope.seat_mates(first).map(AgentId) {
        robots.push((Node::Robot(agent), robot_parts(&spec, &args.run_dir, agent)?.machine));
    }
    let mut bus = join(args, Node::Robot(first))?;
    drive_crowd(&mut robots, &mut bus, Settings::default(), vec![planner()]).map_err(Failure::fault)?;
    Ok(exit::SUCCESS)
}

/// The coordinator, until the run is over.
pub fn coordinator(args: &ChildArgs) -> Result<u8, Failure> {
    let spec = RunSpec::read(&args.run_dir)?;
    let world = Arc::new(spec.world()?);
    serve(args, Node::Coordinator, coordinator_parts(&spec, world)?)
}

/// The simulator, until it is told to end.
pub fn simulator(args: &ChildArgs) -> Result<u8, Failure> {
    let spec = RunSpec::read(&args.run_dir)?;
    serve(args, Node::Simulator, arbiter_parts(&spec, &spec.world()?)?)
}

fn join(args: &ChildArgs, node: Node) -> Result<Endpoint, Failure> {
    lamma_bus::process::tie_self_to_parent().map_err(Failure::fault)?;
    // The second line of defence, should the parent die without the kernel telling us.
    lamma_bus::process::exit_when_stdin_closes().map_err(Failure::fault)?;
    lamma_bus::process::raise_open_files_limit().map_err(Failure::fault)?;
    Endpoint::open(&args.scope, node).map_err(Failure::fault)
}

fn serve<M>(args: &ChildArgs, node: Node, parts: Parts<M, M::Job, M::Done>) -> Result<u8, Failure>
where
    M: Machine,
    M::Job: Send + 'static,
    M::Done: Send + 'static,
{
    let mut bus = join(args, node)?;
    let Parts { mut machine, workers } = parts;
    drive(&mut machine, &mut bus, Settings::default(), workers).map_err(Failure::fault)?;
    Ok(exit::SUCCESS)
}
