//! The embedded default: a semantic parser grounded in the scene, with no model and no network.
//!
//! The stages: [`text`] (words and spelling), [`remark`] (what is told beside the orders), [`rewrite`] (plainer words
//! for the same), [`clause`] and [`phrase`] (grammar), [`mention`] (which things of the scene are meant), [`effect`]
//! (what each verb makes of them), [`situation`] (vague commands), and [`emit`] (sub-tasks). Where the grammar asks,
//! or is not sure of an instruction of many parts, [`gist`] says it again from its parts alone, and that is read. The
//! knowledge is data ([`lexicon`]); the code knows grammar. Everything is deterministic, and what is not understood
//! is asked for, never guessed.

mod clause;
mod complaint;
mod effect;
mod ellipsis;
mod emit;
mod everyday;
mod gist;
mod gloss;
mod inflect;
mod lexicon;
mod literal;
mod mention;
mod phrase;
mod plain;
mod reading;
mod remark;
mod rewrite;
mod scene;
mod sense;
mod situation;
mod slang;
mod snapshot;
mod spelled_out;
mod spelling;
mod syntax;
mod text;
mod trigger;

use std::path::Path;
use std::sync::atomic::{AtomicBool, Ordering};

use lamma_domains::goal::PropertyValue;

use crate::{Answer, Decomposition, LanguageModel, LmError, Request};
use clause::Parser;
use effect::{Change, Fact, Interpreter};
use emit::{Emitter, Stay};
pub use gloss::Gloss;
use lexicon::Lexicon;
pub use lexicon::squash;
use literal::{
    goes_on_about_it, is_concrete, is_mere_step, is_weak, notes_a_state, only_goes, only_tells,
    others_concrete, says_state, says_where, tells_of_going, tells_only,
};
use mention::{Discourse, Spoken};
use plain::{Plain, plain};
use reading::Reading;
use scene::Scene;
pub use sense::{Clues, LooseNoun};
use snapshot::Snapshot;
use spelled_out::Told;
use syntax::Clause;
pub(crate) use text::damerau_levenshtein;

/// Below this confidence it asks.
const THRESHOLD: f64 = 0.5;

/// A strong situation that explains so many words stands for the whole sentence, not for a clause of it.
const SURE_WHOLE: usize = 3;

/// What is said in so many clauses, one of which is understood, is no single situation.
const MANY_CLAUSES: usize = 3;

/// A reading this sure is not replaced by what a situation would do.
const SURE: f64 = 0.8;

/// `true`, as a property's value.
fn yes() -> PropertyValue {
    PropertyValue::Flag(true)
}

/// `false`, as a property's value.
fn no() -> PropertyValue {
    PropertyValue::Flag(false)
}

/// The value that "not" makes of a value.
fn opposite(value: &PropertyValue) -> PropertyValue {
    match value {
        PropertyValue::Flag(flag) => PropertyValue::Flag(!flag),
        PropertyValue::Word(_) => PropertyValue::Word("RoomTemp".to_owned()),
    }
}

/// The embedded default.
pub struct Offline {
    lexicon: Lexicon,
}

impl Offline {
    /// With the lexicon that is built in.
    pub fn new() -> Result<Self, LmError> {
        Ok(Self { lexicon: Lexicon::embedded()? })
    }

    /// With the lexicon of a folder instead: files of the names of those in `domains/household/lexicon`.
    pub fn from_folder(folder: &Path) -> Result<Self, LmError> {
        Ok(Self { lexicon: Lexicon::from_folder(folder)? })
    }

    /// Adds a user's lexicon: the text of a TOML file, and its name for messages.
    pub fn extend(&mut self, name: &str, text: &str) -> Result<(), LmError> {
        self.lexicon.extend(name, text)
    }

