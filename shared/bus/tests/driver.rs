//! The driver on a bus: inputs, outputs, time, jobs and how it ends.
#![expect(clippy::unwrap_used, reason = "a failure here is a failed test")]

use std::sync::atomic::{AtomicBool, Ordering};
use std::time::Instant;

use lamma_bus::driver::{DriverError, End, Settings, Stop, Worker, drive};
use lamma_bus::iceoryx::{Endpoint, Run};
use lamma_bus::inproc::Hub;
use lamma_bus::{Bus, Received, trace};
use lamma_protocol::message::{Command, Grant};
use lamma_protocol::{
    AgentId, Epoch, Input, JobId, Machine, Message, Node, Output, Revision, Tick, Topic, frame,
};

/// A machine made of the outputs it gives at its start and a function of its inputs.
struct Script<F> {
    outputs: std::collections::VecDeque<Output<&'static str>>,
    timeout: Option<Tick>,
    react: F,
}

type Outputs = Vec<Output<&'static str>>;

fn script<F: FnMut(Input<'_, String>) -> Outputs>(start: Outputs, react: F) -> Script<F> {
    Script { outputs: start.into(), timeout: None, react }
}

impl<F: FnMut(Input<'_, String>) -> Outputs> Machine for Script<F> {
    type Job = &'static str;
    type Done = String;

    fn handle(&mut self, now: Tick, input: Input<'_, String>) {
        if matches!(input, Input::Timeout) {
            assert!(self.timeout.is_some_and(|t| t <= now), "a timeout before its time");
            self.timeout = None;
        }
        self.outputs.extend((self.react)(input));
    }

    fn poll_output(&mut self) -> Option<Output<&'static str>> {
        self.outputs.pop_front()
    }

    fn poll_timeout(&self) -> Option<Tick> {
        self.timeout
    }
}

/// Says its job back; `panic` panics, `cancel` lasts until it is cancelled, `deaf` for ever.
fn worker() -> Worker<&'static str, String> {
    Box::new(|job, cancelled| match job {
        "panic" => panic!("boom"),
        "cancel" => {
            while !cancelled.load(Ordering::Relaxed) {
                std::thread::yield_now();
            }
            "cancelled".to_owned()
        }
        job => job.to_owned(),
    })
}

fn grant() -> Message {
    Message::Grant(Grant { epoch: Epoch(1), lost: vec![] })
}

fn coordinator() -> lamma_bus::inproc::Inproc {
    Hub::new(1).open(Node::Coordinator).expect("a node of the team")
}

#[test]
fn revisions_are_added_and_rise_within_the_incarnation() {
    let hub = Hub::new(1);
    let mut simulator = hub.open(Node::Simulator).unwrap();
    let mut bus = hub.open(Node::Coordinator).unwrap();
    let start = vec![Output::Publish(Topic::Grant, grant()), Output::Publish(Topic::Grant, grant())];
    let mut machine = script([start, vec![Output::Finish]].concat(), |_| vec![]);
    let settings = Settings { incarnation: 4, ..Settings::default() };
    assert_eq!(drive(&mut machine, &mut bus, settings, vec![]).unwrap(), End::Finished);
    let mut seen = None;
    simulator.receive(&mut |r| {
        if let Received::Message(Topic::Grant, envelope) = r {
            seen = Some(envelope.revision);
        }
    });
    assert_eq!(seen, Some(Revision { incarnation: 4, number: 2 }));
}

