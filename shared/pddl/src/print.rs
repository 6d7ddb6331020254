//! The canonical text of a tree: parsing it gives the same tree, printing that gives the same text.
//!
//! Parts (conditions, effects, terms) print on one line; actions, domains and problems are laid out.

use std::fmt::{self, Display, Formatter};

use crate::ast::*;
use crate::layout::Doc;
use crate::name::Name;

fn call<T: Display>(head: impl Display, args: &[T]) -> String {
    args.iter().fold(format!("({head}"), |text, arg| format!("{text} {arg}")) + ")"
}

/// Implements `Display` as the one-line form of a part's `doc`.
macro_rules! display_flat {
    ($($type:ty),*) => {
        $(impl Display for $type {
            fn fmt(&self, f: &mut Formatter<'_>) -> fmt::Result {
                self.doc().write_flat(f)
            }
        })*
    };
}

/// Implements `Display` as the laid out form of a `doc`, with a newline at its end.
macro_rules! display_laid_out {
    ($($type:ty),*) => {
        $(impl Display for $type {
            fn fmt(&self, f: &mut Formatter<'_>) -> fmt::Result {
                self.doc().write_laid_out(f, 0)?;
                f.write_str("\n")
            }
        })*
    };
}

display_flat!(Condition, Effect, NumericExpr, Signature, Init, Metric);
display_laid_out!(Domain, Problem, Action, Axiom);

impl Display for Term {
    fn fmt(&self, f: &mut Formatter<'_>) -> fmt::Result {
        match self {
            Term::Constant(name) => write!(f, "{name}"),
            Term::Variable(name) => write!(f, "?{name}"),
        }
    }
}

impl Display for Atom {
    fn fmt(&self, f: &mut Formatter<'_>) -> fmt::Result {
        f.write_str(&call(&self.predicate, &self.args))
    }
}

impl Display for GroundAtom {
    fn fmt(&self, f: &mut Formatter<'_>) -> fmt::Result {
        write!(f, "({}", self.predicate)?;
        self.args.iter().try_for_each(|arg| write!(f, " {arg}"))?;
        f.write_str(")")
    }
}

impl Display for FunctionTerm {
    fn fmt(&self, f: &mut Formatter<'_>) -> fmt::Result {
        f.write_str(&call(&self.function, &self.args))
    }
}

impl Display for Decimal {
    fn fmt(&self, f: &mut Formatter<'_>) -> fmt::Result {
        f.write_str(&self.0)
    }
}

impl Display for Comparison {
    fn fmt(&self, f: &mut Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            Comparison::Less => "<",
            Comparison::LessEqual => "<=",
            Comparison::Equal => "=",
            Comparison::GreaterEqual => ">=",
            Comparison::Greater => ">",
        })
    }
}

impl Display for ArithmeticOp {
    fn fmt(&self, f: &mut Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            ArithmeticOp::Add => "+",
            ArithmeticOp::Subtract => "-",
            ArithmeticOp::Multiply => "*",
            ArithmeticOp::Divide => "/",
        })
    }
}

impl Display for AssignOp {
    fn fmt(&self, f: &mut Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            AssignOp::Assign => "assign",
            AssignOp::Increase => "increase",
            AssignOp::Decrease => "decrease",
            AssignOp::ScaleUp => "scale-up",
            AssignOp::ScaleDown => "scale-down",
        })
    }
}

/// Names of one typed list in groups of the same type, without regard to `private_to`.
fn typed_groups(names: &[TypedName], mark: &str) -> Vec<Doc> {
    let mut groups = Vec::new();
    for group in names.chunk_by(|a, b| a.types == b.types) {
        let text: Vec<String> = group.iter().map(|name| format!("{mark}{}", name.name)).collect();
        let is_last = std::ptr::eq(group.as_ptr_range().end, names.as_ptr_range().end);
        let types = match group[0].types.as_slice() {
            // Names without a type would take the type of the next group.
            [] if is_last => String::new(),
            [] => " - object".to_owned(),
            [one] => format!(" - {one}"),
            several => format!(" - {}", call("either", several)),
        };
        groups.push(Doc::text(text.join(" ") + &types));
    }
    groups
}

fn params(names: &[TypedName]) -> Doc {
    Doc::list("", typed_groups(names, "?"))
}

fn private_head(private: &Private) -> String {
    match private {
        Private::Owner => ":private".to_owned(),
        Private::Agent(agent) => format!(":private {agent}"),
        Private::Variable(agent) => {
            let types: Vec<String> =
                typed_groups(std::slice::from_ref(agent), "?").iter().map(Doc::flat).collect();
            format!(":private {}", types.join(" "))
        }
    }
}

fn objects(names: &[TypedName]) -> Vec<Doc> {
    let mut docs = Vec::new();
    for run in names.chunk_by(|a, b| a.private_to == b.private_to) {
        match &run[0].private_to {
            None => docs.extend(typed_groups(run, "")),
            Some(private) => {
                // An owner's first object has its type at once, or it could be taken for the agent's name.
                let alone = usize::from(*private == Private::Owner && !run[0].types.is_empty());
                let (first, others) = run.split_at(alone);
                let groups = [first, others].into_iter().flat_map(|part| typed_groups(part, ""));
                docs.push(Doc::list(private_head(private), groups.collect()));
            }
        }
    }
    docs
}

fn signatures(signatures: &[Signature], suffix: &str) -> Vec<Doc> {
    let mut docs = Vec::new();
    for run in signatures.chunk_by(|a, b| a.private_to == b.private_to) {
        let inside = run.iter().map(|s| Doc::text(s.doc().flat() + suffix)).collect::<Vec<_>>();
        match &run[0].private_to {
            None => docs.extend(inside),
            Some(private) => docs.push(Doc::list(private_head(private), inside).broken()),
        }
    }
    docs
}

