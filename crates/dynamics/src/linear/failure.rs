//! How backends fail.

use std::error::Error;

/// Why a backend failed.
pub type LinearBackendError = Box<dyn Error + Send + Sync>;
