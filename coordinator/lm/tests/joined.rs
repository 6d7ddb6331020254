//! Orders joined in one instruction: two to four of `data/orders.txt`, each said in one of many ways, with pronouns,
//! conjunctions, sentences and politeness between them. The seed decides which; the goal is that of each.

#[path = "judge/mod.rs"]
#[allow(dead_code, reason = "the lines of a grammar have no numbers")]
mod judge;

use lamma_lm::Offline;

/// Of so many sentences, so many in a hundred at least must have exactly the goal of their orders.
const SENTENCES: usize = 1500;
const LEAST: usize = 97;

const SHELLS: [&str; 8] = ["", "", "", "", "please ", "hey, ", "first, ", "okay, "];
const JOINTS: [&str; 11] = [
    ", and ",
    " and ",
    ". ",
    "; ",
    ", then ",
    ". Then ",
    ". After that, ",
    ". Also, ",
    ". Next, ",
    ". Finally, ",
    ". Meanwhile, ",
];

/// An order: what it may be of, and how it is said.
struct Order {
    things: Vec<(&'static str, &'static str)>,
    others: Others,
    goal: &'static str,
    said: Vec<&'static str>,
}

/// What `Y` may be.
enum Others {
    None,
    /// Another of the same things.
    Another,
    These(Vec<(&'static str, &'static str)>),
}

/// Steele, Lea and Flood's `SplitMix64`.
struct Random(u64);

impl Random {
    fn below(&mut self, end: usize) -> usize {
        self.0 = self.0.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let mut mixed = self.0;
        mixed = (mixed ^ (mixed >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        mixed = (mixed ^ (mixed >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        ((mixed ^ (mixed >> 31)) % end.max(1) as u64) as usize
    }

    fn pick<'t, T>(&mut self, of: &'t [T]) -> &'t T {
        &of[self.below(of.len())]
    }
}

fn things(text: &'static str) -> Vec<(&'static str, &'static str)> {
    text.split(", ").filter_map(|thing| thing.rsplit_once(' ')).collect()
}

fn orders() -> Vec<Order> {
    let mut orders: Vec<Order> = Vec::new();
    for line in include_str!("data/orders.txt").lines().filter(|line| !line.is_empty()) {
        if let Some((_, head)) = line.strip_prefix('[').and_then(|line| line.split_once("] ")) {
            let mut parts = head.split('|').map(str::trim);
            let mut next = || parts.next().unwrap_or_default();
            let (of, others, goal) = (things(next()), next(), next());
            let others = match others {
                "" => Others::None,
                "another" => Others::Another,
                these => Others::These(things(these)),
            };
            orders.push(Order { things: of, others, goal, said: Vec::new() });
        } else if let Some(order) = orders.last_mut().filter(|_| !line.starts_with('#')) {
            order.said.push(line);
        }
    }
    orders
}

/// One sentence and its goal; no thing is spoken of in two orders.
fn sentence(orders: &[Order], random: &mut Random) -> String {
    let count = 2 + random.below(3);
    let (mut said, mut goals, mut used) = (Vec::new(), Vec::new(), Vec::new());
    let mut drawn = Vec::new();
    for _ in 0..60 {
        let number = random.below(orders.len());
        let order = &orders[number];
        let thing = if order.things.is_empty() { ("", "") } else { *random.pick(&order.things) };
        let other = match &order.others {
            Others::None => ("", ""),
            Others::Another => *random.pick(&order.things),
            Others::These(these) => *random.pick(these),
        };
        let mut kinds: Vec<&str> = vec![thing.1, other.1];
        let fixed = order.goal.split([' ', ';', ':', '@']).filter(|word| ["Plate", "Fridge"].contains(word));
        kinds.extend(fixed.filter(|kind| order.things.is_empty() || *kind == "Plate"));
        kinds.retain(|kind| !kind.is_empty());
        let again = kinds.iter().any(|kind| used.contains(kind)) || thing.1 == other.1 && !other.1.is_empty();
        if drawn.contains(&number) || again {
            continue;
        }
        drawn.push(number);
        used.extend(kinds);
        let way: &'static str = random.pick::<&'static str>(&order.said);
        said.push(named(way, thing.0, other.0));
        goals.push(named(order.goal, thing.1, other.1));
        if said.len() == count {
            break;
        }
    }
    let mut text = (*random.pick::<&'static str>(&SHELLS)).to_owned();
    for (at, order) in said.iter().enumerate() {
        let joint = if at == 0 { "" } else { *random.pick::<&'static str>(&JOINTS) };
        text.push_str(joint);
        text.push_str(order);
    }
    format!("FloorPlan6 | {text}. | {}\n", goals.join("; "))
}

fn named(text: &str, thing: &str, other: &str) -> String {
    let word = |part: &str| part.replace('X', thing).replace('Y', other);
    text.split(' ').map(word).collect::<Vec<_>>().join(" ")
}

#[test]
fn joined_orders_are_all_understood() {
    let offline = Offline::new().expect("the built-in lexicon reads");
    let (orders, mut random) = (orders(), Random(7));
    let lines: String = (0..SENTENCES).map(|_| sentence(&orders, &mut random)).collect();
    let outcomes = judge::outcomes(&lines, &offline).expect("the grammar writes lines");
    let bad: Vec<_> = outcomes.iter().filter(|outcome| !outcome.good).collect();
    let good = outcomes.len() - bad.len();
    println!("joined orders: {good} of {}", outcomes.len());
    let told: String = bad
        .iter()
        .map(|outcome| format!("{}\n    want {}\n    {}\n", outcome.sentence, outcome.goal, outcome.told))
        .collect();
    assert!(good * 100 >= outcomes.len() * LEAST, "{good} of {}\n{told}", outcomes.len());
}