    /// What it makes of an instruction.
    pub fn read(&self, request: &Request) -> Answer {
        let scene = Scene::new(&request.objects, &request.robots);
        let unknown: Vec<&str> = scene.kinds().filter(|kind| !self.lexicon.knows_type(kind)).collect();
        let reading = if unknown.is_empty() {
            read(&request.instruction, &self.lexicon, &scene)
        } else {
            let mut lexicon = self.lexicon.clone();
            for kind in unknown {
                lexicon.add_type(kind);
            }
            read(&request.instruction, &lexicon, &scene)
        };
        let mut reading = reading;
        check_robots(&mut reading.decomposition, &request.robots);
        reading.answer(&text::shortened(&request.instruction), request.assume)
    }
}

impl LanguageModel for Offline {
    fn name(&self) -> String {
        "offline".to_owned()
    }

    fn decompose(&mut self, request: &Request, cancel: &AtomicBool) -> Result<Answer, LmError> {
        if cancel.load(Ordering::Relaxed) {
            return Err(LmError::Cancelled);
        }
        Ok(self.read(request))
    }
}

/// Keeps the advice for robots that there are, by their own names.
fn check_robots(decomposition: &mut Decomposition, team: &[crate::RobotView]) {
    let squashed = |name: &str| lexicon::squash(name);
    for subtask in &mut decomposition.subtasks {
        for said in std::mem::take(&mut subtask.robots) {
            match team.iter().find(|robot| squashed(&robot.name) == squashed(&said)) {
                Some(robot) => subtask.robots.push(robot.name.clone()),
                None if team.is_empty() => subtask.robots.push(said),
                None => {
                    let text = format!("there is no {said}: anyone may do \"{}\"", subtask.text);
                    decomposition.assumptions.push(text);
                }
            }
        }
    }
}

/// The best reading of an instruction: without its remarks, or with them where nothing is understood without.
fn read(instruction: &str, lexicon: &Lexicon, scene: &Scene<'_>) -> Reading {
    let plain = plain(instruction, lexicon, scene);
    let mut reading = read_words(&plain.words, instruction, lexicon, scene);
    reading.remark(&plain.remarks);
    if !reading.is_understood() {
        let mut others =
            plain.others(lexicon, scene).map(|words| read_words(&words, instruction, lexicon, scene));
        if let Some(other) = others.find(Reading::is_understood) {
            reading = other;
        }
    }
    let said = plain.said(lexicon);
    if reading.leaves_room_for_more(said.len())
        && let Some(told) = in_short(&said, lexicon, scene)
        && (told.says_more_than(&reading) || reading.asks_what_cannot_be(scene, lexicon))
    {
        reading.give_way_to(told);
        reading.remark(&plain.remarks);
    }
    let Plain { repairs, typed, cut, .. } = plain;
    if cut < instruction.len() {
        reading.problems.push("the instruction is too long; only its beginning was read".to_owned());
        reading.decomposition.confidence *= 0.5;
    }
    for (typed, word) in &typed {
        for problem in &mut reading.problems {
            *problem = text::in_own_words(problem, word, typed);
        }
    }
    reading.decomposition.assumptions.splice(0..0, repairs);
    reading
}

/// A reading of the gist of what was said, if that leaves nothing open.
fn in_short(said: &[String], lexicon: &Lexicon, scene: &Scene<'_>) -> Option<Reading> {
    let short = gist::gist(said, lexicon, scene)?;
    if wishes_for_dirt(&short, said, lexicon) || tells_of_a_mess(said) {
        return None;
    }
    let short = short.join(" ");
    let tokens = rewrite::rewritten(text::tokens(&short), lexicon);
    let words: Vec<String> = tokens.into_iter().map(|token| token.text).collect();
    let mut reading = word_by_word(&words, lexicon, scene);
    if !reading.is_understood() || !reading.problems.is_empty() {
        return None;
    }
    reading.decomposition.confidence = reading.decomposition.confidence.min(reading::AS_A_GIST);
    let short = short.replace(" .", ".");
    let short = format!("took it in short as \"{}\"", short.trim_end_matches('.'));
    reading.decomposition.assumptions.insert(0, short);
    Some(reading)
}

