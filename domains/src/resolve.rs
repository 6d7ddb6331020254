//! Which objects of a world a word of a goal can mean.

use crate::goal_error::{GoalProblem, GoalProblemKind};
use crate::kinds::Kinds;
use crate::nearest;
use crate::world::{Thing, WorldSetup};

/// The objects that a word can mean.
#[derive(Clone, Debug)]
pub(crate) struct Candidates<'a> {
    /// The type, spelt as AI2-THOR does.
    pub kind: &'a str,
    /// The objects, in order; never empty.
    pub things: Vec<&'a Thing>,
    /// For people: the type, or the object's name.
    pub label: String,
}

impl<'a> Candidates<'a> {
    /// Those for which the test holds, or the problem if none is left.
    pub fn retain(
        mut self,
        test: impl Fn(&Thing) -> bool,
        problem: impl FnOnce(&Self) -> GoalProblem,
    ) -> Result<Self, GoalProblem> {
        if !self.things.iter().any(|t| test(t)) {
            return Err(problem(&self));
        }
        self.things.retain(|t| test(t));
        Ok(self)
    }
}

/// The basins are what holds things in most sinks and bathtubs.
pub(crate) fn is_a(kind: &str, asked: &str) -> bool {
    kind == asked || matches!((kind, asked), ("SinkBasin", "Sink") | ("BathtubBasin", "Bathtub"))
}

/// The objects that `word`, a type or an object's name in any case, can mean.
pub(crate) fn resolve<'a>(
    setup: &'a WorldSetup,
    word: &str,
    path: &str,
) -> Result<Candidates<'a>, GoalProblem> {
    let table = Kinds::get();
    if let Some(thing) = setup.thing(word) {
        return Ok(Candidates { kind: &thing.kind, things: vec![thing], label: thing.name.clone() });
    }
    let spelt = |name: &str| table.names().find(|k| k.eq_ignore_ascii_case(name)).map(|k| table.whole(k));
    if let Some(kind) = spelt(word) {
        let things: Vec<&Thing> = setup.things.iter().filter(|t| is_a(&t.kind, kind)).collect();
        if things.is_empty() {
            let what = format!("{} has no {kind}", setup.scene);
            return Err(GoalProblem::new(GoalProblemKind::Absent, path, what));
        }
        return Ok(Candidates { kind, things, label: kind.to_string() });
    }
    let prefix = word.rsplit_once('_').and_then(|(kind, _)| spelt(kind));
    if let Some(kind) = prefix {
        let there: Vec<&str> =
            setup.things.iter().filter(|t| t.kind == kind).map(|t| t.name.as_str()).collect();
        let there = if there.is_empty() { format!("no {kind}") } else { there.join(", ") };
        let what = format!("{} has no `{word}`; it has {there}", setup.scene);
        return Err(GoalProblem::new(GoalProblemKind::Absent, path, what));
    }
    let here = setup.things.iter().map(|t| t.kind.as_str());
    let hint = nearest::hint(word, here.chain(table.names()));
    let what = format!("unknown object type `{word}`{hint}");
    Err(GoalProblem::new(GoalProblemKind::Unknown, path, what))
}
