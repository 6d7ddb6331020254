//! A priority queue of facts for costs that are mostly small.

use crate::task::FactId;

/// Facts by cost: a bucket for each small cost, a heap for the rest.
#[derive(Debug, Default)]
pub(super) struct BucketQueue {
    buckets: Vec<Vec<FactId>>,
    at: usize,
    highest: usize,
    dear: std::collections::BinaryHeap<std::cmp::Reverse<(u32, FactId)>>,
}

impl BucketQueue {
    const BUCKETS: usize = 1 << 14;

    pub fn clear(&mut self) {
        for bucket in self.buckets.iter_mut().take(self.highest + 1) {
            bucket.clear();
        }
        self.dear.clear();
        self.at = 0;
        self.highest = 0;
    }

    #[inline]
    pub fn push(&mut self, cost: u32, fact: FactId) {
        let at = cost as usize;
        if at >= Self::BUCKETS {
            return self.dear.push(std::cmp::Reverse((cost, fact)));
        }
        if at >= self.buckets.len() {
            self.buckets.resize_with(at + 1, Vec::new);
        }
        self.highest = self.highest.max(at);
        self.at = self.at.min(at);
        self.buckets[at].push(fact);
    }

    #[inline]
    pub fn pop(&mut self) -> Option<(u32, FactId)> {
        while self.at < self.buckets.len() && self.at <= self.highest {
            if let Some(fact) = self.buckets[self.at].pop() {
                return Some((self.at as u32, fact));
            }
            self.at += 1;
        }
        self.dear.pop().map(|std::cmp::Reverse(entry)| entry)
    }
}
