//! Shows what the embedded default makes of sentences: `read FOLDER FLOORPLAN SENTENCE...`, with the facts of
//! `FOLDER/ai2thor` for the scene, or our own scene of that name if the folder is `own`; `-` reads the sentences from
//! standard input, one a line.

use std::collections::BTreeMap;
use std::io::BufRead;
use std::path::Path;
use std::time::Duration;

use lamma_lm::{Answer, ObjectView, Offline, Request};
use serde_json::Value;

type Failure = Box<dyn std::error::Error>;

fn main() -> Result<(), Failure> {
    let arguments: Vec<String> = std::env::args().skip(1).collect();
    let [folder, plan, sentences @ ..] = arguments.as_slice() else {
        return Err("usage: read FOLDER FLOORPLAN SENTENCE...".into());
    };
    let objects = if folder == "own" {
        let world = lamma_domains::world::setup(plan, &[], None, 0)?;
        lamma_domains::view::views(&world, world.facts())
    } else {
        objects(Path::new(folder), plan)?
    };
    let offline = match std::env::var_os("LEXICON") {
        Some(folder) => Offline::from_folder(Path::new(&folder))?,
        None => Offline::new()?,
    };
    let lines: Vec<String> = if sentences == ["-"] {
        std::io::stdin().lock().lines().collect::<Result<_, _>>()?
    } else {
        sentences.to_vec()
    };
    for sentence in lines {
        let request = Request {
            instruction: sentence.clone(),
            objects: objects.clone(),
            robots: Vec::new(),
            assume: false,
            deadline: Duration::from_secs(5),
        };
        println!("\n> {sentence}");
        match offline.read(&request) {
            Answer::Understood(decomposition) => {
                println!("  confidence {:.2}", decomposition.confidence);
                for subtask in &decomposition.subtasks {
                    let goal = serde_json::to_string(&subtask.goal)?;
                    let lasting = if subtask.lasting { "" } else { " (undone later)" };
                    println!(
                        "  {} after {:?}{lasting}: {goal}   [{}]",
                        subtask.id, subtask.after, subtask.text
                    );
                }
                for assumption in &decomposition.assumptions {
                    println!("  - {assumption}");
                }
            }
            Answer::Clarify(clarification) => {
                println!("  ASKS {}", clarification.question);
                println!("  not understood: {:?}", clarification.not_understood);
                for reading in &clarification.readings {
                    for subtask in &reading.subtasks {
                        println!(
                            "    perhaps {:.2} {}",
                            reading.confidence,
                            serde_json::to_string(&subtask.goal)?
                        );
                    }
                }
            }
        }
    }
    Ok(())
}

fn objects(folder: &Path, plan: &str) -> Result<Vec<ObjectView>, Failure> {
    let read = |name: &str| -> Result<Value, Failure> {
        Ok(serde_json::from_slice(&std::fs::read(folder.join("ai2thor").join(name))?)?)
    };
    let affordances = read("object_affordances.json")?["types"].clone();
    let accepted = read("alfred_constants.json")?["data"]["VAL_RECEPTACLE_OBJECTS"].clone();
    let plans = read("floorplan_objects.json")?["floor_plans"].clone();
    let counts: BTreeMap<String, Value> =
        plans[plan]["objects"].as_object().ok_or("no such floor plan")?.clone().into_iter().collect();
    let mut objects = Vec::new();
    for (kind, fact) in counts {
        let list = if kind.ends_with("Table") { "TableTop" } else { &kind };
        for number in 1..=fact["count"].as_u64().unwrap_or(1) {
            let known = affordances[&kind].as_object().into_iter().flatten();
            objects.push(ObjectView {
                name: format!("{kind}_{number}"),
                kind: kind.clone(),
                affordances: known
                    .filter(|(_, v)| **v == Value::Bool(true))
                    .map(|(k, _)| k.clone())
                    .collect(),
                accepts: accepted[list]
                    .as_array()
                    .into_iter()
                    .flatten()
                    .filter_map(Value::as_str)
                    .map(str::to_owned)
                    .collect(),
                ..ObjectView::default()
            });
        }
    }
    Ok(objects)
}
