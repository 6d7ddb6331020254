//! How far it is from thing to thing: steps of 0.25 m over the cells of the floor.
//!
//! AI2-THOR's agents move from cell to cell in four directions. The way between two things is the shortest one from
//! where one stands at the first to where one stands at the second; turning takes no time. What lies on the floor is
//! in the middle of the room, and so is everybody at the start.

use std::collections::{BTreeMap, VecDeque};

use crate::scene::{CELL_M, Grid};
use crate::world::Thing;

/// Places and the ways between them.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Ways {
    /// The place of each thing that does not move.
    pub place_of: BTreeMap<String, usize>,
    /// Steps from place to place.
    pub steps: Vec<Vec<u32>>,
    /// The place of the floor.
    pub middle: usize,
}

type Cell = (usize, usize);

impl Ways {
    /// The ways of a floor between the things that do not move.
    pub fn new(floor: &Grid, things: &[Thing]) -> Ways {
        let mut cells: Vec<Cell> = Vec::new();
        let mut place_of = BTreeMap::new();
        let mut middle = 0;
        for thing in things {
            let Some(cell) = thing.stand.and_then(|stand| floor.cell(stand)) else { continue };
            let place = cells.iter().position(|c| *c == cell).unwrap_or_else(|| {
                cells.push(cell);
                cells.len() - 1
            });
            if thing.kind == "Floor" {
                middle = place;
            }
            place_of.insert(thing.name.clone(), place);
        }
        let steps = cells.iter().map(|from| floor.steps_from(*from, &cells)).collect();
        Ways { place_of, steps, middle }
    }
}

impl Grid {
    /// The cell at a point of the floor; none where nobody can walk.
    fn cell(&self, at: [f64; 2]) -> Option<Cell> {
        let index = |axis: usize| {
            let cells = (at[axis] - self.corner[axis]) / CELL_M;
            // A cell of a room: small, and not negative.
            (cells > -0.5).then(|| cells.round() as usize)
        };
        Some((index(0)?, index(1)?)).filter(|cell| self.is_free(*cell))
    }

    fn is_free(&self, (x, z): Cell) -> bool {
        self.rows.get(z).is_some_and(|row| row.as_bytes().get(x) == Some(&b'.'))
    }

    /// Steps to each of the cells; where there is no way, as if there were no walls.
    fn steps_from(&self, from: Cell, to: &[Cell]) -> Vec<u32> {
        let mut steps = BTreeMap::from([(from, 0u32)]);
        let mut queue = VecDeque::from([from]);
        while let Some((x, z)) = queue.pop_front() {
            let next = steps[&(x, z)] + 1;
            for cell in [(x + 1, z), (x.wrapping_sub(1), z), (x, z + 1), (x, z.wrapping_sub(1))] {
                if self.is_free(cell) && !steps.contains_key(&cell) {
                    steps.insert(cell, next);
                    queue.push_back(cell);
                }
            }
        }
        let straight = |to: &Cell| (from.0.abs_diff(to.0) + from.1.abs_diff(to.1)) as u32;
        to.iter().map(|cell| steps.get(cell).copied().unwrap_or_else(|| straight(cell))).collect()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_way_leads_around_what_stands_in_it() {
        let floor =
            Grid { corner: [-0.5, 1.0], rows: ["...", ".#.", ".#.", ".#."].map(String::from).to_vec() };
        let cell = |x: f64, z: f64| floor.cell([x, z]);
        assert_eq!(cell(-0.5, 1.75), Some((0, 3)));
        assert_eq!(cell(0.0, 1.75), Some((2, 3)));
        assert_eq!(cell(-0.25, 1.75), None, "furniture");
        assert_eq!(cell(-0.75, 1.0), None, "outside");
        assert_eq!(floor.steps_from((0, 3), &[(0, 3), (0, 1), (2, 3)]), [0, 2, 8]);
    }

    #[test]
    fn where_a_wall_divides_the_room_the_way_is_straight() {
        let floor = Grid { corner: [0.0, 0.0], rows: vec![".#.".to_string()] };
        assert_eq!(floor.steps_from((0, 0), &[(2, 0)]), [2]);
    }
}
