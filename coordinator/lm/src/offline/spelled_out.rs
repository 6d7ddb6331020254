//! A vague wish whose doing is spelled out: "I need a coffee. Fill the mug from the machine, …" asks for no more than
//! what is said behind it.

use super::effect::{Change, Fact};
use super::mention::Discourse;

/// What facts are of and what they are, apart from which clause makes them.
#[derive(Clone, Debug, Default)]
pub struct Told {
    /// Of what a situation brought about, and in which clauses.
    pub vague: Vec<(usize, String)>,
    /// Of all that was said in so many words.
    pub said: Vec<String>,
}

impl Told {
    /// Of the facts of a reading, some of whose clauses were read as situations.
    pub fn of(facts: &[Fact], situations: &[usize], discourse: &Discourse<'_>) -> Self {
        let mut told = Self::default();
        let kind = |entity: usize| discourse.entities.get(entity).map_or("", |entity| entity.kind());
        for fact in facts {
            let change = match &fact.change {
                Change::State(property, value) => format!("{property} {value:?}"),
                Change::Inside(place) => format!("in {}", kind(*place)),
                Change::Held => "held".to_owned(),
            };
            let text = format!("{} {change}", kind(fact.entity));
            if situations.contains(&fact.clause) {
                told.vague.push((fact.clause, text));
            } else {
                told.said.push(text);
            }
        }
        told
    }

    /// The clauses read as situations.
    pub fn situations(&self) -> Vec<usize> {
        let mut clauses: Vec<usize> = self.vague.iter().map(|(clause, _)| *clause).collect();
        clauses.dedup();
        clauses
    }

    /// Which of them bring about nothing but what other words say, at least half of it.
    pub fn spelled_out(&self, without: &Self) -> Vec<usize> {
        let mut clauses = self.situations();
        clauses.retain(|clause| {
            let mine = self.vague.iter().filter(|(of, _)| of == clause);
            let (said, all) = mine.fold((0, 0), |(said, all), (_, fact)| {
                (said + usize::from(without.said.contains(fact)), all + 1)
            });
            2 * said >= all
        });
        clauses
    }
}
