//! What a shortest schedule needs at all: operators that only others make superfluous are left out.
//!
//! From the goal backwards, every maker of a literal that something relevant relies on is relevant. Two kinds
//! of makers count only if their operator is relevant for another reason:
//!
//! - *Outdone events.* The conditional effect of an operator makes a literal that another operator of the same
//!   agent makes in any case, asking for no more and threatening no more: going to a thing in the fridge in
//!   order to stand at the fridge, where one may go to the fridge itself.
//! - *Round trips.* An operator leads from g back to h, of which only one holds at a time, and g can only be reached
//!   from h: putting down what was picked up for nothing in order to have a hand free again. That g and h exclude each
//!   other may be said by a variable, or because h is what a robot has to give in order to get any of several things
//!   and gets only for giving one of them back ([`Search::given_for`]).
//!
//! In a schedule that relies on such a maker and on nothing else of its operator, the operator can be replaced
//! by the one that outdoes it, or be left out together with what led to g, step for step. So leaving these out
//! loses no shortest schedule, and the bound stays a bound.

use std::collections::{BTreeMap, BTreeSet};

use super::model::{Lit, Maker, Model};

/// What is relevant.
#[derive(Debug)]
pub(super) struct Relevance {
    pub operators: Vec<bool>,
    /// What these operators or the goal rely on.
    pub lits: Vec<bool>,
}

struct Search<'a> {
    model: &'a Model,
    /// Operators that are there at all.
    allowed: &'a [bool],
    lits: Vec<bool>,
    operators: Vec<bool>,
    changed: bool,
    /// What each operator makes, by itself or by an event.
    makes: Vec<Vec<(Lit, Maker)>>,
    /// What each operator threatens, and its excuses.
    threatens: Vec<Vec<(Lit, &'a [Lit])>>,
    /// What is had in exchange for a literal, where that is looked at already.
    given_for: BTreeMap<Lit, BTreeSet<Lit>>,
}

impl Relevance {
    /// Of the operators that are `allowed`; there are no others.
    pub fn new(model: &Model, allowed: &[bool]) -> Self {
        let operators = model.preconditions.len();
        let mut search = Search {
            model,
            allowed,
            lits: vec![false; model.literals_count()],
            operators: vec![false; operators],
            changed: true,
            makes: vec![Vec::new(); operators],
            threatens: vec![Vec::new(); operators],
            given_for: BTreeMap::new(),
        };
        for lit in (0..model.literals_count() as u32).map(Lit) {
            for maker in search.makers(lit).copied().collect::<Vec<_>>() {
                search.makes[model.operator_of(maker) as usize].push((lit, maker));
            }
            for threat in model.threats[lit.index()].iter().filter(|t| allowed[t.operator as usize]) {
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
        Relevance { operators: search.operators, lits: search.lits }
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
        if !self.given_for.contains_key(&lit) {
            let given = self.given_for(lit);
            self.given_for.insert(lit, given);
        }
        for &maker in &model.makers[lit.index()] {
            let operator = model.operator_of(maker);
            if !self.allowed[operator as usize] {
                continue;
            }
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

    /// What makes the literal true, of what is there.
    fn makers(&self, lit: Lit) -> impl Iterator<Item = &Maker> {
        let model = self.model;
        model.makers[lit.index()]
            .iter()
            .filter(move |&&maker| self.allowed[model.operator_of(maker) as usize])
    }

    fn is_needed(&self, lit: Lit) -> bool {
        self.lits[lit.index()]
    }

    /// What can only be had in exchange for the literal, where the literal can only be had for one of these: of all of
    /// them and it no two ever hold, and nothing undoes it but what asks for it. Empty if there is no such set.
    fn given_for(&self, back: Lit) -> BTreeSet<Lit> {
        let model = self.model;
        let none = BTreeSet::new();
        let asks = |operator: u32, lit: Lit| model.preconditions.row(operator as usize).contains(&lit);
        let undoes = |operator: u32, lit: Lit| {
            self.threatens[operator as usize].iter().any(|(l, excuses)| *l == lit && excuses.is_empty())
        };
        let gives = |operator: u32, lit: Lit| asks(operator, lit) && undoes(operator, lit);
        let taken_for = |lit: &Lit| {
            let gets = |maker: &Maker| matches!(*maker, Maker::Operator(o) if gives(o, back));
            *lit != back && !model.is_derived(*lit) && self.makers(*lit).all(gets)
        };
        let mut given = BTreeSet::new();
        for &maker in self.makers(back) {
            let operator = model.operator_of(maker);
            let mut returned = model.preconditions.row(operator as usize).iter();
            match returned.find(|&lit| undoes(operator, *lit) && taken_for(lit)) {
                Some(lit) => given.insert(*lit),
                None => return none,
            };
        }
        let once = |lit: &Lit| {
            self.makers(*lit).all(|&maker| {
                let made = &self.makes[model.operator_of(maker) as usize];
                made.iter().filter(|(l, _)| *l == back || given.contains(l)).count() == 1
            })
        };
        let at_first = given.iter().chain([&back]).filter(|lit| model.initially[lit.index()]).count();
        let undone_by = model.threats[back.index()].iter().filter(|t| self.allowed[t.operator as usize]);
        if at_first > 1 || !given.iter().all(once) || !undone_by.into_iter().all(|t| asks(t.operator, back)) {
            return none;
        }
        given
    }

    /// Whether the operator only leads back to `back`, from where it must have been left for nothing.
    fn is_round_trip(&self, operator: u32, back: Lit) -> bool {
        let model = self.model;
        let before = model.preconditions.row(operator as usize);
        let given = self.given_for.get(&back);
        let excludes = |lit: Lit| model.excludes(lit, back) || given.is_some_and(|g| g.contains(&lit));
        let Some(&left_to) = before.iter().find(|&&lit| excludes(lit)) else { return false };
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
            && self.makers(left_to).all(leads_away_for_nothing)
            && self.makes[operator as usize].iter().all(|(lit, _)| *lit == back || !self.is_needed(*lit))
    }

    /// Whether some operator does for sure what the event does, and all else of use that comes with it.
    fn is_outdone(&self, event: u32, lit: Lit) -> bool {
        let by = |maker: &Maker| match *maker {
            Maker::Operator(other) => self.outdoes(other, event, lit),
            Maker::Event(_) => false,
        };
        self.makers(lit).any(by)
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
