//! A grounded task as text, in the finite-domain format that Fast Downward's search reads ("Translator output
//! format", version 3; Helmert, "Concise finite-domain representations for PDDL planning tasks", AIJ 173,
//! 2009). For people who want to look at a task, or to give it to another search.

use std::collections::BTreeMap;
use std::fmt::{self, Write};

use crate::task::{FactId, OperatorId, Task};

/// The task. Costs are rounded to whole numbers, as the format has no others. Mutex groups beyond the
/// variables are not listed; no search needs them.
pub fn write_sas(task: &Task) -> String {
    let mut out = String::new();
    // Writing to a string does not fail.
    let _ = Writer { task, out: &mut out, layer: layers(task) }.all();
    out
}

/// The axiom layer of each derived variable.
fn layers(task: &Task) -> BTreeMap<u32, usize> {
    let of = |(layer, range): (usize, &std::ops::Range<usize>)| {
        task.axioms[range.clone()].iter().map(move |axiom| (task.facts[axiom.head.index()].variable, layer))
    };
    task.axiom_layers.iter().enumerate().flat_map(of).collect()
}

struct Writer<'a> {
    task: &'a Task,
    out: &'a mut String,
    layer: BTreeMap<u32, usize>,
}

impl Writer<'_> {
    fn all(&mut self) -> fmt::Result {
        let task = self.task;
        writeln!(self.out, "begin_version\n3\nend_version")?;
        writeln!(self.out, "begin_metric\n{}\nend_metric", u8::from(task.has_costs))?;
        self.variables()?;
        writeln!(self.out, "0")?;
        writeln!(self.out, "begin_state")?;
        for variable in 0..task.variables.len() as u32 {
            writeln!(self.out, "{}", self.initial(variable))?;
        }
        writeln!(self.out, "end_state\nbegin_goal\n{}", task.goal.len())?;
        for fact in &task.goal {
            writeln!(self.out, "{}", self.pair(*fact))?;
        }
        writeln!(self.out, "end_goal\n{}", task.operators.len())?;
        (0..task.operators.len() as u32).try_for_each(|o| self.operator(OperatorId(o)))?;
        writeln!(self.out, "{}", task.axioms.len())?;
        (0..task.axioms.len()).try_for_each(|a| self.axiom(a))
    }

    fn value(&self, fact: FactId) -> u32 {
        fact.0 - self.task.variables[self.task.facts[fact.index()].variable as usize].first.0
    }

    fn pair(&self, fact: FactId) -> String {
        format!("{} {}", self.task.facts[fact.index()].variable, self.value(fact))
    }

    /// A derived variable starts with the value that no rule gives it.
    fn initial(&self, variable: u32) -> u32 {
        let derived = self.task.axioms.iter().find(|a| self.task.facts[a.head.index()].variable == variable);
        match derived {
            Some(axiom) => 1 - self.value(axiom.head).min(1),
            None => self.value(self.task.variables[variable as usize].fact(&self.task.init)),
        }
    }

    fn variables(&mut self) -> fmt::Result {
        writeln!(self.out, "{}", self.task.variables.len())?;
        for (number, variable) in self.task.variables.iter().enumerate() {
            let layer = self.layer.get(&(number as u32)).map_or(-1, |l| *l as i64);
            writeln!(self.out, "begin_variable\nvar{number}\n{layer}\n{}", variable.size)?;
            for value in 0..variable.size {
                writeln!(self.out, "{}", self.atom(FactId(variable.first.0 + value)))?;
            }
            writeln!(self.out, "end_variable")?;
        }
        Ok(())
    }

    /// `Atom in(apple, fridge)`, as the format writes facts.
    fn atom(&self, fact: FactId) -> String {
        match self.task.literal(fact) {
            Some(literal) => {
                let args: Vec<&str> = literal.atom.args.iter().map(|a| a.as_str()).collect();
                let sign = if literal.holds { "Atom" } else { "NegatedAtom" };
                format!("{sign} {}({})", literal.atom.predicate, args.join(", "))
            }
            None => "<none of those>".into(),
        }
    }

    fn operator(&mut self, operator: OperatorId) -> fmt::Result {
        let task = self.task;
        let effects: Vec<(&[FactId], FactId)> = task
            .effects(operator)
            .iter()
            .map(|fact| (&[][..], *fact))
            .chain(task.conditional_effects(operator))
            .collect();
        let of = |fact: FactId| task.facts[fact.index()].variable;
        let before = |variable: u32| task.preconditions(operator).iter().find(|p| of(**p) == variable);
        let prevail: Vec<&FactId> = task
            .preconditions(operator)
            .iter()
            .filter(|p| effects.iter().all(|(_, e)| of(*e) != of(**p)))
            .collect();
        let name = task.act(operator).to_string();
        let name = name.trim_start_matches('(').trim_end_matches(')');
        writeln!(self.out, "begin_operator\n{name}\n{}", prevail.len())?;
        for fact in prevail {
            writeln!(self.out, "{}", self.pair(*fact))?;
        }
        writeln!(self.out, "{}", effects.len())?;
        for (condition, effect) in &effects {
            write!(self.out, "{}", condition.len())?;
            for fact in *condition {
                write!(self.out, " {}", self.pair(*fact))?;
            }
            let pre = before(of(*effect)).map_or("-1".to_string(), |p| self.value(*p).to_string());
            writeln!(self.out, " {} {pre} {}", of(*effect), self.value(*effect))?;
        }
        writeln!(self.out, "{}\nend_operator", task.operators[operator.index()].cost.round())
    }

    fn axiom(&mut self, number: usize) -> fmt::Result {
        let axiom = self.task.axioms[number];
        let body = self.task.axiom_bodies.row(axiom.body as usize);
        writeln!(self.out, "begin_rule\n{}", body.len())?;
        for fact in body {
            writeln!(self.out, "{}", self.pair(*fact))?;
        }
        let (variable, value) = (self.task.facts[axiom.head.index()].variable, self.value(axiom.head));
        writeln!(self.out, "{variable} {} {value}\nend_rule", 1 - value.min(1))
    }
}
