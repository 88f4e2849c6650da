//! Whether two objects are the same, told in constant time.

use std::sync::atomic::{AtomicU64, Ordering};

/// Tells one state of an object from all others: what keeps data of an object, such as a search of a
/// collision model, compares identities to notice another object of equal size.
///
/// Copies of an object share its identity, and a change gives it a new one. So equal identities mean equal
/// content. The reverse does not hold: two objects that were built alike have two identities.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
pub struct Identity(u64);

impl Identity {
    /// An identity that nothing else has. [`Self::default`] is that of empty objects.
    pub fn unique() -> Self {
        // 2^64 identities do not run out: one per nanosecond lasts for 580 years.
        static NEXT: AtomicU64 = AtomicU64::new(1);
        Self(NEXT.fetch_add(1, Ordering::Relaxed))
    }
}
