//! The simulator, which interprets the PDDL domain, and a state machine written without it agree on what is
//! possible and on what comes of it: random acts through both.
//!
//! 8,000 acts by default; `AGREEMENT_STEPS=100000 cargo test -p lamma-tests --test agreement -- --nocapture`
//! does more and prints how often each action was applied and refused.
#![allow(clippy::unwrap_used, reason = "a test fails by panicking")]

use std::collections::{BTreeMap, BTreeSet};

use lamma_domains::robots::{Robot, SKILLS, actions_of};
use lamma_domains::seed::Seed;
use lamma_domains::world::{ObjectSpec, Rules, Thing, WorldSetup, setup_with};
use lamma_pddl::Name;
use lamma_planner::GroundAct;
use lamma_protocol::message::{Act, Grant, Message, Request, Verdict};
use lamma_protocol::{AgentId, Envelope, Epoch, Input, Machine, Output, Revision, StepIndex, Tick, Topic};
use lamma_simulator::{AgentSpec, Arbiter, Event, Happening, WorldConfig};
use lamma_tests::house::{COMPARED, House};

/// Things that happen without the team in one world.
const EVENTS: usize = 60;

/// Acts in one world before a new one is begun: later ones meet ever more broken and used-up things.
const EPISODE: usize = 400;

const KITCHEN: &str = r#"[
    {"type": "Apple", "in": "CounterTop_1"}, {"type": "Bread", "in": "CounterTop_1"}, {"type": "Egg", "in": "Fridge"},
    {"type": "Potato", "in": "Microwave"}, {"type": "Knife", "in": "CounterTop_1"}, {"type": "Pan", "in": "StoveBurner_1"},
    {"type": "Plate", "in": "CounterTop_1"}, {"type": "Mug", "in": "CounterTop_1", "is": {"isDirty": true}},
    {"type": "Bowl", "in": "SinkBasin"}, {"type": "Tomato", "in": "Bowl_1"}, {"type": "SoapBottle", "in": "CounterTop_1"},
    {"type": "PaperTowelRoll", "in": "CounterTop_1"}, {"type": "Cup", "in": "Cabinet_1", "is": {"fillLiquid": "wine"}}
]"#;

/// Each action's parameters after the robot: what a random act gives them.
#[derive(Clone, Copy)]
enum Give {
    Anything,
    Near,
    Held,
    /// Where the thing before it lies.
    ItsPlace,
    Crew,
    Liquid,
}

fn parameters(action: &str) -> &'static [Give] {
    match action {
        "GoToObject" => &[Give::Anything],
        "PickupObject" => &[Give::Near, Give::ItsPlace],
        "PutObject" => &[Give::Held, Give::Near],
        "DropHandObject" | "ThrowObject" => &[Give::Held],
        "PickupTogether" => &[Give::Crew, Give::Near, Give::ItsPlace],
        "PutTogether" => &[Give::Crew, Give::Held, Give::Near],
        "FillObject" => &[Give::Near, Give::Liquid],
        _ => &[Give::Near],
    }
}

/// Something that happens before a step of a robot.
#[derive(Clone, Debug)]
struct Scripted {
    agent: usize,
    step: u64,
    /// The act, or none for a step that fails.
    act: Option<Vec<String>>,
}

impl Scripted {
    fn event(&self) -> Event {
        let what = match &self.act {
            Some(words) => {
                Happening::Act(GroundAct::new(words[0].as_str(), words[1..].iter().map(String::as_str)))
            }
            None => Happening::Fail,
        };
        Event { agent: AgentId(self.agent as u16), step: self.step, what }
    }
}

/// Events of an episode, some of them possible when their time comes.
fn script(setup: &WorldSetup, random: &mut Seed) -> Vec<Scripted> {
    let pick = |which: &dyn Fn(&Thing) -> bool, random: &mut Seed| -> String {
        let names: Vec<&str> = setup.things.iter().filter(|t| which(t)).map(|t| t.name.as_str()).collect();
        names[random.below(names.len())].to_string()
    };
    let one = |_| {
        let agent = random.below(setup.members.len());
        let step = 1 + random.below(EPISODE / setup.members.len()) as u64;
        let act = match random.below(5) {
            0 => None,
            1 | 2 => Some(vec!["DoorClosed".to_string(), pick(&|t| t.can("openable"), random)]),
            _ => {
                let (x, to) =
                    (pick(&|t| t.can("pickupable"), random), pick(&|t| t.can("receptacle"), random));
                Some(vec!["ObjectMoved".to_string(), x, to])
            }
        };
        Scripted { agent, step, act }
    };
    (0..EVENTS).map(one).collect()
}

