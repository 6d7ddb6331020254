//! `--events FILE` and `--random-events N`: what happens to the home while the team works.
//!
//! A script is JSON Lines, one event a line, tied to a step of a robot (counted from 1 over the whole run):
//!
//! ```json
//! {"robot": "robot1", "before_step": 3, "move": "Apple_1", "to": "DiningTable_1"}
//! {"robot": "robot2", "before_step": 2, "close": "Fridge_1"}
//! {"robot": "robot1", "before_step": 5, "fail": true}
//! ```

use std::path::Path;

use lamma_domains::nearest;
use lamma_domains::seed::Seed;
use lamma_domains::world::WorldSetup;
use lamma_planner::GroundAct;
use lamma_protocol::AgentId;
use lamma_simulator::{Event, Happening};
use serde::{Deserialize, Serialize};

use crate::error::Failure;

/// The steps before which random events happen: early ones, so that they meet most plans.
const EARLY: usize = 6;

/// A line of a script.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct ScriptLine {
    /// Whose step it comes before.
    robot: String,
    /// Which, from 1.
    before_step: u64,
    /// A thing that somebody carries elsewhere, with `to`.
    #[serde(default, rename = "move", skip_serializing_if = "Option::is_none")]
    moved: Option<String>,
    /// Where to.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    to: Option<String>,
    /// A door that somebody shuts.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    close: Option<String>,
    /// The step itself fails.
    #[serde(default, skip_serializing_if = "std::ops::Not::not")]
    fail: bool,
}

/// Reads a script. Names are checked when the world is known.
pub fn read(path: &Path) -> Result<Vec<ScriptLine>, Failure> {
    let text = std::fs::read_to_string(path).map_err(|e| Failure::unreadable(path, &e))?;
    let lines = text.lines().enumerate().filter(|(_, line)| !line.trim().is_empty());
    lines
        .map(|(index, line)| {
            serde_json::from_str(line)
                .map_err(|e| Failure::bad_input(format!("{}:{}: {e}", path.display(), index + 1)))
        })
        .collect()
}

/// So many events, drawn by the seed.
pub fn random(setup: &WorldSetup, count: u32, seed: u64) -> Vec<ScriptLine> {
    let mut random = Seed::new(seed, &["events"]);
    let movable: Vec<&str> =
        setup.things.iter().filter(|t| t.can("pickupable")).map(|t| t.name.as_str()).collect();
    let places: Vec<&str> = setup
        .things
        .iter()
        .filter(|t| t.can("receptacle") && !t.can("pickupable") && !t.can("openable"))
        .map(|t| t.name.as_str())
        .collect();
    let doors: Vec<&str> =
        setup.things.iter().filter(|t| t.can("openable")).map(|t| t.name.as_str()).collect();
    let pick = |list: &[&str], random: &mut Seed| list.get(random.below(list.len())).map(ToString::to_string);
    (0..count)
        .map(|_| {
            let robot = setup.members.get(random.below(setup.members.len())).map(|m| m.name.clone());
            let before_step = 1 + random.below(EARLY) as u64;
            let mut line = ScriptLine {
                robot: robot.unwrap_or_default(),
                before_step,
                moved: None,
                to: None,
                close: None,
                fail: false,
            };
            match random.below(3) {
                0 => line.fail = true,
                1 => line.close = pick(&doors, &mut random),
                _ => (line.moved, line.to) = (pick(&movable, &mut random), pick(&places, &mut random)),
            }
            line.fail |= line.close.is_none() && (line.moved.is_none() || line.to.is_none());
            line
        })
        .collect()
}

/// The script in terms of the world.
pub fn resolve(script: &[ScriptLine], setup: &WorldSetup) -> Result<Vec<Event>, Failure> {
    script.iter().map(|line| event(line, setup)).collect()
}

fn event(line: &ScriptLine, setup: &WorldSetup) -> Result<Event, Failure> {
    let agent = setup.members.iter().position(|m| m.name == line.robot).ok_or_else(|| {
        let hint = nearest::hint(&line.robot, setup.members.iter().map(|m| m.name.as_str()));
        Failure::bad_input(format!("events: the team has no `{}`{hint}", line.robot))
    })?;
    let thing = |name: &String| {
        setup.thing(name).map(|t| t.name.clone()).ok_or_else(|| {
            let hint = nearest::hint(name, setup.things.iter().map(|t| t.name.as_str()));
            Failure::bad_input(format!("events: the scene has no `{name}`{hint}"))
        })
    };
    let what = match (&line.moved, &line.to, &line.close, line.fail) {
        (Some(x), Some(to), None, false) => {
            Happening::Act(GroundAct::new("ObjectMoved", [thing(x)?.as_str(), thing(to)?.as_str()]))
        }
        (None, None, Some(door), false) => {
            Happening::Act(GroundAct::new("DoorClosed", [thing(door)?.as_str()]))
        }
        (None, None, None, true) => Happening::Fail,
        _ => {
            let what = "events: give one of `move` with `to`, `close`, or `\"fail\": true`";
            return Err(Failure::bad_input(what.to_string()));
        }
    };
    Ok(Event { agent: AgentId(agent as u16), step: line.before_step, what })
}
