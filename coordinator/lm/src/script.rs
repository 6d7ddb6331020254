//! A plan of the whole team as a language model writes it, without a planner: what it is asked and how its answer is
//! read.
//!
//! This is how methods without a planner work (SMART-LLM, chain of thought); they are here to be compared with. A
//! step says when it is done: steps of one number run side by side, and each number waits for all before it, as the
//! joined threads of such methods do. What the world allows is not asked here: the simulator judges.

use std::collections::{BTreeMap, BTreeSet};
use std::fmt::Write;

use lamma_domains::robots::{SKILLS, actions_of, union_domain};
use serde::{Deserialize, Serialize};
use serde_json::{Value, json};

use crate::decode::{LONGEST, json_part, nearest};
use crate::{Request, prompt};

/// More steps are refused.
pub const MOST_STEPS: usize = 400;

/// A sub-task and who is to do it.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub struct Allotted {
    /// In words.
    pub text: String,
    /// The robots that do it; empty where the model is to choose.
    pub robots: Vec<String>,
}

/// What a model is asked to write a plan for.
#[derive(Clone, Debug, PartialEq)]
pub struct ScriptRequest {
    /// The instruction, the scene, the team.
    pub request: Request,
    /// The instruction divided and given out, where that is done.
    pub parts: Vec<Allotted>,
}

/// A step of a plan.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct ScriptStep {
    /// When: after all steps with a smaller number.
    pub at: u32,
    /// Who.
    pub robot: String,
    /// What.
    pub action: String,
    /// With what.
    #[serde(default)]
    pub args: Vec<String>,
}

/// A plan.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Script {
    /// Each robot's steps are in its order.
    pub steps: Vec<ScriptStep>,
}

const SYSTEM: &str = "\
You write the plan of a team of household robots for an instruction: every action of every robot.
Think step by step in \"reasoning\": what shall be true at the end, which robot can do what, which actions in which order.
Answer with one JSON object and nothing else:
{\"reasoning\":\"…\",\"steps\":[{\"at\":0,\"robot\":\"robot1\",\"action\":\"GoToObject\",\"args\":[\"Apple_1\"]},…]}
- \"at\": steps with the same number run at the same time; a step waits for all steps with a smaller number.
- \"args\" are object names of the scene, in the order of the action's parameters, without the robot.
- A robot does only what it has the skill for, and stands at what it acts on: it goes there first.";

/// The messages of the first try.
pub(crate) fn messages(asked: &ScriptRequest, wording: &prompt::Wording) -> Vec<Value> {
    let mut text = prompt::scene(&asked.request, wording);
    if !asked.parts.is_empty() {
        text.push_str("\nSub-tasks and who does them:\n");
        for (index, part) in asked.parts.iter().enumerate() {
            let who = if part.robots.is_empty() { "whoever can".to_string() } else { part.robots.join(", ") };
            let _ = writeln!(text, "{}. {} ({who})", index + 1, part.text);
        }
    }
    text.push_str("\nActions:\n");
    for (action, parameters) in actions(&asked.request) {
        let _ = writeln!(text, "{action} {}", parameters.join(" "));
    }
    if !wording.bare {
        text.push_str("\nWhat they need and do (PDDL):\n");
        let known: BTreeSet<&str> = actions(&asked.request).into_keys().collect();
        for action in union_domain().actions.iter().filter(|a| known.contains(a.name.as_str())) {
            let _ = writeln!(text, "{}: needs {}", action.name, action.precondition);
        }
    }
    vec![json!({"role": "system", "content": SYSTEM}), json!({"role": "user", "content": text})]
}

/// The actions that somebody of the team has, with the names of their parameters after the robot.
fn actions(request: &Request) -> BTreeMap<&'static str, Vec<String>> {
    let skills: BTreeSet<&str> =
        request.robots.iter().flat_map(|r| r.skills.iter().map(String::as_str)).collect();
    let known = actions_of(SKILLS.into_iter().filter(|skill| skills.contains(skill)));
    let own = union_domain().actions.iter().filter(|action| known.contains(action.name.as_str()));
    own.map(|action| {
        let parameter = |p: &lamma_pddl::ast::TypedName| {
            let kind = p.types.first().map_or("object", |t| t.as_str());
            format!("{kind}:{}", p.name.as_str().trim_start_matches('?'))
        };
        (action.name.as_str(), action.params.iter().skip(1).map(parameter).collect())
    })
    .collect()
}

