//! What goes wrong in a run: drawn from the seed, printed with a failure.

use crate::rng::Rng;

/// The faults of one run. Until `heal_us` messages are lost, doubled and delayed; after it the network is
/// well and the run has to come to its end (a safety phase, then a liveness phase, as in TigerBeetle's
/// simulator).
#[derive(Clone, Debug, PartialEq)]
pub struct FaultPlan {
    /// Chance that a delivery is lost.
    pub loss: f64,
    /// Chance that a delivery comes twice.
    pub duplication: f64,
    /// Mean extra delay of a delivery, in microseconds; deliveries overtake each other.
    pub delay_us_mean: u64,
    /// When the network heals.
    pub heal_us: u64,
    /// Robots that die: (robot, when).
    pub crashes: Vec<(usize, u64)>,
    /// How long the supervisor takes to notice a death.
    pub notice_us: u64,
    /// Robots that stand still for a while: (robot, from, to). Long ones are given up and wake up late.
    pub pauses: Vec<(usize, u64, u64)>,
}

impl FaultPlan {
    /// Nothing goes wrong.
    pub fn none() -> Self {
        FaultPlan {
            loss: 0.0,
            duplication: 0.0,
            delay_us_mean: 0,
            heal_us: 0,
            crashes: Vec::new(),
            notice_us: 1_000,
            pauses: Vec::new(),
        }
    }

    /// A plan for a team of `robots`. Each kind of fault is absent in a share of the runs, so that the
    /// others are seen alone too.
    pub fn draw(rng: &mut Rng, robots: usize) -> Self {
        let mut sometimes = |p: f64| if rng.chance(p) { 1.0 } else { 0.0 };
        let (lossy, doubling, slow) = (sometimes(0.7), sometimes(0.6), sometimes(0.7));
        let loss = lossy * rng.fraction(0.3);
        let duplication = doubling * rng.fraction(0.5);
        let delay_us_mean = (slow * rng.fraction(30_000.0)) as u64;
        let heal_us = rng.range(0, 3_000_000);
        let mut crashes = Vec::new();
        let mut pauses = Vec::new();
        for robot in 0..robots {
            if rng.chance(0.2) {
                crashes.push((robot, rng.range(0, 1_500_000)));
            } else if rng.chance(0.2) {
                let from = rng.range(0, 1_000_000);
                pauses.push((robot, from, from + rng.range(1_000, 9_000_000)));
            }
        }
        FaultPlan {
            loss,
            duplication,
            delay_us_mean,
            heal_us,
            crashes,
            notice_us: rng.range(100, 50_000),
            pauses,
        }
    }
}
