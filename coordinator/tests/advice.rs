//! The language model's own allocation, taken as it is (`--allocator lm`) and as advice only, with the model's
//! answer from a cassette.

#![allow(clippy::unwrap_used, reason = "a test that cannot go on says so by panicking")]

use std::path::Path;
use std::sync::Arc;
use std::sync::atomic::AtomicBool;
use std::time::{Duration, Instant};

use lamma_coordinator::allocate::allocate;
use lamma_coordinator::allocation::{AllocateInput, Allocation, Cut, NoAllocation};
use lamma_coordinator::decompose::{Instruction, decompose};
use lamma_coordinator::house::team;
use lamma_coordinator::{AllocationRule, Understanding, Understood};
use lamma_domains::tasks::Task;
use lamma_domains::world::WorldSetup;
use lamma_lm::cassette::{Record, Replay};
use lamma_lm::chat::{ChatModel, Reply, Transport, TransportError};
use serde_json::{Value, json};

/// A model that always says the same.
struct Says(String);

impl Transport for Says {
    fn send(&mut self, _: &Value, _: Instant, _: &AtomicBool) -> Result<Reply, TransportError> {
        Ok(Reply { content: self.0.clone(), usage: None })
    }
}

/// The robot that can go and switch only, and two that can carry.
fn kitchen() -> WorldSetup {
    let task: Task = serde_json::from_value(json!({
        "id": "advice", "scene": "FloorPlan6", "instruction": "-", "team": ["robot1", "robot2", "robot24"],
        "goal": [{"object": "LightSwitch", "is": {"isToggled": false}}]
    }))
    .unwrap();
    task.world(0).unwrap().0
}

/// Asks the model twice, with a recorder in between and then from the recording alone.
fn understood(world: &WorldSetup, answer: Value, cassette: &Path) -> Understanding {
    let facts = world.facts().cloned().collect();
    let instruction = Instruction {
        text: "Put the apple in the sink and switch the light off.".into(),
        assume: false,
        deadline: Duration::from_secs(10),
    };
    let never = AtomicBool::new(false);
    let mut ask =
        |model: &mut dyn lamma_lm::LanguageModel| match decompose(model, world, &facts, &instruction, &never)
        {
            Understood::Yes(understanding) => understanding,
            other => panic!("not understood: {other:?}"),
        };
    let recorder = Record::new(Says(answer.to_string()), cassette).unwrap();
    let live = ask(&mut ChatModel::new(recorder, "scripted".into(), 0, 7));
    let replay = Replay::read(cassette).unwrap();
    let replayed = ask(&mut ChatModel::new(replay, "scripted".into(), 0, 7));
    assert_eq!(live, replayed);
    replayed
}

fn allocated(
    world: &WorldSetup,
    understanding: &Understanding,
    rule: AllocationRule,
) -> Result<Allocation, NoAllocation> {
    let input = AllocateInput {
        cut: Cut::default(),
        rule,
        team: Arc::new(team(world)),
        available: (0..world.members.len()).collect(),
        facts: world.facts().cloned().collect(),
        final_goal: understanding.final_goal(),
        subgoals: understanding.subgoals.clone(),
        excluded: Default::default(),
        expansions: 2_000,
    };
    allocate(&input, &AtomicBool::new(false))
}

/// An answer that gives the carrying and the switching to these robots.
fn answer(carries: &str, switches: &str) -> Value {
    json!({"subtasks": [
        {"id": "s1", "text": "apple", "goal": [{"object": "Sink", "contains": ["Apple"]}], "after": [],
         "robots": [carries], "lasting": true},
        {"id": "s2", "text": "light", "goal": [{"object": "LightSwitch", "is": {"isToggled": false}}],
         "after": [], "robots": [switches], "lasting": true}
    ], "assumptions": [], "confidence": 0.9})
}

#[test]
fn what_the_model_gives_to_whom_is_followed_only_where_that_is_asked_for() {
    let folder = std::env::temp_dir().join(format!("lamma-advice-{}", std::process::id()));
    std::fs::create_dir_all(&folder).unwrap();
    let world = kitchen();

    // Both to one robot: possible, and slower than to two.
    let both = understood(&world, answer("robot1", "robot1"), &folder.join("both.jsonl"));
    let followed = allocated(&world, &both, AllocationRule::AsAdvised).unwrap();
    assert_eq!((followed.members_of(0), followed.members_of(1)), (vec![0], vec![0]));
    let shortest = allocated(&world, &both, AllocationRule::Shortest).unwrap();
    assert_ne!(shortest.members_of(0), shortest.members_of(1));

    // The carrying to the robot that cannot carry: taken as it is it fails, and says so.
    let wrong = understood(&world, answer("robot24", "robot1"), &folder.join("wrong.jsonl"));
    match allocated(&world, &wrong, AllocationRule::AsAdvised) {
        Err(NoAllocation::GaveUp(why)) => assert!(why.contains("given to robot24"), "{why}"),
        other => panic!("{other:?}"),
    }
    let mended = allocated(&world, &wrong, AllocationRule::Shortest).unwrap();
    assert!(!mended.members_of(0).contains(&2), "robot24 cannot carry");
    std::fs::remove_dir_all(&folder).unwrap();
}