/// The JSON schema of an answer.
pub(crate) fn schema() -> Value {
    let step = json!({
        "type": "object",
        "additionalProperties": false,
        "required": ["at", "robot", "action", "args"],
        "properties": {
            "at": {"type": "integer"},
            "robot": {"type": "string"},
            "action": {"type": "string"},
            "args": {"type": "array", "items": {"type": "string"}}
        }
    });
    json!({
        "type": "object",
        "additionalProperties": false,
        "required": ["reasoning", "steps"],
        "properties": {"reasoning": {"type": "string"}, "steps": {"type": "array", "items": step}}
    })
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct Wire {
    #[serde(default, rename = "reasoning")]
    _reasoning: Option<String>,
    steps: Vec<ScriptStep>,
}

/// The plan in a text, or everything that is wrong with its form, in words a model can act on.
pub fn decode(text: &str, request: &Request) -> Result<Script, Vec<String>> {
    if text.len() > LONGEST {
        return Err(vec![format!("the answer has {} bytes; at most {LONGEST} are read", text.len())]);
    }
    let body = json_part(text).ok_or_else(|| vec!["the answer holds no JSON object".to_owned()])?;
    let wire: Wire =
        serde_json::from_str(body).map_err(|error| vec![format!("not the format asked for: {error}")])?;
    if wire.steps.len() > MOST_STEPS {
        return Err(vec![format!("steps: {} of them; at most {MOST_STEPS}", wire.steps.len())]);
    }
    let mut errors = Vec::new();
    let actions = actions(request);
    let robots: BTreeSet<&str> = request.robots.iter().map(|r| r.name.as_str()).collect();
    let objects: BTreeSet<&str> = request.objects.iter().map(|o| o.name.as_str()).collect();
    let names: BTreeSet<&str> = actions.keys().copied().collect();
    for (index, step) in wire.steps.iter().enumerate() {
        let place = format!("steps[{index}]");
        if !robots.contains(step.robot.as_str()) {
            let hint = nearest(&step.robot, &robots);
            errors.push(format!("{place}.robot: {:?} is not in the team{hint}", step.robot));
        }
        match actions.get(step.action.as_str()) {
            None => {
                let hint = nearest(&step.action, &names);
                errors.push(format!("{place}.action: {:?} is no action of the team{hint}", step.action));
            }
            Some(parameters) if parameters.len() != step.args.len() => errors.push(format!(
                "{place}.args: {} takes {} ({}), not {}",
                step.action,
                parameters.len(),
                parameters.join(" "),
                step.args.len()
            )),
            Some(parameters) => {
                // Liquids, crews and the like are no objects of the scene: the simulator knows them.
                let thing = |p: &String| ["thing:", "item:"].iter().any(|kind| p.starts_with(kind));
                for (arg, _) in step.args.iter().zip(parameters).filter(|(_, p)| thing(p)) {
                    if !objects.contains(arg.as_str()) {
                        let hint = nearest(arg, &objects);
                        errors.push(format!("{place}.args: {arg:?} is no object of this scene{hint}"));
                    }
                }
            }
        }
    }
    if errors.is_empty() { Ok(Script { steps: wire.steps }) } else { Err(errors) }
}

#[cfg(test)]
mod tests {
    use std::time::Duration;

    use super::*;
    use crate::{ObjectView, RobotView};

    fn request() -> Request {
        let object = |name: &str, kind: &str| ObjectView {
            name: name.into(),
            kind: kind.into(),
            ..ObjectView::default()
        };
        Request {
            instruction: "Put the apple in the fridge".into(),
            objects: vec![object("Apple_1", "Apple"), object("Fridge_1", "Fridge")],
            robots: vec![RobotView {
                name: "robot1".into(),
                skills: ["GoToObject", "PickupObject", "PutObject", "FillObject"].map(String::from).to_vec(),
                capacity_kg: 1.0,
            }],
            assume: false,
            deadline: Duration::from_secs(1),
        }
    }

    #[test]
    fn a_plan_is_read_and_what_is_wrong_with_it_is_said() {
        let good = r#"Sure: {"reasoning": "go", "steps": [{"at": 0, "robot": "robot1", "action": "GoToObject", "args": ["Apple_1"]},
            {"at": 1, "robot": "robot1", "action": "FillObject", "args": ["Apple_1", "water"]}]}"#;
        assert_eq!(decode(good, &request()).map(|s| s.steps.len()), Ok(2));
        for (from, to, wanted) in [
            (
                "robot1\", \"action\": \"GoTo",
                "robot2\", \"action\": \"GoTo",
                "steps[0].robot: \"robot2\" is not in the team; did you mean \"robot1\"?",
            ),
            ("GoToObject", "GotoObjekt", "did you mean \"GoToObject\"?"),
            ("GoToObject", "OpenObject", "is no action of the team"),
            ("[\"Apple_1\"]", "[\"Apple_2\"]", "did you mean \"Apple_1\"?"),
            ("[\"Apple_1\"]", "[]", "GoToObject takes 1 (thing:x), not 0"),
            ("\"at\": 0", "\"when\": 0", "unknown field"),
            ("\"at\": 0", "\"at\": -1", "not the format asked for"),
        ] {
            let text = good.replacen(from, to, 1);
            assert_ne!(text, good, "{from}");
            let errors = decode(&text, &request()).expect_err(wanted).join("\n");
            assert!(errors.contains(wanted), "{from} -> {to}: {errors}");
        }
    }

    #[test]
    fn the_model_is_told_the_parts_the_actions_and_on_wish_what_they_need() {
        let parts = vec![Allotted { text: "store the apple".into(), robots: vec!["robot1".into()] }];
        let asked = ScriptRequest { request: request(), parts };
        let told = |bare| {
            messages(&asked, &prompt::Wording { bare, ..Default::default() })[1]["content"].to_string()
        };
        for text in [told(false), told(true)] {
            assert!(text.contains("1. store the apple (robot1)"), "{text}");
            assert!(text.contains("PutObject item:x thing:c") && !text.contains("OpenObject"), "{text}");
        }
        assert!(told(false).contains("hand-free") && !told(true).contains("hand-free"));
    }
}