struct Both {
    setup: WorldSetup,
    arbiter: Arbiter,
    house: House,
    revision: u64,
    epoch: u64,
    now: Tick,
    /// What will still happen without the team.
    script: Vec<Scripted>,
    /// Steps of each robot that were judged.
    judged: Vec<u64>,
    /// What robots gather around for a while, so that they meet.
    focus: String,
}

impl Both {
    fn new(scene: &str, team: &[Robot], objects: Option<&str>, rules: &Rules, seed: u64) -> Both {
        let objects: Option<Vec<ObjectSpec>> = objects.map(|o| serde_json::from_str(o).unwrap());
        let setup =
            setup_with(scene, team, objects.as_deref(), seed, rules).unwrap_or_else(|e| panic!("{e}"));
        let script = script(&setup, &mut Seed::new(seed, &["events"]));
        let agents = setup.members.iter().map(|m| AgentSpec {
            name: Name::new(&m.name),
            skills: m.domain.actions.iter().map(|a| a.name.clone()).collect(),
        });
        let arbiter = Arbiter::new(WorldConfig {
            domain: setup.domain.clone(),
            objects: setup.objects.clone(),
            init: setup.init.clone(),
            agents: agents.collect(),
            on_lost: setup.on_lost.clone(),
            step_ms: 0,
            events: script.iter().map(|event| event.event()).collect(),
            travel: None,
        })
        .unwrap();
        let house = House::new(&setup, team, rules);
        let judged = vec![0; team.len()];
        Both {
            setup,
            arbiter,
            house,
            revision: 0,
            epoch: 0,
            now: Tick(0),
            script,
            judged,
            focus: "Floor_1".into(),
        }
    }

    fn say(&mut self, topic: Topic, message: Message) {
        self.revision += 1;
        let revision = Revision { incarnation: 0, number: self.revision };
        self.arbiter.handle(self.now, Input::Message(topic, Envelope { revision, message }));
    }

    /// The answer to that step of the agent, among what the simulator says; it repeats older ones.
    fn verdict(&mut self, agent: AgentId, step: StepIndex) -> Option<Verdict> {
        let mut verdict = None;
        while let Some(output) = self.arbiter.poll_output() {
            match output {
                Output::Publish(Topic::Ack(to), Message::Ack(ack))
                    if to == agent && (ack.epoch, ack.step) == (Epoch(self.epoch), step) =>
                {
                    verdict = Some(ack.verdict);
                }
                _ => {}
            }
        }
        verdict
    }

    fn grant(&mut self, lost: Vec<AgentId>) {
        self.epoch += 1;
        self.say(Topic::Grant, Message::Grant(Grant { epoch: Epoch(self.epoch), lost }));
    }

    /// The simulator's answer.
    fn ask(&mut self, agent: usize, words: &[&str]) -> Result<(), String> {
        let step = self.arbiter.progress()[agent];
        let act = Act { action: words[0].into(), args: words[1..].iter().map(ToString::to_string).collect() };
        let request = Request { epoch: Epoch(self.epoch), step, act, gates: Vec::new() };
        let id = AgentId(agent as u16);
        self.say(Topic::Request(id), Message::Request(request));
        let mut verdict = self.verdict(id, step);
        if verdict.is_none() {
            // It is held until the world has been still: something happens first.
            self.now = self.now.after_ms(1_000);
            self.arbiter.handle(self.now, Input::Timeout);
            verdict = self.verdict(id, step);
        }
        match verdict {
            Some(Verdict::Applied { .. }) => Ok(()),
            Some(Verdict::Refused(refusal)) => {
                // What is refused stays refused within its epoch.
                self.grant(Vec::new());
                Err(refusal.reason)
            }
            None => panic!("no answer to {words:?}"),
        }
    }

