//! `lamma list`: scenes and robots.

use crate::cli::ListWhat;
use crate::exit;
use crate::out::say;

/// Prints the list.
pub fn list(what: ListWhat) -> u8 {
    match what {
        ListWhat::Scenes => lamma_domains::scene::names().iter().for_each(|name| say(format_args!("{name}"))),
        ListWhat::Robots => {
            for robot in lamma_domains::robots::catalogue() {
                let skills = robot.skills.join(" ");
                say(format_args!("{:8} {:>6} kg  {skills}", robot.name, robot.capacity_kg));
            }
        }
    }
    exit::SUCCESS
}