/// "it should be muddy", of what is only said to be muddy.
fn wishes_for_dirt(short: &[String], said: &[String], lexicon: &Lexicon) -> bool {
    let dirty = |word: &String| {
        lexicon.adjective(&[word]).is_some_and(|adjective| adjective.set.get("isDirty") == Some(&yes()))
    };
    let wished = |word: &String| ["should", "must", "make", "get", "want", "leave"].contains(&word.as_str());
    !said.iter().any(wished) && short.windows(2).any(|two| two[0] == "be" && dirty(&two[1]))
}

/// "it fell on the floor", "pens all over the desk": where things are, and not where they go.
fn tells_of_a_mess(said: &[String]) -> bool {
    said.iter().any(|word| ["fell", "fallen", "strewn", "littered"].contains(&word.as_str()))
        || said.windows(2).any(|two| two[0] == "all" && two[1] == "over")
}

/// The best reading of some words: word by word, or as a situation where that explains more.
fn read_words(words: &[String], instruction: &str, lexicon: &Lexicon, scene: &Scene<'_>) -> Reading {
    if text::says_nothing(words, lexicon, scene) {
        return Reading::nothing(instruction);
    }
    let mut reading = word_by_word(words, lexicon, scene);
    let strong = situation::ranked(lexicon, &situation::words_of(words), true);
    let explained = strong.first().map_or(0, |(_, explained)| *explained);
    let absent = reading.problems.iter().any(|problem| problem.starts_with("there is no "));
    let one_sentence = !words[..words.len().saturating_sub(1)].contains(&".".to_owned());
    let sure = reading.decomposition.confidence > SURE;
    if explained >= SURE_WHOLE && one_sentence && !sure && !reading.concrete {
        if let Some(whole) = as_situation(words, instruction, lexicon, scene) {
            reading = whole;
        }
    } else if (!absent || explained >= 2)
        && !reading.concrete
        && (reading.clauses < MANY_CLAUSES || reading.decomposition.subtasks.is_empty())
        && (reading.decomposition.subtasks.is_empty() || reading.decomposition.confidence < THRESHOLD)
    {
        let whole = as_situation(words, instruction, lexicon, scene);
        match whole {
            Some(mut whole) if whole.decomposition.confidence > reading.decomposition.confidence => {
                whole.others.push(reading.decomposition);
                reading = whole;
            }
            Some(whole) => reading.others.push(whole.decomposition),
            None => {}
        }
    }
    reading
}

/// Reads clause by clause; a vague wish that others spell out asks for no more than they say.
fn word_by_word(words: &[String], lexicon: &Lexicon, scene: &Scene<'_>) -> Reading {
    let reading = clause_by_clause(words, &[], lexicon, scene);
    let vague = reading.told.situations();
    if vague.is_empty() || reading.clauses <= MANY_CLAUSES {
        return reading;
    }
    let without = clause_by_clause(words, &vague, lexicon, scene);
    let spelled_out = reading.told.spelled_out(&without.told);
    if spelled_out.is_empty() || without.problems.len() > reading.problems.len() {
        return reading;
    }
    if spelled_out == vague { without } else { clause_by_clause(words, &spelled_out, lexicon, scene) }
}

