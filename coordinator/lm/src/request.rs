//! What a language model is told: the instruction, the scene as it is now, and the team.

use std::time::Duration;

use serde::{Deserialize, Serialize};

/// A question.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Request {
    /// What the person said.
    pub instruction: String,
    /// The objects of the scene.
    pub objects: Vec<ObjectView>,
    /// The team.
    pub robots: Vec<RobotView>,
    /// Take the best reading instead of asking.
    pub assume: bool,
    /// How long the answer may take.
    pub deadline: Duration,
}

/// An object as it is now.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct ObjectView {
    /// `Apple_1`
    pub name: String,
    /// `Apple`
    pub kind: String,
    /// The objects it lies in or on.
    pub parents: Vec<String>,
    /// Affordances by their AI2-THOR names: `pickupable`, `receptacle`, `openable`, `toggleable`,
    /// `sliceable`, `cookable`, `breakable`, `dirtyable`, `canFillWithLiquid`, `canBeUsedUp`,
    /// `isHeatSource`, `isColdSource`.
    pub affordances: Vec<String>,
    /// Properties that hold now, by their AI2-THOR names: `isOpen`, `isToggled`, `isDirty`, …
    pub states: Vec<String>,
    /// Object types it can hold, if a receptacle.
    pub accepts: Vec<String>,
    /// Materials: `Metal`, `Food`, …
    pub materials: Vec<String>,
    /// Mass in kilograms; 0 for what is fixed.
    pub mass_kg: f64,
}

/// A member of the team.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct RobotView {
    /// `robot1`
    pub name: String,
    /// The skills it has.
    pub skills: Vec<String>,
    /// The heaviest thing it can lift, in kilograms.
    pub capacity_kg: f64,
}
