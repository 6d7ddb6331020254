//! What the data folder tells of types and floor plans, and the request that a task makes of it.

use std::collections::BTreeMap;
use std::path::Path;
use std::time::Duration;

use lamma_lm::{ObjectView, Request};
use serde_json::Value;

use crate::{Failure, strict};

/// What is known of types and floor plans.
pub struct Facts {
    affordances: Value,
    constants: Value,
    layouts: Value,
}

impl Facts {
    /// Reads them.
    pub fn read(folder: &Path) -> Result<Self, Failure> {
        let read = |name: &str| -> Result<Value, Failure> {
            Ok(serde_json::from_slice(&std::fs::read(folder.join("ai2thor").join(name))?)?)
        };
        Ok(Self {
            affordances: read("object_affordances.json")?["types"].clone(),
            constants: read("alfred_constants.json")?["data"].clone(),
            layouts: read("alfred_layouts_v2.1.json")?["floor_plans"].clone(),
        })
    }

    /// A sentence in the scene of its task.
    pub fn request(&self, task: &Value, sentence: &str) -> Request {
        let plan = task["floor_plan"].as_str().unwrap_or_default().trim_start_matches("FloorPlan");
        let layout = &self.layouts[plan];
        let mut counts: BTreeMap<String, u64> = BTreeMap::new();
        for (kind, count) in task["object_counts"].as_object().into_iter().flatten() {
            counts.insert(kind.clone(), count.as_u64().unwrap_or(1));
        }
        for kind in layout["object_types"].as_array().into_iter().flatten().filter_map(Value::as_str) {
            if self.affordances[kind]["pickupable"] != Value::Bool(true) && kind != "Glassbottle" {
                let poses = layout["receptacle_standing_pose"].as_object();
                let receptacles = poses
                    .map_or(0, |poses| poses.keys().filter(|id| id.split('|').next() == Some(kind)).count());
                counts.insert(kind.to_owned(), receptacles.max(1) as u64);
            }
        }
        for kind in
            ["toggle_target", "parent_target"].map(|key| task["goal"][key].as_str().unwrap_or_default())
        {
            if !kind.is_empty() {
                counts.entry(kind.to_owned()).or_insert(1);
            }
        }
        let mut objects = Vec::new();
        for (kind, count) in counts {
            for number in 1..=count {
                objects.push(self.object(&kind, number));
            }
        }
        Request {
            instruction: sentence.to_owned(),
            objects,
            robots: Vec::new(),
            assume: !strict(),
            deadline: Duration::from_secs(5),
        }
    }

    fn object(&self, kind: &str, number: u64) -> ObjectView {
        const AFFORDANCES: [&str; 12] = [
            "pickupable",
            "receptacle",
            "openable",
            "toggleable",
            "sliceable",
            "cookable",
            "breakable",
            "dirtyable",
            "canFillWithLiquid",
            "canBeUsedUp",
            "isHeatSource",
            "isColdSource",
        ];
        let known = &self.affordances[kind];
        let mut affordances: Vec<String> =
            AFFORDANCES.iter().filter(|a| known[**a] == Value::Bool(true)).map(|a| (*a).to_owned()).collect();
        let lists = &self.constants["VAL_RECEPTACLE_OBJECTS"];
        let list = if kind.ends_with("Table") { "TableTop" } else { kind };
        let accepts: Vec<String> = lists[list]
            .as_array()
            .into_iter()
            .flatten()
            .filter_map(Value::as_str)
            .map(str::to_owned)
            .collect();
        if !accepts.is_empty() && !affordances.iter().any(|a| a == "receptacle") {
            affordances.push("receptacle".to_owned());
        }
        if kind == "Glassbottle" {
            affordances.push("pickupable".to_owned());
        }
        ObjectView {
            name: format!("{kind}_{number}"),
            kind: kind.to_owned(),
            affordances,
            accepts,
            ..ObjectView::default()
        }
    }
}
