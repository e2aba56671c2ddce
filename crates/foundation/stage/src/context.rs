//! How to run: nothing here is hashed, so nothing here may change a result.

use std::any::{Any, TypeId};
use std::cell::Cell;
use std::collections::HashMap;
use std::fmt;
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::{Arc, Condvar, Mutex, MutexGuard, PoisonError};
use std::time::Duration;

use biplane_artifact::ContentHash;

/// How long one item waits for what another prepares before it prepares its own; see [`Context::prepared`].
const PATIENCE: Duration = if cfg!(test) { Duration::from_millis(500) } else { Duration::from_secs(10) };

type MemoKey = (ContentHash, TypeId);

enum Slot {
    Building,
    Ready(Arc<dyn Any + Send + Sync>),
}

#[derive(Default)]
struct Shared {
    cancelled: AtomicBool,
    memo: Mutex<HashMap<MemoKey, Slot>>,
    changed: Condvar,
}

impl Shared {
    fn memo(&self) -> MutexGuard<'_, HashMap<MemoKey, Slot>> {
        // Every change to the map is a single insert or remove, so one that panicked left it whole.
        self.memo.lock().unwrap_or_else(PoisonError::into_inner)
    }
}

/// Given to every `run`, shared by all items of one run of the program. Clones are the same context.
#[derive(Clone, Default)]
pub struct Context(Arc<Shared>);

impl Context {
    /// Not cancelled, with nothing prepared.
    pub fn new() -> Self {
        Self::default()
    }

    /// Asks all items to stop. Cannot be taken back.
    pub fn cancel(&self) {
        self.0.cancelled.store(true, Ordering::Relaxed);
    }

    /// Whether to stop. A stage that looks may return any error or value: nothing of it is kept once this is true.
    pub fn cancelled(&self) -> bool {
        self.0.cancelled.load(Ordering::Relaxed)
    }

    /// What `build` makes, once a run for each hash and type `V`: a mesh's adjacency, a search tree over curves.
    ///
    /// `V` must be a type of its own for this preparation and a function of the content that `hash` is of, nothing else:
    /// then it does not matter which item comes first. Everything is kept until the context goes.
    ///
    /// One item builds while others wait, so far as waiting is safe. `build` may call `prepared` for something else, and
    /// may use a thread pool, whose threads may then pick up another item that wants what is being built here. So a
    /// thread that is itself building never waits, and no thread waits longer than ten seconds: it builds its own copy
    /// instead, which is equal.
    pub fn prepared<V: Any + Send + Sync>(&self, hash: ContentHash, build: impl FnOnce() -> V) -> Arc<V> {
        let key = (hash, TypeId::of::<V>());
        match self.claim(key) {
            Claim::Ready(value) => value.downcast().unwrap_or_else(|_| Arc::new(build())),
            Claim::OwnCopy => Arc::new(build()),
            Claim::Mine => {
                let ticket = Ticket { shared: &self.0, key };
                let depth = BUILDING.replace(BUILDING.get() + 1);
                let restore = RestoreDepth(depth);
                let value = Arc::new(build());
                drop(restore);
                self.0.memo().insert(ticket.key, Slot::Ready(Arc::clone(&value) as _));
                drop(ticket);
                value
            }
        }
    }

    fn claim(&self, key: MemoKey) -> Claim {
        let building = |memo: &mut HashMap<MemoKey, Slot>| matches!(memo.get(&key), Some(Slot::Building));
        let mut memo = self.0.memo();
        if building(&mut memo) {
            if BUILDING.get() > 0 {
                return Claim::OwnCopy;
            }
            let waited = self.0.changed.wait_timeout_while(memo, PATIENCE, |m| building(m));
            memo = waited.unwrap_or_else(PoisonError::into_inner).0;
        }
        match memo.get(&key) {
            Some(Slot::Ready(value)) => Claim::Ready(Arc::clone(value)),
            Some(Slot::Building) => Claim::OwnCopy,
            None => {
                memo.insert(key, Slot::Building);
                Claim::Mine
            }
        }
    }
}

