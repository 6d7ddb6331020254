//! The processes of a rally: machines, driver and bus are the ones of every run.

use std::sync::{Arc, Mutex, PoisonError};

use lamma_bus::Bus;
use lamma_bus::driver::{Settings, drive, drive_crowd};
use lamma_protocol::{AgentId, Envelope, Input, Message, Node, Tick, Topic};
use lamma_robot::{Robot, RobotConfig};
use lamma_simulator::Arbiter;

use super::coordinator::RallyCoordinator;
use super::task::Rally;
use crate::cli::{RallyArgs, RallyRole};
use crate::error::Failure;
use crate::exit;
use crate::process::child::seat;
use crate::process::join::{Place, open};
use crate::process::planner;
use crate::spec::EXPANSIONS;

/// Where the simulator writes when each step of the lead was asked for first, in microseconds.
pub const LEAD_FILE: &str = "lead.json";

/// One process of a rally, until it is over.
pub fn member(args: &RallyArgs) -> Result<u8, Failure> {
    lamma_bus::process::tie_self_to_parent().map_err(Failure::fault)?;
    // The second line of defence, should the parent die without the kernel telling us.
    lamma_bus::process::exit_when_stdin_closes().map_err(Failure::fault)?;
    lamma_bus::process::raise_open_files_limit().map_err(Failure::fault)?;
    match args.role {
        RallyRole::Coordinator => coordinator(args)?,
        RallyRole::Simulator => simulator(args)?,
        RallyRole::Robots => robots(args)?,
    }
    Ok(exit::SUCCESS)
}

fn join(args: &RallyArgs, rally: &Rally, node: Node) -> Result<Box<dyn Bus>, Failure> {
    open(&args.child, Place { run: super::RUN, agents: rally.agents }, node)
}

fn coordinator(args: &RallyArgs) -> Result<(), Failure> {
    let rally = Rally::read(&args.child.run_dir)?;
    let mut machine = RallyCoordinator::new(rally, args.limit_ms);
    let mut bus = join(args, &rally, Node::Coordinator)?;
    drive(&mut machine, bus.as_mut(), Settings::default(), Vec::new()).map_err(Failure::fault)?;
    Ok(())
}

fn simulator(args: &RallyArgs) -> Result<(), Failure> {
    let rally = Rally::read(&args.child.run_dir)?;
    let domain = Rally::domain(&args.child.run_dir).map_err(Failure::fault)?;
    let mut machine = Arbiter::new(rally.world(domain)).map_err(Failure::fault)?;
    let mut bus = join(args, &rally, Node::Simulator)?;
    let asked: Arc<Mutex<Vec<u64>>> = Arc::default();
    let seen = Arc::clone(&asked);
    let record = move |now: Tick, _: Node, input: &Input<'_, ()>| {
        if let Input::Message(Topic::Request(Rally::LEAD), Envelope { message: Message::Request(r), .. }) =
            input
        {
            let mut seen = seen.lock().unwrap_or_else(PoisonError::into_inner);
            if r.step.index() == seen.len() {
                seen.push(now.0);
            }
        }
    };
    let settings = Settings { record: Some(Box::new(record)), ..Settings::default() };
    drive(&mut machine, bus.as_mut(), settings, Vec::new()).map_err(Failure::fault)?;
    let asked = asked.lock().unwrap_or_else(PoisonError::into_inner);
    let path = args.child.run_dir.join(LEAD_FILE);
    let text = serde_json::to_string(&*asked).map_err(Failure::fault)?;
    std::fs::write(&path, text).map_err(|e| Failure::io("write", &path, &e))
}

/// All robots of one seat: one, or as many as a worker hosts.
fn robots(args: &RallyArgs) -> Result<(), Failure> {
    let rally = Rally::read(&args.child.run_dir)?;
    let first = AgentId(args.child.agent);
    let domain = Rally::domain(&args.child.run_dir).map(Arc::new);
    let robot = |id| {
        let config = RobotConfig {
            id,
            pid: std::process::id(),
            domain: domain.clone(),
            expansions: EXPANSIONS,
            share: None,
        };
        (Node::Robot(id), Robot::new(config))
    };
    let mut robots: Vec<(Node, Robot)> = seat(&args.child).map(AgentId).map(robot).collect();
    let mut bus = join(args, &rally, Node::Robot(first))?;
    let workers = vec![planner()];
    drive_crowd(&mut robots, bus.as_mut(), Settings::default(), workers).map_err(Failure::fault)?;
    Ok(())
}
