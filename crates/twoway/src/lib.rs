//! The two-way interior point method: resolve(x, y) without intersections.
