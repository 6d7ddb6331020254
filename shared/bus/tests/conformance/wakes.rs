//! What ends a wait, for any transport.
#![expect(clippy::unwrap_used, reason = "a failure here is a failed test")]

use std::time::Duration;

use lamma_bus::Bus;
use lamma_protocol::message::Gate;
use lamma_protocol::{Awaits, FrameHeader, Node, StepIndex, Topic, codec, frame};

use super::Fixture;
use super::suite::{PATIENCE, R0, R1, receive, sample, settle, until, words};

pub fn a_publication_ends_a_wait_in_another_thread<F: Fixture>() {
    let bus = F::new(1);
    std::thread::scope(|scope| {
        let (ready, is_ready) = std::sync::mpsc::channel();
        let reader = scope.spawn({
            let bus = &bus;
            move || {
                let mut robot = bus.open(Node::Robot(R0));
                ready.send(()).unwrap();
                for number in 1..=100 {
                    // No timeout: a bell that is not heard makes this test hang, and fail by that.
                    while !receive(&mut robot).iter().any(|g| g.number() == number) {
                        robot.wait(None).unwrap();
                    }
                    let topic = Topic::Request(R0);
                    robot.publish(topic, &sample(topic, number)).unwrap();
                }
            }
        });
        let mut simulator = bus.open(Node::Simulator);
        is_ready.recv().unwrap();
        for number in 1..=100 {
            simulator.publish_frame(&words(number, 10)).unwrap();
            while !receive(&mut simulator).iter().any(|g| g.number() == number) {
                simulator.wait(None).unwrap();
            }
        }
        reader.join().unwrap();
    });
}

/// A frame in which R1 has done so many steps.
fn progress(version: u64, done: u64) -> Vec<u64> {
    let progress = vec![StepIndex(0), StepIndex(done as u32)];
    frame::write_frame(&FrameHeader { version, progress, ..FrameHeader::default() }, &[])
}

pub fn an_awaited_frame_ends_a_wait_in_another_thread<F: Fixture>() {
    let bus = F::new(2);
    std::thread::scope(|scope| {
        let (ready, is_ready) = std::sync::mpsc::channel();
        let reader = scope.spawn({
            let bus = &bus;
            move || {
                let mut robot = bus.open(Node::Robot(R0));
                ready.send(()).unwrap();
                for number in 1..=100 {
                    let gate = Gate { agent: R1, done: StepIndex(number as u32) };
                    while !receive(&mut robot).iter().any(|g| g.number() == 2 * number) {
                        robot.await_frames(Awaits::Opening(gate));
                        robot.wait(None).unwrap();
                    }
                    let topic = Topic::Request(R0);
                    robot.publish(topic, &sample(topic, number)).unwrap();
                }
            }
        });
        let mut simulator = bus.open(Node::Simulator);
        is_ready.recv().unwrap();
        for number in 1..=100 {
            simulator.publish_frame(&progress(2 * number - 1, number - 1)).unwrap();
            simulator.publish_frame(&progress(2 * number, number)).unwrap();
            while !receive(&mut simulator).iter().any(|g| g.number() == number) {
                simulator.wait(None).unwrap();
            }
        }
        reader.join().unwrap();
    });
}

pub fn what_is_not_awaited_comes_with_what_is<F: Fixture>() {
    let bus = F::new(2);
    let (mut simulator, mut robot) = (bus.open(Node::Simulator), bus.open(Node::Robot(R0)));
    settle(&mut [&mut simulator, &mut robot]);
    let ack = Topic::Ack(R0);
    robot.await_frames(Awaits::NoFrame);
    simulator.publish_frame(&progress(1, 1)).unwrap();
    simulator.publish_quietly(ack, &codec::encode(&sample(ack, 1)).unwrap()).unwrap();
    simulator.publish(Topic::Ack(R0), &sample(ack, 2)).unwrap();
    let got = until(&mut robot, ack, 2, &mut [&mut simulator]);
    assert!(got.iter().any(|g| g.topic() == Some(Topic::Frame) && g.number() == 1), "{got:?}");
    // One that came before it was awaited is not waited for in vain.
    simulator.publish_frame(&progress(2, 1)).unwrap();
    robot.await_frames(Awaits::AnyFrame);
    while !receive(&mut robot).iter().any(|g| g.number() == 2) {
        assert!(robot.wait(Some(PATIENCE)).unwrap(), "the frame was slept through");
    }
}

pub fn a_waker_ends_a_wait<F: Fixture>() {
    let bus = F::new(1);
    let mut robot = bus.open(Node::Robot(R0));
    let waker = robot.waker();
    std::thread::scope(|scope| {
        let thread = scope.spawn(move || {
            std::thread::sleep(Duration::from_millis(20));
            waker.wake();
        });
        while !robot.wait(None).unwrap() {}
        thread.join().unwrap();
    });
}

pub fn a_waker_used_before_the_wait_is_not_lost<F: Fixture>() {
    let bus = F::new(1);
    let mut robot = bus.open(Node::Robot(R0));
    robot.waker().wake();
    assert!(robot.wait(Some(PATIENCE)).unwrap());
}

pub fn a_wait_ends_with_its_time<F: Fixture>() {
    let bus = F::new(1);
    let mut robot = bus.open(Node::Robot(R0));
    while robot.wait(Some(Duration::from_millis(5))).unwrap() {}
}