    /// What happens before the robot's next step, in the state machine; how much of it was possible, and whether the
    /// step itself fails.
    fn happen(&mut self, agent: usize) -> (usize, bool) {
        self.judged[agent] += 1;
        let step = self.judged[agent];
        let (now, later) =
            std::mem::take(&mut self.script).into_iter().partition(|e| (e.agent, e.step) == (agent, step));
        self.script = later;
        let now: Vec<Scripted> = now;
        let fails = now.iter().any(|event| event.act.is_none());
        let words = now.iter().filter_map(|event| event.act.as_ref());
        let words: Vec<Vec<&str>> = words.map(|w| w.iter().map(String::as_str).collect()).collect();
        (words.iter().filter(|w| self.house.happen(w).is_ok()).count(), fails)
    }

    fn facts(&self) -> BTreeSet<String> {
        let state = self.arbiter.state();
        let compared = state.facts.iter().filter(|f| COMPARED.contains(&f.predicate.as_str()));
        compared.map(|f| f.to_string().trim_matches(['(', ')']).to_string()).collect()
    }

    fn same_state(&self) -> Result<(), String> {
        let (theirs, ours) = (self.facts(), self.house.facts());
        if theirs == ours {
            return Ok(());
        }
        let only = |a: &BTreeSet<String>, b: &BTreeSet<String>| a.difference(b).cloned().collect::<Vec<_>>();
        Err(format!(
            "simulator alone: {:?}; state machine alone: {:?}",
            only(&theirs, &ours),
            only(&ours, &theirs)
        ))
    }

    /// An act for a random robot: mostly one that the state machine takes for possible, so that much happens,
    /// else any, so that much is refused.
    fn random_act(&mut self, random: &mut Seed) -> (usize, Vec<String>) {
        let agent = random.below(self.setup.members.len());
        let robot = self.setup.members[agent].name.clone();
        if random.below(20) == 0 {
            self.focus = self.anything(random);
        }
        let actions: Vec<&str> = actions_of(SKILLS).into_iter().collect();
        let wild = random.below(4) == 0;
        let mut trial = self.house.clone();
        for _ in 0..5 {
            let action = actions[random.below(actions.len())];
            // A hand is seldom withdrawn, or no crew ever comes together.
            if action == "WithdrawHand" && random.below(8) > 0 {
                continue;
            }
            for _ in 0..10 {
                let act = self.propose(action, &robot, random);
                if wild || trial.act(&act.iter().map(String::as_str).collect::<Vec<_>>()).is_ok() {
                    return (agent, act);
                }
            }
        }
        (agent, self.propose("GoToObject", &robot, random))
    }

    fn propose(&self, action: &str, robot: &str, random: &mut Seed) -> Vec<String> {
        let mut words = vec![action.to_string(), robot.to_string()];
        for give in parameters(action) {
            let word = match give {
                Give::Anything if random.below(2) == 0 => self.focus.clone(),
                Give::Anything => self.anything(random),
                Give::Near => self.one_of(self.house.near(robot), random),
                Give::Held => self.one_of(self.house.held(robot), random),
                Give::ItsPlace => self.one_of(self.house.container(&words[words.len() - 1]), random),
                Give::Crew => self.one_of(self.house.crews_of(robot), random),
                Give::Liquid => ["water", "coffee", "wine"][random.below(3)].to_string(),
            };
            words.push(word);
        }
        words
    }

    fn anything(&self, random: &mut Seed) -> String {
        self.setup.things[random.below(self.setup.things.len())].name.clone()
    }

    /// One of these; now and then anything at all.
    fn one_of<'a>(&self, names: impl Iterator<Item = &'a str>, random: &mut Seed) -> String {
        let names: Vec<&str> = names.collect();
        match names.len() {
            0 => self.anything(random),
            _ if random.below(15) == 0 => self.anything(random),
            n => names[random.below(n)].to_string(),
        }
    }
}

fn robot(name: &str, capacity_kg: f64, hands: u8) -> Robot {
    Robot { name: name.into(), skills: SKILLS.map(String::from).to_vec(), capacity_kg, hands }
}

