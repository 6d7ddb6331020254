//! `lamma list`: scenes and robots.

use crate::cli::ListWhat;
use crate::exit;

/// Prints the list.
pub fn list(what: ListWhat) -> u8 {
    match what {
        ListWhat::Scenes => lamma_domains::scene::names().iter().for_each(|name| println!("{name}")),
        ListWhat::Robots => {
            for robot in lamma_domains::robots::catalogue() {
                println!("{:8} {:>6} kg  {}", robot.name, robot.capacity_kg, robot.skills.join(" "));
            }
        }
    }
    exit::SUCCESS
}