impl fmt::Debug for Context {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_struct("Context").field("cancelled", &self.cancelled()).finish_non_exhaustive()
    }
}

enum Claim {
    Ready(Arc<dyn Any + Send + Sync>),
    Mine,
    OwnCopy,
}

thread_local! {
    /// How many `build` calls this thread is inside of.
    static BUILDING: Cell<usize> = const { Cell::new(0) };
}

struct RestoreDepth(usize);

impl Drop for RestoreDepth {
    fn drop(&mut self) {
        BUILDING.set(self.0);
    }
}

/// Frees the slot if `build` panics, and wakes those who wait either way.
struct Ticket<'a> {
    shared: &'a Shared,
    key: MemoKey,
}

impl Drop for Ticket<'_> {
    fn drop(&mut self) {
        let mut memo = self.shared.memo();
        if matches!(memo.get(&self.key), Some(Slot::Building)) {
            memo.remove(&self.key);
        }
        drop(memo);
        self.shared.changed.notify_all();
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::sync::Barrier;
    use std::sync::atomic::AtomicUsize;
    use std::time::Instant;

    fn hash(n: u8) -> ContentHash {
        ContentHash::from_bytes([n; 32])
    }

    #[test]
    fn one_item_builds_while_the_others_wait() {
        let (context, built, start) = (Context::new(), AtomicUsize::new(0), Barrier::new(8));
        std::thread::scope(|scope| {
            for _ in 0..8 {
                scope.spawn(|| {
                    start.wait();
                    let value = context.prepared(hash(1), || {
                        std::thread::sleep(Duration::from_millis(30));
                        built.fetch_add(1, Ordering::Relaxed)
                    });
                    assert_eq!(*value, 0);
                });
            }
        });
        assert_eq!(built.load(Ordering::Relaxed), 1);
    }

    #[test]
    fn hashes_and_types_are_kept_apart() {
        let context = Context::new();
        assert_eq!(*context.prepared(hash(1), || 1_u32), 1);
        assert_eq!(*context.prepared(hash(2), || 2_u32), 2);
        assert_eq!(*context.prepared(hash(1), || "text"), "text");
        assert_eq!(*context.clone().prepared(hash(1), || 9_u32), 1);
    }

    #[test]
    fn building_within_building_does_not_wait_for_itself() {
        let (context, started) = (Context::new(), Instant::now());
        let outer = context.prepared(hash(1), || {
            // What a thread pool does when it hands an item to a thread that waits for its own parallel loop.
            let same = context.prepared(hash(1), || 5_u32);
            let other = context.prepared(hash(2), || 7_u32);
            *same + *other
        });
        assert_eq!(*outer, 12);
        assert!(started.elapsed() < PATIENCE);
        assert_eq!(*context.prepared(hash(1), || 0_u32), 12);
        assert_eq!(*context.prepared(hash(2), || 0_u32), 7);
    }

    #[test]
    fn a_builder_that_depends_on_one_who_waits_for_it_ends() {
        let (context, started) = (Context::new(), Barrier::new(2));
        std::thread::scope(|scope| {
            // A thread pool may give a part of a builder's parallel loop to a thread that then takes up another item.
            let waiting = scope.spawn(|| {
                started.wait();
                *context.prepared(hash(1), || 5_u32)
            });
            let built = context.prepared(hash(1), || {
                started.wait();
                waiting.join().unwrap()
            });
            assert_eq!(*built, 5);
        });
    }

    #[test]
    fn a_panic_while_building_frees_the_place() {
        let context = Context::new();
        let failed = std::panic::catch_unwind(std::panic::AssertUnwindSafe(|| {
            context.prepared(hash(1), || -> u32 { panic!("on purpose") })
        }));
        assert!(failed.is_err());
        assert_eq!(*context.prepared(hash(1), || 3_u32), 3);
    }
}