/// Reads all clauses but those whose doing is spelled out by others.
fn clause_by_clause(
    words: &[String],
    spelled_out: &[usize],
    lexicon: &Lexicon,
    scene: &Scene<'_>,
) -> Reading {
    let words = text::without_endings(words, lexicon);
    let mut parser = Parser::new(&words, lexicon, scene);
    let mut clauses = parser.clauses();
    let passed_over = std::mem::take(&mut parser.passed_over);
    let choices = std::mem::take(&mut parser.choices);
    ellipsis::share_objects(&mut clauses);
    let mut discourse = Discourse::new(lexicon, scene);
    let mut interpreter = Interpreter::new(&mut discourse, &clauses);
    let mut index = 0;
    while index < clauses.len() {
        if clauses[index].condition {
            let held = interpreter.condition(index, &clauses[index]);
            if let (false, Some(next)) = (held, clauses.get(index + 1)) {
                let text = format!("\"{}\" does not hold now", clauses[index].text);
                interpreter
                    .discourse
                    .assume(format!("{text}, so nothing is done for \"{}\"", next.text), 1.0);
                index += 1;
                // "… wash it and put it away": neither.
                while clauses.get(index + 1).is_some_and(goes_on_about_it) {
                    index += 1;
                }
            }
        } else if spelled_out.contains(&index) {
            done_by_what_follows(&mut interpreter, &clauses[index]);
        } else {
            one_clause(&mut interpreter, index, &clauses, lexicon);
        }
        index += 1;
    }
    interpreter.settle_bans();
    let (facts, situations) = (interpreter.facts, interpreter.situations);
    let said = Told::of(&facts, &situations, &discourse);
    for choice in choices {
        discourse.assume(choice, 0.95);
    }
    for word in passed_over {
        discourse.assume(format!("passed over \"{word}\""), 0.97);
    }
    let told = clauses.iter().filter(|clause| says_where(clause, scene) || says_state(clause, scene));
    let concrete = told.count() > 1 || clauses.iter().any(|clause| is_concrete(clause, lexicon, scene));
    Reading { concrete, told: said, ..finish(discourse, facts, &clauses) }
}

/// Reads a clause word by word; as a situation when that fails, or when a strong one fits.
fn one_clause<'a>(
    interpreter: &mut Interpreter<'_, 'a>,
    index: usize,
    clauses: &[Clause<'a>],
    lexicon: &Lexicon,
) {
    let clause = &clauses[index];
    if only_tells(index, clauses, lexicon, interpreter.discourse.scene) {
        interpreter.discourse.assume(format!("took \"{}\" as a remark", clause.text), 0.95);
        interpreter.discourse.spoken.push(Spoken::default());
        return;
    }
    if interpreter.clears(index, clauses) {
        return;
    }
    // "empty the sink by moving the pan to the stove": what comes next says how.
    let by = clauses.get(index + 1).is_some_and(|next| next.words.first().is_some_and(|word| word == "by"));
    let so =
        clause.words.iter().take_while(|word| ["and", "so", "but", ","].contains(&word.as_str())).count();
    let words = situation::words_of(&clause.words[so..]);
    let names =
        clause.objects.iter().any(|p| matches!(p.head, syntax::Head::Noun(_) | syntax::Head::Named(_)));
    if by && !names && is_weak(clause, lexicon) {
        done_by_what_follows(interpreter, clause);
        return;
    }
    // "I would like the soup ladle to be washed": a wish that goes on.
    let goes_on =
        clauses.get(index + 1).is_some_and(|next| next.words.starts_with(&["to".into(), "be".into()]));
    // "close the fridge, toaster off, lights out": no more than it says.
    let noted = notes_a_state(clause, interpreter.discourse.scene)
        && others_concrete(index, clauses, lexicon, interpreter.discourse.scene) > 1;
    let left_to = clause.negated && situation::is_left_to(&clause.words);
    if (!clause.negated || left_to)
        && !noted
        && !goes_on
        && is_weak(clause, lexicon)
        && !says_where(clause, interpreter.discourse.scene)
        && !says_state(clause, interpreter.discourse.scene)
        && interpreter.first_situation(index, &situation::ranked(lexicon, &words, true), &words)
    {
        interpreter.speak_of_what_came_about(index, clauses);
        return;
    }
    let before = Snapshot::take(interpreter);
    interpreter.clause(index, clause, clauses.get(index + 1));
    let failed =
        interpreter.discourse.problems.len() > before.problems || !interpreter.spoke && !is_mere_step(clause);
    let absent =
        interpreter.discourse.problems[before.problems..].iter().any(|p| p.starts_with("there is no "));
    // What was named and is not here is not to be replaced by what a situation would do.
    let says_little = is_weak(clause, lexicon) || !names;
    if failed && says_little && (!absent || is_weak(clause, lexicon)) {
        let ranked = situation::ranked(lexicon, &words, false);
        let literal = Snapshot::take(interpreter);
        before.restore(interpreter);
        if interpreter.first_situation(index, &ranked, &words) {
            interpreter.speak_of_what_came_about(index, clauses);
            return;
        }
        literal.restore(interpreter);
    }
    // "going to sleep now, so …"
    if !failed && !interpreter.spoke && tells_of_going(clause) {
        let ranked = situation::ranked(lexicon, &words, false);
        if interpreter.first_situation(index, &ranked, &words) {
            interpreter.speak_of_what_came_about(index, clauses);
            return;
        }
    }
    if failed && by && !interpreter.spoke {
        before.restore(interpreter);
        done_by_what_follows(interpreter, clause);
        return;
    }
    let remark = clause.is_remark() && clauses.len() > 1;
    if failed
        && remark
        && !interpreter.spoke
        && !names
        && tells_only(clause)
        && others_concrete(index, clauses, lexicon, interpreter.discourse.scene) > 0
    {
        before.restore(interpreter);
        interpreter.discourse.assume(format!("took \"{}\" as a remark", clause.text), 0.95);
        interpreter.discourse.spoken.push(Spoken::default());
        return;
    }
    if failed && !interpreter.spoke && !clause.negated && !is_mere_step(clause) && !remark {
        interpreter.discourse.problem(format!("I do not know what to do for \"{}\"", clause.text), 0.4);
    }
}

