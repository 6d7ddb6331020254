//! Pieces of actions: that an agent does one of several operators, whichever.
//!
//! "The lift takes in the passenger" says less than "the lift takes in the passenger as its second one, on the third
//! floor", and so does what the solver learns about it. Each piece stands for the operators of an agent that make a
//! literal in a step. What holds afterwards is then made by pieces, the agent's one action is chosen piece by piece, and
//! what all operators of a piece need, the piece needs. (Action splitting: Ernst, Millstein & Weld, "Automatic SAT-
//! compilation of planning problems", IJCAI 1997, section 3; here the pieces come beside the operators, not instead.)

use std::collections::BTreeMap;

use super::formula::Step;
use super::layers::Layer;
use super::model::{Lit, Maker};
use super::sat::Bool;

/// For each literal of the next layer, the operators of the step that make it whatever holds, by agent.
pub(super) type Makers = Vec<Vec<Vec<u32>>>;

impl Step<'_> {
    pub fn makers(&self, after: &Layer) -> Makers {
        after.lits.iter().map(|&lit| self.makers_by_agent(lit)).collect()
    }

    fn makers_by_agent(&self, lit: Lit) -> Vec<Vec<u32>> {
        let mut makers: BTreeMap<u32, Vec<u32>> = BTreeMap::new();
        for maker in &self.model.makers[lit.index()] {
            if let Maker::Operator(operator) = *maker
                && self.operator(operator).is_some()
            {
                makers.entry(self.model.agent_of[operator as usize]).or_default().push(operator);
            }
        }
        makers.into_values().collect()
    }

    /// Every agent does at most one action: at most one piece, and at most one operator of it. An operator belongs to
    /// the piece for what the fewest operators of its agent make.
    pub fn one_action_each(&mut self, makers: &Makers) {
        let mut chosen: Vec<Vec<Bool>> = vec![Vec::new(); self.model.agents];
        for ((agent, _), operators) in self.by_effect(makers) {
            let variables: Vec<Bool> = operators.iter().filter_map(|&o| self.operator(o)).collect();
            self.clauses.at_most_one(&variables);
            chosen[agent as usize].extend(self.piece(&operators));
        }
        chosen.iter().for_each(|pieces| self.clauses.at_most_one(pieces));
    }

    /// The operators of the step by agent and the literal of the next layer, by position, that the fewest of the agent's
    /// make. Those that make none come together.
    fn by_effect(&self, makers: &Makers) -> BTreeMap<(u32, Option<usize>), Vec<u32>> {
        // For each operator how many make the literal, and which it is.
        let mut rarest: BTreeMap<u32, (usize, usize)> = BTreeMap::new();
        for (at, by_agent) in makers.iter().enumerate() {
            for operators in by_agent {
                for &operator in operators {
                    let own = rarest.entry(operator).or_insert((operators.len(), at));
                    *own = (*own).min((operators.len(), at));
                }
            }
        }
        let mut groups: BTreeMap<(u32, Option<usize>), Vec<u32>> = BTreeMap::new();
        for &operator in &self.layer.operators {
            let lit = rarest.get(&operator).map(|&(_, at)| at);
            groups.entry((self.model.agent_of[operator as usize], lit)).or_default().push(operator);
        }
        groups
    }

    /// That the agent of these operators does one of them; `None` if there is none.
    pub fn piece(&mut self, operators: &[u32]) -> Option<Bool> {
        let (&first, others) = operators.split_first()?;
        if others.is_empty() {
            return self.operator(first);
        }
        if let Some(&known) = self.pieces.get(operators) {
            return Some(known);
        }
        let piece = self.clauses.variable();
        let variables: Vec<Bool> = operators.iter().filter_map(|&o| self.operator(o)).collect();
        variables.iter().for_each(|&operator| self.clauses.clause([!operator, piece]));
        self.clauses.clause(variables.into_iter().chain([!piece]));
        let model = self.model;
        let needs = |operator: u32| model.preconditions.row(operator as usize);
        let common = needs(first).iter().filter(|lit| others.iter().all(|&o| needs(o).contains(lit)));
        for &lit in common {
            if let Some(relies) = self.relies(lit, model.agent_of[first as usize]) {
                self.clauses.clause([!piece, relies]);
            }
        }
        self.pieces.insert(operators.to_vec(), piece);
        Some(piece)
    }
}
