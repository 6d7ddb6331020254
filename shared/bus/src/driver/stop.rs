//! Ending a driver from another thread.

use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::{Arc, Mutex, PoisonError};
use std::task::Waker;

/// A flag that ends drivers. Clones are the same flag.
#[derive(Clone, Debug, Default)]
pub struct Stop {
    shared: Arc<Shared>,
}

#[derive(Debug, Default)]
struct Shared {
    set: AtomicBool,
    wakers: Mutex<Vec<Waker>>,
}

impl Stop {
    /// Asks all drivers that have this flag to end.
    pub fn stop(&self) {
        self.shared.set.store(true, Ordering::Release);
        for waker in self.shared.wakers.lock().unwrap_or_else(PoisonError::into_inner).iter() {
            waker.wake_by_ref();
        }
    }

    /// Whether it was used.
    pub fn is_set(&self) -> bool {
        self.shared.set.load(Ordering::Acquire)
    }

    /// Has `waker` woken when the flag is set. A flag set before is seen by the driver's first look.
    pub fn register(&self, waker: &Waker) {
        self.shared.wakers.lock().unwrap_or_else(PoisonError::into_inner).push(waker.clone());
    }
}
