//! What the instruction means: sub-goals with their order, and the goal that shall hold at the end.

use lamma_lm::Clarification;
use lamma_pddl::ast::Condition;

use crate::bans::Ban;
use crate::result::GoalResult;

/// A sub-task with its goal in PDDL.
#[derive(Clone, Debug, PartialEq)]
pub struct Subgoal {
    /// `s1`, `s2`, …
    pub id: String,
    /// In words.
    pub text: String,
    /// What holds when it is done.
    pub goal: Condition,
    /// Sub-goals, by index, that are reached before this one.
    pub after: Vec<usize>,
    /// Whether it shall still hold at the end.
    pub lasting: bool,
    /// Robots that a language model named, as advice.
    pub advice: Vec<String>,
}

/// One fact of the goal, for counting.
#[derive(Clone, Debug, PartialEq)]
pub struct GoalItem {
    /// In words.
    pub text: String,
    /// In PDDL, closed.
    pub condition: Condition,
}

/// Facts that speak of the same objects.
#[derive(Clone, Debug, PartialEq)]
pub struct GoalGroup {
    /// Each by itself.
    pub items: Vec<GoalItem>,
    /// All of them together, of the same objects.
    pub joint: Condition,
}

/// What the outcome is judged by.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct ScoreGoal {
    /// Its independent parts.
    pub groups: Vec<GoalGroup>,
}

impl ScoreGoal {
    /// The whole goal.
    pub fn joint(&self) -> Condition {
        Condition::And(self.groups.iter().map(|g| g.joint.clone()).collect())
    }

    /// Counts what holds. Where each fact of a group holds, but of different objects, one is missing: the
    /// count is full exactly when the goal is reached.
    pub fn judge(&self, holds: impl Fn(&Condition) -> bool) -> GoalResult {
        let mut result = GoalResult::default();
        for group in &self.groups {
            let missing: Vec<&GoalItem> = group.items.iter().filter(|i| !holds(&i.condition)).collect();
            result.total += group.items.len();
            result.reached += group.items.len() - missing.len();
            result.missing.extend(missing.iter().map(|i| i.text.clone()));
            if missing.is_empty() && !holds(&group.joint) {
                result.reached = result.reached.saturating_sub(1);
                let texts: Vec<&str> = group.items.iter().map(|i| i.text.as_str()).collect();
                result.missing.push(format!("of the same objects: {}", texts.join(", ")));
            }
        }
        result
    }
}

/// An understood instruction.
#[derive(Clone, Debug, PartialEq)]
pub struct Understanding {
    /// The sub-tasks, every `after` pointing backwards.
    pub subgoals: Vec<Subgoal>,
    /// The goal in words and PDDL.
    pub goal: ScoreGoal,
    /// What was taken for granted.
    pub assumptions: Vec<String>,
    /// What nobody may do on the way.
    pub bans: Vec<Ban>,
}

impl Understanding {
    /// The same as one task: what is reached on the way, and in which order, is lost.
    pub fn undivided(self) -> Self {
        let lasting = || self.subgoals.iter().filter(|s| s.lasting);
        let texts: Vec<&str> = lasting().map(|s| s.text.as_str()).collect();
        let mut advice: Vec<String> = lasting().flat_map(|s| s.advice.clone()).collect();
        advice.sort();
        advice.dedup();
        let whole = Subgoal {
            id: "s1".into(),
            text: texts.join(", "),
            goal: self.final_goal(),
            after: Vec::new(),
            lasting: true,
            advice,
        };
        Understanding { subgoals: vec![whole], ..self }
    }

    /// Everything that shall hold at the end.
    pub fn final_goal(&self) -> Condition {
        Condition::And(self.subgoals.iter().filter(|s| s.lasting).map(|s| s.goal.clone()).collect())
    }
}

/// How the attempt to understand ended.
#[derive(Clone, Debug, PartialEq)]
pub enum Understood {
    /// Act on this.
    Yes(Understanding),
    /// Ask first.
    Ask(Clarification),
    /// The model's answers cannot be used and nothing is to step in for it.
    NoAnswer(String),
    /// Neither model nor fall-back could be asked.
    Failed(String),
}