fn docs<'a, T: 'a>(items: impl IntoIterator<Item = &'a T>, doc: impl Fn(&T) -> Doc) -> Vec<Doc> {
    items.into_iter().map(doc).collect()
}

impl Signature {
    fn doc(&self) -> Doc {
        Doc::list(self.name.as_str(), typed_groups(&self.params, "?"))
    }
}

impl Condition {
    pub(crate) fn doc(&self) -> Doc {
        match self {
            Condition::And(parts) => Doc::list("and", docs(parts, Condition::doc)),
            Condition::Or(parts) => Doc::list("or", docs(parts, Condition::doc)),
            Condition::Not(inner) => Doc::list("not", vec![inner.doc()]),
            Condition::Imply(if_, then) => Doc::list("imply", vec![if_.doc(), then.doc()]),
            Condition::Exists(names, body) => Doc::list("exists", vec![params(names), body.doc()]),
            Condition::Forall(names, body) => Doc::list("forall", vec![params(names), body.doc()]),
            Condition::Atom(atom) => Doc::text(atom),
            Condition::Equal(left, right) => Doc::text(format!("(= {left} {right})")),
            Condition::Compare(op, left, right) => Doc::list(op.to_string(), vec![left.doc(), right.doc()]),
        }
    }
}

impl Effect {
    fn doc(&self) -> Doc {
        match self {
            Effect::And(parts) => Doc::list("and", docs(parts, Effect::doc)),
            Effect::Forall(names, body) => Doc::list("forall", vec![params(names), body.doc()]),
            Effect::When(condition, effect) => Doc::list("when", vec![condition.doc(), effect.doc()]),
            Effect::Add(atom) => Doc::text(atom),
            Effect::Delete(atom) => Doc::text(format!("(not {atom})")),
            Effect::Assign(op, function, value) => Doc::list(format!("{op} {function}"), vec![value.doc()]),
        }
    }
}

impl NumericExpr {
    fn doc(&self) -> Doc {
        match self {
            NumericExpr::Number(number) => Doc::text(number),
            NumericExpr::Function(function) => Doc::text(function),
            NumericExpr::Operation(op, operands) => {
                Doc::list(op.to_string(), docs(operands, NumericExpr::doc))
            }
        }
    }
}

impl Init {
    fn doc(&self) -> Doc {
        match self {
            Init::Fact(atom) => Doc::text(atom),
            Init::Value(function, value) => Doc::text(format!("(= {function} {value})")),
        }
    }
}

impl Metric {
    fn doc(&self) -> Doc {
        let direction = if self.minimize { "minimize" } else { "maximize" };
        Doc::list(format!(":metric {direction}"), vec![self.expression.doc()])
    }
}

impl Action {
    fn doc(&self) -> Doc {
        let mut fields = Vec::new();
        let mut own_params = self.params.as_slice();
        if let Some(agent) = &self.agent {
            let text: Vec<String> =
                typed_groups(std::slice::from_ref(agent), "?").iter().map(Doc::flat).collect();
            fields.push(Doc::field(":agent", Doc::text(text.join(" "))));
            // Reading puts the agent in front of the parameters, unless it is already among them.
            own_params = own_params.strip_prefix(std::slice::from_ref(agent)).unwrap_or(own_params);
        }
        fields.push(Doc::field(":parameters", params(own_params)));
        let Some(duration) = &self.duration else {
            fields.push(Doc::field(":precondition", self.precondition.doc()));
            fields.push(Doc::field(":effect", self.effect.doc()));
            return Doc::list(format!(":action {}", self.name), fields).broken();
        };
        fields.push(Doc::field(":duration", Doc::list("= ?duration", vec![duration.doc()])));
        fields.push(Doc::field(":condition", Doc::list("at start", vec![self.precondition.doc()])));
        fields.push(Doc::field(":effect", Doc::list("at end", vec![self.effect.doc()])));
        Doc::list(format!(":durative-action {}", self.name), fields).broken()
    }
}

impl Axiom {
    fn doc(&self) -> Doc {
        Doc::list(":derived", vec![self.head.doc(), self.body.doc()])
    }
}

fn section(keyword: &str, items: Vec<Doc>) -> Option<Doc> {
    (!items.is_empty()).then(|| Doc::list(keyword, items).broken())
}

impl Domain {
    fn doc(&self) -> Doc {
        let requirements = docs(&self.requirements, |name: &Name| Doc::text(name));
        let mut sections = Vec::new();
        sections.extend((!requirements.is_empty()).then(|| Doc::list(":requirements", requirements)));
        sections.extend(section(":types", typed_groups(&self.types, "")));
        sections.extend(section(":constants", objects(&self.constants)));
        sections.extend(section(":predicates", signatures(&self.predicates, "")));
        sections.extend(section(":functions", signatures(&self.functions, " - number")));
        sections.extend(self.axioms.iter().map(Axiom::doc));
        sections.extend(self.actions.iter().map(Action::doc));
        Doc::list(format!("define (domain {})", self.name), sections).broken()
    }
}

impl Problem {
    fn doc(&self) -> Doc {
        let mut sections = vec![Doc::text(format!("(:domain {})", self.domain))];
        sections.extend(section(":objects", objects(&self.objects)));
        sections.push(Doc::list(":init", docs(&self.init, Init::doc)).broken());
        sections.push(Doc::list(":goal", vec![self.goal.doc()]));
        sections.extend(self.metric.as_ref().map(Metric::doc));
        Doc::list(format!("define (problem {})", self.name), sections).broken()
    }
}
