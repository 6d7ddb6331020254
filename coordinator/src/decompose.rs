//! The Precondition Identifier: from a language model's reading to sub-goals in PDDL.
//!
//! The model is told what the scene is like now, and its answer is grounded in that scene; nothing it says
//! becomes a fact of the world.

use std::collections::BTreeSet;
use std::sync::atomic::AtomicBool;
use std::time::Duration;

use lamma_domains::condition::condition as goal;
use lamma_domains::goal::{Content, GoalEntry};
use lamma_domains::view::views;
use lamma_domains::world::{Thing, WorldSetup};
use lamma_lm::{
    Answer, Clarification, Decomposition, LanguageModel, LmError, Request, RobotView, Script, ScriptRequest,
    Subtask,
};
use lamma_pddl::ast::GroundAtom;

use crate::bans::Ban;
use crate::understand::{GoalGroup, GoalItem, ScoreGoal, Subgoal, Understanding, Understood};
use crate::written::{NotWritten, WriteInput};

/// What the person wants and how it is to be read.
#[derive(Clone, Debug)]
pub struct Instruction {
    /// In plain English.
    pub text: String,
    /// Take the best reading instead of asking.
    pub assume: bool,
    /// How long the language model may take.
    pub deadline: Duration,
}

/// Asks the model and grounds its answer in the scene.
pub fn decompose(
    model: &mut dyn LanguageModel,
    world: &WorldSetup,
    facts: &BTreeSet<GroundAtom>,
    instruction: &Instruction,
    cancel: &AtomicBool,
) -> Understood {
    let request = request(world, facts, instruction);
    let decomposition = match model.decompose(&request, cancel) {
        Ok(Answer::Understood(decomposition)) => decomposition,
        Ok(Answer::Clarify(clarification)) => return Understood::Ask(clarification),
        Err(error @ (LmError::Unusable { .. } | LmError::Deadline(_))) => {
            return Understood::NoAnswer(error.to_string());
        }
        Err(error) => return Understood::Failed(error.to_string()),
    };
    match ground(world, &decomposition) {
        Ok(understanding) if understanding.subgoals.is_empty() => {
            Understood::Ask(nothing_to_do(instruction, &decomposition))
        }
        Ok(understanding) => Understood::Yes(understanding),
        Err(why) => Understood::Ask(Clarification {
            question: format!("That does not fit the scene: {why}. What should be done instead?"),
            not_understood: vec![why],
            ..Clarification::default()
        }),
    }
}

/// Has the model write the plan itself.
pub fn write(
    model: &mut dyn LanguageModel,
    world: &WorldSetup,
    input: &WriteInput,
    instruction: &Instruction,
    check: &dyn Fn(&Script) -> Vec<String>,
    cancel: &AtomicBool,
) -> Result<Script, NotWritten> {
    let asked =
        ScriptRequest { request: request(world, &input.facts, instruction), parts: input.parts.clone() };
    model.write(&asked, check, cancel).map_err(|error| match error {
        LmError::Unusable { .. } | LmError::Deadline(_) => NotWritten::Unusable(error.to_string()),
        other => NotWritten::Failed(other.to_string()),
    })
}

fn nothing_to_do(instruction: &Instruction, decomposition: &Decomposition) -> Clarification {
    Clarification {
        question: format!("What should be done? \"{}\" names nothing to do.", instruction.text),
        understood: Vec::new(),
        not_understood: vec![instruction.text.clone()],
        readings: vec![decomposition.clone()],
    }
}

fn request(world: &WorldSetup, facts: &BTreeSet<GroundAtom>, instruction: &Instruction) -> Request {
    let robots = world.members.iter().map(|m| RobotView {
        name: m.name.clone(),
        skills: m.skills.clone(),
        capacity_kg: m.capacity_kg,
    });
    Request {
        instruction: instruction.text.clone(),
        objects: views(world, facts),
        robots: robots.collect(),
        assume: instruction.assume,
        deadline: instruction.deadline,
    }
}