/// One world of each kind: its scene, its team, its things, its rules.
fn worlds() -> Vec<(&'static str, Vec<Robot>, Option<&'static str>, Rules)> {
    let weak = vec![robot("r1", 0.35, 2), robot("r2", 0.3, 1), robot("r3", 0.4, 1)];
    let mixed = vec![robot("r1", 5.0, 1), robot("r2", 0.6, 2), robot("r3", 0.5, 1)];
    let mut half = mixed.clone();
    half[0].skills.retain(|s| s != "PickupObject" && s != "SwitchOn");
    half[1].skills.retain(|s| s != "PutObject" && s != "OpenObject");
    let exclusive = vec!["Fridge".into(), "CounterTop_1".into()];
    let own = Rules { knife_free: true, exclusive, ..Rules::default() };
    vec![
        ("FloorPlan6", mixed.clone(), Some(KITCHEN), Rules::default()),
        ("FloorPlan6", weak.clone(), Some(KITCHEN), Rules::default()),
        ("FloorPlan15", half, Some(KITCHEN), own),
        ("FloorPlan209", mixed.clone(), None, Rules::default()),
        ("FloorPlan303", weak, None, Rules::default()),
        ("FloorPlan414", mixed, None, Rules::default()),
    ]
}

#[test]
fn the_simulator_and_the_state_machine_agree() {
    let steps: usize = std::env::var("AGREEMENT_STEPS").ok().and_then(|n| n.parse().ok()).unwrap_or(8_000);
    let worlds = worlds();
    let mut counts: BTreeMap<String, [usize; 2]> = BTreeMap::new();
    let mut lost = 0;
    let mut events = [0, 0];
    for episode in 0..steps.div_ceil(EPISODE) {
        let (scene, team, objects, rules) = &worlds[episode % worlds.len()];
        let mut random = Seed::new(episode as u64, &["agreement"]);
        let mut both = Both::new(scene, team, *objects, rules, episode as u64);
        both.grant(Vec::new());
        both.same_state().unwrap_or_else(|what| panic!("{scene}, episode {episode}, at the start: {what}"));
        let mut log: Vec<String> = Vec::new();
        for step in 0..EPISODE.min(steps - episode * EPISODE) {
            let (agent, words) = both.random_act(&mut random);
            let words: Vec<&str> = words.iter().map(String::as_str).collect();
            let simulator = both.ask(agent, &words);
            let (happened, fails) = both.happen(agent);
            events[0] += happened;
            events[1] += usize::from(fails);
            let machine = if fails { Err("it is made to fail") } else { both.house.act(&words) };
            let tell = |what: String| -> ! {
                let log = log.join("\n");
                panic!("{scene}, episode {episode}, step {step}: {}: {what}\nafter\n{log}", words.join(" "))
            };
            match (&simulator, &machine) {
                (Ok(()), Err(why)) => tell(format!("the simulator did it, but {why}")),
                (Err(why), Ok(())) => tell(format!("the simulator refused it: {why}")),
                _ => both.same_state().unwrap_or_else(|what| tell(what)),
            }
            counts.entry(words[0].to_string()).or_default()[usize::from(simulator.is_err())] += 1;
            if simulator.is_ok() && words[0] == "SupportObject" {
                both.focus = words[2].to_string();
            }
            if simulator.is_ok() {
                log.push(words.join(" "));
            }
            // Near the end of every third episode a robot is lost.
            if step == EPISODE * 3 / 4 && episode % 3 == 0 {
                let gone = random.below(team.len());
                both.grant(vec![AgentId(gone as u16)]);
                both.house.lose(&team[gone].name);
                log.push(format!("RobotLost {}", team[gone].name));
                both.same_state().unwrap_or_else(|what| panic!("{what}\nafter\n{}", log.join("\n")));
                lost += 1;
            }
        }
    }
    let [happened, failed] = events;
    println!(
        "{steps} random acts, {lost} robots lost, {happened} events, {failed} made to fail: the simulator and the state machine agree"
    );
    for (action, [applied, refused]) in &counts {
        println!("{action:<16} applied {applied:>6}  refused {refused:>6}");
    }
    assert!(happened > 0 && failed > 0, "nothing happened without the team: {happened} and {failed}");
    for action in actions_of(SKILLS) {
        let applied = counts.get(action).map_or(0, |c| c[0]);
        assert!(applied > 0, "{action} was never applied: the walk is too tame to test it");
    }
}
