//! Filters of negative curvatures.

use crate::params::HessianFilter;

/// What is done with a negative curvature; `Exact` keeps it, for tests.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Filter {
    Clamp,
    Absolute,
    #[cfg(test)]
    Exact,
}

impl Filter {
    /// The filter for a target; `first` says whether the target is the first of its time step.
    pub fn new(filter: HessianFilter, first: bool) -> Self {
        match filter {
            HessianFilter::Clamp => Filter::Clamp,
            HessianFilter::Absolute => Filter::Absolute,
            HessianFilter::Mixed if first => Filter::Absolute,
            HessianFilter::Mixed => Filter::Clamp,
        }
    }

    #[inline]
    pub fn apply(self, curvature: f64) -> f64 {
        match self {
            Filter::Clamp => curvature.max(0.0),
            Filter::Absolute => curvature.abs(),
            #[cfg(test)]
            Filter::Exact => curvature,
        }
    }
}