/// Grounds a reading: every goal entry becomes a closed PDDL condition over the scene's objects.
pub fn ground(world: &WorldSetup, decomposition: &Decomposition) -> Result<Understanding, String> {
    let subtasks = &decomposition.subtasks;
    let index = |id: &str| subtasks.iter().position(|s| s.id == id);
    let mut subgoals = Vec::with_capacity(subtasks.len());
    for (i, subtask) in subtasks.iter().enumerate() {
        let after: Vec<usize> = subtask.after.iter().filter_map(|id| index(id)).collect();
        if after.iter().any(|&p| p >= i) {
            return Err(format!("sub-task {} is to follow one that comes later", subtask.id));
        }
        let entries = with_tied(subtask, &subtasks[..i]);
        subgoals.push(Subgoal {
            id: subtask.id.clone(),
            text: subtask.text.clone(),
            goal: goal(&entries, world).map_err(|e| e.to_string())?.condition(),
            after,
            lasting: subtask.lasting,
            advice: subtask.robots.clone(),
        });
    }
    let lasting: Vec<GoalEntry> =
        subtasks.iter().filter(|s| s.lasting).flat_map(|s| s.goal.iter().cloned()).collect();
    Ok(Understanding {
        goal: if lasting.is_empty() { ScoreGoal::default() } else { score_goal(world, &lasting)? },
        subgoals,
        assumptions: decomposition.assumptions.clone(),
        bans: decomposition.bans.iter().flat_map(|ban| bans(world, ban)).collect(),
    })
}

/// A ban on a type or an object, for each object it is about.
fn bans(world: &WorldSetup, ban: &lamma_lm::Ban) -> Vec<Ban> {
    let named = |said: &str| -> Vec<String> {
        let is_meant = |thing: &&Thing| thing.name.eq_ignore_ascii_case(said) || thing.kind == said;
        world.things.iter().filter(is_meant).map(|thing| thing.name.clone()).collect()
    };
    let items: Vec<Option<String>> = match &ban.item {
        Some(item) => named(item).into_iter().map(Some).collect(),
        None => vec![None],
    };
    let of = |object: String| {
        items.iter().map(move |item| Ban {
            skill: ban.skill.clone(),
            object: object.clone(),
            item: item.clone(),
        })
    };
    named(&ban.object).into_iter().flat_map(of).collect()
}

/// The goal of a sub-task with what earlier ones demand of the same objects: "wash the fork, put it in the
/// bowl" is about one fork, and the robot that puts it must know which.
fn with_tied(subtask: &Subtask, earlier: &[Subtask]) -> Vec<GoalEntry> {
    let marks: BTreeSet<&str> = subtask.goal.iter().flat_map(marks).collect();
    let tied = |entry: &&GoalEntry| self::marks(entry).iter().any(|m| marks.contains(m));
    let mut entries = subtask.goal.clone();
    for entry in earlier.iter().filter(|s| s.lasting).flat_map(|s| &s.goal).filter(tied) {
        if !entries.contains(entry) {
            entries.push(entry.clone());
        }
    }
    entries
}

/// All marks of an entry, those of what it contains included.
fn marks(entry: &GoalEntry) -> Vec<&str> {
    let inner = entry.contains.iter().flat_map(|content| match content {
        Content::Named(_) => Vec::new(),
        Content::With(inner) => marks(inner),
    });
    entry.same.as_deref().into_iter().chain(inner).collect()
}

/// A task's goal entries as what an outcome is judged by.
pub fn score_goal(world: &WorldSetup, entries: &[GoalEntry]) -> Result<ScoreGoal, String> {
    let groups = goal(entries, world).map_err(|e| e.to_string())?.groups;
    Ok(ScoreGoal { groups: groups.into_iter().map(score_group).collect() })
}

fn score_group(group: lamma_domains::condition::GoalGroup) -> GoalGroup {
    let items = group.facts.into_iter().map(|fact| GoalItem { text: fact.text, condition: fact.condition });
    GoalGroup { items: items.collect(), joint: group.joint }
}

/// An understanding from goal entries alone: each independent part is a sub-task, and none has to wait.
pub fn given(world: &WorldSetup, entries: &[GoalEntry]) -> Result<Understanding, String> {
    let goal = score_goal(world, entries)?;
    let subgoals = goal.groups.iter().enumerate().map(|(i, group)| Subgoal {
        id: format!("s{}", i + 1),
        text: group.items.iter().map(|item| item.text.as_str()).collect::<Vec<_>>().join(", "),
        goal: group.joint.clone(),
        after: Vec::new(),
        lasting: true,
        advice: Vec::new(),
    });
    Ok(Understanding { subgoals: subgoals.collect(), goal, assumptions: Vec::new(), bans: Vec::new() })
}
