//! The processes themselves: `lamma robot`, `lamma coordinator`, `lamma simulator`.

use std::sync::Arc;

use lamma_bus::driver::{Settings, drive};
use lamma_protocol::{AgentId, Machine, Node};

use crate::cli::{ChildArgs, CoordinatorArgs};
use crate::error::Failure;
use crate::exit;
use crate::process::join::join;
use crate::process::{Parts, arbiter_parts, coordinator_parts, robot_parts};
use crate::spec::RunSpec;

/// A robot, until the run is over.
pub fn robot(args: &ChildArgs) -> Result<u8, Failure> {
    let spec = RunSpec::read(&args.run_dir)?;
    let agent = AgentId(args.agent);
    serve(args, &spec, Node::Robot(agent), robot_parts(&spec, &args.run_dir, agent)?)
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
    if args.launched {
        // The second line of defence, should the parent die without the kernel telling us.
        lamma_bus::process::exit_when_stdin_closes().map_err(Failure::fault)?;
    }
    lamma_bus::process::raise_open_files_limit().map_err(Failure::fault)?;
    let mut bus = join(args, spec, node)?;
    let Parts { mut machine, workers } = parts;
    drive(&mut machine, bus.as_mut(), Settings::default(), workers).map_err(Failure::fault)?;
    Ok(exit::SUCCESS)
}