fn done_by_what_follows(interpreter: &mut Interpreter<'_, '_>, clause: &Clause<'_>) {
    interpreter.discourse.spoken.push(Spoken::default());
    interpreter.discourse.assume(format!("\"{}\" is done by what else is said", clause.text), 0.95);
}

fn as_situation(
    words: &[String],
    instruction: &str,
    lexicon: &Lexicon,
    scene: &Scene<'_>,
) -> Option<Reading> {
    let words = situation::words_of(words);
    let ranked = situation::ranked(lexicon, &words, false);
    let mut discourse = Discourse::new(lexicon, scene);
    let clauses = [Clause {
        text: instruction.trim().to_owned(),
        verbs: Vec::new(),
        verb_text: String::new(),
        negated: false,
        condition: false,
        robots: Vec::new(),
        objects: Vec::new(),
        places: Vec::new(),
        complement: lexicon::Settings::new(),
        back: false,
        link: syntax::Link::And,
        unknown: Vec::new(),
        words: words.clone(),
    }];
    let mut interpreter = Interpreter::new(&mut discourse, &clauses);
    if !interpreter.first_situation(0, &ranked, &words) {
        return None;
    }
    let facts = interpreter.facts;
    Some(finish(discourse, facts, &clauses))
}

fn finish(mut discourse: Discourse<'_>, facts: Vec<Fact>, clauses: &[Clause<'_>]) -> Reading {
    let stays: Vec<Stay> = facts
        .iter()
        .filter(|fact| matches!(&fact.change, Change::State(property, _) if property == "temperature"))
        .filter_map(|fact| {
            let device = clauses.get(fact.clause)?.verbs.iter().find_map(|verb| verb.device.clone())?;
            Some(Stay { clause: fact.clause, entity: fact.entity, device })
        })
        .collect();
    discourse.note_what_is_so(&facts);
    discourse.bind_names(&facts);
    let subtasks = Emitter::new(&mut discourse, facts, &stays).subtasks(clauses);
    let confidence = if subtasks.is_empty() { 0.0 } else { discourse.confidence.value() };
    Reading {
        decomposition: Decomposition {
            subtasks,
            assumptions: discourse.assumptions,
            confidence,
            bans: discourse.bans,
        },
        problems: discourse.problems,
        others: Vec::new(),
        only_goes: !clauses.is_empty() && clauses.iter().all(only_goes),
        concrete: false,
        told: Told::default(),
        clauses: clauses.len(),
    }
}
