//! Which operators apply in a state: a decision tree over variables (Helmert 2006, "The Fast Downward
//! planning system", section 5.3.1).

use std::ops::Range;

use crate::task::{FactId, OperatorId, Task};

const NO_NODE: u32 = u32::MAX;

/// The tree.
#[derive(Debug)]
pub(crate) struct Successors {
    nodes: Vec<Node>,
    /// Operators that apply once a node is reached.
    operators: Vec<OperatorId>,
    /// A variable to look at, and where its children start (one per value).
    switches: Vec<(u32, u32)>,
    children: Vec<u32>,
}

#[derive(Clone, Debug, Default)]
struct Node {
    operators: Range<u32>,
    switches: Range<u32>,
}

impl Successors {
    pub fn new(task: &Task) -> Self {
        let mut tree = Successors {
            nodes: Vec::new(),
            operators: Vec::new(),
            switches: Vec::new(),
            children: Vec::new(),
        };
        let mut order: Vec<OperatorId> = (0..task.operators.len() as u32).map(OperatorId).collect();
        // Preconditions are sorted, so operators that share a beginning stand together.
        order.sort_by(|&a, &b| task.preconditions(a).cmp(task.preconditions(b)).then(a.cmp(&b)));
        tree.build(task, &order, 0);
        tree
    }

    /// The node for operators that agree on their first `depth` preconditions.
    fn build(&mut self, task: &Task, operators: &[OperatorId], depth: usize) -> u32 {
        let id = self.nodes.len() as u32;
        self.nodes.push(Node::default());
        let (done, open) =
            operators.split_at(operators.partition_point(|&o| task.preconditions(o).len() == depth));
        let start = self.operators.len() as u32;
        self.operators.extend_from_slice(done);
        self.nodes[id as usize].operators = start..self.operators.len() as u32;
        let fact = |operator: OperatorId| task.preconditions(operator)[depth];
        let variable = |fact: FactId| task.facts[fact.index()].variable;
        let mut switches = Vec::new();
        for group in open.chunk_by(|&a, &b| variable(fact(a)) == variable(fact(b))) {
            let of = variable(fact(group[0]));
            let base = self.children.len() as u32;
            let declared = task.variables[of as usize];
            self.children.resize(self.children.len() + declared.size as usize, NO_NODE);
            switches.push((of, base));
            for same in group.chunk_by(|&a, &b| fact(a) == fact(b)) {
                let child = self.build(task, same, depth + 1);
                self.children[(base + fact(same[0]).0 - declared.first.0) as usize] = child;
            }
        }
        let start = self.switches.len() as u32;
        self.switches.extend(switches);
        self.nodes[id as usize].switches = start..self.switches.len() as u32;
        id
    }

    /// Adds to `out` every operator that applies in `state`.
    pub fn applicable(&self, task: &Task, state: &[u64], out: &mut Vec<OperatorId>) {
        let first = out.len();
        self.visit(task, state, 0, out);
        if task.has_numbers() {
            let mut kept = first;
            for at in first..out.len() {
                if task.has_results(state, out[at]) {
                    out.swap(kept, at);
                    kept += 1;
                }
            }
            out.truncate(kept);
        }
    }

    fn visit(&self, task: &Task, state: &[u64], node: u32, out: &mut Vec<OperatorId>) {
        let node = &self.nodes[node as usize];
        out.extend_from_slice(&self.operators[node.operators.start as usize..node.operators.end as usize]);
        for &(variable, base) in &self.switches[node.switches.start as usize..node.switches.end as usize] {
            let variable = &task.variables[variable as usize];
            let child = self.children[(base + variable.fact(state).0 - variable.first.0) as usize];
            if child != NO_NODE {
                self.visit(task, state, child, out);
            }
        }
    }
}
