//! What a shortest schedule needs at all: operators that only others make superfluous are left out.
//!
//! From the goal backwards, every maker of a literal that something relevant relies on is relevant. Two kinds
//! of makers count only if their operator is relevant for another reason:
//!
//! - *Outdone events.* The conditional effect of an operator makes a literal that another operator of the same
//!   agent makes in any case, asking for no more and threatening no more: going to a thing in the fridge in
//!   order to stand at the fridge, where one may go to the fridge itself.
//! - *Round trips.* An operator leads from value g of a variable back to value h, and g can only be reached
//!   from h: putting down what was picked up for nothing in order to have a hand free again.
//!
//! In a schedule that relies on such a maker and on nothing else of its operator, the operator can be replaced
//! by the one that outdoes it, or be left out together with what led to g, step for step. So leaving these out
//! loses no shortest schedule, and the bound stays a bound.

use super::model::{Lit, Maker, Model};

/// What is relevant.
#[derive(Debug)]
pub(super) struct Relevance {
    pub operators: Vec<bool>,
}

struct Search<'a> {
    model: &'a Model,
    lits: Vec<bool>,
    operators: Vec<bool>,
    changed: bool,
    /// What each operator makes, by itself or by an event.
    makes: Vec<Vec<(Lit, Maker)>>,
    /// What each operator threatens, and its excuses.
    threatens: Vec<Vec<(Lit, &'a [Lit])>>,
}

impl Relevance {
    pub fn new(model: &Model) -> Self {
        let operators = model.preconditions.len();
        let mut search = Search {
            model,
            lits: vec![false; model.literals_count()],
            operators: vec![false; operators],
            changed: true,
            makes: vec![Vec::new(); operators],
            threatens: vec![Vec::new(); operators],
        };
        for lit in (0..model.literals_count() as u32).map(Lit) {
            for &maker in &model.makers[lit.index()] {
                search.makes[model.operator_of(maker) as usize].push((lit, maker));
            }
            for threat in &model.threats[lit.index()] {
                search.threatens[threat.operator as usize].push((lit, &threat.harmless_if));
            }
        }
        model.goal.iter().for_each(|lit| search.lits[lit.index()] = true);
        // A guard that holds now may fail when more is needed, so all of it is looked at until nothing changes.
        while std::mem::take(&mut search.changed) {
            for lit in (0..model.literals_count() as u32).map(Lit) {
                if search.lits[lit.index()] {
                    search.visit(lit);
                }
            }
        }
        Relevance { operators: search.operators }
    }
}

impl Search<'_> {
    fn need(&mut self, lits: &[Lit]) {
        for lit in lits {
            self.changed |= !std::mem::replace(&mut self.lits[lit.index()], true);
        }
    }

    fn visit(&mut self, lit: Lit) {
        let model = self.model;
        for body in model.derivations.get(&lit.0).into_iter().flatten() {
            self.need(body);
        }
        for &maker in &model.makers[lit.index()] {
            let operator = model.operator_of(maker);
            if !self.operators[operator as usize] {
                let superfluous = match maker {
                    Maker::Operator(o) => self.is_round_trip(o, lit),
                    Maker::Event(e) => self.is_outdone(e, lit),
                };
                if superfluous {
                    continue;
                }
                self.operators[operator as usize] = true;
                self.changed = true;
                self.need(model.preconditions.row(operator as usize));
            }
            if let Maker::Event(event) = maker {
                self.need(&model.events[event as usize].condition);
            }
        }
        for threat in &model.threats[lit.index()] {
            if self.operators[threat.operator as usize] {
                self.need(&threat.harmless_if);
            }
        }
    }

    fn is_needed(&self, lit: Lit) -> bool {
        self.lits[lit.index()]
    }

    /// Whether the operator only leads back to `back`, from where it must have been left for nothing.
    fn is_round_trip(&self, operator: u32, back: Lit) -> bool {
        let model = self.model;
        let before = model.preconditions.row(operator as usize);
        let Some(&left_to) = before.iter().find(|&&lit| model.excludes(lit, back)) else { return false };
        let leads_away_for_nothing = |maker: &Maker| match *maker {
            Maker::Event(_) => false,
            Maker::Operator(away) => {
                !self.operators[away as usize]
                    && model.preconditions.row(away as usize).contains(&back)
                    && self.makes[away as usize].iter().all(|(lit, _)| !self.is_needed(*lit))
            }
        };
        !model.initially[left_to.index()]
            && !self.is_needed(left_to)
            && model.makers[left_to.index()].iter().all(leads_away_for_nothing)
            && self.makes[operator as usize].iter().all(|(lit, _)| *lit == back || !self.is_needed(*lit))
    }

    /// Whether some operator does for sure what the event does, and all else of use that comes with it.
    fn is_outdone(&self, event: u32, lit: Lit) -> bool {
        let by = |maker: &Maker| match *maker {
            Maker::Operator(other) => self.outdoes(other, event, lit),
            Maker::Event(_) => false,
        };
        self.model.makers[lit.index()].iter().any(by)
    }

    fn outdoes(&self, other: u32, event: u32, lit: Lit) -> bool {
        let model = self.model;
        let condition = &model.events[event as usize].condition;
        let operator = model.events[event as usize].operator;
        let given = |l: &Lit| condition.contains(l) || model.preconditions.row(operator as usize).contains(l);
        if other == operator
            || model.agent_of[other as usize] != model.agent_of[operator as usize]
            || !model.preconditions.row(other as usize).iter().all(given)
            || self.is_round_trip(other, lit)
        {
            return false;
        }
        let also_made = |(made, maker): &(Lit, Maker)| {
            if !self.is_needed(*made) || self.makes[other as usize].contains(&(*made, Maker::Operator(other)))
            {
                return true;
            }
            let Maker::Event(e) = *maker else { return false };
            let own = &model.events[e as usize].condition;
            let impossible = own.iter().any(|l| condition.iter().any(|c| model.excludes(*l, *c)));
            let events = self.makes[other as usize].iter().filter(|(l, _)| l == made);
            impossible
                || events.into_iter().any(|(_, m)| match *m {
                    Maker::Event(e) => {
                        model.events[e as usize].condition.iter().all(|l| given(l) || own.contains(l))
                    }
                    Maker::Operator(_) => true,
                })
        };
        let no_worse = |(threatened, excuses): &(Lit, &[Lit])| {
            let mut own = self.threatens[operator as usize].iter().filter(|(l, _)| l == threatened);
            !self.is_needed(*threatened) || own.any(|(_, mine)| mine.iter().all(|l| excuses.contains(l)))
        };
        self.makes[operator as usize].iter().all(also_made)
            && self.threatens[other as usize].iter().all(no_worse)
    }
}
