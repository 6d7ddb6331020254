//! The 120 floor plans of iTHOR as data: which objects there are, where they stand, and what is known of them.
//!
//! Ten plans are measured object by object; of the others the object types and the receptacles are known, and
//! the rest is placed by rule and seed (see [`crate::place`]). Every scene says which it is.

use std::collections::BTreeMap;

use serde::{Deserialize, Serialize};

use crate::goal::PropertyValue;
use crate::{HouseError, nearest};

/// How an object came to where it is.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum Placed {
    /// Taken from AI2-THOR's own metadata.
    Measured,
    /// Placed by rule and seed.
    Rule,
}

/// An object of a scene.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct SceneObject {
    /// `Apple_1`
    pub name: String,
    /// `Apple`
    #[serde(rename = "type")]
    pub kind: String,
    /// In kilograms; 0 for what is fixed.
    #[serde(default)]
    pub mass_kg: f64,
    /// Its affordances where they differ from its type's.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub affordances: Option<Vec<String>>,
    /// Metres: x, height, z.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub at: Option<[f64; 3]>,
    /// What it lies in or on; for furniture and fixtures only of interest to people.
    #[serde(default, rename = "in", skip_serializing_if = "Option::is_none")]
    pub parent: Option<String>,
    /// Properties that are not as usual, by their AI2-THOR names.
    #[serde(default, skip_serializing_if = "BTreeMap::is_empty")]
    pub is: BTreeMap<String, PropertyValue>,
    /// The burners a knob controls.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub controls: Vec<String>,
    /// The basins a tap runs into.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub fills: Vec<String>,
    /// Where this differs from the scene's.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub placed: Option<Placed>,
    /// Where one stands at it, on a cell of the floor: x and z in metres. Only of what does not move.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub stand: Option<[f64; 2]>,
}

/// Where one can walk: a grid of cells.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Grid {
    /// The first cell of the first row: x and z in metres.
    pub corner: [f64; 2],
    /// One row for each z, one letter for each x: `.` can be walked on, `#` cannot.
    pub rows: Vec<String>,
}

/// The side of a cell in metres, as AI2-THOR's agents step.
pub const CELL_M: f64 = 0.25;

/// A floor plan.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Scene {
    /// `FloorPlan6`
    pub scene: String,
    /// `kitchen`, `living room`, `bedroom` or `bathroom`.
    pub room: String,
    /// How its objects came to where they are.
    pub placed: Placed,
    /// What is measured and what is not, in words.
    pub about: String,
    /// Its floor.
    pub floor: Grid,
    /// Its objects, by type and number.
    pub objects: Vec<SceneObject>,
}

macro_rules! files {
    ($($number:literal)*) => {
        &[$(($number, include_str!(concat!("../household/scenes/FloorPlan", $number, ".json")))),*]
    };
}

const FILES: &[(u32, &str)] = files! {
    1 2 3 4 5 6 7 8 9 10 11 12 13 14 15 16 17 18 19 20 21 22 23 24 25 26 27 28 29 30 201 202 203 204
    205 206 207 208 209 210 211 212 213 214 215 216 217 218 219 220 221 222 223 224 225 226 227 228
    229 230 301 302 303 304 305 306 307 308 309 310 311 312 313 314 315 316 317 318 319 320 321 322
    323 324 325 326 327 328 329 330 401 402 403 404 405 406 407 408 409 410 411 412 413 414 415 416
    417 418 419 420 421 422 423 424 425 426 427 428 429 430
};

/// The names of all scenes, by number.
pub fn names() -> Vec<String> {
    FILES.iter().map(|(number, _)| format!("FloorPlan{number}")).collect()
}

/// The scene of that name.
pub fn load(name: &str) -> Result<Scene, HouseError> {
    let found = name.strip_prefix("FloorPlan").and_then(|n| FILES.iter().find(|(m, _)| m.to_string() == n));
    match found {
        Some((_, text)) => Ok(serde_json::from_str(text).expect("every embedded scene is read by a test")),
        None => {
            let names = names();
            let hint = nearest::hint(name, names.iter().map(String::as_str));
            Err(HouseError::UnknownScene { name: name.to_string(), hint })
        }
    }
}