#[test]
fn messages_frames_timeouts_and_answers_reach_the_machine() {
    let hub = Hub::new(1);
    let mut supervisor = hub.open(Node::Supervisor).unwrap();
    let mut simulator = hub.open(Node::Simulator).unwrap();
    let envelope = lamma_protocol::Envelope {
        revision: Revision::default(),
        message: Message::Command(Command { lost: vec![AgentId(0)], stop: false }),
    };
    supervisor.publish(Topic::Command, &envelope).unwrap();
    simulator.publish_frame(&frame::write_frame(&Default::default(), &[])).unwrap();
    let mut seen = [false; 4];
    let mut machine = script(vec![Output::Spawn(JobId(1), "work")], |input| {
        match input {
            Input::Message(Topic::Command, e) => seen[0] = e == envelope,
            Input::Frame(frame) => seen[1] = frame.facts() == 0,
            Input::Timeout => seen[2] = true,
            Input::Done(JobId(1), done) => seen[3] = done == "work",
            other => panic!("unexpected {other:?}"),
        }
        if seen == [true; 4] { vec![Output::Finish] } else { vec![] }
    });
    machine.timeout = Some(Tick(2_000));
    let mut bus = hub.open(Node::Coordinator).unwrap();
    let mut trace = trace::Writer::new(Vec::new());
    let record = Some(Box::new(|tick, node, input: &Input<'_, String>| trace.record(tick, node, input)) as _);
    let settings = Settings { record, ..Settings::default() };
    assert_eq!(drive(&mut machine, &mut bus, settings, vec![worker()]).unwrap(), End::Finished);
    let trace = String::from_utf8(trace.finish().unwrap()).unwrap();
    assert_eq!(trace.lines().count(), 4, "every input is one line:\n{trace}");
    assert!(trace.contains(r#""input":{"done":{"job":1,"answer":"work"}}"#), "{trace}");
}

#[test]
fn a_panicking_job_is_an_orderly_error() {
    let mut machine = script(vec![Output::Spawn(JobId(7), "panic")], |_| vec![]);
    let error = drive(&mut machine, &mut coordinator(), Settings::default(), vec![worker()]).unwrap_err();
    assert!(
        matches!(&error, DriverError::JobPanicked { job: 7, message, .. } if message == "boom"),
        "{error}"
    );
}

#[test]
fn a_cancelled_answer_is_dropped() {
    let start = vec![
        Output::Spawn(JobId(1), "cancel"),
        Output::Spawn(JobId(2), "waiting"),
        Output::Cancel(JobId(1)),
        Output::Cancel(JobId(2)),
        Output::Spawn(JobId(3), "wanted"),
    ];
    let mut machine = script(start, |input| match input {
        Input::Done(JobId(3), _) => vec![Output::Finish],
        other => panic!("unexpected {other:?}"),
    });
    let end = drive(&mut machine, &mut coordinator(), Settings::default(), vec![worker()]).unwrap();
    assert_eq!(end, End::Finished);
}

#[test]
fn a_stop_ends_a_sleeping_driver_and_its_jobs() {
    let stop = Stop::default();
    let settings = Settings { stop: stop.clone(), start: Instant::now(), ..Settings::default() };
    let started = AtomicBool::new(false);
    let mut machine = script(vec![Output::Spawn(JobId(1), "cancel")], |_| vec![]);
    std::thread::scope(|scope| {
        let driver = scope.spawn(|| {
            started.store(true, Ordering::Release);
            drive(&mut machine, &mut coordinator(), settings, vec![worker()])
        });
        while !started.load(Ordering::Acquire) {
            std::thread::yield_now();
        }
        stop.stop();
        assert_eq!(driver.join().unwrap().unwrap(), End::Stopped);
    });
}

#[test]
fn publishing_elsewhere_is_an_error_that_names_both() {
    let mut machine = script(vec![Output::Publish(Topic::Command, grant())], |_| vec![]);
    let error = drive(&mut machine, &mut coordinator(), Settings::default(), vec![]).unwrap_err();
    let text = error.to_string();
    assert!(text.contains("coordinator") && text.contains("supervisor"), "{text}");
}

#[test]
fn of_several_frames_at_once_the_last_is_published() {
    let hub = Hub::new(1);
    let mut robot = hub.open(Node::Robot(AgentId(0))).unwrap();
    let mut bus = hub.open(Node::Simulator).unwrap();
    let words =
        |version| frame::write_frame(&lamma_protocol::FrameHeader { version, ..Default::default() }, &[]);
    let frames = (1..=3).map(|v| Output::PublishFrame(words(v))).chain([Output::Finish]).collect();
    drive(&mut script(frames, |_| vec![]), &mut bus, Settings::default(), vec![]).unwrap();
    assert_eq!(bus.stats().published, 1);
    robot.receive(&mut |r| assert!(matches!(r, Received::Frame(f) if f.version() == 3)));
}

/// One machine grants, the other shows it in a frame, the first has seen it.
fn grant_and_frame(simulator: &mut dyn Bus, stop: Stop) {
    let mut arbiter = script(vec![], |input| match input {
        Input::Message(Topic::Grant, envelope) => {
            let Message::Grant(grant) = envelope.message else { unreachable!() };
            let header = lamma_protocol::FrameHeader { epoch: grant.epoch, ..Default::default() };
            vec![Output::PublishFrame(frame::write_frame(&header, &[]))]
        }
        _ => vec![],
    });
    let settings = Settings { stop, ..Settings::default() };
    drive(&mut arbiter, simulator, settings, vec![]).unwrap();
}

fn grant_until_seen(bus: &mut dyn Bus) {
    let mut coordinator = script(vec![Output::Publish(Topic::Grant, grant())], |input| match input {
        Input::Frame(frame) if frame.epoch() == Epoch(1) => vec![Output::Finish],
        _ => vec![],
    });
    assert_eq!(drive(&mut coordinator, bus, Settings::default(), vec![]).unwrap(), End::Finished);
}

#[test]
fn the_same_machines_run_over_shared_memory() {
    let run = Run::create(1).unwrap();
    let scope = run.scope().clone();
    let stop = Stop::default();
    std::thread::scope(|threads| {
        threads.spawn(|| {
            grant_and_frame(&mut Endpoint::open(&scope, Node::Simulator).unwrap(), stop.clone());
        });
        for _ in 0..10 {
            grant_until_seen(&mut run.open(Node::Coordinator).unwrap());
        }
        stop.stop();
    });
    run.end().unwrap();
}
